// The worker of the compiler: checks scenes and draws their maps. It has no board, so a long compile delays nothing that
// a board waits for.
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

  map({ scene }) {
    const values = new Float32Array(checker.callForBytes("map", requestOf(scene)));
    const { mapHead } = checker.layouts;
    const head = /** @type {Omit<T.FrictionField, "frictionN" | "outOfReach">} */ (named(mapHead, values));
    const count = head.widthPx * head.heightPx;
    const pixels = values.subarray(mapHead.length);
    return { ...head, frictionN: pixels.slice(0, count), outOfReach: Int8Array.from(pixels.subarray(count)) };
  },
});
