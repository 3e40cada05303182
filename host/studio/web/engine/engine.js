// The engine of the studio, as the page uses it: README.md has the contract.
// @ts-check

/** @import * as T from "./types" */

import { after, clock } from "../clock.js";
import { serialLine } from "./lines.js";
import { WorkerClient } from "./worker_client.js";


/**
 * Creates the engine with the simulator as its board. `seed` is that of the simulated world.
 * @param {{ seed?: number }} options
 */
export async function createEngine({ seed = 1 } = {}) {
  const module = await WebAssembly.compile(await studio.bytes("engine.wasm"));
  const engine = new Engine(module, seed);
  try {
    await engine.start();
  } catch (error) {
    engine.close();
    throw error;
  }
  return engine;
}

/** Whether this browser can wait inside of WebAssembly, which a board outside of the page needs. */
export const canSuspend = typeof WebAssembly.Suspending === "function";

const NO_JSPI =
  "This browser cannot connect to a board: it lacks JSPI (Chrome 137, Firefox 153, Safari 27 or newer have it). " +
  "The simulator plays on.";
const THIS_PAGE = "the simulator in this page";
/** Longest wait for the end of a line whose board the host has disconnected, ms. */
const LINE_END_MAX_MS = 1000;

export class Engine {
  #module;
  #seed;
  /** @type {WorkerClient<T.FromBoard>} */
  #board;
  /** @type {WorkerClient<T.FromHost>} */
  #host;
  /** @type {WorkerClient<T.FromChecker>} */
  #checker;
  /**
   * The worker of checks, from the first one on, and its start.
   * @type {{ worker: WorkerClient<T.FromChecker>, start: Promise<void> } | undefined}
   */
  #judge;
  /** Ends the check under way, if there is one. */
  endCheck = () => {};
  /**
   * The line to the board outside of the page, if there is one.
   * @type {T.Line | null}
   */
  #line = null;
  /** @type {T.State["link"]} */
  #link = "simulator";
  /** @type {Omit<T.State, "link">} */
  #state = { state: "disarmed", fault: undefined, needsArm: false, driving: THIS_PAGE };
  /** Aborted by `close`. */
  #closed = new AbortController();
  /** The link and the state that the page knows of, as JSON. */
  #reported = "";

  /** @type {(frame: T.Frame) => void} */
  onFrames = () => {};
  /** @type {(change: Float32Array, firstTick: number, samplesPerS: number) => void} */
  onAudio = () => {};
  /** @type {(state: T.State) => void} */
  onState = () => {};
  /**
   * The simulator plays another part of real time than before: `onPace(part)`, 1 where it plays all of it.
   * @type {(part: number) => void}
   */
  onPace = () => {};
  /**
   * A worker has failed: `{ error }`, a sentence.
   * @type {(failure: { error: string }) => void}
   */
  onFailure = ({ error }) => console.error(error);

  /**
   * @param {WebAssembly.Module} module
   * @param {number} seed
   */
  constructor(module, seed) {
    this.#module = module;
    this.#seed = seed;
    this.#board = this.#newBoard();
    this.#host = new WorkerClient("host", (message) => this.#fromHost(message));
    this.#checker = new WorkerClient("checker", (message) => this.onFailure(message));
  }

