// The line to a board outside of the page, as a MessagePort that carries bytes. Empty bytes close it.
// @ts-check

/** @import { Line } from "./types" */

import { after } from "../clock.js";

/** Line rate of a serial port, bits a second; native USB ignores it. */
const BAUD = 2_000_000;
/** Longest wait for each step of closing a port, ms: a port that is stuck is left. */
const CLOSE_MAX_MS = 500;

/**
 * A line over Web Serial.
 * @param {SerialPort} port The user has chosen it.
 * @returns {Promise<Line>}
 */
export async function serialLine(port) {
  await port.open({ baudRate: BAUD, bufferSize: 16384 });
  const writer = port.writable.getWriter();
  const reader = port.readable.getReader();
  const { port1: local, port2: remote } = new MessageChannel();
  /** @type {PromiseWithResolvers<void>} */
  const { promise: closed, resolve } = Promise.withResolvers();
  let isOpen = true;
  const close = () => {
    if (!isOpen) return;
    isOpen = false;
    local.postMessage(new Uint8Array());
    closePort(port, reader, writer).finally(() => {
      local.close();
      resolve();
    });
  };
  local.onmessage = async ({ data }) => {
    try {
      if (data.length === 0) close();
      else if (isOpen) await writer.write(data);
    } catch {
      close();
    }
  };
  readAll(reader, (bytes) => local.postMessage(bytes)).finally(close);
  return { remote, close, closed };
}

/**
 * Gives on all bytes that come, until the end of the line.
 * @param {ReadableStreamDefaultReader<Uint8Array<ArrayBuffer>>} reader
 * @param {(bytes: Uint8Array<ArrayBuffer>) => void} give
 */
async function readAll(reader, give) {
  try {
    for (;;) {
      const { value, done } = await reader.read();
      if (done) return;
      if (value.length > 0) give(value);
    }
  } catch {
    // The cable was pulled.
  }
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
