// The host of a board outside of the page, part of the source of the worker `host`.
//
// The board's bytes come and go through a MessagePort, whatever carries them beyond it. A call to the module that waits
// for bytes is suspended, and no other export may be called meanwhile, so calls wait for each other in a queue. A stop
// breaks off the call under way and those in the queue. README.md says how a board is disarmed.
// @ts-check
"use strict";

/** Time in which one call keeps the board alive, ms. */
const WAIT_MS = 10;
/**
 * A pause of the page counts as no more than this on the module's clock, ms: longer than the time between pings, which
 * are then due, and shorter than the time after which a board counts as silent.
 */
const PAUSE_MAX_MS = 250;
/** What the imports of the module return when the stream is closed. */
const CLOSED = -1;
const STOPPED = "stopped: the board was disarmed meanwhile";

function pageLives() {
  return epochMs() - lastLifeMs <= LIFE_MS;
}

/** A board at the other end of a stream. */
class RemoteBoard {
  /** The instance of the module, once it has started. */
  #engine = /** @type {Engine | undefined} */ (undefined);
  #stream;
  /**
   * The calls under way: one at a time.
   * @type {Promise<unknown>}
   */
  #queue = Promise.resolve();
  /** Each stop begins a new round, which breaks off the calls of the one before. */
  #round = 0;
  /** The call under way: its round, and whether it is a stop, which nothing breaks off. */
  #current = { round: 0, isStop: false };
  /** Time that the module's clock leaves out, ms. */
  #leftOutMs = 0;
  #isOpen = true;
  /** The number of the newest scene: each load, and each `forget`, begins another. */
  #newest = 0;
  /** @type {string | null} */
  #fault = null;
  /** Whether the board has the newest scene: nothing else can be armed. */
  isLoaded = false;
  /** @type {T.BoardState} */
  state = "disarmed";
  driving = "";
  tickHz = 0;
  /** The board is lost, and about to be disconnected. */
  onLost = () => {};

  /** @param {Stream} stream */
  constructor(stream) {
    this.#stream = stream;
  }

  /**
   * Connects to the board at the other end of `port`. Closes the port if that fails.
   * @param {MessagePort} port
   */
  static async connect(port) {
    const board = new RemoteBoard(new Stream(port));
    try {
      board.#engine = await Engine.start(board.#imports());
      Object.assign(board, await board.#call("host_connect"));
    } catch (error) {
      await board.disconnect();
      throw error;
    }
    board.#live();
    return board;
  }

  #imports() {
    const stream = this.#stream;
    return {
      link_write: (/** @type {number} */ address, /** @type {number} */ length) => {
        const isSent = !this.#isBrokenOff && stream.write(this.#instance.bytes.slice(address, address + length));
        return isSent ? 0 : CLOSED;
      },
      link_read: new WebAssembly.Suspending(async (address, length, waitMs) => {
        if (!stream.hasBytes && !stream.isClosed && !this.#isBrokenOff && waitMs > 0) await changed.wait(waitMs);
        await this.#pageToLive();
        const bytes = this.#isBrokenOff ? null : stream.read(length);
        if (bytes === null) return CLOSED;
        this.#instance.bytes.set(bytes, address);
        return bytes.length;
      }),
      link_now_ms: () => performance.now() - this.#leftOutMs,
    };
  }

  get #instance() {
    if (!this.#engine) throw new Error("the engine has not started");
    return this.#engine;
  }

  get #isBrokenOff() {
    return !this.#current.isStop && this.#current.round !== this.#round;
  }

