// The messages between page and server. The server's side is crates/trundle-live/src/wire.

export const WIRE_VERSION = 5;

export type Pose = [x: number, y: number, theta: number];
export type Point = [x: number, y: number];

export interface Task {
  text: string;
  goal?: Pose;
}

export interface RobotState {
  type: "state";
  batch: number;
  time: number;
  pose: Pose;
  covariance: [xx: number, xy: number, yy: number, heading: number];
  twist: [v: number, omega: number];
  command: [v: number, omega: number];
  state: string;
  reason: string | null;
  hold: string | null;
  paused: boolean;
  left: Task[];
  ended: string[];
  over: boolean;
  charge: number | null;
  voltage: number | null;
  charging: boolean;
  movers: [x: number, y: number, radius: number, laterX: number, laterY: number][];
  station: Pose | null;
  counts: [slam: number, mapping: number, control: number, dropped: number];
  stages: [name: string, seconds: number][];
  /** Processor time of the program, and time by its clock [s]; null where the system does not say it. */
  processor: [work: number, clock: number] | null;
  loops: [time: number, x: number, y: number][];
  wheel: { name: string; is_you: boolean } | null;
  viewers: number;
}

/** What is shown: a robot with missions, a base driven by hand, a recorded sequence of images. */
export type RunKind = "robot" | "drive" | "sequence";

export interface Welcome {
  type: "welcome";
  version: number;
  program: string;
  title: string;
  drives: boolean;
  is_steered: boolean;
  kind: RunKind;
  footprint: { disc: number } | { polygon: Point[] };
  max_v: number;
  max_omega: number;
  recording: string;
}

export interface StateEntry {
  time: number;
  name: string;
  reason?: string;
}

/** A series of images or runs, one of which is shown. */
export interface Series {
  unit: string;
  done: number;
  total: number | null;
  /** Number of runs that were shown before this one. */
  number: number;
  shown: string;
  ended: number;
  last: { name: string; is_success: boolean; text: string }[];
}

/** The rule of a zone; a slow one has a speed [m/s]. */
export type ZoneKind = "no_go" | "area" | { slow: number };

/** A zone of the map; number 0 for one that is not kept yet. */
export interface Zone {
  id: number;
  name: string;
  kind: ZoneKind;
  outline: Point[];
}

/** A named place of the map; number 0 for one that is not kept yet. */
export interface Place {
  id: number;
  name: string;
  pose: { x: number; y: number; theta: number };
}

/** The recording of the run. */
export interface Recording {
  on: boolean;
  /** The file that is written, or was written last. */
  file: string | null;
  /** Why it is off, where no person switched it off. */
  reason: string | null;
  /** Free space of its disk [MB]. */
  free_mb: number | null;
}

export interface Setting {
  key: string;
  text: string;
  unit: string;
  value: number;
  min: number;
  max: number;
}

export type Reply =
  | RobotState
  | Welcome
  | { type: "answer"; id: number; refusal?: string; goal?: number }
  | { type: "refused"; refusal: string }
  | { type: "annotations"; zones: Zone[]; places: Place[] }
  | { type: "settings"; settings: Setting[] }
  | ({ type: "recording" } & Recording)
  | ({ type: "series" } & Series)
  | { type: "depth_camera" }
  | { type: "states"; states: StateEntry[] };

export const TILE_CELLS = 64;
const TILE_BYTES = (TILE_CELLS * TILE_CELLS) / 4;

export interface TileMessage {
  kind: "tiles";
  generation: number;
  resolution: number;
  origin: Point;
  tiles: { column: number; row: number; cells: Uint8Array }[];
}

/** Unit of a depth that is sent [m]. */
export const DEPTH_UNIT_M = 0.04;
/** Numbers of a viewpoint: focal lengths and principal point [px], k1, k2, p1, p2, k3, and three rows of map_from_camera. */
const VIEWPOINT_NUMBERS = 21;

export interface DepthMessage {
  kind: "depth";
  width: number;
  /** Number of maps that an operator has replaced. */
  mapNumber: number;
  /** Camera of the picture and its pose; null where the pose is unknown. */
  viewpoint: Float32Array | null;
  pixels: Uint8Array;
}

export type ByteMessage =
  | TileMessage
  | { kind: "scan"; pose: Pose; points: Float32Array }
  | { kind: "plan"; waypoints: Float32Array; points: Float32Array }
  | { kind: "trail"; poses: Float32Array }
  | { kind: "visual"; keyframes: Float32Array; landmarks: Float32Array }
  | { kind: "features"; width: number; height: number; spots: Float32Array; tracked: boolean[] }
  | { kind: "image"; time: number; jpeg: Uint8Array<ArrayBuffer> }
  | DepthMessage;

