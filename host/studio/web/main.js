// The studio's page: makes its parts and connects them.
// @ts-check

import { createEngine } from "./engine/engine.js";
import { makeAbout } from "./page/about.js";
import { followLinks, makeBar, openLink } from "./page/bar.js";
import { Board } from "./page/board.js";
import { fingerNames, sceneText, schema } from "./page/bundled.js";
import { Compare } from "./page/compare.js";
import { followCloses } from "./page/dialogs.js";
import { byId, element, sentenceOf } from "./page/dom.js";
import { Drawer } from "./page/drawer.js";
import { Editor } from "./page/editor.js";
import { showFelt } from "./page/felt.js";
import { FileTabs } from "./page/file_tabs.js";
import { Finger } from "./page/finger.js";
import { Gallery } from "./page/gallery.js";
import { Ghost } from "./page/ghost.js";
import { Hands } from "./page/hands.js";
import { Incoming } from "./page/incoming.js";
import { Lag } from "./page/lag.js";
import { Layers } from "./page/layers.js";
import { Lens } from "./page/lens.js";
import { NewScene } from "./page/new_scene.js";
import { attempt, followPresses, notify } from "./page/notices.js";
import { Numbers } from "./page/numbers.js";
import { OpenScene } from "./page/open_scene.js";
import { beginWithPicture, choosePicture } from "./page/own_picture.js";
import { Player, isPlayable } from "./page/player.js";
import { showCheck, showOutcome, showStatus } from "./page/problems.js";
import { Profiles } from "./page/profiles.js";
import { Project } from "./page/project.js";
import { RealSize } from "./page/real_size.js";
import { makeMap } from "./page/room.js";
import { Samples } from "./page/samples.js";
import { Scope } from "./page/scope.js";
import { keepSite } from "./page/site.js";
import { guardSliders } from "./page/slider_touch.js";
import { Sound } from "./page/sound.js";
import { makeTabs } from "./page/tabs.js";
import { makeTheme } from "./page/theme.js";
import { editWith, perception } from "./page/toml_text.js";
import { makeView } from "./page/view.js";
import { Works } from "./page/works.js";

/** @import { Engine } from "./engine/engine.js" */
/** @import { Checked, Reach } from "./engine/types" */
/** @import { FrictionMap } from "./page/map.js" */
/** @typedef {Awaited<ReturnType<typeof makeParts>>} Parts */

const FIRST_SCENE = "brick";

async function start() {
  const laid = { map: makeMap(), numbers: new Numbers() };
  const engine = await createEngine();
  const instance = await engine.instance();
  editWith(instance);
  laid.numbers.know(perception());
  engine.onFailure = ({ error }) =>
    notify(`The studio has failed: ${error}. Save the scene, then reload the page; a board disarms itself.`);
  followPresses();
  followCloses();
  guardSliders();
  const parts = await makeParts(engine, laid);
  const scene = new OpenScene(parts);
  makeControls(parts);
  makeBar({ ...parts, scene });
  showWhatPlays(parts, scene);
  showWhatIsFelt(parts);
  takeScenes(parts, scene);
  followLinks(scene);
  const last = await scene.autosave.last();
  const first = { name: FIRST_SCENE, text: await sceneText(FIRST_SCENE), files: [] };
  await scene.open(last ?? first).catch(async (error) => {
    if (!last) throw error;
    // What the browser keeps stays under Open.
    await scene.open(first);
    notify(sentenceOf(error));
  });
  // A reload keeps what was changed since the link was opened.
  const [navigation] = performance.getEntriesByType("navigation");
  const isReload = navigation instanceof PerformanceNavigationTiming && navigation.type === "reload";
  if (!(isReload && last)) openLink(scene);
  const { editor, sound, samples, map, player, ghost } = parts;
  ghost.start();
  keepSite();
  // The tests look at the page's parts through this.
  globalThis.studioPage = { engine, editor, sound, samples, map, player };
}

/**
 * @param {Engine} engine
 * @param {{ map: FrictionMap, numbers: Numbers }} laid
 */
