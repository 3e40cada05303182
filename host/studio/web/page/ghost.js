// The ghost finger: slides over the scene by itself in the simulator, until a person touches the map.
// @ts-check

import { after, clock } from "../clock.js";
import { byId } from "./dom.js";
import { attempt } from "./notices.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { Frame, Screen } from "../engine/types" */
/** @import { Finger } from "./finger.js" */
/** @import { FrictionMap } from "./map.js" */
/** @import { Box } from "./place.js" */
/** @import { Sound } from "./sound.js" */

/** The ghost rests for good after it has slid for this long, ms. */
const REST_AFTER_MS = 60_000;
/** One stroke and the pause after it, ms. */
const STROKE_MS = 1500;
const PAUSE_MS = 350;
/**
 * Longest time step between two frames, ms: a busy page slows the ghost down, and never speeds it up. After a longer
 * pause it touches down anew.
 */
const STEP_MAX_MS = 24;
const STALL_MS = 100;
/** Part of a stroke in which the finger speeds up, and in which it slows down. */
const RAMP_PART = 0.15;
/** A stroke's longest way, and the part of the screen that it crosses at most, and along which lines lie. */
const LENGTH_MAX_MM = 130;
const SCREEN_PART = 0.84;
/** How far a stroke bends to the side, in its length. */
const BEND = 0.06;
/** Lines follow each other by the golden ratio: no two near each other, and none twice. */
const GOLDEN = 0.618_034;
/** Smallest radius at which the fingertip is drawn, CSS pixels, and its radius on the screen, mm. */
const RADIUS_MIN_PX = 11;
const RADIUS_MM = 4;
/** Keys that only help to reach others. */
const PASSIVE_KEYS = ["Tab", "Shift", "Control", "Alt", "Meta"];

const SLIDES = "A ghost finger is sliding: press to take over.";
const RESTS = "Press and slide to feel it.";
const STOPPED = "Nothing plays: press Play, at the top.";

export class Ghost {
  #parts;
  #note = byId("first-words");
  #isEnded = false;
  #isDismissed = false;
  #isDown = false;
  /** A single stroke is under way. */
  #isOnce = false;
  #isStarted = false;
  /** Whether each picture of the screen moves it. */
  #isMoving = false;
  /** Time that it has slid, and the time of the last picture, ms. */
  #slidMs = 0;
  #lastMs = 0;
  /**
   * Where the finger is felt, or was last.
   * @type {{ xMm: number, yMm: number } | undefined}
   */
  #felt;

