// Sound: the change of felt friction as audio.
// @ts-check

import { byId, settings } from "./dom.js";
import { attempt } from "./notices.js";

export class Sound {
  /**
   * What plays, once it was asked for.
   * @type {{ context: AudioContext, node: AudioWorkletNode, gain: GainNode } | undefined}
   */
  #built;
  #mode;
  #volume = 0.7;
  #toggle = byId("toggle-sound");
  /**
   * Behind volume, for the tests: an AnalyserNode.
   * @type {AnalyserNode | undefined}
   */
  analyser;
  /** It goes on or off. */
  onChange = () => {};

  constructor() {
    this.#toggle.onclick = () => attempt(() => (this.isOn ? this.stop() : this.start()));
    const volume = byId("volume");
    volume.oninput = () => this.setVolume(Number(volume.value));
    /** @type {NodeListOf<HTMLInputElement>} */
    const modes = document.querySelectorAll("[name=sound-mode]");
    const kept = [...modes].find(({ value }) => value === settings.get("sound")) ?? modes[0];
    kept.checked = true;
    this.#mode = kept.value;
    for (const mode of modes) mode.onchange = () => this.#choose(mode.value);
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
