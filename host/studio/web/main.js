// The studio's page: makes its parts and tells each what the others found out.

import { createEngine } from "./engine/engine.js";
import { zipOf } from "./page/archive.js";
import { Board } from "./page/board.js";
import { fingerNames, sceneText, schema } from "./page/bundled.js";
import { Compare } from "./page/compare.js";
import { attempt, byId, download, element, notify } from "./page/dom.js";
import { Editor } from "./page/editor.js";
import { Finger } from "./page/finger.js";
import { Gallery } from "./page/gallery.js";
import { Incoming } from "./page/incoming.js";
import { Layers } from "./page/layers.js";
import { FrictionMap } from "./page/map.js";
import { Numbers } from "./page/numbers.js";
import { showPictures } from "./page/pictures.js";
import { Player } from "./page/player.js";
import { showCheck } from "./page/problems.js";
import { Profiles } from "./page/profiles.js";
import { Project } from "./page/project.js";
import { RealSize } from "./page/real_size.js";
import { Samples } from "./page/samples.js";
import { Scope } from "./page/scope.js";
import { isLink, linkOf, sceneOf } from "./page/share.js";
import { Sound } from "./page/sound.js";
import { makeTabs } from "./page/tabs.js";
import { makeTheme } from "./page/theme.js";
import { makeView } from "./page/view.js";

const FIRST_SCENE = "brick";

async function start() {
  const project = new Project();
  const engine = await createEngine();
  engine.onFailure = ({ error }) =>
    notify(`The simulator has failed: ${error}. Reload the page; save the scene first.`);
  const player = new Player(engine, project);
  const editor = new Editor(byId("editor"), await schema(), (text) => {
    compare.cancel();
    player.later(text);
  });
  const map = new FrictionMap();
  const finger = new Finger(engine, map);
  const samples = new Samples();
  const scope = new Scope(samples);
  const numbers = new Numbers();
  const sound = new Sound();
  const layers = new Layers(engine, editor);
  const board = new Board(engine);
  const gallery = new Gallery(engine);
  const incoming = new Incoming();
  const compare = new Compare(player, editor);
  const replay = () => player.now(editor.text);
  const profiles = new Profiles(project, fingerNames(), replay);
  new RealSize(map);
  makeTabs(document.querySelector('[role="tablist"]'));
  makeTheme(() => {
    map.draw();
    scope.restyle();
  });
  makeView({ map, finger, scope, engine });

  let reach = { naturalN: 0.25, lowN: 0.25, highN: 0.38 };
  player.onCheck = (check, text) => {
    if (compare.isRunning) return;
    showCheck(check, editor);
    if (!check.ok) return;
    check.text = text;
    reach = check;
  };
  player.onPlay = () => {
    layers.reset();
    if (!compare.isRunning) layers.show(reach);
  };
  player.onMap = (picture, check) => {
    if (!compare.isRunning) map.show(picture, check);
  };
  player.onFailure = notify;

  engine.onFrames = (frame) => {
    samples.add(frame);
    numbers.feel(frame, reach.naturalN);
    finger.feel(frame, reach);
  };
  engine.onAudio = (change, _tick, slowness) => sound.feel(change, slowness);
  finger.onDown = () => {
    byId("map-hint").hidden = true;
    byId("replay").disabled = false;
    if (scope.isPaused) scope.pause(false);
  };
  board.onBoard = replay;

  /** Opens a scene from elsewhere: a real board is disarmed before. */
  async function open({ name, text, files = [], profiles: chosen }) {
    await board.disarmBeforeForeignScene();
    project.files.clear();
    for (const [file, content] of files) project.files.set(file, content);
    project.name = name;
    byId("scene-name").textContent = `${name}.toml`;
    document.title = `${name} · frixel studio`;
    if (chosen) profiles.choose(chosen);
    showPictures(project, editor, removePicture);
    if (editor.text === text) player.now(text);
    else editor.text = text;
  }

  function removePicture(name) {
    project.files.delete(name);
    showPictures(project, editor, removePicture);
    replay();
  }

  gallery.onScene = (name, text) => open({ name, text });
  gallery.onLayer = (text) => editor.append(text);
  incoming.onFiles = async ({ scene, files, finger: own, screen }) => {
    await board.disarmBeforeForeignScene();
    project.files.clear();
    for (const [name, content] of files) project.files.set(name, content);
    if (own) profiles.addFinger(own);
    if (screen) profiles.addScreen(screen);
    if (scene) await open(scene);
    else replay();
    showPictures(project, editor, removePicture);
    if (files.length > 0) byId("tab-pictures").click();
  };

  byId("open-gallery").onclick = () => attempt(() => gallery.open());
  byId("undo").onclick = () => editor.undo();
  byId("redo").onclick = () => editor.redo();
  byId("save").onclick = () => {
    const content = { name: project.name, text: editor.text, files: project.files, profiles: project.profiles };
    download(`${project.name}.zip`, zipOf(content), "application/zip");
  };
  byId("share").onclick = () =>
    attempt(async () => {
      const files = project.ownFilesFor(editor.text).map((name) => [name, project.files.get(name)]);
      const link = linkOf(project.name, editor.text, files);
      history.replaceState(null, "", new URL(link).hash);
      await navigator.clipboard.writeText(link).then(
        () => notify("The link is copied: it holds the whole scene, nothing is uploaded."),
        () =>
          notify(
            "The link stands in the address line: copy it from there. It holds the whole scene, nothing is uploaded.",
          ),
      );
    });

  const openLink = () => isLink(location.hash) && attempt(() => open(sceneOf(location.hash)));
  addEventListener("hashchange", openLink);
  await open({ name: FIRST_SCENE, text: await sceneText(FIRST_SCENE) });
  openLink();
  // The tests look at the page's parts through this.
  globalThis.studioPage = { engine, editor, sound, samples, map, player };
}

start().catch((error) => {
  document
    .querySelector("main")
    .replaceChildren(element("p", { className: "card" }, `The studio cannot start: ${error.message}`));
});
