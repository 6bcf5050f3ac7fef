// The live page: what the robot sees, and how it is steered.

import { Annotations } from "./annotations";
import { drawFeatures, type ImageEnd } from "./camera";
import { Link, type LinkState } from "./link";
import { MapView, type Layers } from "./map_view";
import { Moments } from "./moments";
import { PastCamera } from "./past_camera";
import { addToLog, element, markLog, Panel } from "./panel";
import { Plots } from "./plots";
import { Teleop } from "./teleop";
import { mapNames, saveMap } from "./map_files";
import { SeriesCard } from "./series";
import { RecordingSwitch } from "./recording";
import { Settings } from "./settings";
import { SpaceView } from "./space_view";
import { startTheme, toggleTheme } from "./theme";
import { Timeline } from "./timeline";
import { MapTools, type Tool } from "./tools";
import { WIRE_VERSION, type ByteMessage, type DepthMessage, type Pose, type Reply, type RobotState, type Setting, type Welcome } from "./wire";

startTheme(() => {
  map.recolor();
  plots.draw();
});
const canvas = element<HTMLCanvasElement>("map");
const map = new MapView(canvas);
const space = new SpaceView(element<HTMLCanvasElement>("space"), map);
const panel = new Panel();
const moments = new Moments();
const pastCamera = new PastCamera();
const plots = new Plots(moments, (time) => timeline.look(time));
const timeline = new Timeline(moments, (time, moment) => {
  map.past = moment && { time: time!, pose: moment.pose, covariance: moment.numbers?.covariance ?? null, seen: moment.seen };
  pastCamera.look(time);
  plots.mark(time);
  markLog(time);
});
/** Way of the map for a press of an arrow key [pixels]. */
const PAN_PX = 80;
let welcome: Welcome | null = null;
let state: RobotState | null = null;
/** Whether the run has a depth camera whose images can be drawn in space. */
let hasDepthCamera = false;
/** Whether a goal is added to the queue, without the shift key too. */
let isQueueing = false;
/** What becomes of the last image. */
let imageEnd = Promise.resolve<ImageEnd>("broken");
/** What a refusal beside the map refers to. */
let refused: { text: string; at: Pose } | null = null;

const link = new Link(location.hash.slice(1), viewerName(), {
  onState: showLink,
  onReply,
  onBytes,
});
const annotations = new Annotations(map, () => state?.pose ?? null, {
  ask: async (message, at) => beside((await link.ask(message)).refusal, at),
  go: (pose) => void go(pose, false),
  note: (text) => toast(text, "warn"),
  draw: () => selectTool("zone"),
  onClosed: () => tools.tool !== "move" && selectTool("move"),
});
const settings = new Settings(async (message) => (await link.ask(message)).refusal);
const recording = new RecordingSwitch((on) => void request({ type: "record", on }));
const series = new SeriesCard(() => {
  map.forgetRun();
  space.cloud?.clear();
  beginMoments(new Float32Array());
});
const tools = new MapTools(canvas, map, () => state?.pose[2] ?? 0, annotations.tool, {
  onPlace: (pose) => annotations.newPlace(pose),
  onGoal: (pose, append) => void go(pose, append || isQueueing),
  onPose: (pose) => void request({ type: "set_pose", pose: asGoal(pose) }, pose),
});
const teleop = new Teleop(element("stick"), element("knob"), (v, omega) => link.send({ type: "drive", v, omega }));

/** For tests in a browser, and for the curious: the map, the view of space, the last minutes, and a place of the window where a wall is drawn. */
const inspected = { map, space, moments, wallPixel, settings: [] as Setting[], wireVersion: WIRE_VERSION };
Object.assign(window, { trundle: inspected });

map.onMove = placeOverlays;
connectButtons();
selectTool("move");
if (link && location.hash.length > 1) link.connect();
else showLink("refused", "This link has no token. Open the link that the program prints.");

