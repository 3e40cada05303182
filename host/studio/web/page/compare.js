// Two versions of a scene, compared blind: neither text nor map says which one is felt.

import { byId, element } from "./dom.js";

export class Compare {
  #panel = byId("panel-compare");
  #player;
  #editor;
  /** The text that was put aside. */
  #kept;
  /** During a comparison: which text X and Y are, and what is played. */
  #trial;
  #tally = { a: 0, b: 0, same: 0 };
  /** A comparison begins or ends. */
  onChange = () => {};

  constructor(player, editor) {
    this.#player = player;
    this.#editor = editor;
    this.#show();
  }

  get isRunning() {
    return this.#trial !== undefined;
  }

  /** Ends a comparison without an answer: the scene changes. */
  cancel() {
    if (!this.isRunning) return;
    this.#trial = undefined;
    this.#hide(false);
    this.#show("The scene has changed: the comparison is over.");
  }

  /** Hides what says which version is felt. */
  #hide(isBlind) {
    document.body.classList.toggle("blind", isBlind);
    this.onChange();
  }

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
    if (current === this.#kept) {
      this.#show("A and the scene now are the same text: change the scene first.");
      return;
    }
    const order = Math.random() < 0.5 ? ["a", "b"] : ["b", "a"];
    this.#trial = { order, texts: { a: this.#kept, b: current } };
    this.#hide(true);
    this.#trialPanel();
    this.#feel(0);
  }

  #trialPanel() {
    const feel = ["X", "Y"].map((name, at) =>
      element("button", { "aria-pressed": "false", onclick: () => this.#feel(at) }, `Feel ${name}`),
    );
    const answer = ["X", "Y"].map((name, at) =>
      element("button", { onclick: () => this.#answer(at) }, `${name} is better`),
    );
    const same = element("button", { onclick: () => this.#answer() }, "No difference");
    this.#panel.replaceChildren(
      element("p", {}, "Slide, change between X and Y as often as you like, then choose."),
      element("div", { className: "row" }, ...feel),
      element("div", { className: "row" }, ...answer, same),
    );
    this.#trial.buttons = feel;
  }

  #feel(at) {
    const { order, texts, buttons } = this.#trial;
    for (const [index, button] of buttons.entries()) button.setAttribute("aria-pressed", index === at);
    this.#player.now(texts[order[at]]);
  }

  #answer(at) {
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
