// The scope: reference, felt and voltage over the last seconds.

import { uPlot, uPlotStyle } from "../vendor/studio-vendor.js";
import { byId, colour, download, element } from "./dom.js";

/** What the scope shows while it runs, s. */
const WINDOW_S = 3;
const HEIGHT_PX = 230;

export class Scope {
  #samples;
  #plot;
  #shownNowS = -1;
  isPaused = false;
  /** Paused by zooming or by the button. */
  onPause = () => {};

  constructor(samples) {
    this.#samples = samples;
    document.head.append(element("style", {}, uPlotStyle));
    this.#make();
    new ResizeObserver(([{ contentRect }]) => {
      this.#plot.setSize({ width: Math.max(200, contentRect.width - 4), height: HEIGHT_PX });
    }).observe(byId("scope"));
    const frame = () => {
      if (!this.isPaused && this.#shownNowS !== this.#samples.nowS) this.#draw();
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  /** Makes the chart anew, in the colours of the theme. */
  #make() {
    this.#plot?.destroy();
    const axis = {
      stroke: colour("soft"),
      grid: { stroke: colour("line"), width: 1 },
      ticks: { stroke: colour("line") },
      font: "13px system-ui, sans-serif",
      labelFont: "13px system-ui, sans-serif",
      labelSize: 18,
    };
    const digits = (unit, count) => (_, value) => (Number.isFinite(value) ? `${value.toFixed(count)} ${unit}` : "–");
    const options = {
      width: Math.max(200, byId("scope").clientWidth - 4),
      height: HEIGHT_PX,
      scales: { x: { time: false }, mN: {}, V: { range: (_, low, high) => [0, Math.max(20, high ?? 20)] } },
      axes: [
        { ...axis, label: "s" },
        { ...axis, scale: "mN", label: "mN", size: 48 },
        { ...axis, scale: "V", label: "V rms", side: 1, size: 44, grid: { show: false } },
      ],
      series: [
        { label: "time", value: digits("s", 3) },
        {
          label: "reference",
          scale: "mN",
          stroke: colour("reference"),
          width: 2,
          dash: [6, 4],
          value: digits("mN", 1),
        },
        { label: "felt", scale: "mN", stroke: colour("felt"), width: 2, value: digits("mN", 1) },
        { label: "voltage", scale: "V", stroke: colour("voltage"), width: 1.5, value: digits("V", 0) },
      ],
      cursor: { drag: { x: true, y: false } },
      hooks: { setSelect: [({ select }) => select.width > 0 && this.pause(true)] },
    };
    this.#plot = new uPlot(options, [[], [], [], []], byId("scope"));
    this.#draw();
  }

  restyle() {
    this.#make();
  }

  #draw() {
    const { nowS } = this.#samples;
    this.#shownNowS = nowS;
    const { timeS, referenceN, feltN, voltageV } = this.#samples.since(nowS - WINDOW_S);
    const finite = (values, factor) => values.map((value) => (Number.isFinite(value) ? value * factor : null));
    this.#plot.setData([timeS, finite(referenceN, 1000), finite(feltN, 1000), finite(voltageV, 1)], false);
    this.#plot.setScale("x", { min: nowS - WINDOW_S, max: nowS });
  }

  pause(isPaused) {
    this.isPaused = isPaused;
    this.onPause(isPaused);
  }

  /** What the chart shows, as numbers. */
  saveCsv() {
    const { min, max } = this.#plot.scales.x;
    download("frixel-felt.csv", this.#samples.csv(min, max), "text/csv");
  }

  /** The chart on the card's colour, as a picture. */
  savePng() {
    const chart = this.#plot.ctx.canvas;
    const picture = element("canvas", { width: chart.width, height: chart.height });
    const context = picture.getContext("2d");
    context.fillStyle = colour("card");
    context.fillRect(0, 0, picture.width, picture.height);
    context.drawImage(chart, 0, 0);
    picture.toBlob((blob) => download("frixel-felt.png", blob, "image/png"));
  }
}
