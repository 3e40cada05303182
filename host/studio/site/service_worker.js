// Keeps the files of the site, so that the page opens without a network from the second visit on.
//
// `cargo xtask studio --site` writes the list of files and its version in front of this script.
// @ts-check
/// <reference lib="webworker" />

/** @type {ServiceWorkerGlobalScope} */
const worker = /** @type {any} */ (self);
/** Other sites of the same server have caches of their own. */
const OWN_CACHES = `frixel ${worker.registration.scope} `;
const CACHE = OWN_CACHES + SITE.version;

worker.addEventListener("install", (event) => event.waitUntil(keep()));
worker.addEventListener("activate", (event) => event.waitUntil(forgetOthers()));
// The page of the version before goes on until a person takes the new one.
worker.addEventListener("message", ({ data }) => {
  if (data === "take over") worker.skipWaiting();
});
worker.addEventListener("fetch", (event) => {
  if (event.request.method === "GET") event.respondWith(answer(event.request));
});

async function keep() {
  const cache = await caches.open(CACHE);
  // Past the browser's cache, which may have files of the version before.
  await cache.addAll(SITE.files.map((name) => new Request(name, { cache: "reload" })));
}

/** Deletes what an earlier version of the site has kept. */
async function forgetOthers() {
  const names = await caches.keys();
  const old = names.filter((name) => name.startsWith(OWN_CACHES) && name !== CACHE);
  await Promise.all(old.map((name) => caches.delete(name)));
}

/** @param {Request} request */
async function answer(request) {
  // A browser whose store is broken still has the network.
  const kept = await keptAnswer(request).catch(() => undefined);
  return kept ?? fetch(request);
}

/** @param {Request} request */
async function keptAnswer(request) {
  const cache = await caches.open(CACHE);
  return cache.match(request, { ignoreSearch: true });
}
