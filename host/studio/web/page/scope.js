// The scope: reference, felt and voltage over the last seconds.
// @ts-check

import { clock } from "../clock.js";
import { uPlot, uPlotStyle } from "../vendor/chart-vendor.js";
import { adoptStyle, colour, contextOf, download, element, volts } from "./dom.js";

/** @import { Frame } from "../engine/types" */
/** @import { Samples } from "./samples.js" */

/** What the scope shows while it runs, s. */
const WINDOW_S = 3;
/** Smallest chart, CSS pixels. */
const SIZE_MIN_PX = { width: 160, height: 60 };
/** Least distance of two numbers at an axis of friction or voltage, CSS pixels: in a low chart, and in others. */
const LINES_PX = { low: 18, other: 36 };
const LOW_CHART_PX = 150;
/** Least time between two drawings, ms. */
const FRAME_MS = 30;
/** The scope runs on for this long after a lift, s. */
const AFTER_LIFT_S = 0.3;
/** Height of the words above a saved chart, CSS pixels. */
const HEAD_PX = 30;

/** What time and series mean: in the titles of the legend, and in the scope's menu. */
export const MEANINGS = [
  "time before the newest sample, s",
  "reference: the friction that the scene asks for where the finger is, mN",
  "felt: the friction that the simulated finger feels; it wanders with the finger's load and noise, mN",
  "voltage: the drive on the electrode, V rms",
];

export class Scope {
  #samples;
  #box;
  #resizes;
  #isClosed = false;
  /** @type {uPlot} */
  #plot;
  /** Time of the newest sample in the chart, s of board time. */
  #shownS = -1;
  /** The last touch, s of board time. */
  #touchedS = 0;
  isPaused = false;
  /** Whether a draft is felt: the names of saved files say so. */
  isDraft = false;
  /**
   * Paused by zooming or by the button.
   * @type {(isPaused: boolean) => void}
   */
  onPause = () => {};

