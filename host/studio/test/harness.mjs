// What the browser tests share: the page in Chromium, the bundled scenes, and a virtual board.
//
// `cargo xtask ci studio` builds what they need, and says in the environment where it is:
// STUDIO_PAGE (the HTML file), STUDIO_HASHES (the hashes of the gallery, computed natively), and REAL_BOARD
// (examples/real_board.rs).

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import fs from "node:fs";
import readline from "node:readline";
import { after, afterEach } from "node:test";
import tty from "node:tty";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { addSimulatedClock } from "./simulated_clock.mjs";

const FLAGS = [
  "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
  // Without a process that waits for a page of another site: none comes.
  "--disable-features=SpareRendererForSitePerProcess",
];

/** Longest wait for something that has no time limit of its own: a busy machine may be slow, ms. */
export const WAIT_MAX_MS = 40_000;

export const pageUrl = pathToFileURL(required("STUDIO_PAGE")).href;

export function required(name) {
  const value = process.env[name];
  if (!value) throw new Error(`${name} is not set: run the tests with \`cargo xtask ci studio\``);
  return value;
}

let browser;
/** Errors that the pages of a test have reported. */
const errors = [];
/** What ends what a test has started, and what all tests of its file share, in this order. */
const started = { byTest: new Set(), byFile: new Set() };
let starter = "byTest";

/** Ends something after the test, in whatever way the test ends. Returns a function that ends it before. */
function endLater(end) {
  const ends = started[starter];
  const endNow = () => {
    ends.delete(endNow);
    return end();
  };
  ends.add(endNow);
  return endNow;
}

/** What `start` starts ends after the last test of the file, not after the first that uses it. */
export async function forAllTests(start) {
  starter = "byFile";
  try {
    return await start();
  } finally {
    starter = "byTest";
  }
}

/** The newest ends first. */
async function endAll(ends) {
  for (const end of [...ends].reverse()) await end();
}

/** Ends the pages and programs of a test, which would take the machine's time from the next one. No page may fail. */
export async function endTest() {
  await endAll(started.byTest);
  assert.deepEqual(errors.splice(0), [], "what pages report");
}

/** Ends everything that the tests of a file have started. */
export async function endFile() {
  await endAll(started.byFile);
  await browser?.close();
}

afterEach(endTest);
after(endFile);

/** Makes a program end with `quit`, and waits until it has ended. */
async function endProgram(program, quit) {
  if (program.exitCode !== null || program.signalCode !== null) return;
  const ended = new Promise((resolve) => program.once("exit", resolve));
  quit();
  await ended;
}

/**
 * Opens the page, which must report no error unless it `mayFail`. `init`, if given, runs in the page before its
 * scripts. With `isSimulated`, its time is that of `simulated_clock.mjs`.
 */
export async function openPage(url = pageUrl, { init, isSimulated = false, mayFail = false } = {}) {
  browser ??= await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
  context.setDefaultTimeout(WAIT_MAX_MS);
  const page = await context.newPage();
  if (!mayFail) {
    page.on("pageerror", (error) => errors.push(error.message));
    page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  }
  if (isSimulated) await page.addInitScript(addSimulatedClock);
  await page.addInitScript(() => {
    // The tests end workers as a crash would.
    globalThis.workersOfPage = {};
    const Native = Worker;
    globalThis.Worker = class extends Native {
      constructor(url, options) {
        super(url, options);
        workersOfPage[options?.name] ??= [];
        workersOfPage[options?.name].push(this);
      }
    };
    globalThis.setVisibility = (value) => {
      Object.defineProperty(document, "visibilityState", { value, configurable: true });
      document.dispatchEvent(new Event("visibilitychange"));
    };
  });
  if (init) await page.addInitScript(init);
  endLater(() => context.close());
  await page.goto(url);
  return page;
}

/**
 * Opens the page with an engine of the test's own, as `tested`, and a function `sceneFiles(name)`. That of the page
 * itself ends, so that the machine has time for this one.
 */
