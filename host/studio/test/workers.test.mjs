// The engine's workers: whatever ends or fails, every question has an answer.

import assert from "node:assert/strict";
import { test } from "node:test";
import { CONSTANT, openOnlyEngine } from "./harness.mjs";

/** Runs in the page: the outcome of a promise as a sentence, also where it never settles. */
function addOutcome() {
  globalThis.outcome = (promise) =>
    Promise.race([
      promise.then(() => "done", (error) => error.message),
      new Promise((resolve) => setTimeout(() => resolve("no answer"), 20_000)),
    ]);
}

test("what is asked while the simulator is reset, or of a worker that fails, is rejected, and a reset mends it", async () => {
  const page = await openOnlyEngine();
  await page.evaluate(addOutcome);
  const outcomes = await page.evaluate(async (text) => {
    const play = () => tested.play({ "a.toml": text }, "a.toml", {});
    const [first, second] = [tested.simulate(), tested.simulate()].map(outcome);
    const { board } = workersOfPage;
    const count = board.length;
    while (board.length === count) await new Promise((resolve) => setTimeout(resolve, 0));
    const asked = outcome(play());
    return { asked: await asked, first: await first, second: await second, after: await outcome(play()) };
  }, CONSTANT);
  assert.match(outcomes.asked, /done|reset meanwhile/);
  assert.equal(outcomes.first, "done");
  assert.match(outcomes.second, /wait until that is done/);
  assert.equal(outcomes.after, "done");

  const failed = await page.evaluate(async (text) => {
    const failures = [];
    tested.onFailure = ({ error }) => failures.push(error);
    const play = () => tested.play({ "a.toml": text }, "a.toml", {});
    const fail = (name) => {
      // The page's own engine has workers of the same names, which were started before.
      workersOfPage[name].at(-1).dispatchEvent(new ErrorEvent("error", { message: "out of memory" }));
    };
    const asked = outcome(play());
    fail("board");
    const found = { asked: await asked, later: await outcome(play()) };
    fail("host");
    return { ...found, simulate: await outcome(tested.simulate()), after: await outcome(play()), failures };
  }, CONSTANT);
  assert.match(failed.asked, /the board worker: out of memory/);
  assert.match(failed.later, /the board worker: out of memory/);
  assert.equal(failed.simulate, "done");
  assert.equal(failed.after, "done");
  assert.deepEqual(failed.failures, ["the board worker: out of memory", "the host worker: out of memory"]);
});
