// A web server for the site that `cargo xtask studio --site` makes.

import fs from "node:fs";
import http from "node:http";
import path from "node:path";

const TYPES = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".webmanifest": "application/manifest+json",
  ".svg": "image/svg+xml",
  ".png": "image/png",
  ".jpg": "image/jpeg",
};

/**
 * Serves the files of `site` below a folder of its own, as a host of many sites does, with these further heads. Returns
 * its address, and what ends it.
 */
export async function serve(site, heads = {}) {
  const server = http.createServer((request, answer) => {
    const { pathname } = new URL(request.url, "http://a");
    const name = decodeURIComponent(pathname.replace(/^\/mine\//, "").replace(/(^|\/)$/, "$1index.html"));
    const file = path.join(site, path.normalize(`/${name}`));
    const isThere = pathname.startsWith("/mine/") && fs.existsSync(file);
    if (isThere) answer.writeHead(200, { "content-type": TYPES[path.extname(file)] ?? "text/plain", ...heads }).end(fs.readFileSync(file));
    // Browsers ask for an icon by themselves.
    else answer.writeHead(pathname.endsWith("favicon.ico") ? 204 : 404).end();
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  const end = () => {
    server.close();
    server.closeAllConnections();
  };
  return { address: `http://127.0.0.1:${server.address().port}/mine/`, end };
}