export async function openOnlyEngine(url, options) {
  const page = await openPage(url, options);
  await page.waitForFunction(() => globalThis.studioPage);
  await page.evaluate(async () => {
    studioPage.engine.close();
    const { createEngine } = await import(await studio.moduleUrl("engine/engine.js"));
    globalThis.tested = await createEngine();
    globalThis.felt = [];
    tested.onFrames = (frame) => felt.push(frame);
    globalThis.states = [];
    tested.onState = (state) => states.push(state);
    globalThis.sceneFiles = async (name) => {
      const files = { [name]: await studio.text(`scenes/${name}`) };
      for (const texture of studio.names("scenes/textures/")) {
        files[texture.slice("scenes/".length)] = await studio.bytes(texture);
      }
      return files;
    };
    /** An instance of the module, and what makes a request of a scene, as the workers have them. */
    globalThis.instanceOfModule = async () => {
      const source = `${await studio.text("engine/wasm.js")}\nexport { Engine, requestOf };`;
      const { Engine, requestOf } = await import(URL.createObjectURL(new Blob([source], { type: "text/javascript" })));
      const instance = await Engine.start(undefined, await WebAssembly.compile(await studio.bytes("engine.wasm")));
      return { instance, requestOf };
    };
    /** Slides where constant.toml drives, as long as the page is open, with a sample every 8 ms of the test's clock. */
    globalThis.keepSliding = async () => {
      const beginMs = studioClock.nowMs();
      for (;;) {
        const timeMs = studioClock.nowMs();
        const xMm = 65 + 30 * Math.abs((((timeMs - beginMs) / 1000) % 2) - 1);
        tested.pointer({ timeMs, xMm, yMm: 30, down: true });
        await wait(8);
      }
    };
  });
  return page;
}

/** A scene whose host timeout is long: a board that a command disarms is told apart from one that falls silent. */
export const CONSTANT = `version = 1
[drive]
host_timeout_ms = 1000
[[layer]]
kind = "constant"
above = "natural"
friction_n = 0.11
`;

/** What a virtual board does that says it is real. */
export const stateOf = {
  active: ({ state }) => state === "active",
  disarmed: ({ state }) => state === "disarmed",
  driving: ({ isDriving }) => isDriving,
  silent: ({ isSilent }) => isSilent,
};

/** The clock of a virtual board that says it is real is so much slower than the machine's (examples/real_board.rs). */
export const BOARD_SLOWNESS = 4;

/**
 * As `init` of `openPage`: the clock of the worker that talks to such a board is as slow as the board's, so that a busy
 * machine has as much time to carry an answer as the board has to give it.
 */
export const slowHost = {
  content: `(${(slowness) => {
    const create = URL.createObjectURL.bind(URL);
    const sources = new Map();
    URL.createObjectURL = (blob) => {
      const url = create(blob);
      sources.set(url, blob);
      return url;
    };
    const slow = `{ const now = performance.now.bind(performance); performance.now = () => now() / ${slowness}; }\n`;
    const Native = Worker;
    globalThis.Worker = class extends Native {
      constructor(url, options) {
        super(options?.name === "host" ? create(new Blob([slow, sources.get(url)])) : url, options);
      }
    };
  }})(${BOARD_SLOWNESS})`,
};

/** Waits until so much time has passed on the clock of such a board, ms. */
export const boardTime = (ms) => new Promise((resolve) => setTimeout(resolve, BOARD_SLOWNESS * ms));

/**
 * Starts a virtual board that says it is real, on a line of `baud` bits a second of the board's time. Returns its terminal, its `events`
 * `{ ms, board: { state, fault, isSilent, isDriving } }` as they come, `fail()`, which makes the amplifier report a
 * fault, `hang(isHanging)`, `stop()`, `until(what, isMet)`, which waits until its last event is as `isMet` says, and
 * `assertDisarmed(from, how)`: from its event number `from` on it is disarmed by a command, and stays so.
 */