/** Reads a message of bytes; null for a kind that this page does not know. */
export function readBytes(buffer: ArrayBuffer): ByteMessage | null {
  const view = new DataView(buffer);
  switch (view.getUint8(0)) {
    case 1:
      return readTiles(view, buffer);
    case 2:
      return readScan(view);
    case 3:
      return readPlan(view, buffer);
    case 4:
      return { kind: "image", time: view.getFloat64(8, true), jpeg: new Uint8Array(buffer, 16) };
    case 5:
      return { kind: "trail", poses: new Float32Array(buffer.slice(4)) };
    case 6:
      return readVisualMap(view);
    case 7:
      return readFeatures(view);
    case 8:
      return readDepth(view, buffer);
    default:
      return null;
  }
}

function readDepth(view: DataView, buffer: ArrayBuffer): DepthMessage {
  const isKnown = (view.getUint8(1) & 1) === 1;
  return {
    kind: "depth",
    width: view.getUint16(2, true),
    mapNumber: view.getUint32(4, true),
    viewpoint: isKnown ? new Float32Array(buffer, 8, VIEWPOINT_NUMBERS) : null,
    pixels: new Uint8Array(buffer, 8 + 4 * VIEWPOINT_NUMBERS),
  };
}

/** The way-points of the planner, then the points of its curve. */
function readPlan(view: DataView, buffer: ArrayBuffer): ByteMessage {
  const numbers = new Float32Array(buffer.slice(4));
  const count = 2 * view.getUint16(2, true);
  return { kind: "plan", waypoints: numbers.slice(0, count), points: numbers.slice(count) };
}

/** Keyframes as x, y, heading; landmarks as x, y, z. */
function readVisualMap(view: DataView): ByteMessage {
  const count = 3 * view.getUint32(4, true);
  const total = (view.byteLength - 8) / 2;
  const read = (from: number, to: number, unit: (i: number) => number) =>
    Float32Array.from({ length: to - from }, (_, i) => view.getInt16(8 + 2 * (from + i), true) * unit(i));
  return {
    kind: "visual",
    keyframes: read(0, count, (i) => (i % 3 === 2 ? 1e-4 : 0.01)),
    landmarks: read(count, total, () => 0.01),
  };
}

/** Features of the last image: columns and rows in pixels, and whether each agrees with the pose. */
function readFeatures(view: DataView): ByteMessage {
  const count = (view.byteLength - 8) / 4;
  const spots = new Float32Array(2 * count);
  const tracked: boolean[] = [];
  for (let i = 0; i < count; i++) {
    const x = view.getUint16(8 + 4 * i, true);
    spots[2 * i] = (x & 0x7fff) / 8;
    spots[2 * i + 1] = view.getUint16(10 + 4 * i, true) / 8;
    tracked.push(x >= 0x8000);
  }
  return { kind: "features", width: view.getUint16(4, true), height: view.getUint16(6, true), spots, tracked };
}

function readTiles(view: DataView, buffer: ArrayBuffer): TileMessage {
  const tiles = [];
  const count = view.getUint16(2, true);
  for (let i = 0; i < count; i++) {
    const at = 32 + i * (8 + TILE_BYTES);
    const cells = new Uint8Array(buffer.slice(at + 8, at + 8 + TILE_BYTES));
    tiles.push({ column: view.getInt32(at, true), row: view.getInt32(at + 4, true), cells });
  }
  return {
    kind: "tiles",
    generation: view.getUint32(4, true),
    resolution: view.getFloat64(8, true),
    origin: [view.getFloat64(16, true), view.getFloat64(24, true)],
    tiles,
  };
}

/** The points of a scan, turned into the map frame. */
function readScan(view: DataView): ByteMessage {
  const pose: Pose = [view.getFloat64(4, true), view.getFloat64(12, true), view.getFloat64(20, true)];
  const count = (view.byteLength - 28) / 4;
  const points = new Float32Array(2 * count);
  const [cos, sin] = [Math.cos(pose[2]), Math.sin(pose[2])];
  for (let i = 0; i < count; i++) {
    const x = view.getInt16(28 + 4 * i, true) / 1000;
    const y = view.getInt16(30 + 4 * i, true) / 1000;
    points[2 * i] = pose[0] + cos * x - sin * y;
    points[2 * i + 1] = pose[1] + sin * x + cos * y;
  }
  return { kind: "scan", pose, points };
}
