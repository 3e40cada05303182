// What the page has besides the browser's own: boot.js, the tests, and what TypeScript's libraries do not know yet.

declare global {
  /** boot.js: the files that the page carries. */
  var studio: {
    bytes: (name: string) => Promise<Uint8Array<ArrayBuffer>>;
    text: (name: string) => Promise<string>;
    names: (start?: string) => string[];
    moduleUrl: (name: string) => Promise<string>;
    /** What a content security policy must allow, a sentence. */
    policy: string;
  };
  /** The clock of a test, in place of the machine's. */
  var studioClock: import("./clock.js").Clock | undefined;
  /** The parts of the page, for the tests. */
  var studioPage: object;

  interface Navigator {
    serial: { requestPort: () => Promise<SerialPort> };
  }
  /** Of Web Serial, what the page uses. */
  interface SerialPort {
    readable: ReadableStream<Uint8Array<ArrayBuffer>>;
    writable: WritableStream<Uint8Array<ArrayBuffer>>;
    open: (options: { baudRate: number; bufferSize: number }) => Promise<void>;
    close: () => Promise<void>;
  }

  /** JSPI. */
  namespace WebAssembly {
    var Suspending: new (act: (...numbers: number[]) => Promise<number>) => ImportValue;
    function promising(act: Function): (...numbers: number[]) => Promise<number>;
  }

  /** The globals of an audio worklet, for page/sound_processor.js. */
  class AudioWorkletProcessor {
    readonly port: MessagePort;
  }
  function registerProcessor(name: string, processor: new () => AudioWorkletProcessor): void;
  var sampleRate: number;
}

export {};
