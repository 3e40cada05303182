// The board that plays: the simulator in the page, or one on a serial port.
// @ts-check

import { clock } from "../clock.js";
import { byId } from "./dom.js";
import { attempt, notify } from "./notices.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { BoardState, State } from "../engine/types" */
/** @import { Status } from "./player.js" */

/** For so long after Arm has appeared it cannot be pressed, ms: a press was meant for what stood in its place. */
const ARM_REST_MS = 1000;
/**
 * Why a scene that is shown cannot be armed, by its status as player.js reports it.
 * @type {Record<Status, string>}
 */
const WHY_NOT_ARMED = {
  loaded: "",
  loading: "The scene is on its way to the board.",
  mistaken: "The scene has mistakes: mend them, then arm.",
  failed: "The board does not have the scene that is shown.",
};
/** @type {Record<BoardState, string>} */
const STATE_WORDS = { active: "playing", armed: "armed", disarmed: "disarmed", faulted: "faulted" };

export class Board {
  #engine;
  /** @type {State["link"]} */
  #link = "simulator";
  /**
   * Where the scene that is shown is, as player.js reports it.
   * @type {Status}
   */
  #status = "loading";
  /** Arm has only just appeared. */
  #isArmResting = false;
  /** @type {number | undefined} */
  #armRestTimer;
  /** Another board is connected: the scene is played there. */
  onBoard = () => {};
  /** The board plays, or no longer. */
  onState = () => {};

  /** @param {Engine} engine */
  constructor(engine) {
    this.#engine = engine;
    engine.onState = (state) => this.#show(state);
    this.#show(engine.state);
    byId("board").textContent = "Simulator: starting…";
    byId("open-board").onclick = () => this.#open();
    byId("use-simulator").onclick = () => attempt(() => this.#simulate());
    byId("use-serial").onclick = () => attempt(() => this.#connect());
    byId("arm").onclick = () => attempt(() => engine.arm());
    byId("clear-fault").onclick = () => attempt(() => engine.clearFault());
    byId("stop").onclick = () => attempt(() => (byId("stop").dataset.stopped ? engine.resume() : engine.stop()));
  }

  get isPlaying() {
    return document.documentElement.dataset.state === "active";
  }

  /**
   * Lets nothing be armed but the scene that is shown: `status` is where that is, as player.js reports it.
   * @param {Status} status
   */
  allowArm(status) {
    this.#status = status;
    this.#enableArm();
  }

  #enableArm() {
    const disabled = this.#status !== "loaded" || this.#isArmResting;
    Object.assign(byId("arm"), { disabled, title: WHY_NOT_ARMED[this.#status] });
  }

  /** @param {boolean} isShown */
  #showArm(isShown) {
    const arm = byId("arm");
    if (isShown && arm.hidden) {
      this.#isArmResting = true;
      clock.cancel(this.#armRestTimer);
      this.#armRestTimer = clock.later(ARM_REST_MS, () => {
        this.#isArmResting = false;
        this.#enableArm();
      });
      this.#enableArm();
    }
    arm.hidden = !isShown;
  }

  /** @param {State} state */
  #show({ link, state, fault, needsArm, driving }) {
    if (link === "none" && this.#link !== "none" && fault) notify(fault, undefined, { beside: byId("board") });
    this.#link = link;
    const board = byId("board");
    board.dataset.state = state;
    Object.assign(document.documentElement.dataset, { state, link });
    const isStopped = link === "simulator" && state === "disarmed";
    const word = isStopped ? "stopped" : STATE_WORDS[state];
    const details = fault && link !== "none" ? `, ${fault}` : "";
    // Of a board's long name the end may be cut: Arm has it, too.
    const of = { none: "No board", simulator: `Simulator: ${word}${details}`, serial: `${word}${details}: ${driving}` };
    board.textContent = of[link];
    board.title = board.textContent;
    this.#showArm(needsArm);
    const arm = byId("arm");
    arm.lastElementChild?.replaceChildren(`: drive ${driving}`);
    // A board latches a fault also when its arm switch is let go.
    byId("clear-fault").hidden = state !== "faulted" || link === "simulator";
    const stop = byId("stop");
    stop.hidden = link === "none";
    stop.textContent = isStopped ? "Play" : "Stop";
    if (isStopped) stop.dataset.stopped = "true";
    else delete stop.dataset.stopped;
    this.onState();
  }

  #open() {
    const hasSerial = "serial" in navigator;
    byId("use-serial").disabled = !hasSerial;
    if (!hasSerial) byId("why-serial").textContent = "this browser has no Web Serial: Chromium and Firefox have it";
    byId("board-dialog").showModal();
  }

  async #connect() {
    const port = await chosenPort();
    if (!port) return;
    await this.#engine.connectSerial(port);
    this.onBoard();
  }

  async #simulate() {
    await this.#engine.simulate();
    this.onBoard();
  }
}

/** The port that a person chooses, or undefined if none was chosen. */
async function chosenPort() {
  try {
    return await navigator.serial.requestPort();
  } catch (error) {
    const { name } = /** @type {DOMException} */ (error);
    // The browser's dialog was closed. It shows by itself that there is no port.
    if (name === "NotFoundError") return undefined;
    throw new Error("The browser does not let this page use a serial port.");
  }
}
