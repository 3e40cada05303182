// What the mode Edit shows: a box over the map for each layer, and the panel of the layer that is selected.
// @ts-check

import { byId, element, lay } from "./dom.js";
import { LayerBoxes } from "./layer_boxes.js";
import { layerChoices, layerNumbers, repeatNumbers } from "./layer_numbers.js";
import { LayerPanel } from "./layer_panel.js";
import { PanelCover } from "./panel_cover.js";

/** @import { Schema } from "./completion.js" */
/** @import { EditedLayer, EditedLayers } from "./edited_layers.js" */
/** @import { Hands } from "./hands.js" */
/** @import { Most } from "./layer_numbers.js" */
/** @import { Area, FrictionMap } from "./map.js" */

export class HandsView {
  #map;
  #schema;
  /** The element around the boxes. */
  surface = element("div", { className: "hands", role: "group", tabIndex: -1, hidden: true, "aria-label": "Layers" });
  boxes = new LayerBoxes(this.surface);
  panel;
  #cover;
  /** What can be felt of the scene, as its check said. */
  reach = /** @type {Most} */ ({ naturalN: 0.25, lowN: 0.25, highN: 0.38, reachN: 0.38 });

  /**
   * @param {FrictionMap} map
   * @param {Schema} schema
   * @param {Hands} hands
   */
  constructor(map, schema, hands) {
    this.panel = new LayerPanel(hands);
    this.#map = map;
    this.#schema = schema;
    map.box.append(this.surface);
    this.#cover = new PanelCover(this.panel.element);
  }

  /**
   * Covers the map.
   * @param {Area} area
   */
  cover(area) {
    lay(this.surface, area);
  }

  /**
   * @param {EditedLayers} layers
   * @param {EditedLayer | undefined} selected
   * @param {boolean} isNew Whether another layer is selected.
   */
  draw(layers, selected, isNew) {
    this.boxes.show(layers.all, selected?.key, this.#map.scale);
    // Where there is no layer, the keys lead from the map to what adds one.
    this.surface.tabIndex = layers.all.length > 0 ? -1 : 0;
    if (selected) this.panel.show(selected, this.#tuned(selected, layers), this.reach, isNew);
    else this.panel.showNone(layers.all.length, isNew);
    const { box } = this.#map;
    const around = [byId("numbers"), byId("scope").parentElement ?? box, box.closest(".map-card") ?? box];
    const [numbers, scope, map] = around.map((each) => each.getBoundingClientRect());
    this.panel.place(numbers, scope, map);
    this.#cover.update();
  }

  /**
   * @param {EditedLayer} selected
   * @param {EditedLayers} layers
   */
  #tuned(selected, { screen }) {
    const { toml, at, layer } = selected;
    if (!toml || at === undefined) return [];
    return [
      ...layerChoices(this.#schema, toml, at, layer.kind),
      ...layerNumbers(this.#schema, toml, at, layer.kind, this.reach),
      ...repeatNumbers(selected, screen),
    ];
  }

  /** Gives the focus to a layer, or to what is around the layers. @param {string | undefined} key */
  focus(key) {
    if (key === undefined) this.surface.focus({ preventScroll: true });
    else this.boxes.focus(key);
  }
}
