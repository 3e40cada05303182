// From text to play: checks each version of the scene, draws its map and plays it, the newest one last.

import { mapSizePx } from "./map.js";

/** A pause in typing that lets a check begin, ms. */
const PAUSE_MS = 60;
/** Longer side of the map's picture, pixels. */
const MAP_LONG_SIDE_PX = 960;

export class Player {
  #engine;
  #project;
  #timer;
  #isBusy = false;
  #next;
  /** How many actions that bring another text are under way. */
  #expected = 0;
  /** What came of the newest text that was checked: "loading" until then. */
  #outcome = "loading";
  #status = "loading";

  /** The check has an answer: `onCheck(check)`. */
  onCheck = () => {};
  /** The friction map of a scene that plays: `onMap(map, check)`. */
  onMap = () => {};
  /** The board has this text: `onPlay(text)`. */
  onPlay = () => {};
  /** The board refused, or something failed: `onFailure(sentence)`. */
  onFailure = () => {};
  /**
   * `onStatus(status)` says where the newest text is: "loading"; "loaded", on the board; "mistaken", with mistakes;
   * "failed", refused by the board or lost on its way.
   */
  onStatus = () => {};

  constructor(engine, project) {
    this.#engine = engine;
    this.#project = project;
  }

  /** Runs an action that brings another text: from its begin on the status is "loading". */
  async expect(action) {
    this.#expected += 1;
    this.#report();
    try {
      return await action();
    } finally {
      this.#expected -= 1;
      this.#report();
    }
  }

  /** Plays this text once nothing has changed for a moment. */
  later(text) {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.now(text), PAUSE_MS);
    this.#report();
  }

  /** Plays this text; of texts that come meanwhile, the newest is played after it. */
  async now(text) {
    clearTimeout(this.#timer);
    this.#timer = undefined;
    this.#next = text;
    this.#report();
    if (this.#isBusy) return;
    this.#isBusy = true;
    while (this.#next !== undefined) {
      const newest = this.#next;
      this.#outcome = "loading";
      this.#next = undefined;
      try {
        await this.#play(newest);
      } catch (error) {
        this.#settle("failed");
        this.onFailure(error.message);
      }
    }
    this.#isBusy = false;
  }

  /** Whether a newer text is there, or about to come. */
  get #isOutdated() {
    return this.#next !== undefined || this.#timer !== undefined || this.#expected > 0;
  }

  #settle(outcome) {
    this.#outcome = outcome;
    this.#report();
  }

  #report() {
    const status = this.#isOutdated ? "loading" : this.#outcome;
    if (status === this.#status) return;
    this.#status = status;
    this.onStatus(status);
  }

  async #play(text) {
    const files = await this.#project.filesFor(text);
    const { entry, profiles } = this.#project;
    const scene = [files, entry, { ...profiles }];
    const check = await this.#engine.check(...scene);
    this.onCheck(check);
    if (!check.ok && !check.isDraft) this.#settle("mistaken");
    // A board that was disarmed for another scene gets none but that.
    else if (!this.#isOutdated && (await this.#load(scene, check))) {
      this.onPlay(text);
      this.#settle("loaded");
      if (this.#next !== undefined) return;
      const sizePx = mapSizePx(check.screen, MAP_LONG_SIDE_PX);
      const size = { ...sizePx, speedMmPerS: 100 };
      const map = await this.#engine.map(...scene, size).catch(({ message }) => this.onFailure(message));
      if (map) this.onMap(map, check);
    }
  }

  /** Puts the scene on the board. Resolves to false if it was broken off and a newer one comes in its place. */
  async #load(scene, { isDraft }) {
    for (;;) {
      try {
        await this.#engine.play(...scene);
        return true;
      } catch ({ message, canLoadAgain }) {
        if (!canLoadAgain) throw new Error(isDraft ? `The board does not play this draft:\n${message}` : message);
        // A stop has disarmed the board: the scene is loaded again, and waits there for a press.
        if (this.#isOutdated) return false;
      }
    }
  }
}
