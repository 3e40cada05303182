// Sliders under a finger: a swipe that scrolls the page changes no value, whatever slider it begins on.
// @ts-check

/**
 * A finger on a slider: where it went down, the value before, and what the slider would have been set to since.
 * @typedef {{ pointerId: number, slider: HTMLInputElement, clientX: number, clientY: number, before: string,
 *   held: string | undefined, isSliding: boolean }} Touch
 */

/** A finger that moves less has tapped, CSS pixels. */
const TAP_PX = 6;

/** A slider takes a value where a finger taps it or moves along it. */
export function guardSliders() {
  /** @type {Touch | undefined} */
  let touch;
  addEventListener(
    "pointerdown",
    ({ target, pointerType, pointerId, isPrimary, clientX, clientY }) => {
      if (pointerType !== "touch" || !isPrimary || !isSlider(target)) return;
      touch = { pointerId, slider: target, clientX, clientY, before: target.value, held: undefined, isSliding: false };
    },
    { capture: true },
  );
  addEventListener(
    "pointermove",
    ({ pointerId, clientX, clientY }) => {
      if (touch?.pointerId !== pointerId) return;
      const [along, across] = [Math.abs(clientX - touch.clientX), Math.abs(clientY - touch.clientY)];
      if (along > TAP_PX && along > across) touch.isSliding = true;
    },
    { capture: true },
  );
  // The browser sets a slider where a finger goes down, before it knows whether that scrolls.
  for (const type of ["input", "change"]) {
    addEventListener(
      type,
      (event) => {
        if (!touch || event.target !== touch.slider || touch.isSliding) return;
        event.stopImmediatePropagation();
        if (type === "input") touch.held = touch.slider.value;
        touch.slider.value = touch.before;
      },
      { capture: true },
    );
  }
  // Another finger, on Stop for instance, ends nothing here.
  /** @param {PointerEvent} event */
  const end = ({ pointerId }) => {
    const ended = touch?.pointerId === pointerId ? touch : undefined;
    if (ended) touch = undefined;
    return ended;
  };
  addEventListener("pointerup", (event) => {
    const ended = end(event);
    if (ended?.held !== undefined && !ended.isSliding) set(ended.slider, ended.held);
  });
  addEventListener("pointercancel", (event) => {
    const ended = end(event);
    if (ended?.isSliding && ended.slider.value !== ended.before) set(ended.slider, ended.before);
  });
}

/**
 * @param {EventTarget | null} target
 * @returns {target is HTMLInputElement}
 */
export function isSlider(target) {
  return target instanceof HTMLInputElement && target.type === "range";
}

/**
 * @param {HTMLInputElement} slider
 * @param {string} value
 */
function set(slider, value) {
  slider.value = value;
  for (const type of ["input", "change"]) slider.dispatchEvent(new Event(type, { bubbles: true }));
}
