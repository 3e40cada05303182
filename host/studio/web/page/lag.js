// How late friction comes: prediction on and off, the touch source, and the lag of both as bands on the map.
// @ts-check

import { byId } from "./dom.js";
import { Borders } from "./borders.js";
import { attempt } from "./notices.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { Frame } from "../engine/types" */
/** @import { By } from "./borders.js" */
/** @import { Finger } from "./finger.js" */
/** @import { FrictionMap } from "./map.js" */
/** @import { Player } from "./player.js" */
/** @import { Project } from "./project.js" */

/** How far a band reaches to its side of the stroke, CSS pixels: with prediction to the one, without to the other. */
const WIDE_PX = 15;
/** A band is drawn at least this long, CSS pixels, so that a lag of nothing is seen. */
const LONG_MIN_PX = 3;
/**
 * The map is as dark in the light theme as in the dark one; first.css has the same inks.
 * @type {Record<By, { ink: string, side: number }>}
 */
const BANDS = { predicted: { ink: "#7dffb0", side: -1 }, reported: { ink: "#ff7a1a", side: 1 } };

export class Lag {
  #parts;
  /** @type {Borders | undefined} */
  #borders;
  #isStroke = false;
  #isOpen = false;
  /**
   * The scene, as `Project.opened` counts, that another setting is on its way for: once it plays, the last stroke is
   * slid again.
   * @type {number | undefined}
   */
  #changing;
  /** Whether there is a stroke of a person's that can be slid again. */
  hasStroke = false;
  /** Another way to play was chosen. */
  onChange = () => {};
  /** Drawn anew only when a band comes or goes. */
  isActive = false;

  /** @param {{ engine: Engine, map: FrictionMap, finger: Finger, project: Project, player: Player }} parts */
  constructor(parts) {
    const { finger, project } = parts;
    this.#parts = parts;
    finger.overlays.push(this);
    byId("open-lag").onclick = () => this.#open(!this.isOpen);
    byId("touch").addEventListener("change", () => (this.#changing = project.opened));
    byId("prediction").onchange = () => {
      this.#changing = project.opened;
      this.#predict(byId("prediction").checked);
      this.onChange();
    };
  }

  get isOpen() {
    return this.#isOpen;
  }

  /** @param {boolean} isOpen */
  #open(isOpen) {
    this.#isOpen = isOpen;
    byId("lag").hidden = !isOpen;
    byId("open-lag").setAttribute("aria-expanded", String(isOpen));
    this.#forget();
    this.#say();
    // In a low window it opens below the edge. It scrolls no further than it must: the lag is drawn on the map.
    if (isOpen) byId("lag").scrollIntoView({ block: "nearest" });
    if (isOpen || byId("prediction").checked) return;
    // Nothing else says that friction comes late.
    this.#predict(true);
    if (this.#parts.engine.state.link === "simulator") this.onChange();
  }

  /** @param {boolean} isOn */
  #predict(isOn) {
    byId("prediction").checked = isOn;
    this.#parts.player.withoutPrediction = !isOn;
    this.#say();
  }

  #forget() {
    this.#borders = undefined;
    this.#isStroke = false;
    this.#parts.finger.redraw();
  }

  /** The scene plays, maybe in another way: the last stroke again shows what that changes. */
  played() {
    this.#forget();
    const isChanging = this.#changing === this.#parts.project.opened;
    this.#changing = undefined;
    if (!isChanging || !this.isOpen || !this.hasStroke || this.#parts.engine.state.link !== "simulator") return;
    attempt(() => this.#parts.engine.replay({ slowness: 1 }));
  }

  /** The scene does not play: a later one plays by itself, and no stroke with it. */
  failed() {
    this.#changing = undefined;
  }

  /** Another board plays: it knows no stroke. */
  forgetStroke() {
    this.#changing = undefined;
    this.hasStroke = false;
  }

  /** A board plays as its scene says: it has no switch. */
  showBoard() {
    byId("open-lag").disabled = this.#parts.engine.state.link !== "simulator";
    if (byId("open-lag").disabled) this.#open(false);
  }

  /** @param {Frame} frame */
  feel(frame) {
    if (!this.isOpen || !frame.simulated) return;
    const wasStroke = this.#isStroke;
    for (let at = 0; at < frame.xMm.length; at += 1) this.#add(frame, at);
    if (wasStroke || this.#isStroke) {
      this.#parts.finger.redraw();
      this.#say();
    }
  }

  /**
   * @param {Frame} frame
   * @param {number} at
   */
  #add({ xMm, yMm, predictedXMm, predictedYMm, reportedXMm, reportedYMm, firstTick, ticksPerSample, tickHz }, at) {
    const isDown = Number.isFinite(xMm[at]);
    if (isDown && !this.#isStroke) {
      this.#borders = new Borders((x, y) => this.#parts.map.frictionAt(x, y), this.#parts.map.frictionN);
    }
    if (this.#isStroke && !isDown) this.#borders?.end();
    this.#isStroke = isDown;
    if (!isDown || !Number.isFinite(predictedXMm[at]) || !Number.isFinite(reportedXMm[at])) return;
    this.#borders?.add(
      (1000 * (firstTick + at * ticksPerSample)) / tickHz,
      { xMm: xMm[at], yMm: yMm[at] },
      {
        predicted: { xMm: predictedXMm[at], yMm: predictedYMm[at] },
        reported: { xMm: reportedXMm[at], yMm: reportedYMm[at] },
      },
    );
  }

  #say() {
    const [predicted, reported] = [this.#borders?.meanMm("predicted"), this.#borders?.meanMm("reported")];
    const mm = (/** @type {number | undefined} */ value) => (value === undefined ? "–" : `${value.toFixed(1)} mm`);
    byId("lag-predicted").textContent = mm(predicted);
    byId("lag-reported").textContent = mm(reported);
    const missed = this.#borders?.missed ?? 0;
    const lines = this.#borders?.lines ?? 0;
    byId("lag-missed").textContent = missed > 0 ? `, at ${lines - missed} of ${lines} lines: it missed ${missed}` : "";
    const isOn = byId("prediction").checked;
    byId("lag-predicted").parentElement?.classList.toggle("plays", isOn);
    byId("lag-reported").parentElement?.classList.toggle("plays", !isOn);
  }

  /** @param {CanvasRenderingContext2D} context */
  draw(context) {
    if (!this.isOpen || !this.#borders) return;
    const { scale } = this.#parts.map;
    // Both sides of a line are borders: the band stands where friction rises.
    for (const border of this.#borders.found.filter(({ isUp }) => isUp)) {
      context.save();
      context.translate(border.xMm * scale, border.yMm * scale);
      context.rotate(Math.atan2(border.uy, border.ux));
      for (const [by, { ink, side }] of Object.entries(BANDS)) {
        const lagMm = border[/** @type {By} */ (by)];
        if (lagMm === undefined) continue;
        const long = Math.sign(lagMm || 1) * Math.max(LONG_MIN_PX, Math.abs(lagMm) * scale);
        context.fillStyle = ink;
        context.globalAlpha = 0.85;
        context.fillRect(0, 0, long, side * WIDE_PX);
        context.globalAlpha = 1;
      }
      context.fillStyle = "#fff";
      context.fillRect(-0.5, -WIDE_PX, 1, 2 * WIDE_PX);
      context.restore();
    }
  }
}
