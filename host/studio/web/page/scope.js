// The scope: reference, felt and voltage over the last seconds.

import { uPlot, uPlotStyle } from "../vendor/studio-vendor.js";
import { colour, download, element } from "./dom.js";

/** What the scope shows while it runs, s. */
const WINDOW_S = 3;
const HEIGHT_PX = 190;
/** Least time between two drawings, ms. */
const FRAME_MS = 30;

export class Scope {
  #samples;
  #box;
  #plot;
  #shownNowS = -1;
  isPaused = false;
  /** Whether a draft is felt: the names of saved files say so. */
  isDraft = false;
  /** Paused by zooming or by the button. */
  onPause = () => {};

  /** Draws in the element `box`. */
  constructor(samples, box) {
    this.#samples = samples;
    this.#box = box;
    box.before(element("style", {}, uPlotStyle));
    this.#make();
    new ResizeObserver(([{ contentRect }]) => {
      this.#plot.setSize({ width: Math.max(200, contentRect.width - 4), height: HEIGHT_PX });
    }).observe(this.#box);
    let drawnMs = 0;
    const frame = (ms) => {
      if (!this.isPaused && this.#shownNowS !== this.#samples.nowS && ms - drawnMs >= FRAME_MS) {
        this.#draw();
        drawnMs = ms;
      }
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  /** Makes the chart anew, in the colours of the theme. */
  #make() {
    this.#plot?.destroy();
    const axis = {
      stroke: colour("soft", this.#box),
      grid: { stroke: colour("line", this.#box), width: 1 },
      ticks: { stroke: colour("line", this.#box) },
      font: "13px system-ui, sans-serif",
      labelFont: "13px system-ui, sans-serif",
      labelSize: 18,
    };
    const digits = (unit, count) => (_, value) => (Number.isFinite(value) ? `${value.toFixed(count)} ${unit}` : "–");
    const options = {
      width: Math.max(200, this.#box.clientWidth - 4),
      height: HEIGHT_PX,
      scales: { x: { time: false }, mN: { range: upper }, V: { range: lower } },
      axes: [
        axis,
        { ...axis, scale: "mN", label: "mN", size: 48 },
        { ...axis, scale: "V", label: "V rms", side: 1, size: 44, grid: { show: false } },
      ],
      series: [
        { label: "time", value: digits("s", 3) },
        {
          label: "reference",
          scale: "mN",
          stroke: colour("reference", this.#box),
          width: 2,
          dash: [6, 4],
          value: digits("mN", 1),
        },
        { label: "felt", scale: "mN", stroke: colour("felt", this.#box), width: 2, value: digits("mN", 1) },
        { label: "voltage", scale: "V", stroke: colour("voltage", this.#box), width: 1.5, value: digits("V", 0) },
      ],
      cursor: { drag: { x: true, y: false } },
      hooks: { setSelect: [({ select }) => select.width > 0 && this.pause(true)] },
    };
    this.#plot = new uPlot(options, [[], [], [], []], this.#box);
    this.#draw();
  }

  restyle() {
    this.#make();
  }

  #draw() {
    const { nowS } = this.#samples;
    this.#shownNowS = nowS;
    const { timeS, xMm, referenceN, feltN, voltageV } = this.#samples.since(nowS - WINDOW_S);
    // No friction is drawn while the finger is up, comes down or leaves, so that the axis serves what is felt.
    const isTouch = (at) => Number.isFinite(xMm[at]);
    const isDrawn = (value, at) =>
      Number.isFinite(value) && isTouch(at - 1) && isTouch(Math.min(at + 1, xMm.length - 1));
    const finite = (values, factor) => values.map((value, at) => (isDrawn(value, at) ? value * factor : null));
    this.#plot.setData([timeS, finite(referenceN, 1000), finite(feltN, 1000), voltageV], false);
    this.#plot.setScale("x", { min: nowS - WINDOW_S, max: nowS });
  }

  pause(isPaused) {
    this.isPaused = isPaused;
    this.onPause(isPaused);
  }

  get #fileName() {
    return this.isDraft ? "frixel-felt-draft" : "frixel-felt";
  }

  /** What the chart shows, as numbers. */
  saveCsv() {
    const { min, max } = this.#plot.scales.x;
    download(`${this.#fileName}.csv`, this.#samples.csv(min, max), "text/csv");
  }

  /** The chart on the card's colour, as a picture. */
  savePng() {
    const chart = this.#plot.ctx.canvas;
    const picture = element("canvas", { width: chart.width, height: chart.height });
    const context = picture.getContext("2d");
    context.fillStyle = colour("card", this.#box);
    context.fillRect(0, 0, picture.width, picture.height);
    context.drawImage(chart, 0, 0);
    picture.toBlob((blob) => download(`${this.#fileName}.png`, blob, "image/png"));
  }
}

/** Friction takes the upper part of the chart: what is usual is shown, and more where there is more. */
function upper(_chart, low, high) {
  const least = Math.max(low ?? 230, 0.6 * (high ?? 380));
  const most = Math.max(high ?? 380, least + 20);
  return [least - 0.8 * (most - least), most + 0.05 * (most - least)];
}

/** voltage the lower. */
function lower(_chart, _low, high) {
  return [0, 2.4 * Math.max(20, high ?? 0)];
}
