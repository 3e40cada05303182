// The tools above map and scope.

import { attempt, byId, element } from "./dom.js";
import { MOCKUPS, chooseOwnPicture } from "./mockup.js";

export function makeView({ map, finger, scope, engine }) {
  makeLook(map);
  byId("names").onchange = ({ target }) => {
    map.hasNames = target.checked;
    map.draw();
  };
  byId("pressure").onchange = ({ target }) => (finger.usesPressure = target.checked);
  byId("drag").onchange = ({ target }) => {
    finger.drags = target.checked;
    byId("map").classList.toggle("no-drag", !target.checked);
  };
  makeMenu(document.querySelector(".menu"));
  makeScope(scope);
  makeReplay(engine);
}

/** A press elsewhere, or Escape, closes the menu. */
function makeMenu(menu) {
  document.addEventListener("pointerdown", ({ target }) => {
    if (!menu.contains(target)) menu.open = false;
  });
  menu.addEventListener("keydown", ({ key }) => {
    if (key === "Escape") menu.open = false;
  });
}

function makeLook(map) {
  const look = byId("look");
  const mockup = byId("mockup");
  mockup.append(...Object.entries(MOCKUPS).map(([value, words]) => element("option", { value }, words)));
  look.onchange = () => {
    map.look = look.value;
    byId("mockup-label").hidden = look.value === "map";
    map.draw();
  };
  mockup.onchange = async () => {
    if (mockup.value === "own" && !(await chooseOwnPicture())) mockup.value = map.mockup;
    map.mockup = mockup.value;
    map.draw();
  };
}

function makeScope(scope) {
  const pause = byId("pause");
  pause.onclick = () => scope.pause(!scope.isPaused);
  scope.onPause = (isPaused) => {
    pause.setAttribute("aria-pressed", isPaused);
    pause.textContent = isPaused ? "Run" : "Pause";
  };
  byId("save-csv").onclick = () => scope.saveCsv();
  byId("save-png").onclick = () => scope.savePng();
}

/** The last stroke again, slower; in a loop until the box is cleared, the button pressed, or the map. */
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