async function makeParts(engine, { map, numbers }) {
  const project = new Project(engine);
  const player = new Player(engine, project);
  const sceneSchema = await schema();
  const editor = new Editor(byId("editor"), sceneSchema);
  const samples = new Samples();
  const sound = new Sound();
  const finger = new Finger(engine, map, byId("map-finger"));
  return {
    engine,
    project,
    player,
    editor,
    map,
    samples,
    sound,
    works: new Works(),
    finger,
    lag: new Lag({ engine, map, finger, project, player }),
    lens: new Lens({ map, finger }),
    ghost: new Ghost({ engine, map, finger, sound }),
    hands: new Hands({ map, editor, player, project }, sceneSchema),
    scope: new Scope(samples, byId("scope")),
    numbers,
    layers: new Layers(engine, editor),
    board: new Board(engine),
    gallery: new Gallery(engine),
    compare: new Compare(player, editor, sound),
    profiles: new Profiles(project, fingerNames()),
    /** What can be felt of the scene that plays, as its check said. */
    reach: /** @type {Reach} */ ({ naturalN: 0.25, lowN: 0.25, highN: 0.38 }),
    /** Whether there was a stroke. */
    hasSlid: false,
  };
}

/**
 * What needs nothing but the parts that it controls.
 * @param {Parts} parts
 */
function makeControls({ engine, project, editor, map, finger, scope, compare, ghost, hands, layers }) {
  const drawer = new Drawer();
  editor.onReveal = () => drawer.open();
  new FileTabs(editor, project);
  new RealSize(map);
  makeAbout();
  makeTabs(byId("tools"));
  makeTheme(() => {
    map.draw();
    scope.restyle();
  });
  makeView({ map, finger, scope, engine });
  compare.onChange = () => {
    // Outlines and numbers would say which version is felt.
    hands.mode.set(false);
    if (compare.isRunning) attempt(() => engine.endReplay());
    map.draw();
    ghost.wake();
  };
  hands.onEdit = () => ghost.handOver();
  hands.onPlayOnce = layers.onPlayOnce = (layer) =>
    attempt(async () => {
      const { widthMm, heightMm } = map.screen;
      const [x, y, width, height] = layer.boxMm ?? [0, 0, widthMm, heightMm];
      await ghost.slideOnce({ x, y, width, height });
      await layers.playOnce(layer);
    });
}

/**
 * Shows the outcome of each version of the scene: its mistakes, its map, and whether it plays.
 * @param {Parts} parts
 * @param {OpenScene} scene
 */
function showWhatPlays(parts, scene) {
  const { project, player, editor, map, scope, layers, board, compare, lag, ghost, hands } = parts;
  const hint = byId("map-hint");
  /** @type {Checked | undefined} */
  let shown;
  /** The scene whose strokes the scope has, as `Project.opened` counts. */
  let felt = project.opened;
  player.onCheck = (check, files) => {
    if (compare.isRunning) return;
    showCheck(check, editor);
    if (isPlayable(check)) {
      parts.reach = check;
      project.screen = check.screen;
      showFelt(check);
      scope.isDraft = check.isDraft;
      shown = check;
      hands.show(check, files);
    } else {
      hands.showMistakes(check.problems);
      if (!shown) hint.textContent = "nothing to feel yet: mend the mistake under the text";
    }
  };
  player.onPlay = () => {
    layers.reset();
    if (felt !== project.opened) scope.clear();
    felt = project.opened;
    lag.played();
  };
  layers.onLive = (changes) => {
    const note = byId("map-note");
    note.hidden = changes.length === 0;
    note.textContent = `The map shows the scene as it is written. Now: ${changes.join(", ")}.`;
  };
  player.onMap = (picture, check) => {
    if (!parts.hasSlid) hint.textContent = "press and slide: the trail is thick where friction is high";
    // The words of the first visit say the same.
    hint.hidden ||= !byId("first-words").hidden;
    if (compare.isRunning) return;
    map.show(picture, check);
    ghost.wake();
    if (player.status === "loaded") map.markStale(undefined);
    // While a hand moves layers, the next map is about to come.
    if (player.isHeld) return;
    const { opened } = project;
    map.thumbnail().then((thumbnail) => project.opened === opened && scene.autosave.show(thumbnail));
  };
  player.onFailure = (sentence) => {
    map.markStale("older");
    notify(sentence, undefined, { beside: byId("check") });
  };
  player.onStatus = (status) => {
    board.allowArm(status);
    layers.isSceneLoading = status === "loading";
    showStatus(status);
    if (status === "loaded" && !compare.isRunning && shown) layers.show(shown.layers, shown);
    if (status === "mistaken" || status === "failed") lag.failed();
    // A blind comparison shows no map. What is loaded has its map once that is drawn.
    if (compare.isRunning || status === "loaded") return;
    map.markStale(status === "loading" ? "drawing" : "older");
  };
  layers.onChoose = ({ index }) => hands.choose(index);
  lag.onChange = () => scene.replay();
  board.onBoard = () => {
    lag.forgetStroke();
    byId("replay").disabled = true;
    scene.replay();
  };
}

