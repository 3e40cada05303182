// The studio's page: makes its parts and tells each what the others found out.

import { createEngine } from "./engine/engine.js";
import { makeAbout } from "./page/about.js";
import { projectOf, zipOf } from "./page/archive.js";
import { Autosave } from "./page/autosave.js";
import { Board } from "./page/board.js";
import { fingerNames, sceneText, schema } from "./page/bundled.js";
import { Compare } from "./page/compare.js";
import { attempt, byId, download, element, forgetNotice, notify } from "./page/dom.js";
import { Editor } from "./page/editor.js";
import { FileTabs } from "./page/file_tabs.js";
import { Finger } from "./page/finger.js";
import { Gallery } from "./page/gallery.js";
import { Incoming } from "./page/incoming.js";
import { Layers } from "./page/layers.js";
import { FrictionMap } from "./page/map.js";
import { Numbers } from "./page/numbers.js";
import { Open } from "./page/open.js";
import { showPictures } from "./page/pictures.js";
import { Player } from "./page/player.js";
import { showCheck, showOutcome, showStatus } from "./page/problems.js";
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
import { Works } from "./page/works.js";

const FIRST_SCENE = "brick";
/** Height of header, tools, numbers and scope, CSS pixels: in a low window they are seen together with the map. */
const AROUND_MAP_PX = 530;
const NEW_SCENE = `version = 2

# Type [[layer]], then Ctrl+Space for what a layer can have; or take layers from the Gallery.
`;

