// The page as a part of a site, which `cargo xtask studio --site` makes: the browser keeps its files.
// @ts-check

import { notify } from "./notices.js";

/** Has the site's files kept, so that the page opens without a network from now on. Elsewhere there is no site. */
export async function keepSite() {
  if (!document.querySelector('link[rel="manifest"]') || !("serviceWorker" in navigator)) return;
  // A browser that keeps nothing, as in a private window, still shows the page.
  const registration = await navigator.serviceWorker.register("service-worker.js").catch(() => undefined);
  // The first version of all has nothing to take over from.
  if (!registration || !navigator.serviceWorker.controller) return;
  if (registration.waiting) offer(registration.waiting);
  const follow = () => {
    const { installing } = registration;
    installing?.addEventListener("statechange", () => installing.state === "installed" && offer(installing));
  };
  // It may have been found while the page started.
  follow();
  registration.addEventListener("updatefound", follow);
}

/**
 * Offers a newer version of the site: the page is loaded anew with it, which also disarms a board.
 * @param {ServiceWorker} newer
 */
function offer(newer) {
  const action = () => {
    navigator.serviceWorker.addEventListener("controllerchange", () => location.reload(), { once: true });
    newer.postMessage("take over");
  };
  notify("A newer version of the studio is here. The scene stays as it is.", { words: "Load it", action });
}
