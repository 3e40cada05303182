// The worker of the host of a board outside of the page: what the page asks of it. remote_board.js talks to the board.
// @ts-check
"use strict";

/** @type {RemoteBoard | null} */
let board = null;

function connected() {
  if (!board) throw new Error("no board is connected: connect one, or use the simulator");
  return board;
}

async function disconnect() {
  const leaving = board;
  board = null;
  if (leaving) await leaving.disconnect();
  return {};
}

serve({
  start(message) {
    compiled = message.module;
    return {};
  },

  async connect({ port }) {
    await disconnect();
    const reached = await RemoteBoard.connect(port);
    reached.onLost = () => {
      if (board === reached) board = null;
    };
    board = reached;
    reached.report();
    return {};
  },
  disconnect,

  play: ({ scene }) => connected().play(scene),
  arm: () => connected().arm(),
  // Without a board there is nothing to stop.
  stop: () => board?.stop(),
  forget: () => board?.forget(),
  control: ({ line }) => connected().control(line),
  clearFault: () => connected().clearFault(),

  alive() {
    lastLifeMs = epochMs();
    changed.give();
  },
  gone() {
    lastLifeMs = -Infinity;
    // The board need not wait for its host timeout. If this fails, the page has been told.
    board?.stop().catch(() => {});
  },
});
