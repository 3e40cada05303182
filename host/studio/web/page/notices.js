// Notices: one sentence at a time, which floats over the page beside the control that it is about.
//
// Good news goes by itself once it can have been read, and, unless it offers something, at a press elsewhere. All else
// stays until it is dismissed, by its button or by Escape, or another one comes. Good news that is lasting comes back
// when that other one goes.
// @ts-check

import { clock } from "../clock.js";
import { byId, sentenceOf } from "./dom.js";

/** @typedef {{ words: string, action: () => unknown }} Offer Words of a button, and what it does. */
/** @typedef {{ isGood?: boolean, isLasting?: boolean, beside?: Element }} Manner */
/** @typedef {{ sentence: string, offer: Offer | undefined, manner: Manner }} Notice */

/** How long good news stays, ms: to notice it, and for each of its characters. */
const NOTICE_MS = 4000;
const CHARACTER_MS = 50;
/** What offers something stays longer: a person may first look at what it is about. */
const OFFER_FACTOR = 3;
/** Good news under the pointer or with the focus is looked at again after this time, ms. */
const AGAIN_MS = 1000;
/** Distance of a notice from its control and from the window, CSS pixels. */
const GAP_PX = 8;
const CONTROLS = "button, select, input, summary";

/** @type {number | undefined} */
let timer;
/**
 * The control that a person presses or changes, while its listeners run.
 * @type {Element | undefined}
 */
let pressed;
/** The notice that is shown. @type {Notice | undefined} */
let shown;
/** The last one that is lasting and was not dismissed. @type {Notice | undefined} */
let lasting;

/** Notices stand beside what was pressed, and stay there when the window changes or something is scrolled. */
export function followPresses() {
  for (const type of ["click", "change", "input"]) {
    addEventListener(
      type,
      ({ target }) => {
        pressed = (target instanceof Element && target.closest(CONTROLS)) || undefined;
        setTimeout(() => (pressed = undefined));
      },
      { capture: true },
    );
  }
  for (const type of ["resize", "scroll"])
    addEventListener(type, () => place(byId("notice"), shown?.manner.beside), { capture: true });
  addEventListener("keydown", ({ key, defaultPrevented }) => {
    if (key === "Escape" && !defaultPrevented && !document.querySelector("dialog[open]")) forgetNotice();
  });
  addEventListener("pointerdown", ({ target }) => {
    const isInside = target instanceof Node && byId("notice").contains(target);
    const isPassing = shown?.manner.isGood && shown.offer === undefined;
    if (isPassing && !isInside) forgetNotice();
  });
}

/**
 * Shows a sentence; with `offer`, also a button that does something about it. `beside` is the control that caused it,
 * the one that was just pressed if it is not given. Good news that is lasting stays, and comes back after another
 * sentence. Returns what removes this sentence, unless it has gone.
 * @param {string} sentence
 * @param {Offer} [offer]
 * @param {Manner} manner
 */
export function notify(sentence, offer, { isGood = false, isLasting = false, beside = pressed } = {}) {
  /** @type {Notice} */
  const own = { sentence, offer, manner: { isGood, isLasting, beside } };
  if (isLasting) lasting = own;
  show(own);
  return () => {
    if (own === shown) forgetNotice();
    else if (own === lasting) lasting = undefined;
  };
}

/** @param {Notice} own */
function show(own) {
  const { sentence, offer, manner } = own;
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
  notice.setAttribute("role", manner.isGood ? "status" : "alert");
  notice.classList.toggle("is-good", manner.isGood);
  notice.hidden = false;
  shown = own;
  place(notice, manner.beside);
  clock.cancel(timer);
  const readMs = (NOTICE_MS + CHARACTER_MS * sentence.length) * (offer ? OFFER_FACTOR : 1);
  timer = manner.isGood && !manner.isLasting ? clock.later(readMs, () => expire(notice)) : undefined;
}

/** Removes the sentence: what it says is over. A lasting one that it has replaced is shown again. */
export function forgetNotice() {
  clock.cancel(timer);
  timer = undefined;
  if (shown === lasting) lasting = undefined;
  shown = undefined;
  byId("notice").hidden = true;
  if (lasting) show(lasting);
}

/** @param {HTMLElement} notice */
function expire(notice) {
  if (notice.matches(":hover, :focus-within")) timer = clock.later(AGAIN_MS, () => expire(notice));
  else forgetNotice();
}

/**
 * Puts a notice below its control, or above it where there is more room; without one, below the header. It stays within
 * the window, and lies over no tool of the map and, unless it is about a control there, not over the header.
 * @param {HTMLElement} notice
 * @param {Element | undefined} control
 */
function place(notice, control) {
  if (notice.hidden) return;
  const header = document.querySelector("header");
  const { width, height } = notice.getBoundingClientRect();
  const box = control?.isConnected && control.checkVisibility() ? control.getBoundingClientRect() : undefined;
  const isOfHeader = box && header?.contains(control ?? null);
  const least = isOfHeader ? GAP_PX : (header?.getBoundingClientRect().bottom ?? 0) + GAP_PX;
  const left = box ? box.left : (innerWidth - width) / 2;
  const below = (box?.bottom ?? 0) + GAP_PX;
  const wanted = box && below + height > innerHeight ? box.top - GAP_PX - height : below;
  const x = Math.max(GAP_PX, Math.min(left, innerWidth - width - GAP_PX));
  const within = (/** @type {number} */ top) => Math.max(least, Math.min(top, innerHeight - height - GAP_PX));
  const y = within(wanted);
  const tools = document.querySelector(".map-tools")?.getBoundingClientRect();
  const isOver = tools && x < tools.right && tools.left < x + width && y < tools.bottom && tools.top < y + height;
  notice.style.left = `${x}px`;
  notice.style.top = `${isOver ? within(tools.bottom + GAP_PX) : y}px`;
}

/**
 * Runs what a person asked for; where it fails, says why beside the control.
 * @template Value
 * @param {() => Value | Promise<Value>} action
 * @returns {Promise<Value | undefined>}
 */
export async function attempt(action) {
  const beside = pressed;
  try {
    return await action();
  } catch (error) {
    notify(sentenceOf(error), undefined, { beside });
    return undefined;
  }
}
