// Sound: the change of felt friction as audio.
// @ts-check

import { byId, element, settings } from "./dom.js";
import { attempt } from "./notices.js";

/** @type {Record<string, string>} */
const MODES = {
  headphones: "Headphones: the friction's change as it is, 10 Hz and up",
  pitched: "Small loudspeakers: pitched up four times",
  noise: "Small loudspeakers: noise that swells with the friction",
};

export class Sound {
  /**
   * What plays, once it was asked for.
   * @type {{ context: AudioContext, node: AudioWorkletNode, gain: GainNode } | undefined}
   */
  #built;
  #mode = settings.get("sound") ?? "headphones";
  #volume = 0.7;
  #toggle;
  /**
   * Behind volume, for the tests: an AnalyserNode.
   * @type {AnalyserNode | undefined}
   */
  analyser;
  /** It goes on or off. */
  onChange = () => {};

  constructor() {
    if (!(this.#mode in MODES)) this.#mode = "headphones";
    this.#toggle = element("button", { className: "primary" }, "Turn sound on");
    this.#toggle.onclick = () => attempt(() => (this.isOn ? this.stop() : this.start()));
    const volume = element("input", { type: "range", min: 0, max: 1, step: 0.01, value: this.#volume, id: "volume" });
    volume.oninput = () => this.setVolume(Number(volume.value));
    const modes = Object.entries(MODES).map(([mode, label]) => {
      const choice = element("input", { type: "radio", name: "sound-mode", checked: mode === this.#mode });
      choice.onchange = () => this.#choose(mode);
      return element("div", { className: "row" }, element("label", { className: "check" }, choice, ` ${label}`));
    });
    byId("panel-sound").append(
      element("div", { className: "row" }, this.#toggle, element("label", {}, "Volume ", volume)),
      ...modes,
      element(
        "p",
        { className: "fine" },
        "The sound shows the frequency of the friction's change, not how it feels to touch.",
      ),
    );
  }

  get isOn() {
    return this.#built?.context.state === "running";
  }

  async start() {
    this.#built ??= await this.#build();
    await this.#built.context.resume();
    this.#label();
  }

  async stop() {
    await this.#built?.context.suspend();
    this.#label();
  }

  async #build() {
    const context = new AudioContext({ latencyHint: "interactive" });
    // From a file, a browser takes no blob URL here.
    const source = await studio.text("page/sound_processor.js");
    await context.audioWorklet.addModule(`data:text/javascript,${encodeURIComponent(source)}`);
    const node = new AudioWorkletNode(context, "friction-sound", { numberOfInputs: 0, outputChannelCount: [1] });
    const gain = new GainNode(context, { gain: this.#volume });
    this.analyser = new AnalyserNode(context, { fftSize: 16_384, smoothingTimeConstant: 0 });
    node.connect(gain).connect(this.analyser).connect(context.destination);
    node.port.postMessage({ mode: this.#mode });
    return { context, node, gain };
  }

  #label() {
    this.#toggle.textContent = this.isOn ? "Turn sound off" : "Turn sound on";
    this.onChange();
  }

  /** @param {string} mode */
  #choose(mode) {
    this.#mode = mode;
    settings.set("sound", mode);
    this.#built?.node.port.postMessage({ mode });
  }

  /** @param {number} volume */
  setVolume(volume) {
    this.#volume = volume;
    if (!this.#built) return;
    const { context, gain } = this.#built;
    gain.gain.setTargetAtTime(volume, context.currentTime, 0.02);
  }

  /**
   * @param {Float32Array} samples
   * @param {number} samplesPerS
   */
  feel(samples, samplesPerS) {
    if (this.isOn) this.#built?.node.port.postMessage({ samples, samplesPerS });
  }
}
