// Two versions of a scene, compared blind: neither text nor map says which one is felt.
// @ts-check

import { byId, element } from "./dom.js";
import { attempt } from "./notices.js";

/** @import { Editor } from "./editor.js" */
/** @import { Player } from "./player.js" */
/** @import { Sound } from "./sound.js" */

/** @typedef {"a" | "b"} Version */
/**
 * Which version X and Y are, the texts of both, which were felt, and the buttons that choose and answer.
 * @typedef {object} Trial
 * @property {Version[]} order
 * @property {Record<Version, string>} texts
 * @property {Set<number>} felt
 * @property {HTMLButtonElement[]} feel
 * @property {HTMLButtonElement[]} answers
 */

export class Compare {
  #panel = byId("panel-compare");
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

  /** @param {string} [lastAnswer] */
  #show(lastAnswer) {
    const keep = element("button", {}, this.#kept ? "Keep the scene as it is now as A" : "Keep this scene as A");
    keep.onclick = () => {
      this.#kept = this.#editor.text;
      this.#tally = { a: 0, b: 0, same: 0 };
      this.#show();
    };
    const start = element("button", { className: "primary", disabled: !this.#kept }, "Compare A with the scene now");
    start.onclick = () => this.#start();
    const said = this.#kept
      ? "A is kept. Change the scene, which is B, and compare: they come as X and Y in random order, map and text " +
        "hidden."
      : "Keep a version, change the scene, and find out, without looking, which is better.";
    const { a, b, same } = this.#tally;
    this.#panel.replaceChildren(element("p", {}, said), element("div", { className: "row" }, keep, start));
    if (lastAnswer) this.#panel.append(element("p", {}, lastAnswer));
    if (a + b + same > 0)
      this.#panel.append(element("p", { className: "soft" }, `A ${a} · B ${b} · no difference ${same}`));
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
    this.#trial = { order, texts: { a: kept, b: current }, felt: new Set(), ...this.#trialPanel(current) };
    this.#hide(true);
    this.#feel(0);
  }

  /**
   * Shows the buttons of a comparison, and returns those that choose and answer.
   * @param {string} current The text to go back to.
   */
  #trialPanel(current) {
    const feel = ["X", "Y"].map((name, at) =>
      element("button", { "aria-pressed": "false", onclick: () => this.#feel(at) }, `Feel ${name}`),
    );
    const why = { disabled: true, title: "Feel X and Y first." };
    const answer = ["X", "Y"].map((name, at) =>
      element("button", { ...why, onclick: () => this.#answer(at) }, `${name} is better`),
    );
    const same = element("button", { ...why, onclick: () => this.#answer() }, "No difference");
    const cancel = element("button", {}, "Cancel");
    cancel.onclick = () => {
      this.cancel("The comparison is cancelled; it does not count.");
      this.#player.now(current);
    };
    this.#panel.replaceChildren(
      element("p", {}, "Slide, change between X and Y as often as you like, then choose."),
      element("div", { className: "row" }, ...feel, this.#soundButton()),
      element("div", { className: "row" }, ...answer, same, cancel),
      element("p", { className: "fine" }, "Without a board you hear the difference, and see how the finger lags."),
    );
    return { feel, answers: [...answer, same] };
  }

  #soundButton() {
    const button = element("button", {}, "Turn sound on");
    button.hidden = this.#sound.isOn;
    button.onclick = () =>
      attempt(async () => {
        await this.#sound.start();
        button.hidden = true;
      });
    return button;
  }

  /** @param {number} at */
  #feel(at) {
    if (!this.#trial) return;
    const { order, texts, felt, feel, answers } = this.#trial;
    for (const [index, button] of feel.entries()) button.setAttribute("aria-pressed", String(index === at));
    felt.add(at);
    if (felt.size === 2) for (const button of answers) Object.assign(button, { disabled: false, title: "" });
    this.#player.now(texts[order[at]]);
  }

  /** @param {number} [at] 0 for X, 1 for Y; undefined for no difference. */
  #answer(at) {
    if (!this.#trial) return;
    const { order, texts } = this.#trial;
    this.#trial = undefined;
    this.#hide(false);
    this.#tally[at === undefined ? "same" : order[at]] += 1;
    const which = { a: "A, the version that you kept", b: "B, the scene as it is now" };
    const chosen = at === undefined ? "You felt no difference." : `You chose ${which[order[at]]}.`;
    this.#show(`${chosen} X was ${order[0].toUpperCase()}, Y was ${order[1].toUpperCase()}.`);
    this.#player.now(texts.b);
  }
}
