// From text to play: checks each version of the scene, draws its map and plays it, the newest one last.

/** A pause in typing that lets a check begin, ms. */
const PAUSE_MS = 60;
/** The map's width in pixels. */
const MAP_WIDTH = 960;

export class Player {
  #engine;
  #project;
  #timer;
  #isBusy = false;
  #next;
  #isPending = false;

  /** The check has an answer: `onCheck(check, text)`. */
  onCheck = () => {};
  /** The friction map of a scene that plays: `onMap(map, check)`. */
  onMap = () => {};
  /** The board plays this text: `onPlay(text)`. */
  onPlay = () => {};
  /** The board refused, or something failed: `onFailure(sentence)`. */
  onFailure = () => {};
  /** Whether a text has come that neither plays yet nor was refused: `onPending(isPending)`. */
  onPending = () => {};

  constructor(engine, project) {
    this.#engine = engine;
    this.#project = project;
  }

  /** Plays this text once nothing has changed for a moment. */
  later(text) {
    this.#setPending(true);
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.now(text), PAUSE_MS);
  }

  /** Plays this text; of texts that come meanwhile, the newest is played after it. */
  async now(text) {
    this.#setPending(true);
    clearTimeout(this.#timer);
    this.#timer = undefined;
    this.#next = text;
    if (this.#isBusy) return;
    this.#isBusy = true;
    while (this.#next !== undefined) {
      const newest = this.#next;
      this.#next = undefined;
      try {
        await this.#play(newest);
      } catch (error) {
        this.onFailure(error.message);
      }
      this.#settle();
    }
    this.#isBusy = false;
  }

  /** The text of before plays, or was refused. */
  #settle() {
    if (this.#next === undefined && this.#timer === undefined) this.#setPending(false);
  }

  #setPending(isPending) {
    if (isPending === this.#isPending) return;
    this.#isPending = isPending;
    this.onPending(isPending);
  }

  async #play(text) {
    const files = await this.#project.filesFor(text);
    const { entry, profiles } = this.#project;
    const check = await this.#engine.check(files, entry, profiles);
    this.onCheck(check, text);
    if (!(check.ok || check.isDraft) || this.#next !== undefined) return;
    await this.#engine.play(files, entry, profiles).catch(({ message }) => {
      throw new Error(check.isDraft ? `The board does not play this draft:\n${message}` : message);
    });
    this.onPlay(text);
    this.#settle();
    if (this.#next !== undefined) return;
    const { widthMm, heightMm } = check.screen;
    const size = { widthPx: MAP_WIDTH, heightPx: Math.max(8, Math.round((MAP_WIDTH * heightMm) / widthMm)) };
    this.onMap(await this.#engine.map(files, entry, profiles, { ...size, speedMmPerS: 100 }), check);
  }
}
