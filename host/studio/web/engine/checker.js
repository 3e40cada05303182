// The worker of the compiler: checks scenes, draws their maps, and measures the simulator. It has no board, so a long
// compile delays nothing that a board waits for.
// @ts-check
"use strict";

/** @type {Engine} */
let checker;

serve({
  async start(message) {
    compiled = message.module;
    checker = await Engine.start();
    return {};
  },

  check: ({ scene }) => checker.call("check", requestOf(scene)),
  compile: ({ scene }) => checker.call("compile", requestOf(scene)),
  usedFiles: ({ scene }) => checker.call("used_files", requestOf(scene)),
  picture: ({ bytes }) => checker.call("picture", bytes),
  seeded: ({ scene }) => checker.call("seeded_hash", requestOf(scene)),

  map({ scene }) {
    const values = new Float32Array(checker.callForBytes("map", requestOf(scene)));
    const { mapHead } = checker.layouts;
    const head = /** @type {Omit<T.FrictionField, "frictionN" | "outOfReach">} */ (named(mapHead, values));
    const count = head.widthPx * head.heightPx;
    const pixels = values.subarray(mapHead.length);
    return { ...head, frictionN: pixels.slice(0, count), outOfReach: Int8Array.from(pixels.subarray(count)) };
  },

  /**
   * Runs the simulator as fast as it goes, and returns how many times faster than real time that is: the fastest of
   * some stretches, because other programs on the machine only slow it.
   */
  async speed({ scene, stretches, stretchMs }) {
    const engine = await Engine.start();
    engine.call("simulator_start", null, 1);
    engine.call("simulator_play", requestOf(scene));
    const times = Array.from({ length: stretches }, () => {
      const begin = performance.now();
      for (let ms = 0; ms < stretchMs; ms += 8) {
        const tick = engine.plain("simulator_tick");
        engine.plain("simulator_pointer", tick + 320, 65 + (30 * ms) / stretchMs, 30, 1, 0);
        engine.callForBytes("simulator_run", null, 320, 1);
      }
      return performance.now() - begin;
    });
    return { timesRealTime: stretchMs / Math.min(...times) };
  },
});
