// What the check of the scene found: a list under the editor, and the report.

import { byId, element } from "./dom.js";

export function showCheck({ ok, isDraft, problems, report }, editor) {
  const errors = problems.filter(({ severity }) => severity === "error");
  const result = byId("check");
  result.dataset.bad = !ok;
  document.documentElement.toggleAttribute("data-draft", isDraft === true);
  const count = errors.length === 1 ? "1 mistake" : `${errors.length} mistakes`;
  const outcome = isDraft ? "draft: plays clamped, a board refuses it" : "the version before plays on";
  result.textContent = ok ? "plays" : `${count}; ${outcome}`;
  byId("problems").replaceChildren(...problems.map((problem) => item(problem, editor)));
  if (report) byId("report").textContent = report;
  editor.mark(problems);
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