function onReply(reply: Reply): void {
  switch (reply.type) {
    case "welcome":
      welcome = reply;
      map.setRobot(reply.footprint);
      document.title = `${reply.title} – trundle`;
      element("title").textContent = reply.title;
      document.body.dataset["access"] = reply.drives ? "drive" : "view";
      document.body.dataset["kind"] = reply.kind;
      showKind(reply);
      element("log").replaceChildren();
      recording.begin(reply.recording);
      space.cloud?.clear();
      offerCloud(false);
      sendCamera();
      sendVisualMap();
      void offerMaps();
      break;
    case "state":
      state = reply;
      map.setState(reply);
      panel.show(reply);
      if (moments.add(reply, map.seen)) plots.draw();
      timeline.moved();
      showWheel(reply);
      showPause(reply);
      showLoops(reply);
      break;
    case "annotations":
      annotations.show(reply.zones, reply.places);
      break;
    case "settings":
      settings.show(reply.settings);
      inspected.settings = reply.settings;
      break;
    case "recording":
      recording.show(reply);
      break;
    case "series":
      series.show(reply);
      break;
    case "depth_camera":
      offerCloud(true);
      break;
    case "states":
      addToLog(reply.states, (time) => timeline.look(time));
      moments.enter(reply.states);
      break;
    case "refused":
      toast(reply.refusal, "warn");
      break;
    case "answer":
      break;
  }
}

function onBytes(message: ByteMessage): void {
  switch (message.kind) {
    case "tiles":
      map.tiles.add(message, moments.now);
      map.mapChanged();
      break;
    case "scan":
      map.setScan(message.points);
      break;
    case "plan":
      map.setPlan(message.points, message.waypoints);
      break;
    case "trail":
      map.setTrail(message.poses);
      beginMoments(message.poses);
      break;
    case "visual":
      map.setVisualMap(message.keyframes, message.landmarks);
      break;
    case "features":
      if (!map.past) drawFeatures(message);
      break;
    case "image":
      imageEnd = pastCamera.add(message.time, message.jpeg);
      break;
    case "depth":
      pastCamera.addDepth(message);
      if (isCollecting()) void imageEnd.then((end) => addToCloud(message, end));
      break;
  }
}

/** The time line begins anew, with the path that was driven before. */
function beginMoments(poses: Float32Array): void {
  moments.begin(poses);
  timeline.look(null);
}

// ---- requests

/** Asks, and shows a refusal: beside the place that it concerns, or as a note. */
async function request(message: object, at?: Pose): Promise<boolean> {
  hideRefusal();
  const answer = await link.ask(message);
  if (!answer.refusal) return true;
  if (at) showRefusal(answer.refusal, at);
  else toast(answer.refusal, "warn");
  return false;
}

/** Shows a refusal beside the place that it concerns; the refusal. */
function beside(refusal: string | undefined, at: Pose): string | undefined {
  if (refusal) showRefusal(refusal, at);
  else hideRefusal();
  return refusal;
}

async function go(pose: Pose, append: boolean): Promise<void> {
  if (await request({ type: "go", goals: [asGoal(pose)], append }, pose)) {
    const [x, y] = pose;
    toast(`${append ? "Queued" : "Driving to"} ${x.toFixed(2)}, ${y.toFixed(2)} m`, "good");
  }
}

async function stop(): Promise<void> {
  teleop.release();
  tools.cancel();
  const answer = await link.stop();
  if (answer.refusal) toast(`Not stopped: ${answer.refusal}`, "bad");
}

/** Shows the maps that may be loaded. */
async function offerMaps(): Promise<void> {
  const names = await mapNames(location.hash.slice(1));
  element("maps").hidden = names.length === 0;
  element("map-name").replaceChildren(...names.map((name) => new Option(name)));
}

/** Time for the second press that loads a map [ms]. */
const LOAD_PRESS_MS = 5000;
let loadPressed = -Infinity;

/** The first press says what a map costs, the second loads it. A dialog would keep the stop from working. */
async function loadMap(): Promise<void> {
  const name = element<HTMLSelectElement>("map-name").value;
  if (performance.now() - loadPressed > LOAD_PRESS_MS) {
    loadPressed = performance.now();
    toast("Press Load again: the robot stops, drops its mission, takes the zones and places of the new map, and must find out where it stands.", "warn");
    return;
  }
  loadPressed = -Infinity;
  if (await request({ type: "load_map", name })) toast(`Map ${name} is loaded. Set the pose, or let the robot find it.`, "good");
}

