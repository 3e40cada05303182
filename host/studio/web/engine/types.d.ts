// The contract of README.md as types: what the page asks of the engine, and what page and workers tell each other.

/** Files by the names that scenes use: texts, or bytes. */
export type Files = Record<string, string | Uint8Array<ArrayBuffer>>;
/** A name or TOML text each. */
export type Profiles = { finger?: string; screen?: string; touch?: string };
/** How the simulator in the page plays a scene; a board outside of it plays as the scene says. */
export type PlayOptions = { withoutPrediction?: boolean };
/** What identifies a scene for the engine. */
export type Scene = { files: Files; entry: string } & Profiles & PlayOptions;
/** An instance of the module. Answers come at once. */
export type Instance = {
  call: (name: string, input: Uint8Array<ArrayBuffer>) => any;
  callForBytes: (name: string, input: Uint8Array<ArrayBuffer>) => ArrayBuffer;
};
export type MapSize = { widthPx: number; heightPx: number };
/** A scene, and the numbers that some requests have besides. */
export type Request = Scene & Partial<MapSize> & { speedMmPerS?: number };

export type Problem = {
  severity: "error" | "warning";
  message: string;
  file?: string;
  line?: number;
  column?: number;
  endLine?: number;
  endColumn?: number;
  help?: string | null;
};

/** What is felt of a layer: its verdict in words, the step that is felt most surely, and its surest vibration. */
export type Perceived = {
  verdict: string;
  fromN: number;
  toN: number;
  /** Size of the step, as the command prints it. */
  weberSteps: string;
  texture: {
    verdict: string;
    speedMmPerS: number;
    frequencyHz: number;
    amplitudeN: number;
    thresholdN: number | null;
  } | null;
};

export type Layer = {
  index: number;
  name: string;
  kind: string;
  /** A sentence, or "". */
  felt: string;
  /** Null for a layer that is not felt anywhere, and before the scene is judged. */
  perceived: Perceived | null;
  isLive: boolean;
  whyNotLive: string;
  /** Whether it is on when the scene begins to play. */
  startsOn: boolean;
  gain: number;
  gainMin: number;
  gainMax: number;
  /** The gains with which the drive can give all that the layer asks for; null where it is not live, or with none. */
  gainReach: [number, number] | null;
  /** Names of its copies in control lines. */
  controls: string[];
  file?: string;
  /** First and last line. */
  from: [number, number];
  /** Left, top, width, height of its region, or of the picture that it shows; null for the whole screen. */
  boxMm: [number, number, number, number] | null;
};

/** `pixelMm` are the sides of a pixel of the scene's design, if it has one. */
export type Screen = { widthMm: number; heightMm: number; pixelMm?: [number, number] | null };
/** Friction at no voltage, and the least and the largest that can be reached, N. */
export type Reach = { naturalN: number; lowN: number; highN: number };

/** A scene without mistakes, or a draft. */
export type Checked = Reach & {
  isDraft: boolean;
  screen: Screen;
  /** The lines of `frixel check`, each a name and a text. */
  report: [string, string][];
  reachN: number;
  layers: Layer[];
  /** Defaults of the layers in each file, by its name; an argument of `read_text`. */
  defaults: Record<string, string>;
};
export type Mistaken = { ok: false; isDraft?: false; report?: undefined; problems: Problem[] };
export type Check = ({ ok: boolean; problems: Problem[] } & Checked) | Mistaken;

/** The files that the compiler reads for a text, and what the text is. */
export type UsedFiles = { names: string[]; isWhole: boolean; kind: "scene" | keyof Profiles };

export type FrictionField = MapSize & {
  /** Of each pixel, row after row from the top left. */
  frictionN: Float32Array;
  /** 1 above, -1 below, 0 within. */
  outOfReach: Int8Array;
  /** Reach, N. */
  lowN: number;
  highN: number;
};

/** The columns of a frame, which the module names (host/studio/src/felt.rs): one value for each sample. */
export type Column =
  | "xMm"
  | "yMm"
  | "speedMmPerS"
  | "referenceN"
  | "feltN"
  | "voltageV"
  | "predictedXMm"
  | "predictedYMm"
  | "reportedXMm"
  | "reportedYMm"
  | "contactRadiusMm";
