// Presses and drags on the map while it is edited: which layer they select, and where they move or resize it to.
// @ts-check

import { shortName } from "./dom.js";
import { areaOf } from "./edited_layers.js";
import { SIDE_MIN_MM, bounds, clamp } from "./place.js";

/** @import { Screen } from "../engine/types" */
/** @import { EditedLayer, EditedLayers } from "./edited_layers.js" */
/** @import { Hands } from "./hands.js" */
/** @import { FrictionMap } from "./map.js" */
/** @import { Box, Place, Side } from "./place.js" */
/** @typedef {{ xMm: number, yMm: number }} Point */
/** @typedef {{ x: [number, number], y: [number, number] }} Room Where the first copy can be, mm. */
/**
 * A press that has not been lifted: where it began, and what it dragged from there.
 * @typedef {{ pointerId: number, start: Point, clientX: number, clientY: number, handle: string | undefined,
 *   place: Place | undefined, hasMoved: boolean }} Press
 */

/** A press that moves less is a click, CSS pixels. */
const CLICK_PX = 4;
/** A finger that presses the same place again is so near, CSS pixels. */
const FINGER_PX = 24;
/** How far from a layer's edge a press still selects it, CSS pixels. */
const NEAR_PX = 8;
/** Sides that a hand drags come to rest on multiples of this, mm. */
const GRID_MM = 0.5;
const FINE_GRID_MM = 0.1;
const TYPED_GRID_MM = 0.01;

export class HandDrag {
  #surface;
  #hands;
  #layers;
  #map;
  /** @type {Press | undefined} */
  #press;
  /** What was selected before each of the last two presses, by key. @type {(string | undefined)[]} */
  #before = [];
  /**
   * Where in the window a larger layer was taken.
   * @type {{ clientX: number, clientY: number } | undefined}
   */
  #larger;

