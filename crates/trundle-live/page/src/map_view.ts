// The map with the robot on it. Draws only when something changed; the robot glides between two messages.

import { Tiles } from "./tiles";
import { colors, type Colors } from "./theme";
import { ZoneLayer, type ZoneScene } from "./zone_layer";
import { positionEllipse, type Covariance } from "./uncertainty";
import type { Point, Pose, RobotState, Welcome } from "./wire";

/** Limits of the zoom [pixels a metre]. */
const MIN_SCALE = 4;
const MAX_SCALE = 600;
/** Time in which the drawn robot takes over most of a difference to its estimate [s]. */
const GLIDE_S = 0.08;
/** Largest difference that glides [m]; a larger one is a jump of the estimate. */
const JUMP_M = 0.5;
/** Time for which a closed loop is shown without the landmarks [s]. */
const SHOWN_LOOP_S = 8;

/** Strength of the part of the path that was driven after the time that is looked at. */
const LATER_ALPHA = 0.3;

export interface Layers {
  scan: boolean;
  plan: boolean;
  waypoints: boolean;
  trail: boolean;
  sigma: boolean;
  visual: boolean;
  zones: boolean;
  frontiers: boolean;
}

/** A goal or pose that is being dragged. */
export interface Ghost {
  pose: Pose;
  kind: "goal" | "pose";
}

/** What the map shows beside tiles and robot. What comes later replaces its parts and does not change them. */
export interface Seen {
  state: RobotState | null;
  scan: Float32Array;
  plan: Float32Array;
  waypoints: Float32Array;
}

const NONE = new Float32Array();
const NOTHING: Seen = { state: null, scan: NONE, plan: NONE, waypoints: NONE };

/** What is shown of a time of the past. */
export interface Past {
  time: number;
  pose: Pose;
  /** null where it is not known. */
  covariance: Covariance | null;
  seen: Seen | null;
}

export interface Scene {
  robot: Pose | null;
  reach: number;
  landmarks: Float32Array;
  keyframes: Float32Array;
  trail: number[];
  plan: Float32Array;
  scan: Float32Array;
}

