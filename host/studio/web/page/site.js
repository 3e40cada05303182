// The page as a part of a site, which `cargo xtask studio --site` makes: the browser keeps its files.
// @ts-check

/** Has the site's files kept, so that the page opens without a network from now on. Elsewhere there is no site. */
export function keepSite() {
  if (!document.querySelector('link[rel="manifest"]') || !("serviceWorker" in navigator)) return;
  // A browser that keeps nothing, as in a private window, still shows the page.
  navigator.serviceWorker.register("service-worker.js").catch(() => {});
}
