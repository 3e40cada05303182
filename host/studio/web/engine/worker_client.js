// A worker of the engine, as the page talks to it: its source, questions with answers, and messages without.
// @ts-check

/** @import * as T from "./types" */

/** What the source of each worker consists of, in this order: files of this folder. */
const SCRIPTS = {
  board: ["wasm.js", "board.js"],
  checker: ["wasm.js", "checker.js"],
  host: ["wasm.js", "byte_stream.js", "telemetry.js", "remote_board.js", "host.js"],
};

/**
 * A worker, with promises for its answers.
 * @template {T.FromWorker} Message What it tells unasked.
 */
export class WorkerClient {
  #name;
  #onMessage;
  /** @type {Worker | undefined} */
  #worker;
  /** @type {Map<number, { resolve: (value: any) => void, reject: (error: Error) => void }>} */
  #asked = new Map();
  #lastId = 0;
  /**
   * The files of the last scene that the worker was sent.
   * @type {T.Files}
   */
  #known = {};
  /**
   * Why the worker answers no more, once it has failed or was ended.
   * @type {string | undefined}
   */
  #whyEnded;

  /**
   * @param {keyof typeof SCRIPTS} name
   * @param {(message: Message) => void} onMessage
   */
  constructor(name, onMessage) {
    this.#name = name;
    this.#onMessage = onMessage;
  }

  /** @param {T.Questions["start"]["asked"]} settings */
  async start(settings) {
    const name = this.#name;
    // One classic script: from a file, a browser starts no worker that imports modules.
    const source = await Promise.all(SCRIPTS[name].map((script) => studio.text(`engine/${script}`)));
    if (this.#whyEnded !== undefined) throw new Error(this.#whyEnded);
    const url = URL.createObjectURL(new Blob([source.join("\n")], { type: "text/javascript" }));
    const worker = new Worker(url, { name });
    this.#worker = worker;
    worker.onmessage = ({ data }) => (data.type === "answer" ? this.#settle(data) : this.#onMessage(data));
    worker.onerror = ({ message }) => {
      // What is left of it must not keep a board alive.
      const error = `the ${name} worker: ${message}`;
      this.terminate(error);
      this.#onMessage(/** @type {Message} */ ({ type: "failure", error }));
    };
    await this.ask({ type: "start", ...settings });
    URL.revokeObjectURL(url);
  }

  /** @param {T.Note} message */
  send(message) {
    this.#worker?.postMessage(message);
  }

  /**
   * @template {keyof T.Questions} Type
   * @param {{ type: Type } & T.Questions[Type]["asked"]} message
   * @param {Transferable[]} transfer
   * @returns {Promise<T.Questions[Type]["answer"]>}
   */
  ask(message, transfer = []) {
    if (this.#whyEnded !== undefined) return Promise.reject(new Error(this.#whyEnded));
    const worker = this.#worker;
    if (!worker) return Promise.reject(new Error(`the ${this.#name} worker has not started`));
    const id = ++this.#lastId;
    return new Promise((resolve, reject) => {
      this.#asked.set(id, { resolve, reject });
      const scene = "scene" in message ? { scene: this.#sent(message.scene) } : {};
      worker.postMessage({ ...message, ...scene, id }, transfer);
    });
  }

  /**
   * A scene with only those files that have changed since the last one: a check needs not copy all pictures.
   * @param {T.Request} scene
   * @returns {T.SentScene}
   */
  #sent({ files, ...rest }) {
    const isKnown = (/** @type {string} */ name) => name in this.#known && this.#known[name] === files[name];
    const kept = Object.keys(files).filter(isKnown);
    const changed = Object.entries(files).filter(([name]) => !isKnown(name));
    this.#known = { ...files };
    return { ...rest, files: Object.fromEntries(changed), kept };
  }

  /** @param {T.Answer} answer */
  #settle({ id, value, error, problems = [], canLoadAgain = false }) {
    const asked = this.#asked.get(id);
    this.#asked.delete(id);
    if (error === undefined) asked?.resolve(value);
    else asked?.reject(Object.assign(new Error(error), { problems, canLoadAgain }));
  }

  /** Ends the worker: what it was asked and has not answered is rejected, and what it will be asked. */
  terminate(why = "the board was reset meanwhile") {
    this.#worker?.terminate();
    this.#whyEnded ??= why;
    for (const { reject } of this.#asked.values()) reject(new Error(why));
    this.#asked.clear();
  }
}
