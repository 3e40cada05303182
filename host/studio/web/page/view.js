// The tools above map and scope.
// @ts-check

import { byId, element } from "./dom.js";
import { chooseOwnPicture } from "./mockup.js";
import { attempt } from "./notices.js";
import { MEANINGS } from "./scope.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { Finger } from "./finger.js" */
/** @import { FrictionMap } from "./map.js" */
/** @import { Scope } from "./scope.js" */

/** @param {{ map: FrictionMap, finger: Finger, scope: Scope, engine: Engine }} parts */
export function makeView({ map, finger, scope, engine }) {
  makeLook(map);
  const [names, pressure, drag] = [byId("names"), byId("pressure"), byId("drag")];
  names.onchange = () => {
    map.hasNames = names.checked;
    map.draw();
  };
  pressure.onchange = () => (finger.usesPressure = pressure.checked);
  drag.onchange = () => {
    finger.drags = drag.checked;
    byId("map").classList.toggle("no-drag", !drag.checked);
  };
  for (const id of ["options", "scope-options"]) makeOptions(/** @type {HTMLDetailsElement} */ (byId(id)));
  makeScope(scope);
  makeReplay(engine);
}

/** Least distance of open options from the edges of the window, CSS pixels. */
const EDGE_PX = 8;
/** Room between options and their button, CSS pixels. */
const BELOW_PX = 6;

/**
 * Puts open options below their button, or above it where there is more room, whole within the window.
 * @param {HTMLDetailsElement} options
 */
function placeOptions(options) {
  const list = /** @type {HTMLElement | null} */ (options.querySelector(":scope > div"));
  if (!options.open || !list) return;
  list.style.maxHeight = "";
  const button = options.getBoundingClientRect();
  const { width, height } = list.getBoundingClientRect();
  const least = (document.querySelector("header")?.getBoundingClientRect().bottom ?? 0) + EDGE_PX;
  const [above, below] = [button.top - BELOW_PX - least, innerHeight - EDGE_PX - button.bottom - BELOW_PX];
  const isBelow = height <= below || below >= above;
  const shown = Math.min(height, Math.max(above, below));
  const top = isBelow ? button.bottom + BELOW_PX : button.top - BELOW_PX - shown;
  const left = Math.max(EDGE_PX, Math.min(button.left, innerWidth - EDGE_PX - width));
  Object.assign(list.style, {
    maxHeight: `${shown}px`,
    left: `${left - button.left}px`,
    top: `${top - button.top}px`,
  });
}

/**
 * A press elsewhere closes the options, and so does the focus that leaves them, and Escape wherever the focus is.
 * @param {HTMLDetailsElement} options
 */
function makeOptions(options) {
  options.addEventListener("toggle", () => placeOptions(options));
  addEventListener("resize", () => placeOptions(options));
  document.addEventListener("pointerdown", ({ target }) => {
    if (!(target instanceof Node && options.contains(target))) options.open = false;
  });
  options.addEventListener("focusout", ({ relatedTarget }) => {
    if (relatedTarget instanceof Node && !options.contains(relatedTarget)) options.open = false;
  });
  addEventListener(
    "keydown",
    (event) => {
      if (event.key !== "Escape" || !options.open || document.querySelector("dialog[open]")) return;
      event.preventDefault();
      event.stopPropagation();
      options.open = false;
      options.querySelector("summary")?.focus();
    },
    { capture: true },
  );
}

/** @param {FrictionMap} map */
function makeLook(map) {
  const look = byId("look");
  const mockup = byId("mockup");
  look.onchange = () => {
    map.look = /** @type {FrictionMap["look"]} */ (look.value);
    byId("mockup-label").hidden = look.value === "map";
    map.draw();
  };
  mockup.onchange = async () => {
    if (mockup.value === "own" && !(await chooseOwnPicture())) mockup.value = map.mockup;
    map.mockup = /** @type {FrictionMap["mockup"]} */ (mockup.value);
    map.draw();
  };
}

/** @param {Scope} scope */
function makeScope(scope) {
  const pause = byId("pause");
  pause.onclick = () => scope.pause(!scope.isPaused);
  scope.onPause = (isPaused) => {
    pause.setAttribute("aria-pressed", String(isPaused));
    pause.textContent = isPaused ? "Run" : "Pause";
  };
  byId("save-csv").onclick = () => scope.saveCsv();
  byId("save-png").onclick = () => scope.savePng();
  byId("scope-meanings").append(...MEANINGS.slice(1).map((meaning) => element("p", {}, meaning)));
}

/**
 * The last stroke again, slower; in a loop until the box is cleared, the button pressed, or the map.
 * @param {Engine} engine
 */
function makeReplay(engine) {
  const button = byId("replay");
  let isRunning = false;
  const replay = async () => {
    isRunning = true;
    button.textContent = "Stop replay";
    try {
      let isWhole;
      do ({ isWhole } = await engine.replay({ slowness: Number(byId("slowness").value) }));
      while (isWhole && byId("loop").checked);
    } finally {
      isRunning = false;
      button.textContent = "Replay slowly";
    }
  };
  button.onclick = () => attempt(() => (isRunning ? engine.endReplay() : replay()));
}
