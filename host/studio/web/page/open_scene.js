// The scene that is open: its name, its files, and how another one takes its place.
// @ts-check

import { clock } from "../clock.js";
import { Autosave } from "./autosave.js";
import { byId } from "./dom.js";
import { attempt, forgetNotice, notify } from "./notices.js";
import { showPictures } from "./pictures.js";
import { assertTextsFit, isPicture, isToml } from "./project.js";
import { pictureIn } from "./toml_text.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { Compare } from "./compare.js" */
/** @import { Editor } from "./editor.js" */
/** @import { Found } from "./incoming.js" */
/** @import { OwnPicture } from "./own_picture.js" */
/** @import { Player } from "./player.js" */
/** @import { Profiles } from "./profiles.js" */
/** @import { Project, SavedScene, SceneToOpen } from "./project.js" */
/** @import { Works } from "./works.js" */

/** How long the way back to the scene before is offered once the new one is worked on, ms. */
const BACK_MS = 30_000;

/**
 * @typedef {object} Parts
 * @property {Engine} engine
 * @property {Project} project
 * @property {Player} player
 * @property {Editor} editor
 * @property {Compare} compare
 * @property {Profiles} profiles
 * @property {Works} works
 */

export class OpenScene {
  #parts;
  /** Keeps the scene in the browser. */
  autosave;
  /** Takes the offer away that leads back to the scene before. @type {() => void} */
  #forgetBack = () => {};
  /** Whether the scene was changed since it was opened over another. */
  #isWorkedOn = true;
  /** A layer is about to come behind the others of the scene. */
  onAppend = () => {};

  /** @param {Parts} parts */
  constructor(parts) {
    const { project, player, editor, compare, profiles, works } = parts;
    this.#parts = parts;
    this.autosave = new Autosave(works, () => this.saved);
    editor.onChange = (file, text) => {
      compare.cancel();
      this.#workOn();
      if (file !== undefined) project.files.set(file, text);
      this.autosave.changed();
      player.later(editor.text);
    };
    profiles.onChange = () => {
      this.autosave.changed();
      this.replay();
    };
    byId("scene-name").onchange = () => this.#rename(byId("scene-name").value);
  }

  /**
   * All of it, as archive.js packs it.
   * @returns {SavedScene & { entry: string }}
   */
  get saved() {
    const { name, entry, profiles, files } = this.#parts.project;
    return { name, entry, profiles: { ...profiles }, text: this.#parts.editor.text, files: [...files] };
  }

  /** Plays the scene anew, as it is now. */
  replay() {
    this.#parts.compare.cancel();
    this.#parts.player.now(this.#parts.editor.text);
  }

  /**
   * Opens a scene from elsewhere. A changed scene can be brought back.
   * @param {SceneToOpen} scene
   */
  open(scene) {
    return this.#bringIn(() => this.#replace(scene));
  }

  /**
   * Takes a layer over from elsewhere.
   * @param {string} text
   */
  append(text) {
    return this.#bringIn(async () => {
      this.onAppend();
      this.#parts.editor.append(text);
    });
  }

  /**
   * Likewise a layer that this action puts into the text, or not.
   * @param {() => void} action
   */
  add(action) {
    return this.#bringIn(async () => {
      action();
      this.replay();
    });
  }

  /**
   * Takes a picture for a layer; resolves to the name that it has in the scene.
   * @param {OwnPicture} picture
   */
  takePicture({ name, bytes }) {
    return this.#bringIn(async () => {
      const free = this.#parts.project.freeName(name, bytes);
      this.#parts.project.add(free, bytes);
      this.#filesChanged();
      return free;
    });
  }

  /**
   * Takes what a person has dropped or chosen.
   * @param {Found} found
   */
  take({ scene, files, profiles }) {
    return this.#bringIn(async () => {
      for (const [kind, profile] of profiles) this.#parts.profiles.add(kind, profile);
      if (scene) await this.#replace(scene);
      else {
        for (const [name, content] of files) this.#parts.project.add(name, content);
        this.#filesChanged();
      }
      if (!files.some(([name]) => isPicture(name))) return;
      this.#parts.editor.onReveal();
      byId("tab-pictures").click();
    });
  }

  /**
   * Runs an action that brings something from elsewhere into the scene. A real board is disarmed before, and nothing
   * can be armed until it has the scene that is shown then.
   * @template Value
   * @param {() => Promise<Value>} action
   */
  #bringIn(action) {
    return this.#parts.player.expect(async () => {
      try {
        await this.#parts.engine.forget();
        return await action();
      } catch (error) {
        // The board gets the scene back that is still shown.
        this.replay();
        throw error;
      }
    });
  }

  /** @param {SceneToOpen} scene */
  async #replace({ name, text, files = [], profiles, ...work }) {
    assertTextsFit({ name, text, files });
    const [autosave, project] = [this.autosave, this.#parts.project];
    const before = { ...this.saved, ...autosave.state };
    this.#forgetBack();
    forgetNotice();
    await autosave.leave();
    const { isKept } = autosave;
    await project.replaceFiles(files);
    project.name = name;
    this.#showName();
    if (profiles) this.#parts.profiles.choose(profiles);
    this.#parts.editor.open(text);
    this.#isWorkedOn = true;
    this.#showFiles();
    await autosave.opened(work);
    if (before.isEdited) this.#offerBack(before, isKept);
  }

  /**
   * Offers the scene before, until it is dismissed or a person has worked on the new one for a while.
   * @param {SceneToOpen} before
   * @param {boolean} isKept Whether Open has it, too.
   */
  #offerBack(before, isKept) {
    this.#forgetBack = notify(
      isKept ? `${before.name} is kept in Open.` : `${this.#parts.project.name} is open.`,
      { words: `Back to ${before.name}`, action: () => this.open(before) },
      { isGood: true, isLasting: true, beside: byId("scene-name") },
    );
    this.#isWorkedOn = false;
  }

  /** A person works on the scene: after a while the one before is not missed. */
  #workOn() {
    if (this.#isWorkedOn) return;
    this.#isWorkedOn = true;
    const forget = this.#forgetBack;
    clock.later(BACK_MS, () => forget());
  }

  #showName() {
    const { name } = this.#parts.project;
    Object.assign(byId("scene-name"), { value: name, size: Math.max(4, Math.min(name.length, 24)) });
    document.title = `${name} · frixel studio`;
  }

  /** @param {string} name */
  #rename(name) {
    const project = this.#parts.project;
    const before = project.name;
    project.name = name.trim();
    if (project.files.has(project.entry)) {
      const said = `${project.entry} is a file of this scene already: choose another name.`;
      notify(said, undefined, { beside: byId("scene-name") });
      project.name = before;
    }
    this.#showName();
    if (project.name !== before) this.#filesChanged();
  }

  #filesChanged() {
    this.autosave.changed();
    this.#showFiles();
    this.replay();
  }

  #showFiles() {
    const { engine, project } = this.#parts;
    const { files } = project;
    const remove = (/** @type {string} */ name) => {
      files.delete(name);
      this.#filesChanged();
    };
    const add = (/** @type {string} */ name, /** @type {Uint8Array<ArrayBuffer>} */ bytes) =>
      attempt(async () => {
        const { aspect } = await engine.picture(bytes);
        await this.append(pictureIn("", name, aspect, project.screen));
      });
    showPictures(project, add, remove);
    /** @type {[string, string][]} */
    const texts = [];
    for (const [name, content] of files) if (isToml(name) && typeof content === "string") texts.push([name, content]);
    this.#parts.editor.setFiles(texts);
  }
}
