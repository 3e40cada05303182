// Lines to boards outside of the page, each as a MessagePort that carries bytes. Empty bytes close it.

/** Line rate of a serial port, bits a second; native USB ignores it. */
const BAUD = 2_000_000;

/** A line over Web Serial. `port` is a SerialPort that the user has chosen. */
export async function serialLine(port) {
  await port.open({ baudRate: BAUD, bufferSize: 16384 });
  const writer = port.writable.getWriter();
  const reader = port.readable.getReader();
  const { local, remote } = channel();
  local.onmessage = async ({ data }) => {
    if (data.length > 0) {
      writer.write(data).catch(() => local.postMessage(new Uint8Array()));
      return;
    }
    await reader.cancel().catch(() => {});
    await writer.close().catch(() => {});
    await port.close().catch(() => {});
  };
  readAll(reader, local);
  return remote;
}

async function readAll(reader, local) {
  try {
    for (;;) {
      const { value, done } = await reader.read();
      if (done) break;
      if (value.length > 0) local.postMessage(value);
    }
  } catch {
    // The cable was pulled: the end of the stream says so.
  }
  reader.releaseLock();
  local.postMessage(new Uint8Array());
}

/** The address of the bridge of `frixel studio`, if it serves this page and has a port; else null. */
export function bridgeUrl({ protocol, host, hash } = location) {
  const token = new URLSearchParams(hash.slice(1)).get("bridge");
  return protocol === "http:" && token ? `ws://${host}/serial?token=${token}` : null;
}

/** A line over a WebSocket to the bridge of `frixel studio`. */
export function socketLine(url) {
  return new Promise((resolve, reject) => {
    const socket = new WebSocket(url);
    socket.binaryType = "arraybuffer";
    const { local, remote } = channel();
    socket.onopen = () => resolve(remote);
    socket.onerror = () => reject(new Error("the bridge of `frixel studio` does not answer: is it still running?"));
    socket.onmessage = ({ data }) => local.postMessage(new Uint8Array(data));
    socket.onclose = () => local.postMessage(new Uint8Array());
    local.onmessage = ({ data }) => {
      if (data.length === 0) socket.close();
      else if (socket.readyState === WebSocket.OPEN) socket.send(data);
    };
  });
}

function channel() {
  const { port1, port2 } = new MessageChannel();
  return { local: port1, remote: port2 };
}
