// Plays a bundled scene under the pointer, until there is a page.

import { createEngine } from "./engine/engine.js";

const status = document.getElementById("status");
const engine = await createEngine();
globalThis.engine = engine;
engine.onState = ({ state }) => (status.textContent = document.documentElement.dataset.state = state);
await engine.play({ "grating.toml": await studio.text("scenes/grating.toml") }, "grating.toml", {});
