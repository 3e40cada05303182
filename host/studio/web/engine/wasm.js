// What the workers share, above all the WebAssembly module with values in place of buffers. A classic script, which the
// script of each worker follows in the worker's source: from a file, a browser starts no worker that imports modules.
// @ts-check
"use strict";

/** @import * as T from "./types" */

/** The page sends a sign of life from each animation frame. The host lives this long after one, ms. */
const LIFE_MS = 25;

/**
 * A request was refused; `problems` has the places in the scene's text, if there are any. With `isLinkLost`, the board
 * is unreachable over this line.
 */
class EngineError extends Error {
  /** @param {{ error: string, problems?: T.Problem[], isLinkLost?: boolean }} answer */
  constructor({ error, problems, isLinkLost }) {
    super(error);
    this.problems = problems ?? [];
    this.isLinkLost = isLinkLost ?? false;
  }
}

/** The imports of an instance that is connected to no stream. */
/** @typedef {Record<"link_write" | "link_read" | "link_now_ms", WebAssembly.ImportValue>} Link */
/** @type {Link} */
const NO_LINK = { link_write: () => -1, link_read: () => -1, link_now_ms: () => 0 };

/** @typedef {(...numbers: number[]) => number} Export An export of the module. */

/** One instance of the module. */
class Engine {
  #memory;
  #exports;
  /** @type {Map<string, (...numbers: number[]) => Promise<number>>} */
  #suspending = new Map();
  /**
   * The names of the numbers in answers that are no JSON.
   * @type {{ mapHead: string[], frameHead: string[], frameColumns: string[], tickHz: number }}
   */
  layouts;

  /**
   * @param {WebAssembly.Memory} memory
   * @param {Record<string, Export>} exports
   */
  constructor(memory, exports) {
    this.#memory = memory;
    this.#exports = exports;
    exports.report_panics();
    this.layouts = this.call("layouts");
  }

  /**
   * @param {Link} link
   * @param {WebAssembly.Module} module
   */
  static async start(link = NO_LINK, module = compiled) {
    const { exports } = await WebAssembly.instantiate(module, { link });
    const { memory, ...functions } = exports;
    return new Engine(/** @type {WebAssembly.Memory} */ (memory), /** @type {Record<string, Export>} */ (functions));
  }

