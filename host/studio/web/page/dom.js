// Elements of the page. Text goes in as text nodes only, never as HTML.
// @ts-check

import { clock } from "../clock.js";

/** @import { Ids } from "./ids" */

/**
 * An element of index.html.
 * @template {string} Id
 * @param {Id} id
 * @returns {Id extends keyof Ids ? Ids[Id] : HTMLElement}
 */
export function byId(id) {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no element ${id}`);
  return /** @type {Id extends keyof Ids ? Ids[Id] : HTMLElement} */ (found);
}

/**
 * What `element` takes for an element: properties, listeners (`onclick`) and attributes (`aria-label`).
 * @template Made
 * @typedef {{ [Name in keyof Made]?: Made[Name] | number } & { [name: `${"aria" | "data"}-${string}`]: string | boolean }} Properties
 */

/**
 * Creates an element.
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {Properties<HTMLElementTagNameMap[Tag]>} properties
 * @param {(Node | string)[]} children
 */
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes("-")) made.setAttribute(name, String(value));
    else Object.assign(made, { [name]: value });
  }
  made.append(...children);
  return made;
}

/**
 * Gives an element its place in its parent, CSS pixels.
 * @param {HTMLElement} placed
 * @param {{ left: number, top: number, width: number, height: number }} area
 */
export function lay(placed, area) {
  for (const [side, px] of Object.entries(area)) placed.style.setProperty(side, `${px}px`);
}

/**
 * Adds a style sheet where `within` stands. Unlike an element, it needs no leave of a content security policy.
 * @param {Element} within
 * @param {string} text
 */
export function adoptStyle(within, text) {
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(text);
  /** @type {Document | ShadowRoot} */ (within.getRootNode()).adoptedStyleSheets.push(sheet);
}

/**
 * Offers bytes or text as a file.
 * @param {string} name
 * @param {BlobPart} content
 * @param {string} type
 */
export function download(name, content, type) {
  const url = URL.createObjectURL(new Blob([content], { type }));
  element("a", { href: url, download: name }).click();
  clock.later(10_000, () => URL.revokeObjectURL(url));
}

/**
 * Lets a person choose a file; resolves to undefined if none is chosen.
 * @param {string} accept
 * @returns {Promise<File | undefined>}
 */
export function chosenFile(accept) {
  const input = element("input", { type: "file", accept, hidden: true });
  // Firefox opens no dialog of an input that is in no document.
  document.body.append(input);
  return new Promise((resolve) => {
    const choose = () => {
      resolve(input.files?.[0]);
      input.remove();
    };
    input.onchange = choose;
    input.oncancel = choose;
    input.click();
  });
}

/**
 * A voltage, V rms, in words. Small ones have a decimal, so that half a volt is rounded neither to 1 nor to 0.
 * @param {number} value
 */
export function volts(value) {
  return value.toFixed(value < 9.95 ? 1 : 0);
}

/** Longest name of a scene, and most of a longer name that is shown, characters. */
export const NAME_MAX = 64;

/**
 * A name, cut where it is longer than a person reads.
 * @param {string} name
 */
export function shortName(name) {
  const characters = [...name];
  return characters.length > NAME_MAX ? `${characters.slice(0, NAME_MAX - 1).join("")}…` : name;
}

/**
 * The name of a file without its ending.
 * @param {string} name
 */
export function stemOf(name) {
  return name.replace(/\.\w+$/, "");
}

/**
 * The sentence of an error.
 * @param {unknown} error
 */
export function sentenceOf(error) {
  return error instanceof Error ? error.message : String(error);
}

/** Colours that say which curve is which: they are told apart where the system forces all others, too. */
const CURVES = ["reference", "felt", "voltage"];
/** @type {WeakMap<Element, Map<string, string>>} */
let colours = new WeakMap();

/**
 * The value of a colour of the style sheets where `within` stands, resolved for the theme.
 * @param {string} name
 * @param {Element} within
 */
export function colour(name, within) {
  const known = colours.get(within) ?? new Map();
  colours.set(within, known);
  const before = known.get(name);
  if (before !== undefined) return before;
  const probe = element("span");
  probe.style.color = `var(--${name})`;
  if (CURVES.includes(name)) probe.style.setProperty("forced-color-adjust", "none");
  within.append(probe);
  const { color } = getComputedStyle(probe);
  probe.remove();
  known.set(name, color);
  return color;
}

/**
 * What a canvas is drawn with.
 * @overload
 * @param {HTMLCanvasElement} canvas
 * @returns {CanvasRenderingContext2D}
 */
/**
 * @overload
 * @param {OffscreenCanvas} canvas
 * @returns {OffscreenCanvasRenderingContext2D}
 */
/** @param {HTMLCanvasElement | OffscreenCanvas} canvas */
export function contextOf(canvas) {
  const context = canvas.getContext("2d");
  if (!context) throw new Error("this browser draws on no canvas");
  return context;
}

/**
 * Draws a circle.
 * @param {CanvasRenderingContext2D} context
 * @param {[x: number, y: number, radius: number]} circle
 * @param {{ fill?: string, stroke?: string, width?: number }} inks `width` is that of the line.
 */
export function drawCircle(context, [x, y, radius], { fill, stroke, width = 1 }) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  if (fill) {
    context.fillStyle = fill;
    context.fill();
  }
  if (!stroke) return;
  context.strokeStyle = stroke;
  context.lineWidth = width;
  context.stroke();
}

/** The theme has changed: colours are resolved anew. */
export function forgetColours() {
  colours = new WeakMap();
}

/** A setting that outlives the page, where the browser lets it. */
export const settings = {
  /** @param {string} name */
  get(name) {
    try {
      return localStorage.getItem(`frixel.${name}`);
    } catch {
      return null;
    }
  },
  /**
   * Whether the setting is kept: private windows have no storage, and a full one takes nothing.
   * @param {string} name
   * @param {string} value
   */
  set(name, value) {
    try {
      localStorage.setItem(`frixel.${name}`, value);
      return true;
    } catch {
      return false;
    }
  },
};