export async function startRealBoard({ baud = 2_000_000 } = {}) {
  const board = spawn(required("REAL_BOARD"), [String(baud)], { stdio: ["pipe", "pipe", "inherit"] });
  const hang = (isHanging) => board.kill(isHanging ? "SIGSTOP" : "SIGCONT");
  const stop = endLater(() =>
    endProgram(board, () => {
      hang(false);
      board.stdin.end();
    }),
  );
  const events = [];
  const lines = readline.createInterface({ input: board.stdout });
  const terminal = await new Promise((resolve, reject) => {
    lines.on("line", (line) => (line.startsWith("port: ") ? resolve(line.slice(6)) : events.push(JSON.parse(line))));
    board.on("exit", () => reject(new Error("the virtual board ended")));
  });
  const until = async (what, isMet) => {
    const begin = performance.now();
    while (performance.now() < begin + WAIT_MAX_MS) {
      if (events.length > 0 && isMet(events.at(-1).board)) return events.at(-1);
      await new Promise((resolve) => setTimeout(resolve, 10));
    }
    throw new Error(`not ${what}: ${JSON.stringify(events.slice(-5))}`);
  };
  const assertDisarmed = async (from, how) => {
    await until(`disarmed by ${how}`, stateOf.disarmed);
    await boardTime(300);
    const states = events.slice(from).map((event) => event.board);
    const found = `${how}: ${JSON.stringify(states)}`;
    assert.ok(!states.some(stateOf.silent), `before the host timeout, ${found}`);
    const since = states.slice(states.findIndex(stateOf.disarmed));
    assert.ok(since.every(stateOf.disarmed) && !since.at(-1).isDriving, found);
  };
  return { terminal, events, fail: () => board.stdin.write("fault\n"), hang, stop, until, assertDisarmed };
}

/** Hides the page, or shows it again: `value` is "hidden" or "visible". */
export async function setVisibility(page, value) {
  await page.evaluate((value) => setVisibility(value), value);
}

/**
 * Gives the page a `navigator.serial` whose only port is made of byte streams to a terminal. Like a browser's, it opens
 * only when it is closed, and closes only when nobody holds its streams. In the page, `serialPort` is the port,
 * `serialPort.sent` what was written, a piece each; `serialPort.arrived` what came from the terminal, each piece with
 * the count of pieces that had been written; and `serialPort.pull()` pulls its cable.
 */
export async function addSerialPort(page, terminal) {
  const file = fs.openSync(terminal, fs.constants.O_RDWR | fs.constants.O_NOCTTY);
  const line = new tty.ReadStream(file);
  line.setRawMode(true);
  line.on("error", () => {});
  endLater(() => line.destroy());
  await page.exposeFunction("serialWrite", (bytes) => {
    if (!line.destroyed) fs.writeSync(file, Buffer.from(bytes, "base64"));
  });
  await page.evaluate(() => {
    const port = {
      readable: null,
      writable: null,
      sent: [],
      arrived: [],
      async open() {
        if (port.readable) throw new DOMException("The port is already open.", "InvalidStateError");
        let incoming;
        let outgoing;
        port.readable = new ReadableStream({
          start(controller) {
            incoming = controller;
          },
          cancel() {
            incoming = null;
          },
        });
        port.writable = new WritableStream({
          start(controller) {
            outgoing = controller;
          },
          write(bytes) {
            port.sent.push(Array.from(bytes));
            serialWrite(btoa(String.fromCharCode(...bytes)));
          },
        });
        globalThis.serialArrived = (bytes) => {
          port.arrived.push({ bytes: Array.from(bytes), sentBefore: port.sent.length });
          incoming?.enqueue(bytes);
        };
        port.pull = () => {
          const lost = new DOMException("The device has been lost.", "NetworkError");
          incoming.error(lost);
          outgoing.error(lost);
          incoming = null;
        };
      },
      async close() {
        if (!port.readable) throw new DOMException("The port is already closed.", "InvalidStateError");
        if (port.readable.locked || port.writable.locked) throw new TypeError("Cannot close a locked stream");
        port.readable = null;
        port.writable = null;
      },
    };
    globalThis.serialPort = port;
    const serial = { requestPort: async () => port, getPorts: async () => [port] };
    Object.defineProperty(navigator, "serial", { value: serial, configurable: true });
  });
  // What arrives while the page takes the bytes before goes with the next ones.
  let waiting = [];
  let isBusy = false;
  line.on("data", async (bytes) => {
    waiting.push(bytes);
    if (isBusy) return;
    isBusy = true;
    while (waiting.length > 0) {
      const text = Buffer.concat(waiting).toString("base64");
      waiting = [];
      const arrive = (text) => globalThis.serialArrived?.(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)));
      await page.evaluate(arrive, text).catch(() => {});
    }
    isBusy = false;
  });
}
