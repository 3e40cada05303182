// What goes over a line to a board, as far as the tests tell it apart: firmware/wire/PROTOCOL.md.

/** The payloads of frames in pieces of a line, in order; `piece` is the number of the piece that ends the frame. */
export function framesIn(pieces) {
  const frames = [];
  let bytes = [];
  for (const [piece, part] of pieces.entries()) {
    for (const byte of part) {
      bytes.push(byte);
      if (byte !== 0) continue;
      if (bytes.length > 1) frames.push({ payload: payloadOf(bytes), piece });
      bytes = [];
    }
  }
  return frames;
}

/** COBS without the zero byte that ends the frame, and without the four bytes of the CRC. */
function payloadOf(frame) {
  const payload = [];
  const end = frame.length - 1;
  for (let at = 0; at < end; ) {
    const next = at + frame[at];
    payload.push(...frame.slice(at + 1, next));
    if (next < end) payload.push(0);
    at = next;
  }
  return payload.slice(0, -4);
}

const [REQUEST, FROM_BOARD, CHUNK] = [2, 3, 0x80];
const [PING, DISARM] = [0, 6];
const ANSWER = 0;

/** The number at the beginning of these bytes, and the bytes behind it. */
function varint(bytes) {
  const length = bytes.findIndex((byte) => byte < 0x80) + 1;
  const value = bytes.slice(0, length).reduceRight((sum, byte) => 128 * sum + (byte & 0x7f), 0);
  return [value, bytes.slice(length)];
}

/** `{ name: "ping" | "disarm" | "chunk" | "other", sequence }` of what a host sends. */
export function requestIn([first, ...rest]) {
  if (first !== REQUEST) return { name: first >= CHUNK ? "chunk" : "other" };
  const [sequence, [command]] = varint(rest);
  return { name: { [PING]: "ping", [DISARM]: "disarm" }[command] ?? "other", sequence };
}

/** The sequence number that a board answers with these bytes; undefined when they are no answer. */
export function answeredIn([first, message, ...rest]) {
  return first === FROM_BOARD && message === ANSWER ? varint(rest)[0] : undefined;
}
