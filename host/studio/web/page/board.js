// The board that plays: the simulator in the page, or one on a serial port or behind `frixel studio`.

import { bridgeUrl } from "../engine/engine.js";
import { attempt, byId, element, notify } from "./dom.js";

/** For so long after Arm has appeared it cannot be pressed, ms: a press was meant for what stood in its place. */
const ARM_REST_MS = 1000;
/** Why a scene that is shown cannot be armed, by its status as player.js reports it. */
const WHY_NOT_ARMED = {
  loading: "The scene is on its way to the board.",
  mistaken: "The scene has mistakes: mend them, then arm.",
  failed: "The board does not have the scene that is shown.",
};
const WORDS = { active: "playing", armed: "armed", disarmed: "disarmed", faulted: "faulted" };

export class Board {
  #engine;
  #dialog = byId("board-dialog");
  #link = "simulator";
  /** Where the scene that is shown is, as player.js reports it. */
  #status = "loading";
  /** Arm has only just appeared. */
  #isArmResting = false;
  #armRestTimer;
  /** The bridge of `frixel studio`, or null; read at the start, since a shared scene takes its place in the address. */
  #bridge = bridgeUrl();
  /** Another board is connected: the scene is played there. */
  onBoard = () => {};
  /** The board plays, or no longer. */
  onState = () => {};

  constructor(engine) {
    this.#engine = engine;
    engine.onState = (state) => this.#show(state);
    this.#show({ link: "simulator", state: "disarmed", needsArm: false, driving: "the simulator in this page" });
    byId("board").textContent = "Simulator: starting…";
    byId("open-board").onclick = () => this.#open();
    byId("arm").onclick = () => attempt(() => engine.arm());
    byId("clear-fault").onclick = () => attempt(() => engine.clearFault());
    byId("stop").onclick = () => attempt(() => (byId("stop").dataset.stopped ? engine.resume() : engine.stop()));
  }

  get isPlaying() {
    return document.documentElement.dataset.state === "active";
  }

  /** Lets nothing be armed but the scene that is shown: `status` is where that is, as player.js reports it. */
  allowArm(status) {
    this.#status = status;
    this.#enableArm();
  }

  #enableArm() {
    const disabled = this.#status !== "loaded" || this.#isArmResting;
    Object.assign(byId("arm"), { disabled, title: WHY_NOT_ARMED[this.#status] ?? "" });
  }

  #showArm(isShown) {
    const arm = byId("arm");
    if (isShown && arm.hidden) {
      this.#isArmResting = true;
      clearTimeout(this.#armRestTimer);
      this.#armRestTimer = setTimeout(() => {
        this.#isArmResting = false;
        this.#enableArm();
      }, ARM_REST_MS);
      this.#enableArm();
    }
    arm.hidden = !isShown;
  }

  #show({ link, state, fault, needsArm, driving }) {
    if (link === "none" && this.#link !== "none" && fault) notify(fault);
    this.#link = link;
    const board = byId("board");
    board.dataset.state = state;
    document.documentElement.dataset.state = state;
    const name = link === "simulator" ? "Simulator" : driving;
    const details = fault && link !== "none" ? `, ${fault}` : "";
    board.textContent = link === "none" ? "No board" : `${name}: ${WORDS[state] ?? state}${details}`;
    this.#showArm(needsArm);
    byId("arm").textContent = `Arm: drive ${driving}`;
    // A board latches a fault also when its arm switch is let go.
    byId("clear-fault").hidden = state !== "faulted" || link === "simulator";
    const stop = byId("stop");
    stop.hidden = link === "none";
    const isStopped = state === "disarmed";
    stop.textContent = isStopped && link === "simulator" ? "Play" : "Stop";
    if (isStopped && link === "simulator") stop.dataset.stopped = "true";
    else delete stop.dataset.stopped;
    this.onState();
  }

  #open() {
    const close = element("button", { onclick: () => this.#dialog.close() }, "Close");
    const connect = (words, action, isPossible, why) => {
      const button = element("button", { disabled: !isPossible }, words);
      button.onclick = () =>
        attempt(async () => {
          this.#dialog.close();
          await action();
          this.onBoard();
        });
      return element(
        "p",
        { className: "row" },
        button,
        element("span", { className: "soft" }, isPossible ? why[0] : why[1]),
      );
    };
    const serial = async () => this.#engine.connectSerial(await navigator.serial.requestPort());
    this.#dialog.replaceChildren(
      element("div", { className: "head" }, element("h2", {}, "Board"), close),
      element(
        "p",
        {},
        "A board with an electrode drives hundreds of volts. It plays only after you press Arm here and hold the " +
          "switch on the board. It is disarmed when this page is hidden or closed, and before a foreign scene opens.",
      ),
      connect("Simulator", () => this.#engine.simulate(), true, ["the same firmware, in this page"]),
      connect("Board on a USB port…", serial, "serial" in navigator, [
        "over Web Serial",
        "this browser has no Web Serial (Chrome 89 or newer has it)",
      ]),
      ...(this.#bridge
        ? [
            connect("Board of frixel studio", () => this.#engine.connectSocket(this.#bridge), true, [
              "the serial port that the command was given",
            ]),
          ]
        : []),
    );
    this.#dialog.showModal();
  }
}
