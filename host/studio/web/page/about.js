// What the page is, what it simulates and what not, and whose work it carries.
// @ts-check

import { fillDialog } from "./dialogs.js";
import { byId, element } from "./dom.js";

const IS = `frixel studio runs the firmware of a frixel board in the browser, 40,000 ticks a second, and a simulated
world around it. A board turns friction in newtons into the voltage on an electrovibration screen.`;
const SIMULATED = [
  "Simulated: amplifier, electrode, touch source with its latency, noise and losses, and a finger with the contact model " +
    "of Argatov and Borodich in full, load, noise, and a sliding friction that follows with a lag.",
  "Not simulated: how friction feels. Sound and trail show it; a finger feels it on a screen with a board.",
  "The fingers are assumed, not measured, unless a profile says that it was fitted. A real finger differs from them.",
  "What a simulator shows is no statement about the safety of a board.",
];
const DOCS =
  "docs/design/studio.md of the frixel repository says what everything here is, and docs/inside/evidence.md what is " +
  "known about fingers.";

export function makeAbout() {
  const dialog = byId("about");
  byId("open-about").onclick = async () => {
    const { version, commit, isChanged } = JSON.parse(await studio.text("about.json"));
    const made = commit ? `commit ${commit}${isChanged ? ", with changes" : ""}` : "not made from a checkout";
    const licences = element("details", {}, element("summary", {}, "Licences of all that this file carries"));
    fillDialog(
      dialog,
      "About",
      [],
      element("p", {}, IS),
      element("ul", { className: "plain" }, ...SIMULATED.map((words) => element("li", {}, words))),
      element("p", {}, DOCS),
      element("p", { className: "soft" }, `Version ${version}, ${made}. MIT or Apache-2.0.`),
      licences,
    );
    dialog.showModal();
    licences.append(element("pre", { className: "licences" }, await studio.text("licences.txt")));
  };
}
