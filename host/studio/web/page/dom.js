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
 * @typedef {{ [Name in keyof Made]?: Made[Name] | number } & { [name: `aria-${string}`]: string | boolean }} Properties
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
 * Shows one sentence above the page until it is dismissed or another one comes; with `{ words, action }`, also a button
 * that does something about it.
 * @param {string} sentence
 * @param {{ words: string, action: () => unknown }} [offer]
 */
export function notify(sentence, offer) {
  const notice = byId("notice");
  const [said, offered, dismiss] = /** @type {HTMLCollectionOf<HTMLElement>} */ (notice.children);
  said.textContent = sentence;
  offered.hidden = offer === undefined;
  offered.textContent = offer?.words ?? "";
  offered.onclick = () => {
    forgetNotice();
    if (offer) attempt(offer.action);
  };
  dismiss.onclick = forgetNotice;
  notice.hidden = false;
}

/** Removes the sentence: what it says is over. */
export function forgetNotice() {
  byId("notice").hidden = true;
}

/**
 * The sentence of an error.
 * @param {unknown} error
 */
export function sentenceOf(error) {
  return error instanceof Error ? error.message : String(error);
}

/**
 * Runs what a person asked for; where it fails, says why.
 * @template Value
 * @param {() => Value | Promise<Value>} action
 * @returns {Promise<Value | undefined>}
 */
export async function attempt(action) {
  try {
    return await action();
  } catch (error) {
    notify(sentenceOf(error));
    return undefined;
  }
}

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