function asGoal([x, y, theta]: Pose): { x: number; y: number; theta: number } {
  return { x, y, theta };
}

// ---- controls

function connectButtons(): void {
  const press = (id: string, act: () => void) => element(id).addEventListener("click", act);
  press("stop", () => void stop());
  press("explore", () => void request({ type: "explore" }));
  press("return", () => void request({ type: "return" }));
  press("dock", () => void request({ type: "dock" }));
  press("pause", () => void request({ type: state?.paused ? "continue" : "pause" }));
  press("map-save", () => void saveMap(location.hash.slice(1)).then((problem) => problem && toast(problem, "bad")));
  press("features-toggle", () => {
    element("camera-features").hidden = !element("camera-features").hidden;
    element("features-toggle").setAttribute("aria-pressed", String(!element("camera-features").hidden));
  });
  press("color-choice", () => choosePicture(false));
  press("depth-choice", () => choosePicture(true));
  press("map-load", () => void loadMap());
  press("wheel-take", () => void request({ type: "take_wheel" }));
  press("theme", () => {
    toggleTheme();
    map.recolor();
    plots.draw();
    timeline.draw();
  });
  press("queue-toggle", toggleQueue);
  press("fit", () => {
    map.fit();
    showFollow();
  });
  press("follow", toggleFollow);
  press("zoom-in", () => zoom(1.4));
  press("zoom-out", () => zoom(1 / 1.4));
  press("space-toggle", toggleSpace);
  element("space-toggle").hidden = !space.isPossible;
  press("cloud-toggle", toggleCloud);
  press("help-open", () => toggle("help", "help-open"));
  press("help-close", () => toggle("help", "help-open"));
  press("camera-toggle", toggleCamera);
  press("panel-open", () => {
    const isOpen = document.body.dataset["panel"] !== "open";
    document.body.dataset["panel"] = isOpen ? "open" : "";
    element("panel-open").setAttribute("aria-expanded", String(isOpen));
    sendCamera();
    if (map.follows) map.dirty();
    else map.fit();
  });
  document.querySelectorAll<HTMLElement>("[data-tool]").forEach((button) => {
    button.addEventListener("click", () => selectTool(button.dataset["tool"] as Tool));
  });
  document.querySelectorAll<HTMLInputElement>("[data-layer]").forEach((box) => {
    box.addEventListener("change", () => {
      map.layers[box.dataset["layer"] as keyof Layers] = box.checked;
      sendVisualMap();
      if (box.dataset["layer"] === "frontiers") map.recolor();
      map.dirty();
    });
  });
  element("goal-form").addEventListener("submit", (event) => {
    event.preventDefault();
    typedGoal();
  });
  window.addEventListener("keydown", onKey, { capture: true });
  // A button would take the release of the space bar for a click.
  const isButton = (target: EventTarget | null) => target instanceof HTMLButtonElement;
  window.addEventListener("keyup", (event) => event.code === "Space" && isButton(event.target) && event.preventDefault(), {
    capture: true,
  });
  new MutationObserver(showFollow).observe(document.body, { attributeFilter: ["data-follow"] });
}

