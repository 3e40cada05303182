// What the tests of the layout share: windows, boxes of what is seen, and what is cut.

/** Width and height of windows, CSS pixels. */
export const WINDOWS = [
  [1366, 657], [1440, 789], [1536, 730], [1920, 969], [2560, 1300], [1024, 768], [820, 1180], [390, 844],
];
/** Windows that are too low for all: of a phone whose browser has its bars, and of a laptop at 200 %. */
export const LOW_WINDOWS = [[390, 664], [960, 485]];
/**
 * Least part of a window that the screen's picture has, without ruler and scale: on a phone, and otherwise. A screen
 * whose shape leaves it no such part of the window's width has all of that width.
 */
export const PART = { phone: 0.4, other: 0.25 };
export const PHONE_MAX_PX = 480;
/** What is beside a screen that is as wide as the window, CSS pixels. */
export const AROUND_NARROW_PX = 6;
/** Least height of the curves, CSS pixels. */
export const PLOT_MIN_PX = 55;
/** Edges of boxes may lie within a pixel beyond those of the window. */
export const ROUNDING_PX = 1;

/** In the page: the box of the first element of a selector. */
export function boxOf(selector) {
  const { left, top, right, bottom, width, height } = document.querySelector(selector).getBoundingClientRect();
  return { left, top, right, bottom, width, height };
}

/** Boxes on the page, by their selectors. */
export async function boxes(page, selectors) {
  const found = {};
  for (const selector of selectors) found[selector] = await page.evaluate(boxOf, selector);
  return found;
}

export const isWithin = (inner, outer) =>
  inner.left >= outer.left - ROUNDING_PX && inner.top >= outer.top - ROUNDING_PX &&
  inner.right <= outer.right + ROUNDING_PX && inner.bottom <= outer.bottom + ROUNDING_PX;

export const overlap = (one, other) =>
  Math.min(one.right, other.right) - Math.max(one.left, other.left) > ROUNDING_PX &&
  Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top) > ROUNDING_PX;

/** Scenes that the windows are looked at with, each in its colours. */
export const SCHEMES = { brick: "light", velvet: "dark" };

/** What is cut, also with a mistake in the text: words longer than their box, and tools over others. */
export function cut() {
  const mistakes = document.getElementById("mistakes");
  const shown = { hidden: mistakes.hidden, textContent: mistakes.textContent };
  Object.assign(mistakes, { hidden: false, textContent: "1" });
  const cells = document.querySelectorAll("#numbers dd, #numbers dt, .u-legend tr, header button, .map-card h2, #board");
  const seen = [...cells].filter((each) => each.checkVisibility());
  const long = seen.filter((each) => each.scrollWidth > each.clientWidth + 1).map((each) => each.outerHTML);
  for (const row of document.querySelectorAll("header, .map-tools, .scope-card > .tools, .felt-line")) {
    const boxes = [...row.children].filter((each) => each.checkVisibility()).map((each) => [each, each.getBoundingClientRect()]);
    const inner = boxes.filter(([, { width }]) => width > 0);
    for (const [at, [tool, { left, right }]] of inner.entries()) {
      const end = at + 1 < inner.length ? inner[at + 1][1].left : row.getBoundingClientRect().right;
      if (right > end + 1 || left < row.getBoundingClientRect().left - 1) long.push(`not in its place: ${tool.outerHTML}`);
    }
  }
  Object.assign(mistakes, shown);
  return long;
}

/** Whether anything is wider than the window, or, with `isHigh`, higher. */
export function scrolls(isHigh) {
  const over = [document.scrollingElement, document.querySelector("main")];
  const isOver = ({ scrollWidth, clientWidth, scrollHeight, clientHeight }) =>
    scrollWidth > clientWidth || (isHigh && scrollHeight > clientHeight);
  return over.filter(isOver).map(({ tagName, scrollWidth, scrollHeight }) => [tagName, scrollWidth, scrollHeight]);
}

/** Opens a scene of the gallery, and waits until its map is there. */
export async function openBundled(page, name) {
  await page.click("#open-gallery");
  await page.click(`text="Open ${name}"`);
  await page.waitForFunction((name) => document.getElementById("scene-name").value === name, name);
  await page.waitForFunction(() => document.getElementById("check").textContent === "plays");
  await page.waitForFunction(() => !document.getElementById("map").dataset.stale);
  await page.evaluate(() => document.querySelector("#notice [aria-label=Dismiss]").click());
}
