// What the browser tests share: the page in Chromium, the bundled scenes, and a virtual board.
//
// `cargo xtask studio-test` builds what they need, and says in the environment where it is:
// STUDIO_PAGE (the HTML file), STUDIO_HASHES (the hashes of the gallery, computed natively), FRIXEL (the command).

import { spawn } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import tty from "node:tty";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const FLAGS = [
  "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
];

export const pageUrl = pathToFileURL(required("STUDIO_PAGE")).href;

export function required(name) {
  const value = process.env[name];
  if (!value) throw new Error(`${name} is not set: run the tests with \`cargo xtask studio-test\``);
  return value;
}

let browser;
/** What to end after the tests of a file, in whatever way they ended. */
const leftovers = new Set();

/** Opens the page, and returns it with the list of errors that it reports. */
export async function openPage(url = pageUrl, { init } = {}) {
  browser ??= await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
  const page = await context.newPage();
  const errors = [];
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  await page.addInitScript(() => {
    // The tests end workers as a crash would.
    globalThis.workersOfPage = {};
    const Native = Worker;
    globalThis.Worker = class extends Native {
      constructor(url, options) {
        super(url, options);
        (workersOfPage[options?.name] ??= []).push(this);
      }
    };
  });
  if (init) await page.addInitScript(init);
  await page.goto(url);
  return { page, errors, close: () => context.close() };
}

/** Opens the page, and an engine of the test's own in it, as `tested`, with a function `sceneFiles(name)`. */
export async function openEngine(url = pageUrl, options) {
  const opened = await openPage(url, options);
  await opened.page.evaluate(async () => {
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
    /** Slides back and forth where constant.toml and grating.toml both drive, until `isOver()`, with a sample every 8 ms. */
    globalThis.slideUntil = async (isOver) => {
      const begin = performance.now();
      while (!isOver()) {
        const t = ((performance.now() - begin) / 1000) % 2;
        const xMm = 65 + 30 * Math.abs(t - 1);
        tested.pointer({ timeMs: performance.now(), xMm, yMm: 30, down: true });
        await new Promise((resolve) => setTimeout(resolve, 8));
      }
    };
  });
  return opened;
}

/** Ends everything that the tests of a file have started. */
export async function cleanUp() {
  for (const end of leftovers) await end();
  await browser?.close();
}

/** Starts `frixel sim`; returns its terminal, the folder of its log, and `stop()`. */
export async function startVirtualBoard() {
  const out = fs.mkdtempSync(path.join(os.tmpdir(), "frixel-studio-"));
  const board = spawn(required("FRIXEL"), ["sim", "--out", out], { stdio: ["ignore", "pipe", "pipe"] });
  const terminal = await new Promise((resolve, reject) => {
    let said = "";
    const listen = (bytes) => {
      said += bytes;
      const found = said.match(/\/dev\/[\w/]+/);
      if (found) resolve(found[0]);
    };
    board.stdout.on("data", listen);
    board.stderr.on("data", listen);
    board.on("exit", () => reject(new Error(`frixel sim ended: ${said}`)));
  });
  const stop = () => {
    leftovers.delete(stop);
    return new Promise((resolve) => {
      board.on("exit", resolve);
      board.kill("SIGINT");
    });
  };
  leftovers.add(stop);
  return { terminal, out, stop };
}

/** Starts `frixel studio` with the port of a board; returns the page's address. */
export async function startStudio(terminal) {
  const port = terminal ? ["--port", terminal] : [];
  const options = ["studio", "--no-browser", "--page", required("STUDIO_PAGE"), ...port];
  const server = spawn(required("FRIXEL"), options, { stdio: ["ignore", "pipe", "inherit"] });
  leftovers.add(() => server.kill("SIGINT"));
  return new Promise((resolve, reject) => {
    server.stdout.once("data", (line) => resolve(String(line).trim()));
    server.on("exit", () => reject(new Error("frixel studio ended")));
  });
}

/** The rows of a CSV file, as objects of texts. */
export function rowsOf(file) {
  const [head, ...lines] = fs.readFileSync(file, "utf8").trim().split("\n").map((line) => line.split(","));
  return lines.map((cells) => Object.fromEntries(head.map((name, index) => [name, cells[index]])));
}

/** Gives the page a `navigator.serial` whose only port is made of byte streams to a terminal. */
export async function addSerialPort(page, terminal) {
  const file = fs.openSync(terminal, fs.constants.O_RDWR | fs.constants.O_NOCTTY);
  const line = new tty.ReadStream(file);
  line.setRawMode(true);
  line.on("error", () => {});
  leftovers.add(() => line.destroy());
  await page.exposeFunction("serialWrite", (bytes) => fs.writeSync(file, Buffer.from(bytes, "base64")));
  await page.evaluate(() => {
    const port = {
      async open() {
        port.readable = new ReadableStream({ start: (controller) => (globalThis.serialArrived = (bytes) => controller.enqueue(bytes)) });
        port.writable = new WritableStream({ write: (bytes) => serialWrite(btoa(String.fromCharCode(...bytes))) });
      },
      async close() {},
    };
    const serial = { requestPort: async () => port, getPorts: async () => [port] };
    Object.defineProperty(navigator, "serial", { value: serial, configurable: true });
  });
  line.on("data", (bytes) => {
    page
      .evaluate((text) => globalThis.serialArrived?.(Uint8Array.from(atob(text), (c) => c.charCodeAt(0))), bytes.toString("base64"))
      .catch(() => {});
  });
}
