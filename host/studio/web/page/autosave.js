// Keeps the scene that a person works on in the browser (works.js), a moment after each change.
// @ts-check

import { clock } from "../clock.js";
import { projectOf, zipOf } from "./archive.js";
import { byId } from "./dom.js";
import { notify } from "./notices.js";

/** @import { OpenWork, SavedScene, SceneToOpen } from "./project.js" */
/** @import { Work, Works } from "./works.js" */

/** Name under which a page remembers its piece of work over a reload. */
const OWN = "frixel.work";
/** A pause in typing after which the scene is kept, ms. */
const PAUSE_MS = 400;

export class Autosave {
  #current;
  #works;
  #id = newId();
  #changedMs = dateMs();
  /**
   * A picture of the scene's map, or null.
   * @type {Blob | null}
   */
  #picture = null;
  /** @type {number | undefined} */
  #timer;
  /**
   * Why the scene is not kept, if it is not.
   * @type {string | undefined}
   */
  #problem;
  /** Whether the scene was changed since it was opened. */
  isEdited = false;

  /**
   * `current()` gives the project as archive.js packs it.
   * @param {Works} works
   * @param {() => SavedScene & { entry: string }} current
   */
  constructor(works, current) {
    this.#works = works;
    this.#current = current;
    addEventListener("pagehide", () => this.#keepNow());
    addEventListener("beforeunload", (event) => {
      this.#keepNow();
      if (this.isEdited && this.#problem) event.preventDefault();
    });
  }

  /**
   * What this page had before its reload, or else what was changed last and no other page has; or undefined.
   * @returns {Promise<SceneToOpen | undefined>}
   */
  async last() {
    try {
      const own = sessionStorage.getItem(OWN);
      if (own && (await this.#works.claim(own, { waits: true }))) return sceneOfWork(await this.#works.get(own));
      for (const { id } of await this.#works.all()) if (await this.#works.claim(id)) return await this.work(id);
    } catch {
      // Without a store, or with a broken entry, the page begins with its first scene.
    }
    return undefined;
  }

  /**
   * A piece of work that is kept, as a scene to open.
   * @param {string} id
   */
  async work(id) {
    return sceneOfWork(await this.#works.get(id));
  }

  /** The piece of work that is open: `id` and `isEdited` bring it back where a scene is opened with them. */
  get state() {
    return { id: this.#id, isEdited: this.isEdited, changedMs: this.#changedMs };
  }

  /** Whether the browser keeps the scene, as far as is known. */
  get isKept() {
    return this.#problem === undefined;
  }

  /** The scene was changed by hand. */
  changed() {
    this.isEdited = true;
    this.#changedMs = dateMs();
    this.#later();
  }

  /**
   * The scene's map has this picture.
   * @param {Blob} picture
   */
  show(picture) {
    this.#picture = picture;
    this.#later();
  }

  /** Another scene takes this one's place: call it before. What was only opened is forgotten, what was changed stays. */
  async leave() {
    if (this.isEdited) await this.#keepNow();
    else await this.#forget();
  }

  /**
   * Another scene is open; with `id`, a piece of work that is kept, unless another page has it.
   * @param {Partial<OpenWork>} work
   */
  async opened({ id, isEdited = false, changedMs = dateMs() }) {
    this.#begin({ isEdited, changedMs });
    if (id !== undefined && (await this.#claim(id))) this.#id = id;
    else await this.#claim(this.#id);
    try {
      sessionStorage.setItem(OWN, this.#id);
    } catch {
      // Without a session's store, a reload finds the newest piece of work.
    }
    this.#later();
  }

  /**
   * From here on nothing is written to the entry of the scene before, and until a claim is answered nothing to one that
   * another page may have.
   * @param {Omit<OpenWork, "id">} work
   */
  #begin({ isEdited, changedMs }) {
    this.#stopTimer();
    this.#id = newId();
    this.isEdited = isEdited;
    this.#changedMs = changedMs;
    this.#picture = null;
    this.#problem = undefined;
  }

  #stopTimer() {
    clock.cancel(this.#timer);
    this.#timer = undefined;
  }

  /** @param {string} id */
  #claim(id) {
    return this.#works.claim(id).catch(() => false);
  }

  async #forget() {
    this.#stopTimer();
    await this.#works.delete(this.#id).catch(() => {});
  }

  #later() {
    clock.cancel(this.#timer);
    this.#timer = clock.later(PAUSE_MS, () => this.#keep());
  }

  /** Keeps what waits to be kept, or could not be. */
  async #keepNow() {
    if (this.#timer !== undefined || this.#problem !== undefined) await this.#keep();
  }

  async #keep() {
    this.#stopTimer();
    const project = this.#current();
    try {
      await this.#works.put({ ...this.state, name: project.name, zip: zipOf(project), picture: this.#picture });
      this.#problem = undefined;
    } catch (error) {
      this.#isNotKept(error);
    }
  }

  /**
   * Says once for each scene that it is not kept, and why.
   * @param {unknown} error
   */
  #isNotKept(error) {
    const isFull = error instanceof Error && error.name === "QuotaExceededError";
    const why = isFull ? "its store is full" : "it keeps nothing for this page";
    if (this.isEdited && this.#problem !== why) {
      const cure = "Save it before you close the page; in Open you can delete pieces of work that you no longer need.";
      const said = `The browser does not keep ${this.#current().name}: ${why}. ${cure}`;
      notify(said, undefined, { beside: byId("save") });
      this.#problem = why;
    }
  }
}

/**
 * @param {Work | undefined} work
 * @returns {SceneToOpen}
 */
function sceneOfWork(work) {
  if (!work) throw new Error("The browser no longer keeps this scene.");
  const { id, isEdited, changedMs, zip } = work;
  return { ...projectOf(zip, { isOwn: true }), id, isEdited, changedMs };
}

/** Time since 1970, ms. */
function dateMs() {
  return Math.round(clock.startMs() + clock.nowMs());
}

function newId() {
  return [...crypto.getRandomValues(new Uint32Array(4))].map((part) => part.toString(16)).join("-");
}
