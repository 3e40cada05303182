// What the panel of the selected layer does: its numbers tune the layer, its buttons add, double and delete layers.
// @ts-check

import { isSlider } from "./slider_touch.js";

/** @import { Hands } from "./hands.js" */
/** @import { HandsView } from "./hands_view.js" */

/**
 * @param {HandsView} view That the panel is of.
 * @param {Hands} hands
 */
export function listenToPanel({ panel, boxes }, hands) {
  const { grip } = hands;
  panel.element.addEventListener("keydown", (event) => {
    if (event.key === "F2") hands.focusName();
    // A number that is again what it was before is no change to a browser.
    if (event.key === "Enter") grip.end();
    if (event.key !== "Escape") return;
    if (grip.isHolding) {
      event.preventDefault();
      grip.cancel();
      letGo(event.target);
    }
    hands.focus(hands.selected?.key);
  });
  // What was typed before is not taken back with what a finger does now.
  panel.element.addEventListener("pointerdown", () => grip.end(), { capture: true });
  // The browser has taken the finger for something else.
  panel.element.addEventListener("pointercancel", () => grip.cancel());
  panel.element.addEventListener("beforeinput", takeComma);
  panel.onTuned = ({ path, decimals }, value) => grip.change([{ path, value, decimals }]);
  panel.name.onName = (name) => hands.rename(name);
  panel.name.onLeave = () => boxes.focus(hands.selected?.key);
  panel.onSide = (side, mm) => grip.setSide(side, mm);
  panel.onEnd = () => grip.end();
  panel.onText = () => hands.showText();
  panel.onPlayOnce = () => hands.playOnce();
  panel.onDuplicate = () => hands.duplicate();
  panel.onDelete = () => hands.delete();
  panel.onClose = () => hands.focus(undefined);
  panel.onAdd = (name) => hands.add(name);
  panel.onPicture = () => hands.onPicture();
}

/**
 * A comma in a number is a point. Browsers leave it out, which makes the number ten times as large.
 * @param {InputEvent} event
 */
function takeComma(event) {
  const { target, data, cancelable } = event;
  const isNumber = target instanceof HTMLInputElement && target.type === "number";
  if (!isNumber || !cancelable || !data?.includes(",")) return;
  event.preventDefault();
  // A field of a number has no selection that a script could replace.
  document.execCommand("insertText", false, data.replaceAll(",", "."));
}

/**
 * A slider that is dragged follows the pointer no more.
 * @param {EventTarget | null} target
 */
function letGo(target) {
  if (!isSlider(target)) return;
  target.disabled = true;
  target.disabled = false;
}
