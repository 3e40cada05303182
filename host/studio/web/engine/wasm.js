// What the workers share, above all the WebAssembly module with values in place of buffers. A classic script, which the
// script of each worker follows in the worker's source: from a file, a browser starts no worker that imports modules.
"use strict";

/** The page sends a sign of life from each animation frame. The host lives this long after one, ms. */
const LIFE_MS = 25;

/**
 * A request was refused; `problems` has the places in the scene's text, if there are any. With `isLinkLost`, the board
 * can no longer be talked to over this line.
 */
class EngineError extends Error {
  constructor({ error, problems, isLinkLost }) {
    super(error);
    this.problems = problems ?? [];
    this.isLinkLost = isLinkLost ?? false;
  }
}

/** The imports of an instance that is connected to no stream. */
const NO_LINK = { link_write: () => -1, link_read: () => -1, link_now_ms: () => 0 };

/** One instance of the module. */
class Engine {
  #exports;
  #suspending = new Map();

  static async start(module, link = NO_LINK) {
    const engine = new Engine();
    const { exports } = await WebAssembly.instantiate(module, { link });
    engine.#exports = exports;
    exports.report_panics();
    return engine;
  }

  /** Memory of the instance. The view is valid until the next call. */
  get bytes() {
    return new Uint8Array(this.#exports.memory.buffer);
  }

  /** Calls an export that returns nothing or a number of its own. */
  plain(name, ...numbers) {
    return this.#exports[name](...numbers);
  }

  /** Calls an export, and returns its answer, an object. */
  call(name, input, ...numbers) {
    this.#put(input);
    return JSON.parse(this.#text(this.#guarded(name, () => this.#exports[name](...numbers))));
  }

  /** Calls an export, and returns its answer, an ArrayBuffer. */
  callForBytes(name, input, ...numbers) {
    this.#put(input);
    return this.#output(this.#guarded(name, () => this.#exports[name](...numbers)));
  }

  /** Calls an export that suspends. Until the promise settles, no other export may be called. */
  async callSuspending(name, input, ...numbers) {
    if (!this.#suspending.has(name)) this.#suspending.set(name, WebAssembly.promising(this.#exports[name]));
    this.#put(input);
    let code;
    try {
      code = await this.#suspending.get(name)(...numbers);
    } catch (trap) {
      throw this.#failure(trap);
    }
    return JSON.parse(this.#text(code));
  }

  #guarded(name, act) {
    try {
      return act();
    } catch (trap) {
      throw this.#failure(trap);
    }
  }

  /**
   * The error of a trap: the module has written the message of a panic, if it was one. The instance is of no more use,
   * and neither is its board.
   */
  #failure(trap) {
    try {
      const { error } = JSON.parse(new TextDecoder().decode(this.#output(0)));
      return new EngineError({ error, isLinkLost: true });
    } catch {
      return Object.assign(trap, { isLinkLost: true });
    }
  }

  #put(input) {
    const bytes = input ?? new Uint8Array();
    const address = this.#exports.input(bytes.length);
    this.bytes.set(bytes, address);
  }

  #text(code) {
    return new TextDecoder().decode(this.#output(code));
  }

  /** The answer. Throws an EngineError for a code other than 0. */
  #output(code) {
    const address = this.#exports.output();
    const bytes = this.#exports.memory.buffer.slice(address, address + this.#exports.output_len());
    if (code !== 0) throw new EngineError(JSON.parse(new TextDecoder().decode(bytes)));
    return bytes;
  }
}

/** The bytes of a request for a scene: { files, entry, finger, screen } and numbers. */
function requestOf({ files, ...rest }) {
  const encoder = new TextEncoder();
  const contents = Object.entries(files).map(([name, content]) => {
    return { name, bytes: typeof content === "string" ? encoder.encode(content) : content };
  });
  const heads = contents.map(({ name, bytes }) => ({ name, len: bytes.length }));
  const json = encoder.encode(JSON.stringify({ ...rest, files: heads }));
  const length = new Uint8Array(4);
  new DataView(length.buffer).setUint32(0, json.length, true);
  return joined([length, json, ...contents.map(({ bytes }) => bytes)]);
}

function joined(parts) {
  const all = new Uint8Array(parts.reduce((length, part) => length + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

/** Time since 1970 in ms, on the clock that the page and its workers share. */
function epochMs() {
  return performance.timeOrigin + performance.now();
}

/** Answers the requests of the page with `actions[type](message)`; messages without `id` get no answer. */
function serve(actions) {
  self.onmessage = async ({ data: message }) => {
    try {
      const value = await actions[message.type](message);
      if (message.id !== undefined) self.postMessage({ type: "answer", id: message.id, value });
    } catch (error) {
      const { message: sentence, problems, canLoadAgain } = error;
      if (message.id !== undefined) {
        self.postMessage({ type: "answer", id: message.id, error: sentence, problems, canLoadAgain });
      } else {
        self.postMessage({ type: "failure", error: sentence });
      }
    }
  };
}