  /**
   * Draws in the element `box`.
   * @param {Samples} samples
   * @param {HTMLElement} box
   */
  constructor(samples, box) {
    this.#samples = samples;
    this.#box = box;
    adoptStyle(box, uPlotStyle);
    this.#plot = this.#made();
    this.#draw();
    this.#resizes = new ResizeObserver(() => this.#fit());
    this.#resizes.observe(this.#box);
    let drawnMs = 0;
    /** @param {number} ms */
    const frame = (ms) => {
      if (this.#isClosed) return;
      if (!this.isPaused && this.#shownS !== this.#newestS && ms - drawnMs >= FRAME_MS) {
        this.#draw();
        drawnMs = ms;
      }
      clock.nextFrame(frame);
    };
    clock.nextFrame(frame);
  }

  /** Ends the drawing, and takes the chart's listeners from the window. */
  close() {
    this.#isClosed = true;
    this.#resizes.disconnect();
    this.#plot.destroy();
  }

  /** Makes the chart anew, in the colours of the theme. */
  #made() {
    const axis = {
      stroke: colour("soft", this.#box),
      grid: { stroke: colour("line", this.#box), width: 1 },
      ticks: { stroke: colour("line", this.#box) },
      font: "13px system-ui, sans-serif",
      labelFont: "13px system-ui, sans-serif",
      labelSize: 18,
    };
    /** @type {(unit: string, write: (value: number) => string) => uPlot.Series["value"]} */
    const digits = (unit, write) => (_, value) => (Number.isFinite(value) ? `${write(value)} ${unit}` : "–");
    const tenths = (/** @type {number} */ value) => value.toFixed(1);
    /** @type {uPlot.Options} */
    const options = {
      ...SIZE_MIN_PX,
      scales: { x: { time: false }, mN: { range: upper }, V: { range: lower } },
      axes: [
        { ...axis, size: 34, space: 64, values: (_, splits) => splits.map((value) => beforeNow(value)) },
        { ...axis, scale: "mN", label: "mN", size: 48, space: linesPx, values: (_, splits) => splits.map(notBelowZero) },
        { ...axis, scale: "V", label: "V rms", side: 1, size: 44, space: linesPx, grid: { show: false } },
      ],
      series: [
        { label: "time", value: (_, value) => (Number.isFinite(value) ? beforeNow(value, 3) : "–") },
        {
          label: "reference",
          scale: "mN",
          stroke: colour("reference", this.#box),
          width: 2,
          dash: [6, 4],
          value: digits("mN", tenths),
        },
        { label: "felt", scale: "mN", stroke: colour("felt", this.#box), width: 2, value: digits("mN", tenths) },
        { label: "voltage", scale: "V", stroke: colour("voltage", this.#box), width: 1.5, value: digits("V rms", volts) },
      ],
      cursor: { drag: { x: true, y: false } },
      legend: { markers: { dash: (plot, at) => (plot.series[at].dash ? "dashed" : "solid") } },
      hooks: { setSelect: [({ select }) => select.width > 0 && this.pause(true)] },
    };
    const plot = new uPlot(options, [[], [], [], []], this.#box);
    /** @type {NodeListOf<HTMLElement>} */
    const rows = this.#box.querySelectorAll(".u-legend tr");
    for (const [at, row] of rows.entries()) row.title = MEANINGS[at] ?? "";
    return plot;
  }

  /** The chart fills its box, but for the legend below it. */
  #fit() {
    const { paddingLeft, paddingRight } = getComputedStyle(this.#box);
    const width = this.#box.clientWidth - parseFloat(paddingLeft) - parseFloat(paddingRight);
    const legend = this.#box.querySelector(".u-legend");
    const height = this.#box.clientHeight - (legend?.getBoundingClientRect().height ?? 0);
    this.#plot.setSize({
      width: Math.max(SIZE_MIN_PX.width, width),
      height: Math.max(SIZE_MIN_PX.height, height),
    });
  }

  restyle() {
    this.#plot.destroy();
    this.#plot = this.#made();
    this.#fit();
    this.#draw();
  }

  /** Clears the chart, because another scene is open. */
  clear() {
    this.#samples.clear();
    this.#touchedS = 0;
    this.#draw();
  }

  /**
   * The scope stands still while nothing touches.
   * @param {Frame} frame
   */
  feel({ contact }) {
    const { nowS } = this.#samples;
    if (contact || nowS < this.#touchedS) this.#touchedS = nowS;
  }

  /** Time of the newest sample that is drawn, s of board time. */
  get #newestS() {
    return Math.min(this.#samples.nowS, this.#touchedS + AFTER_LIFT_S);
  }

  #draw() {
    this.#shownS = this.#newestS;
    const { timeS, xMm, referenceN, feltN, voltageV } = this.#samples.since(this.#shownS - WINDOW_S);
    // No friction is drawn while the finger is up, comes down or leaves, so that the axis serves what is felt.
    const isTouch = (/** @type {number} */ at) => Number.isFinite(xMm[at]);
    const isDrawn = (/** @type {number} */ value, /** @type {number} */ at) =>
      Number.isFinite(value) && isTouch(at - 1) && isTouch(Math.min(at + 1, xMm.length - 1));
    const finite = (/** @type {number[]} */ values, /** @type {number} */ factor) =>
      values.map((value, at) => (isDrawn(value, at) ? value * factor : null));
    const agoS = timeS.map((atS) => atS - this.#shownS);
    this.#plot.setData([agoS, finite(referenceN, 1000), finite(feltN, 1000), voltageV], false);
    this.#plot.setScale("x", { min: -WINDOW_S, max: 0 });
  }

  /** @param {boolean} isPaused */
  pause(isPaused) {
    this.isPaused = isPaused;
    this.onPause(isPaused);
  }

  get #fileName() {
    return this.isDraft ? "frixel-felt-draft" : "frixel-felt";
  }

  /** What the chart shows, as numbers. */
  saveCsv() {
    const { min = 0, max = 0 } = this.#plot.scales.x;
    download(`${this.#fileName}.csv`, this.#samples.csv(this.#shownS + min, this.#shownS + max), "text/csv");
  }

  /** The chart on the card's colour, as a picture. */
  savePng() {
    const chart = this.#plot.ctx.canvas;
    const ratio = devicePixelRatio;
    const picture = element("canvas", { width: chart.width, height: chart.height + HEAD_PX * ratio });
    const context = contextOf(picture);
    context.fillStyle = colour("card", this.#box);
    context.fillRect(0, 0, picture.width, picture.height);
    context.drawImage(chart, 0, HEAD_PX * ratio);
    context.scale(ratio, ratio);
    context.font = "14px system-ui, sans-serif";
    context.textBaseline = "middle";
    let left = 12;
    const write = (/** @type {string} */ words, /** @type {string} */ ink) => {
      context.fillStyle = colour(ink, this.#box);
      context.fillText(words, left, HEAD_PX / 2);
      left += context.measureText(words).width + 22;
    };
    if (this.isDraft) write("DRAFT", "danger");
    write("reference (dashed), mN", "reference");
    write("felt, mN", "felt");
    write("voltage, V rms", "voltage");
    write("time in s", "ink");
    picture.toBlob((blob) => blob && download(`${this.#fileName}.png`, blob, "image/png"));
  }
}

/**
 * A time before the newest sample, s, in words.
 * @param {number} seconds
 */
function beforeNow(seconds, digits = 2) {
  if (Math.abs(seconds) < 0.0005) return "now";
  return `${Number(seconds.toFixed(digits))} s`.replace("-", "−");
}

/**
 * Friction is drawn above the voltage: the axis goes on below zero, where there is none.
 * @param {number} mN
 */
export const notBelowZero = (mN) => (mN < 0 ? "" : `${mN}`);

/** @type {uPlot.Axis.Space} */
const linesPx = (_chart, _axis, _min, _max, heightPx) => (heightPx < LOW_CHART_PX ? LINES_PX.low : LINES_PX.other);

/**
 * Friction takes the upper part of the chart: what is usual is shown, and more where there is more.
 * @param {uPlot} _chart
 * @param {number | null} low
 * @param {number | null} high
 * @returns {uPlot.Range.MinMax}
 */
function upper(_chart, low, high) {
  const least = Math.max(low ?? 230, 0.6 * (high ?? 380));
  const most = Math.max(high ?? 380, least + 20);
  return [least - 0.8 * (most - least), most + 0.05 * (most - least)];
}

/**
 * voltage the lower.
 * @param {uPlot} _chart
 * @param {number | null} _low
 * @param {number | null} high
 * @returns {uPlot.Range.MinMax}
 */
function lower(_chart, _low, high) {
  return [0, 2.4 * Math.max(20, high ?? 0)];
}
