// The bytes to and from a board outside of the page, over a MessagePort. Part of the source of the worker `host`.
// @ts-check
"use strict";

/** Bytes that wait to be read at most, for example while the page is hidden; the oldest are dropped first. */
const ARRIVED_MAX_BYTES = 1_000_000;

/** Wakes waiters when something has changed. */
class Signal {
  /** @type {Set<() => void>} */
  #waiting = new Set();

  give() {
    for (const wake of this.#waiting) wake();
  }

  /**
   * Resolves when the signal is given, or after `waitMs`.
   * @param {number} [waitMs]
   */
  async wait(waitMs) {
    /** @type {PromiseWithResolvers<void>} */
    const { promise, resolve } = Promise.withResolvers();
    const wake = () => resolve();
    this.#waiting.add(wake);
    const timer = waitMs === undefined ? undefined : setTimeout(wake, waitMs);
    await promise;
    clearTimeout(timer);
    this.#waiting.delete(wake);
  }
}

/** Bytes have arrived, the page lives, the call under way is broken off, or the stream was closed. */
const changed = new Signal();

/** A byte stream over a MessagePort. Empty bytes mean that the other end has closed. */
class Stream {
  #port;
  /** @type {Uint8Array[]} */
  #arrived = [];
  #arrivedLength = 0;
  isClosed = false;
  /** Bytes were dropped since this was last set to false. */
  hasDropped = false;

  /** @param {MessagePort} port */
  constructor(port) {
    this.#port = port;
    port.onmessage = ({ data }) => this.#take(data);
  }

  /** @param {Uint8Array} bytes */
  #take(bytes) {
    if (bytes.length === 0) this.isClosed = true;
    else this.#arrived.push(bytes);
    this.#arrivedLength += bytes.length;
    while (this.#arrivedLength > ARRIVED_MAX_BYTES) {
      this.#arrivedLength -= this.#arrived.shift()?.length ?? 0;
      this.hasDropped = true;
    }
    changed.give();
  }

  get hasBytes() {
    return this.#arrivedLength > 0;
  }

  close() {
    this.isClosed = true;
    this.#port.postMessage(new Uint8Array());
    this.#port.close();
    changed.give();
  }

  /**
   * Whether the bytes were sent.
   * @param {Uint8Array} bytes
   */
  write(bytes) {
    if (!this.isClosed) this.#port.postMessage(bytes);
    return !this.isClosed;
  }

  /**
   * At most `max` of the bytes that have arrived; null when there are none and the stream is closed.
   * @param {number} max
   */
  read(max) {
    const first = this.#arrived.shift();
    if (first === undefined) return this.isClosed ? null : new Uint8Array();
    if (first.length > max) this.#arrived.unshift(first.subarray(max));
    const bytes = first.subarray(0, max);
    this.#arrivedLength -= bytes.length;
    return bytes;
  }
}
