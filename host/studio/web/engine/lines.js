// Lines to boards outside of the page, each as a MessagePort that carries bytes. Empty bytes close it.
// @ts-check

/** @import { Line } from "./types" */

import { after } from "../clock.js";

/** Line rate of a serial port, bits a second; native USB ignores it. */
const BAUD = 2_000_000;
const NO_BRIDGE =
  "The bridge of `frixel studio` gives no connection: is the command still running, its board plugged in, and no " +
  "other page connected to it?";
/** Longest wait for each step of closing a port, ms: a port that is stuck is left. */
const CLOSE_MAX_MS = 500;
/** Where the tab remembers the token of its bridge. */
const BRIDGE = "frixel.bridge";
/** Longest wait for the bridge to accept a connection, ms. */
const OPEN_MAX_MS = 5000;

/**
 * A line over Web Serial.
 * @param {SerialPort} port The user has chosen it.
 */
export async function serialLine(port) {
  await port.open({ baudRate: BAUD, bufferSize: 16384 });
  const writer = port.writable.getWriter();
  const reader = port.readable.getReader();
  return line((local) => {
    readAll(reader, local);
    return {
      write: (bytes) => writer.write(bytes),
      close: () => closePort(port, reader, writer),
    };
  });
}

/**
 * @param {ReadableStreamDefaultReader<Uint8Array<ArrayBuffer>>} reader
 * @param {Local} local
 */
async function readAll(reader, local) {
  try {
    for (;;) {
      const { value, done } = await reader.read();
      if (done) break;
      if (value.length > 0) local.receive(value);
    }
  } catch {
    // The cable was pulled: the end of the line says so.
  }
  local.close();
}

/**
 * Sends what is still to be sent, for a moment, and closes the port, which has to be free of readers and writers.
 * @param {SerialPort} port
 * @param {ReadableStreamDefaultReader<Uint8Array<ArrayBuffer>>} reader
 * @param {WritableStreamDefaultWriter<Uint8Array<ArrayBuffer>>} writer
 */
async function closePort(port, reader, writer) {
  await ended(reader.cancel());
  await ended(writer.close());
  await ended(writer.abort());
  reader.releaseLock();
  writer.releaseLock();
  await ended(port.close());
}

/**
 * Waits for a promise, but not for ever, and not for its outcome.
 * @param {Promise<unknown>} promise
 */
function ended(promise) {
  return Promise.race([promise.catch(() => {}), after(CLOSE_MAX_MS)]);
}

/**
 * The address of the bridge of `frixel studio`, if it serves this page and has a port; else null. The tab remembers its
 * token, since a shared scene takes the token's place in the page's address.
 */
export function bridgeUrl({ protocol, host, hash } = location) {
  if (protocol !== "http:") return null;
  const given = new URLSearchParams(hash.slice(1)).get("bridge");
  try {
    if (given) sessionStorage.setItem(BRIDGE, given);
    const token = given ?? sessionStorage.getItem(BRIDGE);
    return token ? `ws://${host}/serial?token=${token}` : null;
  } catch {
    // Without a session's store, the bridge is known as long as the address has its token.
    return given ? `ws://${host}/serial?token=${given}` : null;
  }
}

/**
 * A line over a WebSocket to the bridge of `frixel studio`.
 * @param {string} url
 */
export async function socketLine(url) {
  const socket = new WebSocket(url);
  socket.binaryType = "arraybuffer";
  const opened = new Promise((resolve) => (socket.onopen = () => resolve(true)));
  const failed = new Promise((resolve) => (socket.onerror = () => resolve(false)));
  if (!(await Promise.race([opened, failed, after(OPEN_MAX_MS)]))) {
    socket.close();
    throw new Error(NO_BRIDGE);
  }
  return line((local) => {
    const closed = new Promise((resolve) => (socket.onclose = resolve));
    closed.then(() => local.close());
    socket.onmessage = ({ data }) => local.receive(new Uint8Array(data));
    return {
      async write(bytes) {
        if (socket.readyState === WebSocket.OPEN) socket.send(bytes);
      },
      async close() {
        socket.close();
        await ended(closed);
      },
    };
  });
}

/**
 * The end of a line in the page: takes what has arrived, and closes the line.
 * @typedef {{ receive: (bytes: Uint8Array<ArrayBuffer>) => void, close: () => void }} Local
 */

/**
 * A line whose far end `open` connects: both functions that it returns may fail or take their time.
 * @param {(local: Local) => {
 *   write: (bytes: Uint8Array<ArrayBuffer>) => Promise<void>, close: () => Promise<void>,
 * }} open
 * @returns {Line}
 */
function line(open) {
  const { port1: local, port2: remote } = new MessageChannel();
  /** @type {PromiseWithResolvers<void>} */
  const { promise: closed, resolve } = Promise.withResolvers();
  let isOpen = true;
  const close = () => {
    if (!isOpen) return;
    isOpen = false;
    local.postMessage(new Uint8Array());
    far.close().finally(() => {
      local.close();
      resolve();
    });
  };
  const far = open({ receive: (bytes) => local.postMessage(bytes), close });
  local.onmessage = async ({ data }) => {
    try {
      if (data.length === 0) close();
      else if (isOpen) await far.write(data);
    } catch {
      close();
    }
  };
  return { remote, close, closed };
}