/**
 * Shows what the finger feels, and lets it be heard.
 * @param {Parts} parts
 */
function showWhatIsFelt(parts) {
  const { engine, samples, scope, numbers, finger, ghost, lag, lens, sound, board } = parts;
  const hint = byId("map-hint");
  engine.onFrames = (frame) => {
    samples.add(frame);
    scope.feel(frame);
    numbers.feel(frame, parts.reach.naturalN);
    finger.feel(frame, parts.reach);
    ghost.feel(frame);
    lag.feel(frame);
    lens.feel(frame, parts.reach);
  };
  const pace = byId("pace");
  engine.onPace = (part) => {
    pace.hidden = part === 1;
    pace.textContent = `This computer plays at ${part} of real time: curves look jagged, and touch drops out.`;
  };
  engine.onAudio = (change, _tick, samplesPerS) => sound.feel(change, samplesPerS);
  finger.onDown = () => {
    parts.hasSlid = true;
    lag.hasStroke = true;
    hint.hidden = board.isPlaying;
    const { link, needsArm } = engine.state;
    const button = link === "simulator" ? "Play" : needsArm && "Arm";
    hint.textContent = button ? `nothing plays: press ${button}, at the top` : "nothing plays";
    byId("replay").disabled = false;
  };
  board.onState = () => {
    showOutcome();
    if (engine.state.link !== "simulator") pace.hidden = true;
    lag.showBoard();
    ghost.showBoard();
    if (parts.hasSlid && board.isPlaying) hint.hidden = true;
  };
}

/**
 * Takes scenes, layers and files from elsewhere.
 * @param {Parts} parts
 * @param {OpenScene} scene
 */
function takeScenes({ engine, project, editor, gallery, hands }, scene) {
  gallery.onScene = (name, text) => scene.open({ name, text, files: [] });
  const begin = new NewScene(engine);
  begin.onScene = (name, text) => hands.editNext(() => scene.open({ name, text, files: [] }));
  begin.onPicture = () => attempt(() => beginWithPicture(engine, scene, hands, project));
  hands.onPicture = () =>
    attempt(async () => {
      if (!hands.canEdit()) return;
      const picture = await choosePicture(engine);
      if (picture) hands.addPicture(await scene.takePicture(picture), picture.aspect);
    });
  hands.onAdd = (add) => attempt(() => scene.add(add));
  scene.onAppend = () => hands.selectLastAfterCheck();
  gallery.onLayer = (text) => scene.append(text);
  const incoming = new Incoming(engine, async () => {
    const { names } = await engine.usedFiles(await project.filesFor(editor.text), project.entry);
    return names;
  });
  incoming.onFiles = (found) => scene.take(found);
}

start().catch((error) => {
  const why = element("p", { className: "card" }, `The studio cannot start: ${sentenceOf(error)}`);
  document.querySelector("main")?.replaceChildren(why);
});
