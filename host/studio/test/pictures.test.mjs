// The pictures of docs/design/studio: `shots.mjs` takes each of them, and a document shows it.

import assert from "node:assert/strict";
import fs from "node:fs";
import { test } from "node:test";

const DOCS = new URL("../../../docs/design/", import.meta.url);

test("each picture of the studio is taken by the command and shown in a document, and none is missing", () => {
  const pictures = fs.readdirSync(new URL("studio/", DOCS)).sort();
  const documents = fs.readdirSync(DOCS).filter((name) => name.endsWith(".md"));
  const text = documents.map((name) => fs.readFileSync(new URL(name, DOCS), "utf8")).join("\n");
  const shown = [...new Set([...text.matchAll(/\]\(studio\/([\w-]+\.png)\)/g)].map(([, name]) => name))].sort();
  assert.deepEqual(pictures, shown);
  const shots = fs.readFileSync(new URL("shots.mjs", import.meta.url), "utf8");
  for (const picture of pictures) assert.match(shots, new RegExp(`^  "?${picture.replace(".png", "")}"?: `, "m"), picture);
});