export class MapView {
  readonly tiles = new Tiles();
  readonly layers: Layers = {
    scan: true,
    plan: true,
    waypoints: true,
    trail: true,
    sigma: true,
    visual: false,
    zones: true,
    frontiers: true,
  };
  /** Zones, places and what is being drawn. */
  readonly zones: ZoneScene = { zones: [], places: [], draft: null, hidden: 0 };
  follows = true;
  ghost: Ghost | null = null;
  private lookedAt: Past | null = null;
  /** Called after each change of the view, for what is placed by the map's frame. */
  onMove: () => void = () => {};
  private readonly context: CanvasRenderingContext2D;
  private readonly zoneLayer: ZoneLayer;
  private colors: Colors = colors();
  private scale = 60;
  private center: Point = [0, 0];
  private now = NOTHING;
  private drawn: Pose | null = null;
  private footprint: Welcome["footprint"] = { disc: 0.17 };
  private keyframes = new Float32Array();
  private landmarks = new Float32Array();
  private trail: number[] = [];
  /** Time of each point of the trail [s]. */
  private trailTimes: number[] = [];
  private isDirty = true;
  private isFitted = false;
  /** Whether the map is shown as a whole while it grows, until a person moves it. */
  keepsFit = false;
  private last = 0;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.context = canvas.getContext("2d")!;
    this.zoneLayer = new ZoneLayer(this.context);
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.recolor();
    requestAnimationFrame((now) => this.frame(now));
  }

  setRobot(footprint: Welcome["footprint"]): void {
    this.footprint = footprint;
    this.dirty();
  }

  /** What is shown now. */
  get seen(): Seen {
    return this.now;
  }

  /** The time of the past that is looked at. */
  get past(): Past | null {
    return this.lookedAt;
  }

  set past(past: Past | null) {
    this.lookedAt = past;
    this.tiles.look(past && past.time);
    this.dirty();
  }

  /** What is shown of the time that is looked at. */
  private get shown(): Seen {
    return this.past ? (this.past.seen ?? NOTHING) : this.now;
  }

  setState(state: RobotState): void {
    this.now = { ...this.now, state };
    const [x, y] = state.pose;
    const n = this.trail.length;
    if (n === 0 || Math.hypot(x - this.trail[n - 2]!, y - this.trail[n - 1]!) > 0.02) {
      this.trail.push(x, y);
      this.trailTimes.push(state.time);
    }
    if (this.trail.length > 12000) {
      this.trail.splice(0, 2000);
      this.trailTimes.splice(0, 1000);
    }
    this.dirty();
  }

  setScan(points: Float32Array): void {
    this.now = { ...this.now, scan: points };
    this.dirty();
  }

  setVisualMap(keyframes: Float32Array, landmarks: Float32Array): void {
    this.keyframes = keyframes as Float32Array<ArrayBuffer>;
    this.landmarks = landmarks as Float32Array<ArrayBuffer>;
    this.dirty();
  }

  setPlan(points: Float32Array, waypoints: Float32Array): void {
    this.now = { ...this.now, plan: points, waypoints };
    this.dirty();
  }

  /** Another run is shown: path, scan, plan and landmarks were those of the last one. */
  forgetRun(): void {
    this.trail = [];
    this.trailTimes = [];
    this.keyframes = this.landmarks = new Float32Array();
    this.now = { ...NOTHING, state: this.now.state };
    this.past = null;
    this.isFitted = false;
    this.dirty();
  }

  /** The path driven before this page came: x, y, heading and time of each point. */
  setTrail(poses: Float32Array): void {
    this.trail = [];
    this.trailTimes = [];
    for (let i = 0; i + 3 < poses.length; i += 4) {
      this.trail.push(poses[i]!, poses[i + 1]!);
      this.trailTimes.push(poses[i + 3]!);
    }
    this.dirty();
  }

  /** The map has grown: the first map is shown as a whole. */
  mapChanged(): void {
    const isDue = !this.isFitted || (this.keepsFit && !this.follows);
    if (isDue && this.tiles.knownBounds()) {
      this.isFitted = true;
      this.fit();
    }
    this.dirty();
  }

  recolor(): void {
    this.colors = colors();
    this.tiles.setColors(this.colors.floor, this.colors.wall, this.layers.frontiers ? this.colors.frontier : this.colors.floor);
    this.dirty();
  }

  dirty(): void {
    this.isDirty = true;
  }

  /** The place of a point of the map frame on the canvas [device pixels]. */
  toScreen = (p: Point): Point => [
    this.canvas.width / 2 + (p[0] - this.center[0]) * this.scale * devicePixelRatio,
    this.canvas.height / 2 - (p[1] - this.center[1]) * this.scale * devicePixelRatio,
  ];

  /** The point of the map frame at a place of the window [CSS pixels]. */
  toMap(x: number, y: number): Point {
    const box = this.canvas.getBoundingClientRect();
    return [
      this.center[0] + (x - box.left - box.width / 2) / this.scale,
      this.center[1] - (y - box.top - box.height / 2) / this.scale,
    ];
  }

  /** The place of a point of the map frame in the window [CSS pixels]. */
  toWindow(p: Point): Point {
    const [x, y] = this.toScreen(p);
    const box = this.canvas.getBoundingClientRect();
    return [box.left + x / devicePixelRatio, box.top + y / devicePixelRatio];
  }

  pan(dx: number, dy: number): void {
    this.keepsFit = false;
    this.follows = false;
    this.center = [this.center[0] - dx / this.scale, this.center[1] + dy / this.scale];
    this.dirty();
  }

  zoom(factor: number, x?: number, y?: number): void {
    this.keepsFit = false;
    const box = this.canvas.getBoundingClientRect();
    const at: Point = [x ?? box.left + box.width / 2, y ?? box.top + box.height / 2];
    const before = this.toMap(...at);
    this.scale = Math.min(MAX_SCALE, Math.max(MIN_SCALE, this.scale * factor));
    const after = this.toMap(...at);
    if (!this.follows) {
      this.center = [this.center[0] + before[0] - after[0], this.center[1] + before[1] - after[1]];
    }
    this.dirty();
  }

  /** Shows all that is known. */
  fit(): void {
    const bounds = this.tiles.knownBounds();
    const box = this.canvas.getBoundingClientRect();
    if (!bounds || box.width === 0) return;
    const { left, right, top, bottom } = this.insets();
    const [w, h] = [bounds.max[0] - bounds.min[0] + 1, bounds.max[1] - bounds.min[1] + 1];
    const free: Point = [box.width - left - right, box.height - top - bottom];
    this.scale = Math.min(160, Math.max(MIN_SCALE, Math.min(free[0] / w, free[1] / h)));
    this.follows = false;
    this.center = [
      (bounds.min[0] + bounds.max[0]) / 2 + (right - left) / 2 / this.scale,
      (bounds.min[1] + bounds.max[1]) / 2 + (top - bottom) / 2 / this.scale,
    ];
    this.dirty();
  }

  /** What the view of space draws besides the tiles. */
  get scene(): Scene {
    const { state, plan, scan } = this.shown;
    return {
      robot: this.past ? this.past.pose : this.drawn,
      reach: this.reach(),
      landmarks: this.landmarks,
      keyframes: this.keyframes,
      trail: this.trail,
      plan: state?.left.length ? plan : NONE,
      scan,
    };
  }

  get metresOf100Pixels(): number {
    return 100 / this.scale;
  }

  /** The parts of the window that panels cover [CSS pixels]. */
  private insets(): { left: number; right: number; top: number; bottom: number } {
    const isWide = window.innerWidth > 900;
    const bottom = document.body.dataset["panel"] === "open" ? window.innerHeight / 2 + 160 : 150;
    return isWide ? { left: 76, right: 348, top: 84, bottom: 104 } : { left: 56, right: 16, top: 96, bottom };
  }

  private resize(): void {
    const box = this.canvas.getBoundingClientRect();
    this.canvas.width = Math.max(1, Math.round(box.width * devicePixelRatio));
    this.canvas.height = Math.max(1, Math.round(box.height * devicePixelRatio));
    this.dirty();
  }

  private frame(now: number): void {
    const dt = Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    if (this.glide(dt) || this.isDirty) {
      this.isDirty = false;
      this.draw();
      this.onMove();
    }
    requestAnimationFrame((next) => this.frame(next));
  }

  /** Moves the drawn robot towards its estimate; whether it moved. */
  private glide(dt: number): boolean {
    if (!this.now.state) return false;
    const [x, y, theta] = this.now.state.pose;
    const known = this.drawn;
    if (!known || Math.hypot(x - known[0], y - known[1]) > JUMP_M || document.hidden) {
      this.drawn = [x, y, theta];
    } else {
      const part = 1 - Math.exp(-dt / GLIDE_S);
      const turn = Math.atan2(Math.sin(theta - known[2]), Math.cos(theta - known[2]));
      const isNear = Math.hypot(x - known[0], y - known[1]) < 5e-4 && Math.abs(turn) < 1e-3;
      if (isNear) return this.followRobot();
      this.drawn = [known[0] + part * (x - known[0]), known[1] + part * (y - known[1]), known[2] + part * turn];
    }
    this.followRobot();
    return true;
  }

  /** Keeps the robot in the middle of the free part of the window; whether the view moved. */
  private followRobot(): boolean {
    if (!this.follows || !this.drawn) return false;
    const { left, right, top, bottom } = this.insets();
    const center: Point = [
      this.drawn[0] + (right - left) / 2 / this.scale,
      this.drawn[1] + (top - bottom) / 2 / this.scale,
    ];
    const has = Math.hypot(center[0] - this.center[0], center[1] - this.center[1]) > 1e-4;
    this.center = center;
    return has;
  }

  private draw(): void {
    const { context, canvas } = this;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    this.drawGrid();
    this.tiles.draw(context, this.toScreen, this.scale * devicePixelRatio);
    if (this.layers.zones || this.zones.draft) this.zoneLayer.draw(this.zones, this.colors, this.toScreen);
    if (this.layers.visual) this.drawVisualMap();
    this.drawLoops();
    if (this.layers.trail) this.drawTrail();
    if (this.layers.plan) this.drawPlan();
    if (this.layers.waypoints) this.drawWaypoints();
    if (this.layers.scan) this.drawScan();
    const { station } = this.shown.state ?? {};
    if (station) this.drawStation(station);
    this.drawMovers();
    this.drawGoals();
    if (this.layers.sigma) this.drawSigma();
    if (this.drawn) this.drawRobot(this.drawn, this.past ? 0.3 : 1);
    if (this.past) this.drawRobot(this.past.pose, 1);
    if (this.ghost) this.drawGhost(this.ghost);
  }

  /** Lines of each metre, and stronger ones of each five. */
  private drawGrid(): void {
    const { context, canvas } = this;
    const ratio = devicePixelRatio;
    const step = this.scale > 18 ? 1 : this.scale > 7 ? 5 : 25;
    const half: Point = [canvas.width / 2 / this.scale / ratio, canvas.height / 2 / this.scale / ratio];
    for (const axis of [0, 1] as const) {
      const from = Math.ceil((this.center[axis] - half[axis]) / step) * step;
      for (let at = from; at < this.center[axis] + half[axis]; at += step) {
        const [x, y] = this.toScreen(axis === 0 ? [at, 0] : [0, at]);
        context.strokeStyle = Math.round(at) % (5 * step) === 0 ? this.colors.gridStrong : this.colors.grid;
        context.lineWidth = ratio;
        context.beginPath();
        if (axis === 0) {
          context.moveTo(Math.round(x) + 0.5, 0);
          context.lineTo(Math.round(x) + 0.5, canvas.height);
        } else {
          context.moveTo(0, Math.round(y) + 0.5);
          context.lineTo(canvas.width, Math.round(y) + 0.5);
        }
        context.stroke();
      }
    }
  }

  /** A path through points, without those less than a pixel from the one before. The last point belongs to it. */
  private line(points: ArrayLike<number>): void {
    const { context } = this;
    context.beginPath();
    let [lastX, lastY] = [Infinity, Infinity];
    for (let i = 0; i + 1 < points.length; i += 2) {
      const [x, y] = this.toScreen([points[i]!, points[i + 1]!]);
      if (Math.abs(x - lastX) + Math.abs(y - lastY) < devicePixelRatio && i + 3 < points.length) continue;
      if (i === 0) context.moveTo(x, y);
      else context.lineTo(x, y);
      [lastX, lastY] = [x, y];
    }
  }

  /** The driven path; of a time of the past, the part that was driven later is faint. */
  private drawTrail(): void {
    const { context } = this;
    context.lineJoin = context.lineCap = "round";
    context.strokeStyle = this.colors.trail;
    context.lineWidth = 2 * devicePixelRatio;
    const later = this.past ? this.trailTimes.findIndex((time) => time > this.past!.time) : -1;
    this.line(later < 0 ? this.trail : this.trail.slice(0, 2 * later));
    context.stroke();
    if (later < 0) return;
    context.globalAlpha = LATER_ALPHA;
    this.line(this.trail.slice(Math.max(0, 2 * later - 2)));
    context.stroke();
    context.globalAlpha = 1;
  }

  private drawPlan(): void {
    const { plan, state } = this.shown;
    if (plan.length < 4 || !state?.left.length) return;
    const { context } = this;
    context.lineJoin = context.lineCap = "round";
    this.line(plan);
    context.strokeStyle = this.colors.planCase;
    context.lineWidth = 7 * devicePixelRatio;
    context.stroke();
    context.strokeStyle = this.colors.plan;
    context.lineWidth = 3 * devicePixelRatio;
    context.stroke();
  }

  /** The way-points of the planner as rings on their straight segments, past which the curve is drawn. */
  private drawWaypoints(): void {
    const { waypoints, state } = this.shown;
    if (waypoints.length < 4 || !state?.left.length) return;
    const { context } = this;
    const ratio = devicePixelRatio;
    context.strokeStyle = this.colors.plan;
    context.fillStyle = this.colors.robotEdge;
    context.lineWidth = 1.5 * ratio;
    this.line(waypoints);
    context.setLineDash([3 * ratio, 4 * ratio]);
    context.stroke();
    context.setLineDash([]);
    for (let i = 0; i + 1 < waypoints.length; i += 2) {
      const [x, y] = this.toScreen([waypoints[i]!, waypoints[i + 1]!]);
      context.beginPath();
      context.arc(x, y, 4 * ratio, 0, 2 * Math.PI);
      context.fill();
      context.stroke();
    }
  }

  private drawScan(): void {
    const { context } = this;
    const { scan } = this.shown;
    const size = Math.max(2, Math.min(5, this.scale * 0.03)) * devicePixelRatio;
    context.fillStyle = this.colors.scan;
    for (let i = 0; i + 1 < scan.length; i += 2) {
      const [x, y] = this.toScreen([scan[i]!, scan[i + 1]!]);
      context.fillRect(x - size / 2, y - size / 2, size, size);
    }
  }

  /** The goals of the mission: pins with their order and their heading. */
  private drawGoals(): void {
    const goals = this.shown.state?.left.flatMap((task) => (task.goal ? [task.goal] : [])) ?? [];
    goals.forEach((goal, i) => this.drawPin(goal, goals.length > 1 ? String(i + 1) : "", this.colors.goal, 1));
  }

  private drawPin(pose: Pose, label: string, color: string, alpha: number): void {
    const { context } = this;
    const ratio = devicePixelRatio;
    const [x, y] = this.toScreen([pose[0], pose[1]]);
    context.save();
    context.translate(x, y);
    context.globalAlpha = alpha;
    context.save();
    context.rotate(-pose[2]);
    context.strokeStyle = context.fillStyle = color;
    this.outline();
    context.globalAlpha = 0.18 * alpha;
    context.fill();
    context.globalAlpha = alpha;
    context.lineWidth = 1.5 * ratio;
    context.setLineDash([4 * ratio, 3 * ratio]);
    context.stroke();
    context.setLineDash([]);
    const tip = Math.max(20 * ratio, (this.reach() + 0.12) * this.scale * ratio);
    context.lineWidth = 2.5 * ratio;
    context.beginPath();
    context.moveTo(7 * ratio, 0);
    context.lineTo(tip, 0);
    context.moveTo(tip - 6 * ratio, -5 * ratio);
    context.lineTo(tip, 0);
    context.lineTo(tip - 6 * ratio, 5 * ratio);
    context.stroke();
    context.restore();
    context.fillStyle = color;
    context.beginPath();
    context.arc(0, 0, (label ? 9 : 6) * ratio, 0, 2 * Math.PI);
    context.fill();
    context.strokeStyle = this.colors.robotEdge;
    context.lineWidth = 2 * ratio;
    context.stroke();
    if (label) {
      context.fillStyle = this.colors.robotEdge;
      context.font = `700 ${11 * ratio}px system-ui, sans-serif`;
      context.textAlign = "center";
      context.textBaseline = "middle";
      context.fillText(label, 0, 0.5 * ratio);
    }
    context.restore();
  }

  /** The ellipse that holds the position with 95 %, and the wedge of the heading. */
  private drawSigma(): void {
    const { context } = this;
    const pose = this.past ? this.past.pose : this.drawn;
    const covariance = this.past ? this.past.covariance : this.now.state?.covariance;
    if (!pose || !covariance) return;
    const unit = this.scale * devicePixelRatio;
    const { long, short, direction } = positionEllipse(covariance);
    if (!Number.isFinite(long) || long * unit > 5000) return;
    const [x, y] = this.toScreen([pose[0], pose[1]]);
    context.save();
    context.translate(x, y);
    context.fillStyle = this.colors.sigma;
    context.beginPath();
    context.ellipse(0, 0, Math.max(long * unit, 1), Math.max(short * unit, 1), -direction, 0, 2 * Math.PI);
    context.fill();
    const spread = Math.min(Math.PI / 2, 2 * Math.sqrt(Math.max(0, covariance[3])));
    const length = (this.reach() + 0.5) * unit;
    context.beginPath();
    context.moveTo(0, 0);
    context.arc(0, 0, length, -pose[2] - spread, -pose[2] + spread);
    context.fill();
    context.restore();
  }

  /** Landmarks by their height, blue on the floor to red at 2 m, and the keyframes' cameras. */
  private drawVisualMap(): void {
    const { context } = this;
    const ratio = devicePixelRatio;
    const size = 2 * ratio;
    for (let i = 0; i + 2 < this.landmarks.length; i += 3) {
      const [x, y] = this.toScreen([this.landmarks[i]!, this.landmarks[i + 1]!]);
      const height = Math.max(0, Math.min(1, this.landmarks[i + 2]! / 2));
      context.fillStyle = `hsl(${(220 - 220 * height).toFixed(0)} 75% 58% / 0.75)`;
      context.fillRect(x - size / 2, y - size / 2, size, size);
    }
    context.strokeStyle = this.colors.ghost;
    context.lineWidth = 1.4 * ratio;
    context.globalAlpha = 0.8;
    for (let i = 0; i + 2 < this.keyframes.length; i += 3) {
      const [x, y] = this.toScreen([this.keyframes[i]!, this.keyframes[i + 1]!]);
      const heading = -this.keyframes[i + 2]!;
      const length = 9 * ratio;
      context.beginPath();
      context.moveTo(x + length * Math.cos(heading - 0.5), y + length * Math.sin(heading - 0.5));
      context.lineTo(x, y);
      context.lineTo(x + length * Math.cos(heading + 0.5), y + length * Math.sin(heading + 0.5));
      context.closePath();
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  /** Closed loops: with the landmarks all, else those of the last seconds. */
  private drawLoops(): void {
    const { context } = this;
    const { state } = this.shown;
    const now = state?.time ?? 0;
    for (const [time, x, y] of state?.loops ?? []) {
      const age = now - time;
      if (age > SHOWN_LOOP_S && !this.layers.visual) continue;
      const [left, top] = this.toScreen([x, y]);
      const radius = (9 + 16 * Math.max(0, 1 - age / SHOWN_LOOP_S)) * devicePixelRatio;
      context.strokeStyle = this.colors.goal;
      context.lineWidth = 2.5 * devicePixelRatio;
      context.beginPath();
      context.arc(left, top, radius, 0.4, 2 * Math.PI - 0.4);
      context.stroke();
    }
  }

  /** The charging station: its front, and the light before it. */
  private drawStation(pose: Pose): void {
    const { context } = this;
    const unit = this.scale * devicePixelRatio;
    const [x, y] = this.toScreen([pose[0], pose[1]]);
    context.save();
    context.translate(x, y);
    context.rotate(-pose[2]);
    context.fillStyle = this.colors.robot;
    context.globalAlpha = 0.85;
    context.fillRect(-0.1 * unit, -0.12 * unit, 0.1 * unit, 0.24 * unit);
    context.globalAlpha = 0.15;
    context.beginPath();
    context.moveTo(0, 0);
    context.arc(0, 0, 0.7 * unit, -0.4, 0.4);
    context.fill();
    context.restore();
  }

  /** People and what else moves, with their way in the next second. */
  private drawMovers(): void {
    const { context } = this;
    const unit = this.scale * devicePixelRatio;
    for (const [x, y, radius, laterX, laterY] of this.shown.state?.movers ?? []) {
      const now = this.toScreen([x, y]);
      const later = this.toScreen([laterX, laterY]);
      context.strokeStyle = context.fillStyle = this.colors.ghost;
      context.lineWidth = 2 * devicePixelRatio;
      context.globalAlpha = 0.22;
      context.beginPath();
      context.arc(...later, Math.max(4, radius * unit), 0, 2 * Math.PI);
      context.fill();
      context.globalAlpha = 1;
      context.beginPath();
      context.arc(...now, Math.max(4, radius * unit), 0, 2 * Math.PI);
      context.stroke();
      context.beginPath();
      context.moveTo(...now);
      context.lineTo(...later);
      context.stroke();
    }
  }

  private drawRobot(pose: Pose, alpha: number): void {
    const { context } = this;
    const ratio = devicePixelRatio;
    const [x, y] = this.toScreen([pose[0], pose[1]]);
    const size = Math.max(9 * ratio, this.reach() * this.scale * ratio);
    context.save();
    context.translate(x, y);
    context.rotate(-pose[2]);
    context.globalAlpha = alpha;
    context.shadowColor = "rgba(0, 0, 0, 0.45)";
    context.shadowBlur = 12 * ratio;
    context.fillStyle = this.colors.robot;
    this.outline(9 * ratio);
    context.fill();
    context.shadowBlur = 0;
    context.strokeStyle = this.colors.robotEdge;
    context.lineWidth = 2 * ratio;
    context.stroke();
    context.fillStyle = this.colors.robotEdge;
    context.beginPath();
    context.moveTo(0.62 * size, 0);
    context.lineTo(-0.32 * size, 0.42 * size);
    context.lineTo(-0.12 * size, 0);
    context.lineTo(-0.32 * size, -0.42 * size);
    context.closePath();
    context.fill();
    context.restore();
  }

  private drawGhost(ghost: Ghost): void {
    this.drawPin(ghost.pose, "", ghost.kind === "goal" ? this.colors.goal : this.colors.ghost, 0.9);
  }

  /** The robot's outline as a path at the origin, x ahead. A small one is drawn as a disc. */
  private outline(smallest = 0): void {
    const { context } = this;
    const scale = this.scale * devicePixelRatio;
    context.beginPath();
    if ("disc" in this.footprint || this.reach() * scale < smallest) {
      context.arc(0, 0, Math.max(smallest, this.reach() * scale), 0, 2 * Math.PI);
      return;
    }
    for (const [x, y] of this.footprint.polygon) context.lineTo(x * scale, -y * scale);
    context.closePath();
  }

  /** The farthest point of the outline [m]. */
  private reach(): number {
    if ("disc" in this.footprint) return this.footprint.disc;
    return Math.max(...this.footprint.polygon.map(([x, y]) => Math.hypot(x, y)));
  }
}