  /** @param {{ engine: Engine, map: FrictionMap, finger: Finger, sound: Sound }} parts */
  constructor(parts) {
    const { map, finger } = parts;
    this.#parts = parts;
    finger.overlays.push(this);
    this.#offerSound();
    byId("first-dismiss").onclick = () => this.dismiss();
    for (const type of /** @type {const} */ (["pointerdown", "click", "keydown"]))
      map.box.addEventListener(type, (event) => this.#touched(event), { capture: true });
    document.addEventListener("visibilitychange", () => (this.#maySlide ? this.wake() : this.#lift()));
  }

  /** Whether it may slide now: never with a board, unseen, in a blind comparison, or while layers are edited. */
  get #maySlide() {
    const { link, state } = this.#parts.engine.state;
    const isMapTaken = document.body.classList.contains("blind") || this.#parts.map.box.classList.contains("editing");
    const isThere = state === "active" && this.#parts.map.frictionN.length > 0;
    return link === "simulator" && isThere && !isMapTaken && document.visibilityState === "visible";
  }

  /** Whether it is drawn at each picture of the screen. */
  get isActive() {
    return this.#isMoving;
  }

  /** Begins, where a person has not asked for less motion: then nothing moves before a press. */
  start() {
    this.#show();
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) this.end();
    if (this.#isEnded) return;
    this.#isStarted = true;
    this.#parts.finger.isGuided = true;
    this.#say();
    this.wake();
  }

  /** Slides on, if it may: call it when what may keep it from sliding has changed. */
  wake() {
    if (!this.#isStarted || this.#isEnded || this.#isMoving || !this.#maySlide) return;
    this.#isMoving = true;
    clock.nextFrame((ms) => this.#frame(ms));
  }

  /** Ends for good: the finger lifts. */
  end() {
    this.#lift();
    this.#isEnded = true;
    this.#isMoving = false;
    this.#parts.finger.isGuided = false;
    this.#parts.finger.redraw();
    this.#say();
  }

  /** Ends for good, and removes the words. */
  dismiss() {
    this.end();
    this.#isDismissed = true;
    this.#show();
  }

  /** The map is a person's: the ghost ends for good, and of the words only sound is still offered. */
  handOver() {
    if (!this.#isEnded) this.end();
    this.#note.classList.add("taken");
  }

  /** Sound that is on can be turned off, whatever was dismissed. */
  #show() {
    this.#note.hidden = this.#isDismissed && !this.#parts.sound.isOn;
    if (this.#isDismissed) this.#note.classList.add("taken");
  }

  /** The board plays, or another one: what the words say is of the simulator. */
  showBoard() {
    if (this.#parts.engine.state.link !== "simulator" && !this.#isDismissed) this.dismiss();
    this.#say();
    this.wake();
  }

  #say() {
    const { link, state } = this.#parts.engine.state;
    const isStopped = link === "simulator" && state === "disarmed";
    byId("first-hint").textContent = isStopped ? STOPPED : this.#isStarted && !this.#isEnded ? SLIDES : RESTS;
  }

  #offerSound() {
    const { sound } = this.#parts;
    const hear = byId("hear");
    hear.onclick = () => attempt(() => (sound.isOn ? sound.stop() : sound.start()));
    let isAnswered = false;
    sound.onChange = () => {
      isAnswered ||= sound.isOn;
      hear.textContent = sound.isOn ? "♪ Turn sound off" : "♪ Hear it";
      hear.hidden = isAnswered && !sound.isOn;
      this.#show();
    };
    sound.onChange();
  }

  /**
   * A person touches the map: it is theirs, and the words go.
   * @param {Event} event
   */
  #touched(event) {
    const isInNote = event.target instanceof Node && this.#note.contains(event.target);
    if (isInNote || (event instanceof KeyboardEvent && PASSIVE_KEYS.includes(event.key))) return;
    this.handOver();
  }

  /** @param {number} ms */
  #frame(ms) {
    if (this.#isEnded) return;
    if (this.#slidMs >= REST_AFTER_MS) {
      this.end();
      return;
    }
    if (!this.#maySlide) {
      this.#isMoving = false;
      this.#lift();
      this.#parts.finger.redraw();
      return;
    }
    this.#slide(ms);
    this.#lastMs = ms;
    clock.nextFrame((next) => this.#frame(next));
  }

  /** @param {number} ms */
  #slide(ms) {
    this.#slidMs += Math.min(ms - this.#lastMs, STEP_MAX_MS);
    // After a stall the finger comes down at its new place, and does not slide there at once.
    if (ms - this.#lastMs > STALL_MS) this.#lift();
    const stroke = Math.floor(this.#slidMs / (STROKE_MS + PAUSE_MS));
    const part = (this.#slidMs % (STROKE_MS + PAUSE_MS)) / STROKE_MS;
    if (part > 1) {
      this.#lift();
      return;
    }
    this.#isDown = true;
    this.#parts.engine.pointer({ timeMs: ms, ...placeAt(stroke, part, this.#parts.map.screen), down: true });
  }

  /**
   * Slides once along the middle of a box, also where it rests for good, and resolves when the finger has its speed.
   * With a finger on the map, or a board, it leaves the sliding to the person.
   * @param {Box} box
   */
  async slideOnce({ x, y, width, height }) {
    const { engine, finger } = this.#parts;
    const { link, state } = engine.state;
    if (this.#isOnce || this.#isMoving || finger.isDown || link !== "simulator" || state !== "active") return;
    this.#isOnce = true;
    /** @type {number | undefined} */
    let beganMs;
    const frame = (/** @type {number} */ ms) => {
      beganMs ??= ms;
      const part = (ms - beganMs) / STROKE_MS;
      this.#isOnce = part <= 1 && !finger.isDown;
      if (!finger.isDown) {
        const at = placeAt(0, Math.min(part, 1), { widthMm: width, heightMm: height });
        engine.pointer({ timeMs: ms, xMm: x + at.xMm, yMm: y + at.yMm, down: part <= 1 });
      }
      if (this.#isOnce) clock.nextFrame(frame);
    };
    clock.nextFrame(frame);
    await after(2 * RAMP_PART * STROKE_MS);
  }

  /** At once: whoever takes over comes to a screen without a finger. */
  #lift() {
    if (this.#isDown) this.#parts.engine.lift();
    this.#isDown = false;
  }

  /** @param {Frame} frame */
  feel({ xMm, yMm }) {
    const at = xMm.findLastIndex(Number.isFinite);
    if (at >= 0) this.#felt = { xMm: xMm[at], yMm: yMm[at] };
  }

  /**
   * A fingertip that no pointer looks like: pale, with a dashed outline and a nail.
   * @param {CanvasRenderingContext2D} context
   */
  draw(context) {
    if (this.#isEnded || !this.#felt) return;
    const { scale } = this.#parts.map;
    const radius = Math.max(RADIUS_MIN_PX, RADIUS_MM * scale);
    context.save();
    context.translate(this.#felt.xMm * scale, this.#felt.yMm * scale);
    context.rotate(-0.35);
    context.globalAlpha = this.#isDown ? 1 : 0.45;
    const skin = context.createLinearGradient(0, -radius, 0, 4 * radius);
    skin.addColorStop(0, "#ffffffb0");
    skin.addColorStop(1, "#ffffff00");
    context.beginPath();
    context.moveTo(-radius, 4 * radius);
    context.lineTo(-radius, 0);
    context.arc(0, 0, radius, Math.PI, 2 * Math.PI);
    context.lineTo(radius, 4 * radius);
    context.fillStyle = skin;
    context.fill();
    context.setLineDash([5, 4]);
    context.lineWidth = 3;
    context.strokeStyle = "#000a";
    context.stroke();
    context.lineWidth = 1.5;
    context.strokeStyle = "#fff";
    context.stroke();
    context.setLineDash([]);
    context.beginPath();
    context.ellipse(0, -0.15 * radius, 0.5 * radius, 0.62 * radius, 0, 0, 2 * Math.PI);
    context.stroke();
    context.restore();
  }
}

/**
 * The place in a stroke, from 0 at its begin to 1 at its end.
 * @param {number} stroke Its number.
 * @param {number} part
 * @param {Screen} screen
 */
function placeAt(stroke, part, { widthMm, heightMm }) {
  const isWide = widthMm >= heightMm;
  const [long, short] = isWide ? [widthMm, heightMm] : [heightMm, widthMm];
  const length = Math.min(SCREEN_PART * long, LENGTH_MAX_MM);
  const passed = eased(part) - 0.5;
  const along = long / 2 + (stroke % 2 === 0 ? 1 : -1) * length * passed;
  const line = 0.5 + SCREEN_PART * (((0.5 + stroke * GOLDEN) % 1) - 0.5);
  const bend = Math.min(BEND * length, 0.5 * (1 - SCREEN_PART) * short);
  const across = line * short + bend * (1 - 4 * passed * passed) - bend / 2;
  return isWide ? { xMm: along, yMm: across } : { xMm: across, yMm: along };
}

/**
 * The part of the way at a part of the time: even speed between two ramps.
 * @param {number} part
 */
function eased(part) {
  const speed = 1 / (1 - RAMP_PART);
  const ramp = (/** @type {number} */ time) => (speed * time * time) / (2 * RAMP_PART);
  if (part < RAMP_PART) return ramp(part);
  if (part > 1 - RAMP_PART) return 1 - ramp(1 - part);
  return speed * (part - RAMP_PART / 2);
}
