// The worker of the host of a board outside of the page.
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
/** Bytes that wait to be read at most, for example while the page is hidden; the oldest are dropped first. */
const ARRIVED_MAX_BYTES = 1_000_000;
/** A simulated board that refuses to play is asked again after this time, ms. */
const ASK_AGAIN_MS = 250;
/** What the imports of the module return when the stream is closed. */
const CLOSED = -1;
const STOPPED = "stopped: the board was disarmed meanwhile";

/** @type {Board | null} */
let board = null;

function pageLives() {
  return epochMs() - lastLifeMs <= LIFE_MS;
}

/** Wakes those that wait for something to have changed. */
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

/** A board at the other end of a stream. */
class Board {
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
  /** Until then a simulated board that has refused to play is not asked again, on the worker's clock, ms. */
  #refusedUntilMs = 0;
  isSimulated = true;
  isWanted = false;
  /** Whether the board has the newest scene: nothing else can be armed. */
  isLoaded = false;
  /** @type {T.BoardState} */
  state = "disarmed";
  driving = "";

  /** @param {Stream} stream */
  constructor(stream) {
    this.#stream = stream;
  }

  /**
   * Connects to the board at the other end of `port`. Closes the port if that fails.
   * @param {MessagePort} port
   */
  static async connect(port) {
    const board = new Board(new Stream(port));
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

  /** The error of a call that a stop has broken off. A simulated board would play what is loaded again. */
  #stopped() {
    return Object.assign(new Error(STOPPED), { canLoadAgain: this.#isOpen && !this.isSimulated });
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
      // Nobody knows what the board has reported: it is disarmed, and its state is known again.
      this.#stream.hasDropped = false;
      await this.#disarm();
    }
    const isAsked = this.isSimulated && this.isWanted && this.state === "disarmed";
    if (isAsked && performance.now() >= this.#refusedUntilMs) await this.#playAgain();
    const { state, fault, telemetry } = await this.#call("host_wait", null, WAIT_MS);
    this.state = state;
    this.#fault = fault;
    this.report();
    if (telemetry.length > 0) tell({ type: "frame", frame: frameOf(telemetry) });
  }

  /** A simulated board that was disarmed plays on. One that refuses is there: its state, which is read next, says why. */
  async #playAgain() {
    try {
      await this.#call("host_play");
    } catch (error) {
      if (!(error instanceof EngineError) || error.isLinkLost) throw error;
      this.#refusedUntilMs = performance.now() + ASK_AGAIN_MS;
    }
  }

  report() {
    if (!this.#isOpen) return;
    const needsArm = !this.isSimulated && this.isLoaded && this.state === "disarmed";
    tell({ type: "state", state: this.state, fault: this.#fault, needsArm, driving: this.driving });
  }

  /** A scene is about to come: until the board has it, nothing can be armed. Returns the scene's number. */
  #expectScene() {
    this.isLoaded = false;
    this.#newest += 1;
    return this.#newest;
  }

  /** @param {T.Request} scene */
  async play(scene) {
    const round = this.#round;
    const number = this.#expectScene();
    try {
      await this.#call("host_load", requestOf(scene));
      this.isLoaded = number === this.#newest;
    } finally {
      // Before the answer: who waits for it knows whether the scene can be armed.
      this.report();
    }
    // A board with an electrode waits for an explicit press.
    if (!this.isSimulated) return;
    if (round !== this.#round) throw this.#stopped();
    await this.#drive();
  }

  /** Arms the board. */
  arm() {
    // After a refused load the board has another scene than the page.
    if (!this.isLoaded) throw new Error("no scene is on the board: open one that it does not refuse");
    return this.#drive();
  }

  async #drive() {
    this.isWanted = true;
    await this.#call("host_play");
  }

  /** Breaks off whatever is under way, and disarms the board. */
  async stop() {
    this.isWanted = false;
    await this.#disarm();
    // A hidden page hears nothing more of the board until it is visible again.
    if (this.state !== "faulted") [this.state, this.#fault] = ["disarmed", null];
    this.report();
  }

  /** Disarms a board with an electrode, which cannot be armed before another scene is loaded. */
  async forget() {
    if (this.isSimulated) return;
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
   * The line, or the instance of the module, is of no more use: disconnects, and tells the page.
   * @param {Error} error
   */
  #lose(error) {
    if (!this.#isOpen) return;
    if (board === this) board = null;
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

/** @typedef {"xMm" | "yMm" | "speedMmPerS" | "referenceN" | "voltageV"} Told The columns that a board tells. */
/** @typedef {Record<Told | "tick", number> & { isTouched: boolean }} Telemetry */

/**
 * Telemetry as a frame of samples. What the finger feels and where it is, a board cannot know.
 * @param {Telemetry[]} telemetry
 * @returns {T.WorkerFrame}
 */
function frameOf(telemetry) {
  const column = (/** @type {Told} */ name) => Float32Array.from(telemetry, (sample) => sample[name]);
  const unknown = () => new Float32Array(telemetry.length).fill(NaN);
  const [first, second] = telemetry;
  return {
    firstTick: first.tick,
    tick: telemetry[telemetry.length - 1].tick,
    ticksPerSample: second ? second.tick - first.tick : 400,
    xMm: column("xMm"),
    yMm: column("yMm"),
    speedMmPerS: column("speedMmPerS"),
    referenceN: column("referenceN"),
    feltN: unknown(),
    voltageV: column("voltageV"),
    predictedXMm: unknown(),
    predictedYMm: unknown(),
    reportedXMm: unknown(),
    reportedYMm: unknown(),
    contactRadiusMm: unknown(),
    contact: telemetry[telemetry.length - 1].isTouched,
    delayMs: 0,
    slowness: 1,
    simulated: false,
  };
}

function connected() {
  if (!board) throw new Error("no board is connected: connect one, or use the simulator");
  return board;
}

async function disconnect() {
  const leaving = board;
  board = null;
  if (leaving) await leaving.disconnect();
  return {};
}

serve({
  start(message) {
    compiled = message.module;
    return {};
  },

  async connect({ port }) {
    await disconnect();
    board = await Board.connect(port);
    board.report();
    return {};
  },
  disconnect,

  play: ({ scene }) => connected().play(scene),
  arm: () => connected().arm(),
  // Without a board there is nothing to stop.
  stop: () => board?.stop(),
  forget: () => board?.forget(),
  control: ({ line }) => connected().control(line),
  clearFault: () => connected().clearFault(),

  alive() {
    lastLifeMs = epochMs();
    changed.give();
  },
  gone() {
    lastLifeMs = -Infinity;
    // A board with an electrode need not wait for its host timeout. If this fails, the page has been told.
    if (board && !board.isSimulated) board.stop().catch(() => {});
  },
});
