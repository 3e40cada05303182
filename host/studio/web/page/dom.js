// Elements of the page. Text goes in as text nodes only, never as HTML.

export function byId(id) {
  return document.getElementById(id);
}

/** Creates an element with properties, listeners (`onclick`), attributes (`aria-label`) and children. */
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes("-")) made.setAttribute(name, value);
    else made[name] = value;
  }
  made.append(...children);
  return made;
}

/** Offers bytes or text as a file. */
export function download(name, content, type) {
  const url = URL.createObjectURL(new Blob([content], { type }));
  element("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/**
 * Shows one sentence above the page until it is dismissed or another one comes; with `{ words, action }`, also a button
 * that does something about it.
 */
export function notify(sentence, offer) {
  const notice = byId("notice");
  const [said, offered, dismiss] = notice.children;
  said.textContent = sentence;
  offered.hidden = offer === undefined;
  offered.textContent = offer?.words ?? "";
  offered.onclick = () => {
    forgetNotice();
    attempt(offer.action);
  };
  dismiss.onclick = forgetNotice;
  notice.hidden = false;
}

/** Removes the sentence: what it says is over. */
export function forgetNotice() {
  byId("notice").hidden = true;
}

/** Runs what a person asked for; where it fails, says why. */
export async function attempt(action) {
  try {
    return await action();
  } catch (error) {
    notify(error.message);
    return undefined;
  }
}

let colours = new WeakMap();

/** The value of a colour of the style sheets where `within` stands, resolved for the theme. */
export function colour(name, within) {
  if (!colours.has(within)) colours.set(within, new Map());
  const known = colours.get(within);
  if (!known.has(name)) {
    const probe = element("span");
    probe.style.color = `var(--${name})`;
    within.append(probe);
    known.set(name, getComputedStyle(probe).color);
    probe.remove();
  }
  return known.get(name);
}

/** The theme has changed: colours are resolved anew. */
export function forgetColours() {
  colours = new WeakMap();
}

/** A setting that outlives the page, where the browser lets it. */
export const settings = {
  get(name) {
    try {
      return localStorage.getItem(`frixel.${name}`);
    } catch {
      return null;
    }
  },
  /** Whether the setting is kept: private windows have no storage, and a full one takes nothing. */
  set(name, value) {
    try {
      localStorage.setItem(`frixel.${name}`, value);
      return true;
    } catch {
      return false;
    }
  },
};
