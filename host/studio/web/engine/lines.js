// Lines to boards outside of the page, each as a MessagePort that carries bytes. Empty bytes close it.
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
