// The studio's page: makes its parts and tells each what the others found out.

import { createEngine } from "./engine/engine.js";
import { zipOf } from "./page/archive.js";
import { Board } from "./page/board.js";
import { fingerNames, sceneText, schema } from "./page/bundled.js";
import { Compare } from "./page/compare.js";
import { attempt, byId, download, element, notify } from "./page/dom.js";
import { Editor } from "./page/editor.js";
import { FileTabs } from "./page/file_tabs.js";
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
import { Project, isPicture, isToml } from "./page/project.js";
import { RealSize } from "./page/real_size.js";
import { Samples } from "./page/samples.js";
import { Scope } from "./page/scope.js";
import { fragmentIn, isLink, linkOf, sceneOf, whoCanOpen } from "./page/share.js";
import { Sound } from "./page/sound.js";
import { makeTabs } from "./page/tabs.js";
import { makeTheme } from "./page/theme.js";
import { makeView } from "./page/view.js";

const FIRST_SCENE = "brick";

async function start() {
  const engine = await createEngine();
  const project = new Project(engine);
  engine.onFailure = ({ error }) =>
    notify(`The simulator has failed: ${error}. Reload the page; save the scene first.`);
  const player = new Player(engine, project);
  const editor = new Editor(byId("editor"), await schema(), (file, text) => {
    compare.cancel();
    if (file !== undefined) project.files.set(file, text);
    player.later(editor.text);
  });
  new FileTabs(editor, project);
  const map = new FrictionMap(byId("map"), byId("map-picture"));
  const finger = new Finger(engine, map, byId("map-finger"));
  const samples = new Samples();
  const scope = new Scope(samples, byId("scope"));
  const numbers = new Numbers();
  const sound = new Sound();
  const layers = new Layers(engine, editor);
  const board = new Board(engine);
  const gallery = new Gallery(engine);
  const incoming = new Incoming(async (files, entry) =>
    engine.usedFiles(files ?? (await project.filesFor(editor.text)), entry ?? project.entry),
  );
  const compare = new Compare(player, editor);
  compare.onChange = () => map.draw();
  const replay = () => player.now(editor.text);
  const profiles = new Profiles(project, fingerNames(), replay);
  new RealSize(map);
  makeTabs(byId("tools"));
  makeTheme(() => {
    map.draw();
    scope.restyle();
  });
  makeView({ map, finger, scope, engine });

  let reach = { naturalN: 0.25, lowN: 0.25, highN: 0.38 };
  player.onCheck = (check) => {
    if (compare.isRunning) return;
    showCheck(check, editor);
    if (!check.ok && !check.isDraft) return;
    reach = check;
    scope.isDraft = check.isDraft;
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
    await project.replaceFiles(files);
    project.name = name;
    byId("scene-name").textContent = project.entry;
    document.title = `${project.name} · frixel studio`;
    if (chosen) profiles.choose(chosen);
    showFiles();
    if (editor.text === text) player.now(text);
    else editor.text = text;
  }

  function showFiles() {
    showPictures(project, editor, removePicture);
    editor.setFiles([...project.files].filter(([name]) => isToml(name)));
  }

  function removePicture(name) {
    project.files.delete(name);
    showFiles();
    replay();
  }

  gallery.onScene = (name, text) => open({ name, text });
  gallery.onLayer = (text) => editor.append(text);
  incoming.onFiles = async ({ scene, files, finger: own, screen }) => {
    await board.disarmBeforeForeignScene();
    if (own) profiles.addFinger(own);
    if (screen) profiles.addScreen(screen);
    if (scene) await open(scene);
    else {
      for (const [name, content] of files) project.add(name, content);
      showFiles();
      replay();
    }
    if (files.some(([name]) => isPicture(name))) byId("tab-pictures").click();
  };

  byId("open-gallery").onclick = () => attempt(() => gallery.open());
  byId("undo").onclick = () => editor.undo();
  byId("redo").onclick = () => editor.redo();
  byId("save").onclick = () =>
    attempt(async () => {
      const { name, entry, profiles } = project;
      const files = await project.filesForZip(editor.text);
      download(`${name}.zip`, zipOf({ name, entry, profiles, text: editor.text, files }), "application/zip");
    });
  byId("share").onclick = () =>
    attempt(async () => {
      const link = linkOf(project.name, editor.text, await project.filesForLink(editor.text));
      history.replaceState(null, "", new URL(link).hash);
      const place = await navigator.clipboard.writeText(link).then(
        () => "The link is copied.",
        () => "The link stands in the address line: copy it from there.",
      );
      notify(`${place} It holds the whole scene; nothing is uploaded. ${whoCanOpen(location)}`);
    });

  const openLink = () => isLink(location.hash) && attempt(() => open(sceneOf(location.hash)));
  addEventListener("hashchange", openLink);
  const takeLink = (event) => {
    const fragment = fragmentIn(event.clipboardData?.getData("text/plain") ?? "");
    if (fragment === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    attempt(() => open(sceneOf(fragment)));
  };
  addEventListener("paste", takeLink, { capture: true });
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
