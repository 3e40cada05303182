// What the check of the scene found: a list under the editor, and the report.

import { byId, element } from "./dom.js";

/** What the last check came to. */
let outcome = "";

export function showCheck({ ok, isDraft, problems, report }, editor) {
  const errors = problems.filter(({ severity }) => severity === "error");
  const result = byId("check");
  result.dataset.bad = !ok;
  document.documentElement.toggleAttribute("data-draft", isDraft === true);
  const count = errors.length === 1 ? "1 mistake" : `${errors.length} mistakes`;
  const meanwhile = isDraft ? "draft: plays clamped, a board refuses it" : "the version before plays on";
  outcome = ok ? "" : `${count}; ${meanwhile}`;
  showOutcome();
  byId("problems").replaceChildren(...problems.map((problem) => item(problem, editor)));
  if (report) byId("report").textContent = feltFirst(report);
  editor.mark(problems);
}

/** Says what the check came to; a scene without mistakes plays only where the board does. */
export function showOutcome() {
  const isPlaying = document.documentElement.dataset.state === "active";
  byId("check").textContent = outcome || (isPlaying ? "plays" : "no mistakes");
}

/** The report with what a person feels before what a board needs. */
function feltFirst(report) {
  const first = ["draft", "feel", "step", "out of reach"];
  const rank = (line) => {
    const at = first.findIndex((word) => line.trimStart().startsWith(`${word} `));
    return at < 0 ? first.length : at;
  };
  return report
    .split("\n")
    .sort((a, b) => rank(a) - rank(b))
    .join("\n");
}

function item({ severity, message, file, line }, editor) {
  const shown = element("li", { className: severity });
  const place = [file, line && `line ${line}`].filter(Boolean).join(", ");
  if (line !== undefined && editor.has(file))
    shown.append(element("button", { onclick: () => editor.goTo(file, line) }, place));
  else shown.append(element("b", {}, `${place || (severity === "error" ? "mistake" : "note")} `));
  shown.append(message);
  return shown;
}
