// What a person would feel of layers, as bars and small numbers. The sentences behind them are in the report.
// @ts-check

import { byId, element, shortName } from "./dom.js";
import { notify } from "./notices.js";
import { perception } from "./toml_text.js";

/** @import { Checked, Layer, Perceived } from "../engine/types" */
/** @typedef {{ naturalN: number, reachN: number }} Scale Friction of bare glass, and the most that can be reached, N. */

/** @typedef {{ name: string, text: string }} Line Of a report. */

/** Lines of a report that say what a scene as a whole is like, by their names, in the order in which they are shown. */
const REMARKS = ["draft", "warning", "out of reach", "alike", "note"];
/** Lines on single layers, which the table has. */
const OF_LAYERS = ["not felt", "unknown", "maybe", "felt", "more"];

/** What the numbers of layers are: one line, where they are shown. */
const STEP = "Step: the largest step of friction, inside the layer or at its border, in Weber steps.";
/** @type {Record<string, string>} */
const MEANINGS = {
  reachable: "what this board and finger can give; the map's colours end there",
  targets: "the least and the most that the scene asks for anywhere on the screen",
};

/**
 * Whether something is felt, in the words of the check; a press says the whole sentence.
 * @param {string} verdict
 * @param {string} sentence
 */
function chip(verdict, sentence) {
  const className = `verdict ${verdict.replaceAll(" ", "-")}`;
  const button = element("button", { type: "button", className, title: sentence }, verdict);
  button.onclick = () => notify(sentence, undefined, { isGood: true, beside: button });
  return button;
}

/** What the numbers of layers are. */
export function stepWords() {
  return `${STEP} ${perception().weberStep}`;
}

/** @param {number} newtons */
const millinewtons = (newtons) => `${Math.round(newtons * 1000)}`;

/**
 * A step of friction as a bar between bare glass and the most that can be reached.
 * @param {Perceived} perceived
 * @param {Scale} scale
 */
function stepBar({ fromN, toN }, { naturalN, reachN }) {
  const part = (/** @type {number} */ n) => Math.max(0, Math.min(1, (n - naturalN) / Math.max(reachN - naturalN, 1e-9)));
  const [low, high] = [Math.min(fromN, toN), Math.max(fromN, toN)].map(part);
  const fill = element("span");
  fill.style.left = `${100 * low}%`;
  fill.style.width = `${100 * (high - low)}%`;
  const words = `${millinewtons(fromN)} to ${millinewtons(toN)} mN`;
  return element("span", { className: "step-bar", title: words, role: "img", "aria-label": words }, fill);
}

/**
 * What is felt of a layer, in one line: whether, its step as a bar, and the frequency of its texture.
 * @param {Layer} layer
 * @param {Scale} scale
 */
export function feltLine({ perceived, felt }, scale) {
  if (!perceived) return element("span", { className: "felt-line soft" }, "hidden by the layers above");
  const line = element("span", { className: "felt-line", title: felt }, chip(perceived.verdict, felt));
  line.append(stepBar(perceived, scale), element("span", {}, element("small", {}, "step "), perceived.weberSteps));
  const { texture } = perceived;
  if (texture) line.append(element("span", {}, `${Math.round(texture.frequencyHz)}`, element("small", {}, " Hz")));
  return line;
}

/**
 * The panel of what is felt: a table of layers, remarks on the scene, and the whole report, folded.
 * @param {Checked} check
 */
export function showFelt({ layers, report, ...scale }) {
  const named = report.map(([name, text]) => ({ name, text }));
  const remarks = named.filter(({ name, text }) => REMARKS.includes(name) && text !== "nothing");
  remarks.sort((one, other) => REMARKS.indexOf(one.name) - REMARKS.indexOf(other.name));
  const board = named.filter(({ name }) => ![...REMARKS, ...OF_LAYERS].includes(name));
  const words = named.filter(({ name }) => OF_LAYERS.includes(name));
  const hasLayers = layers.length > 0;
  byId("no-layers").hidden = hasLayers;
  byId("felt-layers").hidden = !hasLayers;
  byId("felt-layers").tBodies[0].replaceChildren(...layers.map((layer) => row(layer, scale)));
  byId("felt-step").textContent = hasLayers ? stepWords() : "";
  const remark = (/** @type {Line} */ { name, text }) =>
    element("p", { className: "remark" }, element("b", {}, name), ` ${text}`);
  byId("remarks").replaceChildren(...remarks.map(remark));
  byId("board-needs").replaceChildren(...board.map(pair));
  byId("felt-words").replaceChildren(...words.map(pair));
}

/**
 * @param {Layer} layer
 * @param {Scale} scale
 */
function row({ name, perceived, felt }, scale) {
  const title = element("th", { scope: "row", title: felt }, shortName(name));
  if (!perceived) return element("tr", {}, title, element("td", { colSpan: 4, className: "soft" }, "hidden"));
  const { texture } = perceived;
  const hertz = texture ? `${Math.round(texture.frequencyHz)} Hz at ${Math.round(texture.speedMmPerS)} mm/s` : "–";
  const most = millinewtons(Math.max(perceived.fromN, perceived.toN));
  const friction = element("td", {}, stepBar(perceived, scale), " ", element("span", { className: "number" }, `${most} mN`));
  const cells = [chip(perceived.verdict, felt), perceived.weberSteps, hertz].map((content) => element("td", {}, content));
  return element("tr", {}, title, cells[0], friction, cells[1], cells[2]);
}

/** @param {Line} line */
function pair({ name, text }) {
  const meaning = element("span", { className: "soft" }, MEANINGS[name] ? `: ${MEANINGS[name]}` : "");
  return element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, text, meaning));
}
