// The elements of index.html that are more than an HTMLElement, by their ids.

export type Ids = {
  [id in
    | "open-gallery" | "new" | "open-files" | "save" | "share" | "undo" | "redo" | "arm" | "clear-fault" | "stop"
    | "open-board" | "open-about" | "theme" | "real-size" | "replay" | "pause" | "save-csv" | "save-png"
    | "tab-pictures" | "hear" | "first-dismiss" | "open-lag"]: HTMLButtonElement;
} & { [id in "files" | "names" | "drag" | "pressure" | "loop" | "prediction" | "scene-name"]: HTMLInputElement } & {
  [id in "finger" | "screen" | "touch" | "look" | "mockup" | "slowness"]: HTMLSelectElement;
} & { [id in "gallery" | "new-scene" | "open" | "about" | "size" | "board-dialog"]: HTMLDialogElement } & {
  [id in "map-picture" | "map-finger"]: HTMLCanvasElement;
};
