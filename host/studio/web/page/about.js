// What the page is: its version, and whose work it carries.
// @ts-check

import { byId } from "./dom.js";

export function makeAbout() {
  byId("open-about").onclick = async () => {
    byId("about").showModal();
    const { version, commit, isChanged } = JSON.parse(await studio.text("about.json"));
    const made = commit ? `commit ${commit}${isChanged ? ", with changes" : ""}` : "not made from a checkout";
    byId("version").textContent = `Version ${version}, ${made}. MIT or Apache-2.0.`;
    byId("licences").textContent = await studio.text("licences.txt");
  };
}
