// Modules of the page in node: those that touch no document.

import { register } from "node:module";

// The page is packed with `vendor` beside `page`.
const vendor = new URL("../vendor/studio-vendor.js", import.meta.url).href;
const hook = `export const resolve = (name, context, next) =>
  next(name.endsWith("/vendor/studio-vendor.js") ? ${JSON.stringify(vendor)} : name, context);`;
register(`data:text/javascript,${encodeURIComponent(hook)}`);

/** A module of `web/page`. */
export function pageModule(name) {
  return import(new URL(`../web/page/${name}`, import.meta.url).href);
}