function onKey(event: KeyboardEvent): void {
  const isMoving = state !== null && Math.hypot(...state.command) > 0;
  // A name has blanks: they are typed while the robot stands.
  if (event.code === "Space" && event.target === element("note-name") && !isMoving) return;
  if (event.code === "Space") {
    event.preventDefault();
    event.stopPropagation();
    if (!event.repeat && document.body.dataset["access"] !== "view") void stop();
    return;
  }
  const isTyping = event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement;
  if (isTyping && event.key === "Escape") return selectTool("move");
  if (isTyping && (event.target as HTMLInputElement).type !== "checkbox") return;
  if (event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
  const isDriving = tools.tool === "drive";
  const actions: Record<string, () => void> = {
    m: () => selectTool("move"),
    g: () => selectTool("goal"),
    p: () => selectTool("pose"),
    t: () => selectTool("drive"),
    z: () => selectTool("zone"),
    n: () => selectTool("place"),
    q: toggleQueue,
    enter: () => event.target === canvas && annotations.tool.close(),
    escape: () => selectTool("move"),
    f: toggleFollow,
    "0": () => map.fit(),
    "3": toggleSpace,
    c: toggleCloud,
    "+": () => zoom(1.4),
    "=": () => zoom(1.4),
    "-": () => zoom(1 / 1.4),
    "?": () => toggle("help", "help-open"),
  };
  const pans: Record<string, [number, number]> = {
    ArrowLeft: [PAN_PX, 0],
    ArrowRight: [-PAN_PX, 0],
    ArrowUp: [0, PAN_PX],
    ArrowDown: [0, -PAN_PX],
  };
  const pan = pans[event.key];
  if (pan && !isDriving && event.target === canvas) return map.pan(...pan);
  if (isDriving && "wasd".includes(event.key.toLowerCase())) return;
  actions[event.key.toLowerCase()]?.();
}

function zoom(factor: number): void {
  if (space.isShown) space.zoom(1 / factor);
  else map.zoom(factor);
}

/** Shows the view of space or the map. Goals are set on the map. */
function toggleSpace(): void {
  space.show(!space.isShown);
  element("space-toggle").setAttribute("aria-pressed", String(space.isShown));
  sendVisualMap();
  offerCloud(hasDepthCamera);
  if (space.cloud) sendCamera();
}

/** Offers the cloud beside the view of space, if the run has a depth camera. */
function offerCloud(isPossible: boolean): void {
  hasDepthCamera = isPossible;
  element("cloud-toggle").hidden = !(isPossible && space.isShown);
}

/** Collects the points of depth images, or forgets them. */
function toggleCloud(): void {
  if (element("cloud-toggle").hidden) return;
  space.collect(!space.cloud);
  element("cloud-toggle").setAttribute("aria-pressed", String(space.cloud !== null));
  sendCamera();
}

function isCollecting(): boolean {
  return space.isShown && space.cloud !== null && !document.hidden;
}

/** Adds a depth image to the cloud, in the colours of its image; a busy page leaves both out. */
function addToCloud(message: DepthMessage, end: ImageEnd): void {
  if (end === "busy") return;
  space.cloud?.add(message, end === "drawn" ? element<HTMLCanvasElement>("camera") : null);
}

function selectTool(tool: Tool): void {
  const { access, kind } = document.body.dataset;
  const isForRobot = tool !== "move" && tool !== "drive";
  const isDenied = (access === "view" && tool !== "move") || (isForRobot && kind !== undefined && kind !== "robot");
  const chosen = isDenied ? "move" : tool;
  if (space.isShown && chosen !== "move" && chosen !== "drive") toggleSpace();
  if (tools.tool !== chosen || chosen === "move") annotations.close(false);
  tools.tool = chosen;
  tools.cancel();
  hideRefusal();
  if (chosen === "zone") annotations.beginZone();
  teleop.enabled = chosen === "drive";
  element("stick").hidden = chosen !== "drive";
  document.body.dataset["tool"] = chosen;
  document.querySelectorAll<HTMLElement>("[data-tool]").forEach((button) => {
    button.setAttribute("aria-pressed", String(button.dataset["tool"] === chosen));
  });
}

/** A goal replaces the mission, or is added to it. */
function toggleQueue(): void {
  isQueueing = !isQueueing;
  element("queue-toggle").setAttribute("aria-pressed", String(isQueueing));
}

function toggleFollow(): void {
  map.follows = !map.follows;
  map.dirty();
  showFollow();
}

function showFollow(): void {
  element("follow").setAttribute("aria-pressed", String(map.follows));
}

function typedGoal(): void {
  const number = (id: string) => {
    const text = element<HTMLInputElement>(id).value.trim().replace(",", ".");
    return text === "" ? 0 : Number(text);
  };
  const pose: Pose = [number("goal-x"), number("goal-y"), (number("goal-heading") * Math.PI) / 180];
  if (pose.every(Number.isFinite)) void go(pose, isQueueing);
  else toast("A goal is three numbers: x and y in metres, the heading in degrees.", "warn");
}

function toggle(id: string, button: string): void {
  const target = element(id);
  target.hidden = !target.hidden;
  element(button).setAttribute("aria-expanded", String(!target.hidden));
}

// ---- camera

function toggleCamera(): void {
  const body = element("camera-body");
  body.hidden = !body.hidden;
  const button = element("camera-toggle");
  button.textContent = body.hidden ? "Show" : "Hide";
  button.setAttribute("aria-expanded", String(!body.hidden));
  sendCamera();
}

/** Images are sent only while they can be seen, depth only while it is chosen; the cloud needs both. */
function sendCamera(): void {
  const isShown = element("camera-card").offsetParent !== null && !element("camera-body").hidden && !document.hidden;
  const isDepthShown = isShown && !element("camera-depth").hidden;
  link.send({ type: "camera", on: isShown || isCollecting(), depth: isDepthShown || isCollecting() });
}

/** Shows depth or colour. */
function choosePicture(isDepth: boolean): void {
  element("camera-depth").hidden = !isDepth;
  element("depth-choice").setAttribute("aria-pressed", String(isDepth));
  element("color-choice").setAttribute("aria-pressed", String(!isDepth));
  sendCamera();
}
document.addEventListener("visibilitychange", sendCamera);

function sendVisualMap(): void {
  link.send({ type: "visual_map", on: map.layers.visual || space.isShown });
}

/** A place in the middle of the window where the map has a wall [CSS pixels]. */
function wallPixel(): [number, number] | null {
  const box = canvas.getBoundingClientRect();
  for (let ring = 20; ring < box.height / 2 - 130; ring += 2) {
    for (let turn = 0; turn < 2 * Math.PI; turn += 0.02) {
      const [x, y] = [box.width / 2 - 100 + ring * Math.cos(turn), box.height / 2 + ring * Math.sin(turn)];
      if (map.tiles.isWall(map.toMap(x, y))) return [x, y];
    }
  }
  return null;
}

// ---- what the page says

/** Offers what this run can do: a base without autonomy is driven by hand alone, a sequence of images is looked at. */
function showKind({ kind, drives, is_steered: isSteered }: Welcome): void {
  const words = { robot: "Robot", drive: "Robot", sequence: "Camera pose" };
  element("robot-title").textContent = words[kind];
  if (kind === "sequence") {
    const layer = document.querySelector<HTMLInputElement>('[data-layer="visual"]')!;
    layer.checked = map.layers.visual = true;
    element("camera-features").hidden = false;
    element("features-toggle").setAttribute("aria-pressed", "true");
  }
  // Nobody points at a map that is looked at alone: it is shown as a whole while it grows.
  map.keepsFit = !isSteered;
  if (kind === "drive" && drives) selectTool("drive");
  else if (tools.tool !== "move") selectTool(tools.tool);
}

function showLink(next: LinkState, reason: string): void {
  document.body.dataset["link"] = next;
  const meter = element("link");
  const texts = { connecting: "connecting", open: "live", lost: "no link", ended: "ended", refused: "refused" };
  meter.dataset["tone"] = next === "open" ? "good" : next === "connecting" ? "warn" : "bad";
  meter.querySelector("span")!.textContent = texts[next];
  meter.title = texts[next];
  if (next === "open") return;
  // A page that has lost its robot keeps on saying why while it tries again.
  if (next === "connecting" && state) return;
  element("status").dataset["tone"] = next === "connecting" || next === "ended" ? "idle" : "bad";
  const titles = { connecting: "Connecting", lost: "No link", ended: "Ended", refused: "Not let in" };
  const reasons = {
    connecting: "",
    lost: "The program is gone without a word, or the network is. Trying again.",
    ended: "The program has ended. What it last showed stays here; the page connects again when it is started anew.",
    refused: reason,
  };
  element("state").textContent = titles[next];
  element("reason").textContent = reasons[next];
}

function showWheel(now: RobotState): void {
  const wheel = element("wheel");
  const others = now.viewers > 1 ? `, ${now.viewers} viewers` : "";
  const take = element("wheel-take");
  take.hidden = !(welcome?.drives && now.wheel && !now.wheel.is_you);
  wheel.dataset["holds"] = now.wheel ? (now.wheel.is_you ? "you" : "other") : "nobody";
  const free = welcome?.drives ? "The wheel is free" : "Looking only";
  const text = now.wheel ? (now.wheel.is_you ? "You hold the wheel" : `${now.wheel.name} holds the wheel`) : free;
  const shown = text + others;
  const target = element("wheel-text");
  if (target.textContent !== shown) target.textContent = shown;
}

function showPause(now: RobotState): void {
  const button = element("pause");
  const text = now.paused ? "Continue" : "Pause";
  const label = button.querySelector("span")!;
  if (label.textContent === text) return;
  label.textContent = text;
  button.querySelector("use")!.setAttribute("href", now.paused ? "#i-play" : "#i-pause");
  button.classList.toggle("call", now.paused);
}

function toast(text: string, tone: "good" | "warn" | "bad"): void {
  const note = document.createElement("div");
  note.className = "toast";
  note.dataset["tone"] = tone;
  note.textContent = text;
  const notes = element("toasts");
  // A note that is repeated, as those of a held key, is shown once.
  for (const other of [...notes.children]) if (other.textContent === text) other.remove();
  notes.append(note);
  while (notes.children.length > 3) notes.firstElementChild?.remove();
  setTimeout(() => note.remove(), tone === "good" ? 2500 : 6000);
}

function showRefusal(text: string, at: Pose): void {
  refused = { text, at };
  element("bubble").textContent = text;
  element("bubble").hidden = false;
  placeOverlays();
  setTimeout(() => refused?.text === text && hideRefusal(), 7000);
}

function hideRefusal(): void {
  refused = null;
  element("bubble").hidden = true;
}

/** Moves what is bound to the map: the refusal and the scale. */
function placeOverlays(): void {
  if (refused) {
    const [x, y] = map.toWindow([refused.at[0], refused.at[1]]);
    const bubble = element("bubble");
    bubble.style.left = `${x}px`;
    bubble.style.top = `${y}px`;
  }
  showFollow();
  showScale();
}

/** Number of closed loops at the last message; null before the first. */
let shownLoops: number | null = null;

function showLoops(now: RobotState): void {
  const last = now.loops.at(-1)?.[0] ?? 0;
  if (shownLoops !== null && last > shownLoops) toast("A loop was closed: the map is corrected.", "good");
  shownLoops = last;
}

let shownScale = "";

function showScale(): void {
  const metres = map.metresOf100Pixels;
  const steps = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50];
  const length = steps.findLast((step) => step <= 1.2 * metres) ?? steps[0]!;
  const text = length < 1 ? `${Math.round(100 * length)} cm` : `${length} m`;
  const width = `${((100 * length) / metres).toFixed(0)}px`;
  if (shownScale === text + width) return;
  shownScale = text + width;
  element("scale-text").textContent = text;
  element("scale-bar").style.width = width;
}

/** How other viewers see this one. */
function viewerName(): string {
  const agent = navigator.userAgent;
  const of = (names: [RegExp, string][]) => names.find(([pattern]) => pattern.test(agent))?.[1] ?? "";
  const browser = of([
    [/Firefox/, "Firefox"],
    [/Edg\//, "Edge"],
    [/Chrom/, "Chrome"],
    [/Safari/, "Safari"],
  ]);
  const system = of([
    [/iPhone/, "iPhone"],
    [/iPad/, "iPad"],
    [/Android/, "Android"],
    [/Windows/, "Windows"],
    [/Mac OS/, "Mac"],
    [/Linux/, "Linux"],
  ]);
  return `${browser || "A browser"} on ${system || "a computer"}`;
}