  /** The state last passed to `onState`; at the start, the simulator. */
  get state() {
    return { link: this.#link, ...this.#state };
  }

  async start() {
    const module = this.#module;
    const board = this.#board.start({ module, seed: this.#seed });
    await Promise.all([board, this.#host.start({ module }), this.#checker.start({ module })]);
    keepAlive((type) => {
      this.#board.send({ type });
      if (this.#line) this.#host.send({ type });
    }, this.#closed.signal);
  }

  /** @returns {WorkerClient<T.FromBoard>} */
  #newBoard() {
    return new WorkerClient("board", (message) => this.#fromBoard(message));
  }

  /** @param {T.FromBoard} message */
  #fromBoard(message) {
    if (message.type === "failure") this.onFailure(message);
    if (this.#link !== "simulator") return;
    if (message.type === "frame") {
      this.onFrames({ ...message.frame, state: this.#state.state });
      this.onAudio(message.sound, message.soundTick, message.frame.tickHz / message.frame.slowness);
    } else if (message.type === "pace") {
      this.onPace(message.pace);
    } else if (message.type === "state") {
      this.#reportSimulator(message.state, message.fault ?? undefined);
    } else if (message.type === "failure") {
      this.#reportSimulator("disarmed", message.error);
    }
  }

  /** @param {T.FromHost} message */
  #fromHost(message) {
    if (message.type === "failure") {
      this.onFailure(message);
      this.#line?.close();
      this.#line = null;
    }
    if (this.#link === "simulator") return;
    if (message.type === "frame") {
      this.onFrames({ ...message.frame, state: this.#state.state });
    } else if (message.type === "state") {
      const { state, fault, needsArm, driving } = message;
      this.#report({ state, fault: fault ?? undefined, needsArm, driving });
    } else if (message.type === "lost" || message.type === "failure") {
      this.#reportNoBoard(message.error);
    }
  }

  /**
   * No board is there: the one before was lost, or could not be reached.
   * @param {string} [why]
   */
  #reportNoBoard(why) {
    this.#link = "none";
    this.#report({ state: "disarmed", fault: why, needsArm: false, driving: "no board" });
  }

  /**
   * @param {T.BoardState} state
   * @param {string} [fault]
   */
  #reportSimulator(state, fault) {
    this.#report({ state, fault, needsArm: false, driving: THIS_PAGE });
  }

  /** @param {Omit<T.State, "link">} state */
  #report(state) {
    this.#state = state;
    const now = this.state;
    if (JSON.stringify(now) === this.#reported) return;
    this.#reported = JSON.stringify(now);
    this.onState(now);
  }

  /**
   * An instance of the module in the page itself, for what cannot wait for a worker.
   * @returns {Promise<T.Instance>}
   */
  async instance() {
    const source = [await studio.text("engine/wasm.js"), "export { Engine };"];
    const url = URL.createObjectURL(new Blob([source.join("\n")], { type: "text/javascript" }));
    const instances = await import(url);
    URL.revokeObjectURL(url);
    return instances.Engine.start(undefined, this.#module);
  }

  /**
   * Compiles a scene and judges what is felt of it, which can take seconds: in a worker of its own. Another check ends
   * it, and so does `endCheck`; it then resolves to undefined.
   * @param {T.Files} files
   * @param {string} entry
   * @param {T.Profiles} profiles
   * @returns {Promise<T.Check | undefined>}
   */
  check(files, entry, profiles) {
    this.endCheck();
    this.#judge ??= this.#newJudge();
    const { worker, start } = this.#judge;
    return new Promise((resolve, reject) => {
      let isUnderWay = true;
      this.endCheck = () => {
        if (!isUnderWay) return;
        worker.terminate("the check was ended");
        this.#judge = undefined;
        resolve(undefined);
      };
      const judged = start.then(() => worker.ask({ type: "check", scene: { files, entry, ...profiles } }));
      judged.finally(() => (isUnderWay = false)).then(resolve, reject);
    });
  }

  #newJudge() {
    /** @type {WorkerClient<T.FromChecker>} */
    const worker = new WorkerClient("checker", (message) => this.onFailure(message));
    return { worker, start: worker.start({ module: this.#module }) };
  }

  /**
   * As `check`, at once and without what is felt.
   * @param {T.Files} files
   * @param {string} entry
   * @param {T.Profiles} profiles
   * @returns {Promise<T.Check>}
   */
  compile(files, entry, profiles) {
    return this.#checker.ask({ type: "compile", scene: { files, entry, ...profiles } });
  }

  /**
   * @param {T.Files} files
   * @param {string} entry
   */
  usedFiles(files, entry) {
    return this.#checker.ask({ type: "usedFiles", scene: { files, entry } });
  }

  /**
   * Reads a picture as the compiler does, and throws where it cannot be played.
   * @param {Uint8Array<ArrayBuffer>} bytes
   */
  picture(bytes) {
    return this.#checker.ask({ type: "picture", bytes });
  }

  /**
   * @param {T.Files} files
   * @param {string} entry
   * @param {T.Profiles} profiles
   * @param {Partial<T.MapSize> & { speedMmPerS?: number }} options
   */
  map(files, entry, profiles, { widthPx = 1000, heightPx = 800, speedMmPerS = 100 } = {}) {
    return this.#checker.ask({ type: "map", scene: { files, entry, ...profiles, widthPx, heightPx, speedMmPerS } });
  }

  /**
   * @param {T.Files} files
   * @param {string} entry
   * @param {T.Profiles & T.PlayOptions} profiles
   */
  play(files, entry, profiles) {
    return this.#player.ask({ type: "play", scene: { files, entry, ...profiles } });
  }

  /** @param {string} line */
  control(line) {
    return this.#player.ask({ type: "control", line });
  }

  stop() {
    return this.#player.ask({ type: "stop" });
  }

  /** Plays on after a stop, on the simulator in the page. */
  resume() {
    return this.#board.ask({ type: "resume" });
  }

  /** Arms the board outside of the page, which plays the scene that it has. Only a person's press may call this. */
  arm() {
    return this.#host.ask({ type: "arm" });
  }

  /** Disarms a board outside of the page. It cannot be armed again before another scene is played there. */
  async forget() {
    if (!this.#line) return;
    await this.#host.ask({ type: "forget" }).catch((error) => {
      // A board that is lost cannot be armed.
      if (this.#link !== "none") throw error;
    });
  }

  clearFault() {
    return this.#host.ask({ type: "clearFault" });
  }

  /** @param {Omit<T.PointerSample, "epochMs"> & { timeMs: number }} sample `timeMs` is an event's `timeStamp`. */
  pointer({ timeMs, xMm, yMm, down, loadN }) {
    const sample = { epochMs: clock.startMs() + timeMs, xMm, yMm, down, loadN };
    this.#board.send({ type: "pointer", sample });
  }

  /** Lifts the finger at once, and forgets what is still to be played of it. */
  lift() {
    this.#board.send({ type: "lift" });
  }

  replay({ slowness = 10 } = {}) {
    return this.#board.ask({ type: "replay", slowness });
  }

  /** Ends a replay before its end, if there is one. */
  endReplay() {
    return this.#board.ask({ type: "endReplay" });
  }

  /** The worker that plays scenes. */
  get #player() {
    return this.#link === "simulator" ? this.#board : this.#host;
  }

  /** Plays on the simulator, as it is after a reset, and disconnects a board. */
  async simulate() {
    await this.#change(async () => {
      await this.#disconnect();
      this.#board.terminate();
      this.#link = "simulator";
      const board = this.#newBoard();
      await board.start({ module: this.#module, seed: this.#seed });
      this.#board = board;
      this.#reportSimulator("disarmed");
    });
  }

  /**
   * Connects to a board. If that fails, the simulator stays, if it was the board before, and plays on.
   * @param {SerialPort} port
   */
  async connectSerial(port) {
    if (!canSuspend) throw new Error(NO_JSPI);
    await this.#change(async () => {
      try {
        await this.#disconnect();
        if (this.#link !== "simulator") this.#reportNoBoard();
        this.#line = await serialLine(port);
        const { remote } = this.#line;
        await this.#host.ask({ type: "connect", port: remote }, [remote]);
        this.#link = "serial";
      } catch (error) {
        await this.#disconnect();
        throw error;
      }
      // A simulator that has failed plays nothing.
      await this.#board.ask({ type: "stop" }).catch(() => {});
    });
  }

  /**
   * Changes the board, one change at a time.
   * @param {() => Promise<void>} action
   */
  async #change(action) {
    if (this.#isChanging) throw new Error("the board is being changed: wait until that is done");
    this.#isChanging = true;
    try {
      await action();
    } finally {
      this.#isChanging = false;
    }
  }
  #isChanging = false;

  /**
   * Disconnects the board, if there is one, and waits until its port is free. The host ends the line, behind the bytes
   * that disarm the board: a line that is closed at this end could drop them.
   */
  async #disconnect() {
    // A host that has failed ends no line.
    await this.#host.ask({ type: "disconnect" }).catch(() => {});
    const line = this.#line;
    if (!line) return;
    await Promise.race([line.closed, after(LINE_END_MAX_MS)]);
    line.close();
    await line.closed;
    this.#line = null;
  }

  /** Ends the workers and closes the line to a board, which its host timeout disarms. */
  close() {
    this.#closed.abort();
    this.#line?.close();
    this.endCheck();
    for (const worker of [this.#board, this.#host, this.#checker, this.#judge?.worker]) worker?.terminate();
  }
}

/**
 * Sends a sign of life from each animation frame of a visible page, and a farewell when it is hidden or left.
 * @param {(type: "alive" | "gone") => void} send
 * @param {AbortSignal} signal Ends it.
 */
function keepAlive(send, signal) {
  const frame = () => {
    if (signal.aborted) return;
    if (document.visibilityState === "visible") send("alive");
    clock.nextFrame(frame);
  };
  clock.nextFrame(frame);
  document.addEventListener("visibilitychange", () => {
    if (document.visibilityState !== "visible") send("gone");
  }, { signal });
  window.addEventListener("pagehide", () => send("gone"), { signal });
}
