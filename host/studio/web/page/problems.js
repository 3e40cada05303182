// What the check of the scene found: a list under the editor, and how many mistakes.
// @ts-check

import { byId, element } from "./dom.js";
import { DRAFT } from "./player.js";

/** @import { Check, Problem } from "../engine/types" */
/** @import { Editor } from "./editor.js" */
/** @import { Status } from "./player.js" */

/** Words of this many characters stand in small type, on up to three lines. */
const LONG = 20;
/** What the last check found: how many mistakes, in words, and whether the simulator plays the scene as a draft. */
let found = { count: "", isDraft: false };
/**
 * Where the newest text is, as player.js reports it.
 * @type {Status}
 */
let status = "loading";

/**
 * @param {Check} check
 * @param {Editor} editor
 */
export function showCheck(check, editor) {
  const { ok, isDraft, problems } = check;
  const errors = problems.filter(({ severity }) => severity === "error");
  byId("check").dataset.bad = String(!ok);
  document.documentElement.toggleAttribute("data-draft", isDraft === true);
  found = mistakesIn(check);
  showOutcome();
  // What is said of layers is of the last version that plays.
  const isOlder = !ok && !isDraft;
  for (const id of /** @type {const} */ (["felt", "panel-layers"])) byId(id).toggleAttribute("data-older", isOlder);
  const mistakes = byId("mistakes");
  // Warnings are counted where there is no mistake: a scene that plays may play otherwise than its text says.
  const isWarned = errors.length === 0;
  mistakes.hidden = problems.length === 0;
  mistakes.classList.toggle("is-warning", isWarned);
  mistakes.textContent = `${isWarned ? problems.length : errors.length}`;
  mistakes.setAttribute("aria-label", isWarned ? counted(problems.length, "warning") : found.count);
  byId("problems").replaceChildren(...problems.map((problem) => item(problem, editor)));
  editor.mark(problems);
}

/**
 * How many mistakes a check found, in words, and whether the scene plays as a draft all the same.
 * @param {Check} check
 */
export function mistakesIn({ isDraft, problems }) {
  const { length } = problems.filter(({ severity }) => severity === "error");
  return { count: counted(length, "mistake"), isDraft: isDraft === true };
}

/**
 * @param {number} count
 * @param {string} what
 */
const counted = (count, what) => `${count} ${what}${count === 1 ? "" : "s"}`;

/** @param {Status} newStatus */
export function showStatus(newStatus) {
  status = newStatus;
  showOutcome();
}

/** Says what came of the newest text. What plays meanwhile, if anything does, is what the board had before. */
export function showOutcome() {
  const isPlaying = document.documentElement.dataset.state === "active";
  const meanwhile = isPlaying ? "; the one before plays" : "";
  const words = {
    loading: "loading…",
    mistaken: `${found.count}${meanwhile}`,
    failed: isPlaying ? `the board refuses it${meanwhile}` : "not on the board",
    loaded: isPlaying ? "plays" : "no mistakes",
  };
  if (found.isDraft) words.loaded = `${found.count}; ${DRAFT}`;
  const check = byId("check");
  check.textContent = words[status];
  check.toggleAttribute("data-long", words[status].length > LONG);
}

/**
 * @param {Problem} problem
 * @param {Editor} editor
 */
function item({ severity, message, file, line }, editor) {
  const shown = element("li", { className: severity });
  const place = [file, line && `line ${line}`].filter(Boolean).join(", ");
  if (line !== undefined && editor.has(file))
    shown.append(element("button", { onclick: () => editor.goTo(file, line) }, place));
  else shown.append(element("b", {}, `${place || (severity === "error" ? "mistake" : "note")} `));
  shown.append(message);
  return shown;
}
