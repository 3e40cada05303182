// From text to play: checks each version of the scene, draws its map and plays it, the newest one last.
// @ts-check

import { clock } from "../clock.js";
import { sentenceOf } from "./dom.js";
import { mapSizePx } from "./map.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { Check, Checked, EngineFailure, Files, FrictionField } from "../engine/types" */
/** @import { Project } from "./project.js" */
/** @typedef {"loading" | "loaded" | "mistaken" | "failed"} Status */

/** What is said of a scene that plays as a draft. */
export const DRAFT = "draft, clamped: a board refuses it";
/** A pause in typing that lets a check begin, ms. */
const PAUSE_MS = 60;
/** Longer side of the map's picture, pixels. */
const MAP_LONG_SIDE_PX = 960;
/** The same while a hand changes the scene, and the next map is about to come. */
const HELD_LONG_SIDE_PX = 480;

export class Player {
  #engine;
  #project;
  /** @type {number | undefined} */
  #timer;
  #isBusy = false;
  /** @type {string | undefined} */
  #next;
  /** Whether a hand is changing the scene. */
  isHeld = false;
  /** How many actions that bring another text are under way. */
  #expected = 0;
  /**
   * Outcome of the newest text that was checked: "loading" until then.
   * @type {Status}
   */
  #outcome = "loading";
  /** @type {Status} */
  #status = "loading";
  /** Whether the simulator in the page plays without prediction, whatever the scene says. */
  withoutPrediction = false;

  /**
   * The check has an answer: `onCheck(check, files)`.
   * @type {(check: Check, files: Files) => void}
   */
  onCheck = () => {};
  /**
   * The friction map of a scene that plays: `onMap(map, check)`.
   * @type {(map: FrictionField, check: Checked) => void}
   */
  onMap = () => {};
  /**
   * The board has this text: `onPlay(text)`.
   * @type {(text: string) => void}
   */
  onPlay = () => {};
  /**
   * The board refused, or something failed: `onFailure(sentence)`.
   * @type {(sentence: string) => void}
   */
  onFailure = () => {};
  /**
   * `onStatus(status)` says where the newest text is: "loading"; "loaded", on the board; "mistaken", with mistakes;
   * "failed", refused by the board or lost on its way.
   * @type {(status: Status) => void}
   */
  onStatus = () => {};

  /**
   * @param {Engine} engine
   * @param {Project} project
   */
  constructor(engine, project) {
    this.#engine = engine;
    this.#project = project;
  }

  /**
   * Runs an action that brings another text: from its begin on the status is "loading".
   * @template Value
   * @param {() => Promise<Value>} action
   */
  async expect(action) {
    this.#expected += 1;
    this.#report();
    try {
      return await action();
    } finally {
      this.#expected -= 1;
      this.#report();
      // A newer text comes in a moment.
      if (this.#timer === undefined) this.#playOn();
    }
  }

  /**
   * Plays this text once nothing has changed for a moment.
   * @param {string} text
   */
  later(text) {
    if (this.isHeld) {
      this.now(text);
      return;
    }
    clock.cancel(this.#timer);
    this.#timer = clock.later(PAUSE_MS, () => this.now(text));
    this.#report();
  }

  /** A hand begins to change the scene: until it lets go, the texts are checked and drawn, and none is played. */
  hold() {
    this.isHeld = true;
    this.#report();
  }

  /**
   * The hand lets go: this text is played.
   * @param {string} text
   */
  release(text) {
    this.isHeld = false;
    return this.now(text);
  }

  /**
   * Plays this text once no action is about to bring another; of texts that come meanwhile, the newest is played.
   * @param {string} text
   */
  async now(text) {
    clock.cancel(this.#timer);
    this.#timer = undefined;
    this.#next = text;
    // The newer text needs the worker.
    if (this.#isBusy) this.#engine.endCheck();
    this.#report();
    await this.#playOn();
  }

  /** Plays the newest text, and those that come meanwhile, until an action is about to bring another. */
  async #playOn() {
    if (this.#isBusy) return;
    this.#isBusy = true;
    while (this.#next !== undefined && this.#expected === 0) {
      const newest = this.#next;
      this.#outcome = "loading";
      this.#next = undefined;
      try {
        await this.#play(newest);
      } catch (error) {
        this.#settle("failed");
        this.onFailure(sentenceOf(error));
      }
      // An action that began meanwhile may bring no other text than this one.
      if (this.#outcome === "loading" && this.#expected > 0) this.#next ??= newest;
    }
    this.#isBusy = false;
  }

  /** Status of the newest text, as last passed to `onStatus`. */
  get status() {
    return this.#status;
  }

  /** Whether a newer text is there, or about to come. */
  get #isOutdated() {
    return this.isHeld || this.#next !== undefined || this.#timer !== undefined || this.#expected > 0;
  }

  /** @param {Status} outcome */
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

  /** @param {string} text */
  async #play(text) {
    const files = await this.#project.filesFor(text);
    const { entry, profiles, opened } = this.#project;
    /** @type {Parameters<Engine["play"]>} */
    const scene = [files, entry, { ...profiles }];
    const compiled = await this.#engine.compile(...scene);
    if (!isPlayable(compiled)) {
      this.onCheck(compiled, files);
      this.#settle("mistaken");
      return;
    }
    const { isHeld } = this;
    if (isHeld) await this.#draw(scene, compiled, HELD_LONG_SIDE_PX, opened);
    // A board that was disarmed for another scene gets none but that.
    else if (this.#isOutdated || !(await this.#load(scene, compiled))) return;
    else this.onPlay(text);
    if (this.#next !== undefined) return;
    // The board plays while a worker judges what is felt. A judge beside an upload would take the processor from it.
    const check = await this.#engine.check(...scene);
    if (!check || !isPlayable(check)) return;
    this.onCheck(check, files);
    if (isHeld) return;
    this.#settle("loaded");
    if (this.#next === undefined) await this.#draw(scene, check, MAP_LONG_SIDE_PX, opened);
  }

  /**
   * Draws the map of a scene, unless another one is open then.
   * @param {Parameters<Engine["play"]>} scene
   * @param {Checked} check
   * @param {number} longSidePx
   * @param {number} opened
   */
  async #draw(scene, check, longSidePx, opened) {
    const size = { ...mapSizePx(check.screen, longSidePx), speedMmPerS: 100 };
    const map = await this.#engine.map(...scene, size).catch((error) => this.onFailure(sentenceOf(error)));
    if (map && this.#project.opened === opened) this.onMap(map, check);
  }

  /**
   * Puts the scene on the board. Resolves to false if it was broken off and a newer one comes in its place.
   * @param {Parameters<Engine["play"]>} scene
   * @param {Checked} check
   */
  async #load([files, entry, profiles], { isDraft }) {
    const options = this.withoutPrediction ? { withoutPrediction: true } : {};
    for (;;) {
      try {
        await this.#engine.play(files, entry, { ...profiles, ...options });
        return true;
      } catch (error) {
        const { message, canLoadAgain } = /** @type {EngineFailure} */ (error);
        if (!canLoadAgain) throw new Error(isDraft ? `The board does not play this draft:\n${message}` : message);
        // A stop has disarmed the board: the scene is loaded again, and waits there for a press.
        if (this.#isOutdated) return false;
      }
    }
  }
}

/**
 * Whether a scene plays: it has no mistake, or is a draft.
 * @param {Check} check
 * @returns {check is Exclude<Check, { ok: false, report?: undefined }>}
 */
export function isPlayable(check) {
  return check.ok || check.isDraft === true;
}