  /** Memory of the instance. The view is valid until the next call. */
  get bytes() {
    return new Uint8Array(this.#memory.buffer);
  }

  /**
   * Calls an export that returns nothing or a number of its own.
   * @param {string} name
   * @param {number[]} numbers
   */
  plain(name, ...numbers) {
    return this.#exports[name](...numbers);
  }

  /**
   * Calls an export, and returns its answer, an object.
   * @param {string} name
   * @param {Uint8Array | null} [input]
   * @param {number[]} numbers
   */
  call(name, input, ...numbers) {
    return JSON.parse(new TextDecoder().decode(this.callForBytes(name, input, ...numbers)));
  }

  /**
   * Calls an export, and returns its answer, an ArrayBuffer.
   * @param {string} name
   * @param {Uint8Array | null} [input]
   * @param {number[]} numbers
   */
  callForBytes(name, input, ...numbers) {
    this.#put(input);
    let code;
    try {
      code = this.#exports[name](...numbers);
    } catch (trap) {
      throw this.#failure(trap);
    }
    return this.#output(code);
  }

  /**
   * Calls an export that suspends. Until the promise settles, no other export may be called.
   * @param {string} name
   * @param {Uint8Array | null} [input]
   * @param {number[]} numbers
   */
  async callSuspending(name, input, ...numbers) {
    const act = this.#suspending.get(name) ?? WebAssembly.promising(this.#exports[name]);
    this.#suspending.set(name, act);
    this.#put(input);
    const code = await act(...numbers).catch((trap) => {
      throw this.#failure(trap);
    });
    return JSON.parse(new TextDecoder().decode(this.#output(code)));
  }

  /**
   * The error of a trap: the module has written the message of a panic, if it was one. The instance and its board can
   * no longer be used.
   * @param {unknown} trap
   */
  #failure(trap) {
    try {
      const { error } = JSON.parse(new TextDecoder().decode(this.#output(0)));
      return new EngineError({ error, isLinkLost: true });
    } catch {
      return Object.assign(/** @type {Error} */ (trap), { isLinkLost: true });
    }
  }

  /** @param {Uint8Array | null} [input] */
  #put(input) {
    const bytes = input ?? new Uint8Array();
    const address = this.#exports.input(bytes.length);
    this.bytes.set(bytes, address);
  }

  /**
   * The answer. Throws an EngineError for a code other than 0.
   * @param {number} code
   */
  #output(code) {
    const address = this.#exports.output();
    const bytes = this.#memory.buffer.slice(address, address + this.#exports.output_len());
    if (code !== 0) throw new EngineError(JSON.parse(new TextDecoder().decode(bytes)));
    return bytes;
  }
}

/**
 * Values by their names, which the module gives in the order of the values.
 * @template Value
 * @param {string[]} names
 * @param {ArrayLike<Value>} values
 * @returns {Record<string, Value>}
 */
function named(names, values) {
  return Object.fromEntries(names.map((name, at) => [name, values[at]]));
}

/**
 * The bytes of a request for a scene. The module compares names byte by byte; an accented letter is one character or
 * two, and file systems and text editors choose differently: a file goes by its name in either form.
 * @param {T.Request} request
 */
function requestOf({ files, ...rest }) {
  const encoder = new TextEncoder();
  const contents = Object.entries(files).flatMap(([name, content]) => {
    const bytes = typeof content === "string" ? encoder.encode(content) : content;
    const forms = new Set([name, name.normalize("NFC"), name.normalize("NFD")]);
    return [...forms].map((form) => ({ name: form, bytes }));
  });
  const heads = contents.map(({ name, bytes }) => ({ name, len: bytes.length }));
  const json = encoder.encode(JSON.stringify({ ...rest, files: heads }));
  const length = new Uint8Array(4);
  new DataView(length.buffer).setUint32(0, json.length, true);
  return joined([length, json, ...contents.map(({ bytes }) => bytes)]);
}

/** @param {Uint8Array[]} parts */
function joined(parts) {
  const all = new Uint8Array(parts.reduce((length, part) => length + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

/**
 * The time since 1970 that a test has given to this worker, ms; undefined where the machine's clock counts.
 * @type {number | undefined}
 */
let givenMs;
/**
 * What is done again and again.
 * @type {(() => void)[]}
 */
const repeated = [];

/** Time since 1970 in ms, on the clock that the page and its workers share. */
function epochMs() {
  return givenMs ?? performance.timeOrigin + performance.now();
}

/**
 * Calls `act` every so many ms, or each time that a test gives the time.
 * @param {() => void} act
 * @param {number} everyMs
 */
function repeat(act, everyMs) {
  repeated.push(act);
  setInterval(() => {
    if (givenMs === undefined) act();
  }, everyMs);
}

/** @type {Required<T.Actions>["time"]} */
function takeTime({ epochMs }) {
  givenMs = epochMs;
  for (const act of repeated) act();
  return {};
}

/**
 * The module, from the message that starts the worker.
 * @type {WebAssembly.Module}
 */
let compiled;
/** The last sign of life of the page, since 1970, ms. */
let lastLifeMs = -Infinity;

/**
 * The files of the last scene: those that have not changed are not sent again.
 * @type {T.Files}
 */
let known = {};

/**
 * A scene with all of its files, of which the message has those that the worker does not know.
 * @param {T.SentScene} sent
 * @returns {T.Request}
 */
function wholeScene({ kept, files, ...rest }) {
  known = { ...Object.fromEntries(kept.map((name) => [name, known[name]])), ...files };
  return { ...rest, files: known };
}

/**
 * Answers the requests of the page with `actions[type](message)`; messages without `id` get no answer.
 * @param {T.Actions} actions
 */
function serve(actions) {
  /** @type {Record<string, ((message: never) => unknown) | undefined>} */
  const all = { ...actions, time: takeTime };
  self.onmessage = async ({ data: message }) => {
    const { type, id } = message;
    if (message.scene) message.scene = wholeScene(message.scene);
    try {
      const value = await all[type]?.(/** @type {never} */ (message));
      if (id !== undefined) tell({ type: "answer", id, value });
    } catch (error) {
      const { message: sentence, problems, canLoadAgain } = /** @type {T.EngineFailure} */ (error);
      if (id !== undefined) tell({ type: "answer", id, error: sentence, problems, canLoadAgain });
      else tell({ type: "failure", error: sentence });
    }
  };
}

/**
 * Sends a message to the page.
 * @param {T.Answer | T.FromWorker} message
 * @param {Transferable[]} [transfer]
 */
function tell(message, transfer = []) {
  self.postMessage(message, { transfer });
}
