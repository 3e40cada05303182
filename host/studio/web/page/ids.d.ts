// The elements of index.html that are more than an HTMLElement, by their ids.

export type Ids = {
  [id in
    | "open-gallery" | "new" | "open-files" | "save" | "share" | "undo" | "redo" | "arm" | "clear-fault" | "stop"
    | "open-board" | "open-about" | "theme" | "real-size" | "replay" | "pause" | "save-csv" | "save-png"
    | "tab-pictures" | "use-simulator" | "use-serial" | "size-done" | "empty-scene" | "choose-files" | "toggle-sound"
    | "keep-version" | "start-comparison" | "mode-feel" | "mode-edit" | "hear" | "first-dismiss" | "open-lag"]: HTMLButtonElement;
} & { [id in "files" | "names" | "drag" | "pressure" | "loop" | "prediction" | "scene-name" | "volume" | "layer-name" | "card-width" | "link"]: HTMLInputElement } & {
  [id in "finger" | "screen" | "touch" | "look" | "mockup" | "slowness"]: HTMLSelectElement;
} & { [id in "gallery" | "new-scene" | "open" | "about" | "size" | "board-dialog"]: HTMLDialogElement } & {
  [id in "map-picture" | "map-finger"]: HTMLCanvasElement;
} & {
  "felt-layers": HTMLTableElement;
};