  /**
   * @param {Hands} hands
   * @param {EditedLayers} layers
   * @param {FrictionMap} map
   */
  constructor(hands, layers, map) {
    const { surface } = hands.view;
    this.#surface = surface;
    this.#hands = hands;
    this.#layers = layers;
    this.#map = map;
    surface.addEventListener("pointerdown", (event) => this.#down(event));
    surface.addEventListener("pointermove", (event) => this.#move(event));
    surface.addEventListener("pointerup", (event) => this.#up(event));
    surface.addEventListener("pointercancel", (event) => this.#up(event));
    surface.addEventListener("dblclick", (event) => {
      // The first of both clicks may have selected it.
      if (this.#before[0] === hands.selected?.key) this.#takeLarger(event);
    });
    surface.addEventListener("pointerleave", () => hands.view.boxes.mark(undefined));
    // On a tablet that is turned the finger is elsewhere on the map: the drag is taken back, and goes no further.
    addEventListener("resize", () => {
      if (!this.#press) return;
      this.#press.hasMoved = true;
      hands.grip.cancel();
    });
  }

  /**
   * @param {MouseEvent} event
   * @returns {Point}
   */
  #at({ clientX, clientY }) {
    const { left, top } = this.#surface.getBoundingClientRect();
    return { xMm: (clientX - left) / this.#map.scale, yMm: (clientY - top) / this.#map.scale };
  }

  /** @param {Point} point */
  #under({ xMm, yMm }) {
    return this.#layers.under(xMm, yMm, NEAR_PX / this.#map.scale);
  }

  /** @param {PointerEvent} event */
  #down(event) {
    if (event.button !== 0 || this.#press) return;
    // The focus goes to the layer, below.
    event.preventDefault();
    const { clientX, clientY, pointerId, target } = event;
    // A pointer that a test makes cannot be captured.
    if (event.isTrusted) this.#surface.setPointerCapture(pointerId);
    const handle = target instanceof HTMLElement ? target.dataset.side : undefined;
    const start = this.#at(event);
    const found = this.#under(start);
    const selected = this.#hands.selected;
    this.#before = handle ? [] : [this.#before[1], selected?.key];
    const isKept = handle !== undefined || this.#isKept(selected, found, event);
    if (!isKept) this.#larger = undefined;
    this.#hands.focus(isKept ? selected?.key : found[0]?.key);
    this.#press = { pointerId, start, clientX, clientY, handle, place: undefined, hasMoved: false };
    this.#hands.isPressed = true;
  }

  /**
   * Whether what is selected stays so at a press, which may begin to drag it: where no smaller layer is, where it was
   * taken in place of a smaller one, and with Alt.
   * @param {EditedLayer | undefined} selected
   * @param {EditedLayer[]} found The layers there.
   * @param {PointerEvent} press
   */
  #isKept(selected, found, press) {
    if (!selected || !found.includes(selected)) return false;
    const againPx = press.pointerType === "mouse" ? CLICK_PX : FINGER_PX;
    const isThere = this.#larger !== undefined && isNear(this.#larger, press, againPx);
    return press.altKey || isThere || areaOf(selected) <= areaOf(found[0]);
  }

  /** @param {PointerEvent} event */
  #move(event) {
    const press = this.#press;
    if (!press) {
      this.#hands.view.boxes.mark(this.#under(this.#at(event))[0]?.key);
      return;
    }
    if (event.pointerId !== press.pointerId) return;
    if (!press.hasMoved && isNear(press, event, CLICK_PX)) return;
    if (!press.hasMoved) press.place = this.#hands.grip.begin()?.place;
    press.hasMoved = true;
    // What was taken back by a key, or whose text has gone, is not dragged on.
    if (this.#hands.grip.isHolding) this.#drag(press, this.#at(event), event);
  }

  /**
   * With Alt or Ctrl sides rest anywhere, with Shift a layer moves along one axis, and a corner keeps its sides' ratio.
   * @param {Press} press
   * @param {Point} point
   * @param {PointerEvent} keys
   */
  #drag({ place, start, handle }, { xMm, yMm }, { altKey, ctrlKey, metaKey, shiftKey }) {
    if (!place) return;
    const grid = altKey || ctrlKey || metaKey ? FINE_GRID_MM : GRID_MM;
    let [dx, dy] = [xMm - start.xMm, yMm - start.yMm];
    if (shiftKey && !handle) [dx, dy] = Math.abs(dx) >= Math.abs(dy) ? [dx, 0] : [0, dy];
    const { box } = place;
    const keepsRatio = place.keepsRatio || (shiftKey && handle?.length === 2);
    if (handle) this.#hands.grip.resize(resized({ ...place, keepsRatio }, handle, dx, dy, this.#layers.screen, grid));
    else if (place.isWholeScreen) this.#hands.grip.move(snapped(dx, grid), snapped(dy, grid));
    else {
      const { widthMm, heightMm } = this.#layers.screen;
      const all = bounds(box, place.copies);
      const left = clamp(snapped(box.x + dx, grid), box.x - all.x, widthMm - all.x - all.width + box.x);
      const top = clamp(snapped(box.y + dy, grid), box.y - all.y, heightMm - all.y - all.height + box.y);
      this.#hands.grip.move(left - box.x, top - box.y);
    }
  }

  /** @param {PointerEvent} event */
  #up(event) {
    const press = this.#press;
    if (!press || event.pointerId !== press.pointerId) return;
    this.#press = undefined;
    this.#hands.isPressed = false;
    if (event.type === "pointercancel") this.#hands.grip.cancel();
    else if (!press.hasMoved && !press.handle && event.altKey) this.#takeLarger(event);
    this.#hands.grip.end();
  }

  /**
   * Selects the next larger layer here than the one that is selected; after the largest, the smallest.
   * @param {MouseEvent} event
   */
  #takeLarger(event) {
    const found = this.#under(this.#at(event));
    const { selected } = this.#hands;
    const at = found.findIndex(({ key }) => key === selected?.key);
    const next = found[(at + 1) % found.length];
    if (!selected || at < 0 || next.key === selected.key) return;
    this.#hands.focus(next.key);
    this.#larger = { clientX: event.clientX, clientY: event.clientY };
    const where = at + 1 < found.length ? "the next larger one here" : "the smallest here";
    this.#hands.say(`Selected ${shortName(next.layer.name)}, ${where}. Double-click for the next one.`);
  }
}

/**
 * @param {{ clientX: number, clientY: number }} one
 * @param {{ clientX: number, clientY: number }} other
 * @param {number} withinPx
 */
function isNear(one, other, withinPx) {
  return Math.hypot(one.clientX - other.clientX, one.clientY - other.clientY) < withinPx;
}

/**
 * @param {number} mm
 * @param {number} grid
 */
function snapped(mm, grid) {
  return Math.round(mm / grid) * grid;
}

/**
 * The box of a layer whose handle was dragged: the other sides stay, all copies stay on the screen.
 * @param {Place} place
 * @param {string} handle
 * @param {number} dx
 * @param {number} dy
 * @param {Screen} screen
 * @param {number} grid
 */
function resized({ box, copies, keepsRatio }, handle, dx, dy, screen, grid) {
  const all = bounds({ ...box, width: 0, height: 0 }, copies);
  /** @type {Room} */
  const room = {
    x: [box.x - all.x, screen.widthMm - (all.x + all.width - box.x)],
    y: [box.y - all.y, screen.heightMm - (all.y + all.height - box.y)],
  };
  const areX = /** @type {[boolean, boolean]} */ ([handle.includes("w"), handle.includes("e")]);
  const areY = /** @type {[boolean, boolean]} */ ([handle.includes("n"), handle.includes("s")]);
  const [left, right] = dragged([box.x, box.x + box.width], areX, dx, room.x, grid);
  const [top, bottom] = dragged([box.y, box.y + box.height], areY, dy, room.y, grid);
  const made = { x: left, y: top, width: right - left, height: bottom - top };
  return keepsRatio ? inRatio(box, made, handle, room) : made;
}

/**
 * One side of a box, or the other, dragged along an axis.
 * @param {[number, number]} ends
 * @param {[boolean, boolean]} isDragged
 * @param {number} by
 * @param {[number, number]} room
 * @param {number} grid
 * @returns {[number, number]}
 */
function dragged([low, high], [isLow, isHigh], by, [least, most], grid) {
  if (isLow) return [clamp(snapped(low + by, grid), least, high - SIDE_MIN_MM), high];
  if (isHigh) return [low, clamp(snapped(high + by, grid), low + SIDE_MIN_MM, most)];
  return [low, high];
}

/**
 * A box whose sides keep their ratio: the side that was dragged further counts.
 * @param {Box} before
 * @param {Box} made
 * @param {string} handle
 * @param {Room} room
 * @returns {Box}
 */
function inRatio(before, made, handle, room) {
  const ratio = before.height / before.width;
  const widths = [made.width, made.height / ratio];
  const [byWidth, byHeight] = widths.map((width) => Math.abs(width - before.width));
  const most = {
    x: handle.includes("w") ? before.x + before.width - room.x[0] : room.x[1] - before.x,
    y: handle.includes("n") ? before.y + before.height - room.y[0] : room.y[1] - before.y,
  };
  // A picture that is smaller already stays as it is.
  const least = Math.min(before.width, Math.max(SIDE_MIN_MM, SIDE_MIN_MM / ratio));
  const width = clamp(byWidth >= byHeight ? widths[0] : widths[1], least, Math.min(most.x, most.y / ratio));
  const height = width * ratio;
  const x = handle.includes("w") ? before.x + before.width - width : before.x;
  const y = handle.includes("n") ? before.y + before.height - height : before.y;
  return { x, y, width, height };
}

/**
 * A box with one side as typed, as far as the screen goes.
 * @param {Place} place
 * @param {Side} side
 * @param {number} mm
 * @param {Screen} screen
 */
export function withSide(place, side, mm, screen) {
  const { box } = place;
  const handle = { x: "w", y: "n", width: "e", height: "s" }[side];
  const by = mm - box[side];
  return resized(place, handle, by, by, screen, TYPED_GRID_MM);
}
