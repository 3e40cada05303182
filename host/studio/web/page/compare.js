// Two versions of a scene, compared blind: neither text nor map says which one is felt.
// @ts-check

import { byId } from "./dom.js";
import { attempt } from "./notices.js";

/** @import { Editor } from "./editor.js" */
/** @import { Player } from "./player.js" */
/** @import { Sound } from "./sound.js" */

/** @typedef {"a" | "b"} Version */
/**
 * Which version X and Y are, the texts of both, and which were felt.
 * @typedef {{ order: Version[], texts: Record<Version, string>, felt: Set<number> }} Trial
 */

export class Compare {
  #player;
  #editor;
  #sound;
  /**
   * The text that was put aside.
   * @type {string | undefined}
   */
  #kept;
  /**
   * During a comparison: which text X and Y are, and what is played.
   * @type {Trial | undefined}
   */
  #trial;
  #tally = { a: 0, b: 0, same: 0 };
  #feelButtons = buttons("feel-version");
  /** X, Y, and no difference. */
  #answerButtons = buttons("better-version");
  /** A comparison begins or ends. */
  onChange = () => {};

  /**
   * @param {Player} player
   * @param {Editor} editor
   * @param {Sound} sound
   */
  constructor(player, editor, sound) {
    this.#player = player;
    this.#editor = editor;
    this.#sound = sound;
    byId("keep-version").onclick = () => {
      this.#kept = this.#editor.text;
      this.#tally = { a: 0, b: 0, same: 0 };
      this.#show();
    };
    byId("start-comparison").onclick = () => this.#start();
    for (const [at, button] of this.#feelButtons.entries()) button.onclick = () => this.#feel(at);
    for (const [at, button] of this.#answerButtons.entries()) button.onclick = () => this.#answer(at);
    byId("cancel-comparison").onclick = () => {
      const { b: current } = this.#trial?.texts ?? {};
      this.cancel("The comparison is cancelled; it does not count.");
      if (current !== undefined) this.#player.now(current);
    };
    byId("comparison-sound").onclick = () =>
      attempt(async () => {
        await this.#sound.start();
        byId("comparison-sound").hidden = true;
      });
    this.#show();
  }

  get isRunning() {
    return this.#trial !== undefined;
  }

  /** Ends a comparison without an answer: the scene changes. */
  cancel(why = "The scene has changed: the comparison is over.") {
    if (!this.isRunning) return;
    this.#trial = undefined;
    this.#hide(false);
    this.#show(why);
  }

  /**
   * Hides what says which version is felt.
   * @param {boolean} isBlind
   */
  #hide(isBlind) {
    document.body.classList.toggle("blind", isBlind);
    this.onChange();
  }

  #show(outcome = "") {
    byId("compare-versions").hidden = this.isRunning;
    byId("comparison").hidden = !this.isRunning;
    byId("keep-version").textContent = this.#kept ? "Keep the scene as it is now as A" : "Keep this scene as A";
    byId("start-comparison").disabled = !this.#kept;
    byId("compare-words").textContent = this.#kept
      ? "A is kept. Change the scene, which is B, and compare: they come as X and Y in random order, map and text " +
        "hidden."
      : "Keep a version, change the scene, and find out, without looking, which is better.";
    byId("compare-outcome").textContent = outcome;
    const { a, b, same } = this.#tally;
    byId("compare-tally").textContent = a + b + same > 0 ? `A ${a} · B ${b} · no difference ${same}` : "";
  }

  #start() {
    const current = this.#editor.text;
    const kept = this.#kept;
    if (kept === undefined) return;
    if (current === kept) {
      this.#show("A and the scene now are the same text: change the scene first.");
      return;
    }
    /** @type {Version[]} */
    const order = Math.random() < 0.5 ? ["a", "b"] : ["b", "a"];
    this.#trial = { order, texts: { a: kept, b: current }, felt: new Set() };
    for (const button of this.#answerButtons) Object.assign(button, { disabled: true, title: "Feel X and Y first." });
    byId("comparison-sound").hidden = this.#sound.isOn;
    this.#show();
    this.#hide(true);
    this.#feel(0);
  }

  /** @param {number} at */
  #feel(at) {
    if (!this.#trial) return;
    const { order, texts, felt } = this.#trial;
    for (const [index, button] of this.#feelButtons.entries()) button.setAttribute("aria-pressed", String(index === at));
    felt.add(at);
    if (felt.size === 2) for (const button of this.#answerButtons) Object.assign(button, { disabled: false, title: "" });
    this.#player.now(texts[order[at]]);
  }

  /** @param {number} at 0 for X, 1 for Y, 2 for no difference. */
  #answer(at) {
    if (!this.#trial) return;
    const { order, texts } = this.#trial;
    this.#trial = undefined;
    this.#hide(false);
    const answer = order[at] ?? "same";
    this.#tally[answer] += 1;
    const chosen = {
      a: "You chose A, the version that you kept.",
      b: "You chose B, the scene as it is now.",
      same: "You felt no difference.",
    };
    this.#show(`${chosen[answer]} X was ${order[0].toUpperCase()}, Y was ${order[1].toUpperCase()}.`);
    this.#player.now(texts.b);
  }
}

/**
 * The buttons of a class, in the order of the page.
 * @param {string} name
 * @returns {HTMLButtonElement[]}
 */
function buttons(name) {
  return [.../** @type {HTMLCollectionOf<HTMLButtonElement>} */ (document.getElementsByClassName(name))];
}