  /**
   * Waits while the page gives no sign of life. The module is suspended meanwhile and sends nothing, so the board's
   * host timeout disarms it. A stop does not wait for the page.
   */
  async #pageToLive() {
    const begin = performance.now();
    while (!pageLives() && !this.#current.isStop && !this.#isBrokenOff && !this.#stream.isClosed) {
      await changed.wait();
    }
    this.#leftOutMs += Math.max(0, performance.now() - begin - PAUSE_MAX_MS);
  }

  /**
   * @param {string} name
   * @param {Uint8Array | null} [input]
   * @param {number[]} numbers
   */
  #call(name, input, ...numbers) {
    return this.#enqueue({ round: this.#round, isStop: false }, name, input, numbers);
  }

  /**
   * @param {{ round: number, isStop: boolean }} call
   * @param {string} name
   * @param {Uint8Array | null | undefined} input
   * @param {number[]} numbers
   */
  #enqueue(call, name, input, numbers) {
    const isOver = () => !call.isStop && call.round !== this.#round;
    const called = this.#queue.then(async () => {
      if (!this.#isOpen) throw new Error("the board was disconnected meanwhile");
      if (isOver()) throw this.#stopped();
      this.#current = call;
      try {
        return await this.#instance.callSuspending(name, input, ...numbers);
      } catch (error) {
        if (isOver() && !this.#stream.isClosed) throw this.#stopped();
        if (error instanceof Error && "isLinkLost" in error && error.isLinkLost) this.#lose(error);
        throw error;
      }
    });
    this.#queue = called.catch(() => {});
    return called;
  }

  /** The error of a call that a stop has broken off. */
  #stopped() {
    return Object.assign(new Error(STOPPED), { canLoadAgain: this.#isOpen });
  }

  /** Keeps the board alive for as long as the page is. */
  async #live() {
    while (this.#isOpen) {
      try {
        if (!pageLives()) await changed.wait();
        else await this.#keepAlive();
      } catch (error) {
        if (error instanceof Error && error.message !== STOPPED) this.#lose(error);
      }
    }
  }

  async #keepAlive() {
    if (this.#stream.hasDropped) {
      // The board's reports are incomplete: it is disarmed, so that its state is known again.
      this.#stream.hasDropped = false;
      await this.#disarm();
    }
    const { state, fault, telemetry } = await this.#call("host_wait", null, WAIT_MS);
    this.state = state;
    this.#fault = fault;
    this.report();
    if (telemetry.length === 0) return;
    tell({ type: "frame", frame: frameOf(telemetry, this.tickHz, this.#instance.layouts.frameColumns) });
  }

  report() {
    if (!this.#isOpen) return;
    const needsArm = this.isLoaded && this.state === "disarmed";
    tell({ type: "state", state: this.state, fault: this.#fault, needsArm, driving: this.driving });
  }

  /** A scene is about to come: until the board has it, nothing can be armed. Returns the scene's number. */
  #expectScene() {
    this.isLoaded = false;
    this.#newest += 1;
    return this.#newest;
  }

  /**
   * Loads a scene, which waits for an explicit press.
   * @param {T.Request} scene
   */
  async play(scene) {
    const number = this.#expectScene();
    try {
      await this.#call("host_load", requestOf(scene));
      this.isLoaded = number === this.#newest;
    } finally {
      // Before the answer: who waits for it knows whether the scene can be armed.
      this.report();
    }
  }

  /** Arms the board. */
  arm() {
    // After a refused load the board has another scene than the page.
    if (!this.isLoaded) throw new Error("no scene is on the board: open one that it does not refuse");
    return this.#call("host_play");
  }

  /** Breaks off whatever is under way, and disarms the board. */
  async stop() {
    await this.#disarm();
    // A hidden page hears nothing more of the board until it is visible again.
    if (this.state !== "faulted") [this.state, this.#fault] = ["disarmed", null];
    this.report();
  }

  /** Disarms the board, which cannot be armed before another scene is loaded. */
  async forget() {
    this.#expectScene();
    await this.stop();
  }

  #disarm() {
    this.#breakOff();
    return this.#enqueue({ round: this.#round, isStop: true }, "host_stop", null, []);
  }

  #breakOff() {
    this.#round += 1;
    changed.give();
  }

  /** @param {string} line */
  control(line) {
    return this.#call("host_control", new TextEncoder().encode(line));
  }

  clearFault() {
    return this.#call("host_clear_fault");
  }

  /** Breaks off whatever is under way, disarms the board, and closes the stream. */
  async disconnect() {
    this.#isOpen = false;
    this.#breakOff();
    await this.#queue;
    this.#close();
  }

  /**
   * The line, or the instance of the module, can no longer be used: disconnects, and notifies the page.
   * @param {Error} error
   */
  #lose(error) {
    if (!this.#isOpen) return;
    this.onLost();
    this.disconnect();
    tell({ type: "lost", error: error.message });
  }

  #close() {
    this.#current = { round: this.#round, isStop: true };
    try {
      // Dropping the host sends the frames that stop and disarm, if the line still takes them.
      this.#engine?.plain("host_disconnect");
    } catch {
      // The instance has failed; the board notices the silence.
    }
    this.#stream.close();
  }
}