async function start() {
  const engine = await createEngine();
  const project = new Project(engine);
  engine.onFailure = ({ error }) =>
    notify(`The studio has failed: ${error}. Save the scene, then reload the page; a board disarms itself.`);
  const player = new Player(engine, project);
  const editor = new Editor(byId("editor"), await schema(), (file, text) => {
    compare.cancel();
    if (file !== undefined) project.files.set(file, text);
    autosave.changed();
    player.later(editor.text);
  });
  const current = () => {
    const { name, entry, profiles, files } = project;
    return { name, entry, profiles: { ...profiles }, text: editor.text, files: [...files] };
  };
  const works = new Works();
  const autosave = new Autosave(works, current);
  const last = await autosave.last();
  editor.onHistory = () => {
    byId("undo").disabled = !editor.canUndo;
    byId("redo").disabled = !editor.canRedo;
  };
  new FileTabs(editor, project);
  const map = new FrictionMap(byId("map"), byId("map-picture"));
  map.reservedPx = AROUND_MAP_PX;
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
  const compare = new Compare(player, editor, sound);
  compare.onChange = () => map.draw();
  const replay = () => {
    compare.cancel();
    player.now(editor.text);
  };
  const profiles = new Profiles(project, fingerNames(), () => {
    autosave.changed();
    replay();
  });
  new RealSize(map);
  makeAbout();
  makeTabs(byId("tools"));
  makeTheme(() => {
    map.draw();
    scope.restyle();
  });
  makeView({ map, finger, scope, engine });

  const hint = byId("map-hint");
  let hasSlid = false;
  /** Whether a scene without a mistake has come. */
  let isPlayable = false;
  let reach = { naturalN: 0.25, lowN: 0.25, highN: 0.38 };
  player.onCheck = (check) => {
    if (compare.isRunning) return;
    showCheck(check, editor);
    if (!check.ok && !check.isDraft) {
      if (!isPlayable) hint.textContent = "nothing to feel yet: mend the mistake under the text";
      return;
    }
    isPlayable = true;
    reach = check;
    scope.isDraft = check.isDraft;
  };
  player.onPlay = () => {
    layers.reset();
    if (!compare.isRunning) layers.show(reach);
  };
  layers.onLive = (changes) => {
    const note = byId("map-note");
    note.hidden = changes.length === 0;
    note.textContent = `The map shows the scene as it is written. Now: ${changes.join(", ")}.`;
  };
  player.onMap = (picture, check) => {
    if (!hasSlid) hint.textContent = "press and slide: the trail is thick where friction is high";
    if (compare.isRunning) return;
    map.show(picture, check);
    map.thumbnail().then((thumbnail) => autosave.show(thumbnail));
  };
  player.onFailure = notify;
  player.onStatus = (status) => {
    board.allowArm(status);
    layers.isSceneLoading = status === "loading";
    showStatus(status);
  };

  engine.onFrames = (frame) => {
    samples.add(frame);
    scope.feel(frame);
    numbers.feel(frame, reach.naturalN);
    finger.feel(frame, reach);
  };
  engine.onAudio = (change, _tick, slowness) => sound.feel(change, slowness);
  finger.onDown = () => {
    hasSlid = true;
    hint.hidden = board.isPlaying;
    hint.textContent = "nothing plays: press Play or Arm, at the top";
    byId("replay").disabled = false;
  };
  board.onState = () => {
    showOutcome();
    if (hasSlid && board.isPlaying) hint.hidden = true;
  };
  board.onBoard = replay;

  /**
   * Runs an action that brings something from elsewhere into the scene. A real board is disarmed before, and nothing
   * can be armed until it has the scene that is shown then.
   */
  function bringIn(action) {
    return player.expect(async () => {
      try {
        await engine.forget();
        await action();
      } catch (error) {
        // The board gets the scene back that is still shown.
        replay();
        throw error;
      }
    });
  }

  /** Opens a scene from elsewhere. A changed scene can be brought back. */
  const open = (scene) => bringIn(() => replaceScene(scene));

  async function replaceScene({ name, text, files = [], profiles: chosen, ...work }) {
    const before = { ...current(), ...autosave.state };
    forgetNotice();
    await autosave.leave();
    await project.replaceFiles(files);
    project.name = name;
    showName();
    if (chosen) profiles.choose(chosen);
    editor.open(text);
    showFiles();
    await autosave.opened(work);
    if (before.isEdited)
      notify(`${project.name} is open.`, { words: `Back to ${before.name}`, action: () => open(before) });
  }

  function showName() {
    const { name } = project;
    Object.assign(byId("scene-name"), { value: name, size: Math.max(4, Math.min(name.length, 24)) });
    document.title = `${project.name} · frixel studio`;
  }

  function rename(name) {
    const before = project.name;
    project.name = name.trim();
    if (project.files.has(project.entry)) {
      notify(`${project.entry} is a file of this scene already: choose another name.`);
      project.name = before;
    }
    showName();
    if (project.name === before) return;
    autosave.changed();
    showFiles();
    replay();
  }

  function showFiles() {
    showPictures(project, editor, removePicture);
    editor.setFiles([...project.files].filter(([name]) => isToml(name)));
  }

  function removePicture(name) {
    project.files.delete(name);
    autosave.changed();
    showFiles();
    replay();
  }

  gallery.onScene = (name, text) => open({ name, text });
  gallery.onLayer = (text) => bringIn(() => editor.append(text));
  incoming.onFiles = ({ scene, files, finger: own, screen }) =>
    bringIn(async () => {
      if (own) profiles.addFinger(own);
      if (screen) profiles.addScreen(screen);
      if (scene) await replaceScene(scene);
      else {
        for (const [name, content] of files) project.add(name, content);
        autosave.changed();
        showFiles();
        replay();
      }
      if (files.some(([name]) => isPicture(name))) byId("tab-pictures").click();
    });

  const openDialog = new Open(works, () => byId("files").click());
  openDialog.onWork = async (id) => open(await autosave.work(id));
  byId("open-gallery").onclick = () => attempt(() => gallery.open());
  byId("new").onclick = () => attempt(() => open({ name: "untitled", text: NEW_SCENE }));
  byId("scene-name").onchange = ({ target }) => rename(target.value);
  byId("undo").onclick = () => editor.undo();
  byId("redo").onclick = () => editor.redo();
  byId("save").onclick = () =>
    attempt(async () => {
      const files = await project.filesForZip(editor.text);
      const zip = zipOf({ ...current(), files });
      download(`${project.name}.zip`, zip, "application/zip");
      // Throws what a person is told where the studio would not open the zip again.
      projectOf(zip);
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
  await open(last ?? { name: FIRST_SCENE, text: await sceneText(FIRST_SCENE) });
  // A reload keeps what was changed since the link was opened.
  const isReload = performance.getEntriesByType("navigation")[0]?.type === "reload";
  if (!(isReload && last)) openLink();
  // The tests look at the page's parts through this.
  globalThis.studioPage = { engine, editor, sound, samples, map, player };
}

start().catch((error) => {
  document
    .querySelector("main")
    .replaceChildren(element("p", { className: "card" }, `The studio cannot start: ${error.message}`));
});
