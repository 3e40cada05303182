// Joins what the page uses of others into studio-vendor.js and chart-vendor.js, and their licences into LICENCES.txt.
// With --check it writes nothing and fails where a committed file differs from what it would write.

import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const isCheck = process.argv.includes("--check");
const folder = new URL(".", import.meta.url);

const { outputFiles, metafile } = await build({
  absWorkingDir: folder.pathname,
  entryPoints: { "studio-vendor": "entry.js", "chart-vendor": "chart_entry.js" },
  outdir: ".",
  bundle: true,
  format: "esm",
  minify: true,
  target: "es2022",
  legalComments: "none",
  loader: { ".css": "text" },
  banner: { js: "// Made by build.mjs from package-lock.json; LICENCES.txt has whose work this is." },
  metafile: true,
  write: false,
});

const scripts = outputFiles.map(({ path, text }) => [path.slice(folder.pathname.length), text]);
const made = { ...Object.fromEntries(scripts), "LICENCES.txt": licences(Object.keys(metafile.inputs)) };
const stale = Object.keys(made).filter((name) => made[name] !== committed(name));
if (isCheck && stale.length > 0) {
  console.error(`${stale.join(" and ")}: not what \`npm run build\` makes of package-lock.json; run it, commit both`);
  process.exit(1);
}
if (!isCheck) for (const [name, text] of Object.entries(made)) writeFileSync(new URL(name, folder), text);
const sizes = scripts.map(([name, text]) => `${name} ${text.length} bytes`);
console.log(`${sizes.join(", ")}, ${isCheck ? "as committed" : "written"}`);

function committed(name) {
  try {
    return readFileSync(new URL(name, folder), "utf8");
  } catch {
    return undefined;
  }
}

/** The licences of the packages whose files are in the bundle. */
function licences(inputs) {
  const names = inputs.map((input) => /^node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(input)?.[1]).filter(Boolean);
  const packages = [...new Set(names)].sort();
  return packages.map((name) => {
    const home = new URL(`node_modules/${name}/`, folder);
    const { version, license } = JSON.parse(readFileSync(new URL("package.json", home), "utf8"));
    const file = readdirSync(home).find((entry) => /^licen[cs]e/i.test(entry));
    if (file === undefined) throw new Error(`${name} has no licence file`);
    return `${name} ${version} (${license})\n\n${readFileSync(new URL(file, home), "utf8").trim()}\n`;
  }).join(`\n${"-".repeat(78)}\n\n`);
}
