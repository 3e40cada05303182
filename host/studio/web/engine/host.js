// The worker of the compiler, and of the host of a board outside of the page.
//
// It has two instances of the module, because one that waits for bytes is suspended, and no other export of it may be
// called meanwhile: one checks scenes, the other one talks to the board. The board's bytes come and go through a
// MessagePort, whatever carries them beyond it.
"use strict";

/** The page sends a sign of life from each animation frame. The board is pinged this long after one, ms. */
const LIFE_MS = 25;
/** Time in which one call keeps the board alive, ms. */
const WAIT_MS = 10;

let module;
let checker;
let board = null;
let lastLifeMs = -Infinity;

/** A byte stream over a MessagePort, as the imports of an instance. Empty bytes mean that the other end has closed. */
class Stream {
  #port;
  #arrived = [];
  #isClosed = false;
  #wake = () => {};

  constructor(port) {
    this.#port = port;
    port.onmessage = ({ data }) => {
      if (data.length === 0) this.#isClosed = true;
      else this.#arrived.push(data);
      this.#wake();
    };
  }

  close() {
    this.#isClosed = true;
    this.#port.postMessage(new Uint8Array());
    this.#port.close();
  }

  write(bytes) {
    this.#port.postMessage(bytes);
  }

  /** Waits for bytes, and returns at most `max` of them; null when the stream is closed. */
  async read(max, waitMs) {
    if (this.#arrived.length === 0 && !this.#isClosed && waitMs > 0) {
      await new Promise((resolve) => {
        const timer = setTimeout(resolve, waitMs);
        this.#wake = () => {
          clearTimeout(timer);
          resolve();
        };
      });
    }
    const first = this.#arrived.shift();
    if (first === undefined) return this.#isClosed ? null : new Uint8Array();
    if (first.length > max) this.#arrived.unshift(first.subarray(max));
    return first.subarray(0, max);
  }
}

/** A board at the other end of a stream. */
class Board {
  #engine;
  #stream;
  /** The calls under way: one at a time. */
  #queue = Promise.resolve();
  #isOpen = true;
  isSimulated = true;
  isWanted = false;
  isLoaded = false;
  state = "disarmed";
  driving = "";

  static async connect(port) {
    const board = new Board();
    board.#stream = new Stream(port);
    board.#engine = await Engine.start(module, board.#imports());
    const answer = await board.#call("host_connect");
    Object.assign(board, answer);
    board.#live();
    return board;
  }

  #imports() {
    const stream = this.#stream;
    return {
      link_write: (address, length) => stream.write(this.#engine.bytes.slice(address, address + length)),
      link_read: new WebAssembly.Suspending(async (address, length, waitMs) => {
        const bytes = await stream.read(length, waitMs);
        if (bytes === null) return -1;
        this.#engine.bytes.set(bytes, address);
        return bytes.length;
      }),
      link_now_ms: () => performance.now(),
    };
  }

  #call(name, input, ...numbers) {
    const called = this.#queue.then(() => this.#engine.callSuspending(name, input, ...numbers));
    this.#queue = called.catch(() => {});
    return called;
  }

  /** Keeps the board alive for as long as the page is. */
  async #live() {
    try {
      while (this.#isOpen) {
        if (epochMs() - lastLifeMs > LIFE_MS) {
          await new Promise((resolve) => setTimeout(resolve, WAIT_MS / 2));
          continue;
        }
        if (this.isSimulated && this.isWanted && this.state === "disarmed") await this.#call("host_play");
        const { state, fault, telemetry } = await this.#call("host_wait", null, WAIT_MS);
        this.state = state;
        this.report(fault);
        if (telemetry.length > 0) self.postMessage({ type: "frame", frame: frameOf(telemetry) });
      }
    } catch (error) {
      this.#isOpen = false;
      if (board === this) board = null;
      self.postMessage({ type: "lost", error: error.message });
    }
  }

  report(fault = null) {
    const needsArm = !this.isSimulated && this.isLoaded && this.state === "disarmed";
    self.postMessage({ type: "state", state: this.state, fault, needsArm, driving: this.driving });
  }

  async play(scene) {
    await this.#call("host_load", requestOf(scene));
    this.isLoaded = true;
    // A board with an electrode waits for an explicit press.
    if (this.isSimulated) await this.arm();
  }

  async arm() {
    this.isWanted = true;
    await this.#call("host_play");
  }

  async stop() {
    this.isWanted = false;
    await this.#call("host_stop");
  }

  control(line) {
    return this.#call("host_control", new TextEncoder().encode(line));
  }

  clearFault() {
    return this.#call("host_clear_fault");
  }

  async disconnect() {
    this.#isOpen = false;
    await this.#queue;
    // Dropping the host sends the frames that stop and disarm.
    this.#engine.plain("host_disconnect");
    this.#stream.close();
  }
}

/** Telemetry as a frame of samples. What the finger feels, a board cannot know. */
function frameOf(telemetry) {
  const column = (name) => Float32Array.from(telemetry, (sample) => sample[name]);
  const [first, second] = telemetry;
  return {
    firstTick: first.tick,
    tick: telemetry[telemetry.length - 1].tick,
    ticksPerSample: second ? second.tick - first.tick : 400,
    xMm: column("xMm"),
    yMm: column("yMm"),
    speedMmPerS: column("speedMmPerS"),
    referenceN: column("referenceN"),
    feltN: new Float32Array(telemetry.length).fill(NaN),
    voltageV: column("voltageV"),
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

serve({
  async start(message) {
    module = message.module;
    checker = await Engine.start(module);
    return {};
  },

  check: ({ scene }) => checker.call("check", requestOf(scene)),
  usedFiles: ({ scene }) => checker.call("used_files", requestOf(scene)),
  seeded: ({ scene }) => checker.call("seeded_hash", requestOf(scene)),

  map({ scene }) {
    const values = new Float32Array(checker.callForBytes("map", requestOf(scene)));
    const [widthPx, heightPx, lowN, highN] = values;
    const count = widthPx * heightPx;
    return { widthPx, heightPx, lowN, highN, frictionN: values.slice(4, 4 + count), outOfReach: Int8Array.from(values.subarray(4 + count)) };
  },

  /**
   * Runs the simulator as fast as it goes, and returns how many times faster than real time that is: the fastest of
   * some stretches, because other programs on the machine only slow it.
   */
  async speed({ scene, stretches, stretchMs }) {
    const engine = await Engine.start(module);
    engine.call("simulator_start", null, 1);
    engine.call("simulator_play", requestOf(scene));
    const times = Array.from({ length: stretches }, () => {
      const begin = performance.now();
      for (let ms = 0; ms < stretchMs; ms += 8) {
        const tick = engine.plain("simulator_tick");
        engine.plain("simulator_pointer", tick + 320, 65 + (30 * ms) / stretchMs, 30, 1, 0);
        engine.callForBytes("simulator_run", null, 320, 1);
      }
      return performance.now() - begin;
    });
    return { timesRealTime: stretchMs / Math.min(...times) };
  },

  async connect({ port }) {
    if (board) await board.disconnect();
    board = null;
    board = await Board.connect(port);
    board.report();
    return {};
  },
  async disconnect() {
    const leaving = board;
    board = null;
    if (leaving) await leaving.disconnect();
    return {};
  },

  play: ({ scene }) => connected().play(scene),
  arm: () => connected().arm(),
  stop: () => connected().stop(),
  control: ({ line }) => connected().control(line),
  clearFault: () => connected().clearFault(),

  alive() {
    lastLifeMs = epochMs();
  },
  gone() {
    lastLifeMs = -Infinity;
  },
});