export type Columns = Record<Column, Float32Array>;
/** What a worker reports of some time of the board. */
export type WorkerFrame = Columns & {
  tick: number;
  firstTick: number;
  ticksPerSample: number;
  /** Ticks of the board a second. */
  tickHz: number;
  contact: boolean;
  delayMs: number;
  slowness: number;
  simulated: boolean;
};
export type Frame = WorkerFrame & { state: BoardState };

export type BoardState = "disarmed" | "armed" | "active" | "faulted";
/** What a board reports of itself. */
export type Reported = { state: BoardState; fault?: string | null };
export type State = {
  link: "simulator" | "serial" | "none";
  state: BoardState;
  fault?: string;
  needsArm: boolean;
  driving: string;
};

/** `epochMs` is the time of the event since 1970. */
export type PointerSample = { epochMs: number; xMm: number; yMm: number; down: boolean; loadN?: number };

type Nothing = Record<string, never>;
/** Answer of an instance of the module to a control line: what is clamped now, or null. */
export type Notice = { notice: string | null };

/** The questions to the workers, by type: what is asked with them, and the answer. */
export type Questions = {
  start: { asked: { module: WebAssembly.Module; seed?: number }; answer: Nothing };
  /** The time that a test's clock shows. */
  time: { asked: { epochMs: number }; answer: Nothing };
  check: { asked: { scene: Request }; answer: Check };
  compile: { asked: { scene: Request }; answer: Check };
  usedFiles: { asked: { scene: Request }; answer: UsedFiles };
  picture: { asked: { bytes: Uint8Array<ArrayBuffer> }; answer: { aspect: number } };
  map: { asked: { scene: Request }; answer: FrictionField };
  play: { asked: { scene: Request }; answer: unknown };
  control: { asked: { line: string }; answer: Notice };
  stop: { asked: object; answer: unknown };
  resume: { asked: object; answer: unknown };
  replay: { asked: { slowness: number }; answer: { isWhole: boolean } };
  endReplay: { asked: object; answer: unknown };
  connect: { asked: { port: MessagePort }; answer: unknown };
  disconnect: { asked: object; answer: unknown };
  arm: { asked: object; answer: unknown };
  forget: { asked: object; answer: unknown };
  clearFault: { asked: object; answer: unknown };
};
/** A question with its type. */
export type Question = { [Type in keyof Questions]: { type: Type } & Questions[Type]["asked"] }[keyof Questions];

/** What needs no answer. */
export type Note = { type: "alive" | "gone" | "lift" } | { type: "pointer"; sample: PointerSample };
/** A scene on its way to a worker: with the files that have changed, and the names of those that it has. */
export type SentScene = Request & { kept: string[] };
/** What the page sends to a worker; `id` is that of the answer, and a scene is a `SentScene`. */
export type ToWorker = (Question & { id: number }) | Note;

export type Answer = {
  type: "answer";
  id: number;
  value?: unknown;
  error?: string;
  problems?: Problem[];
  canLoadAgain?: boolean;
};
export type Failure = { type: "failure"; error: string };
export type FrameMessage = { type: "frame"; frame: WorkerFrame };
/** Unsolicited messages of the workers. */
export type FromBoard =
  | Failure
  | (FrameMessage & { sound: Float32Array; soundTick: number })
  | ({ type: "state" } & Reported)
  | { type: "pace"; pace: number };
export type FromHost =
  | Failure
  | FrameMessage
  | ({ type: "state"; needsArm: boolean; driving: string } & Reported)
  | { type: "lost"; error: string };
/** The only unsolicited message of the compiler's worker: its failure. */
export type FromChecker = Failure;
export type FromWorker = FromBoard | FromHost;

/** The actions of a worker, by the type of the message that calls for them. */
export type Actions = {
  [Type in keyof Questions]?: (
    message: Questions[Type]["asked"],
  ) => Questions[Type]["answer"] | Promise<Questions[Type]["answer"]>;
} & { alive?: () => void; gone?: () => void; lift?: () => void; pointer?: (message: { sample: PointerSample }) => void };

/** A line to a board outside of the page. */
export type Line = {
  /** The end for the host's worker. */
  remote: MessagePort;
  close: () => void;
  /** Resolves once the line can be opened again, whichever end has closed it. */
  closed: Promise<void>;
};

/** The error of a question that a worker refused. */
export type EngineFailure = Error & { problems: Problem[]; canLoadAgain: boolean };
