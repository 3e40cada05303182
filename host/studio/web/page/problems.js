// What the check of the scene found: a list under the editor, and the report.

import { byId, element } from "./dom.js";

export function showCheck({ ok, problems, report }, editor) {
  const errors = problems.filter(({ severity }) => severity === "error");
  const result = byId("check");
  result.dataset.bad = !ok;
  const count = errors.length === 1 ? "1 mistake" : `${errors.length} mistakes`;
  result.textContent = ok ? "plays" : `${count}; the version before plays on`;
  byId("problems").replaceChildren(...problems.map((problem) => item(problem, editor)));
  if (report) byId("report").textContent = report;
  editor.mark(problems);
}

function item({ severity, message, line }, editor) {
  const shown = element("li", { className: severity });
  if (line !== undefined) shown.append(element("button", { onclick: () => editor.goToLine(line) }, `line ${line}`));
  else shown.append(element("b", {}, severity === "error" ? "mistake " : "note "));
  shown.append(message);
  return shown;
}
