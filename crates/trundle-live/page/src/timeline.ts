// The last ten minutes: where the robot stood and what it did, on a line to scroll back.

import { element, TONES } from "./panel";
import type { Pose, RobotState, StateEntry } from "./wire";

/** Time that the line covers [s]. */
const LENGTH_S = 600;
/** Time between two moments that are kept [s]. */
const PERIOD_S = 0.2;

interface Moment {
  time: number;
  pose: Pose;
}

export class Timeline {
  private moments: Moment[] = [];
  private states: StateEntry[] = [];
  private now = 0;
  private drawn = 0;
  /** The time that is looked at; null: now. */
  private at: number | null = null;
  private readonly slider = element<HTMLInputElement>("past");

  constructor(private readonly onLook: (pose: Pose | null) => void) {
    this.slider.addEventListener("input", () => this.onInput());
    element("past-now").addEventListener("click", () => this.look(null));
  }

  /** The path before this page came: x, y, heading and time of each point. */
  begin(poses: Float32Array): void {
    this.moments = [];
    this.states = [];
    for (let i = 0; i + 3 < poses.length; i += 4) {
      this.moments.push({ time: poses[i + 3]!, pose: [poses[i]!, poses[i + 1]!, poses[i + 2]!] });
    }
    this.look(null);
  }

  addStates(states: StateEntry[]): void {
    this.states.push(...states);
  }

  add(state: RobotState): void {
    this.now = state.time;
    const last = this.moments[this.moments.length - 1];
    if (!last || state.time - last.time >= PERIOD_S) this.moments.push({ time: state.time, pose: state.pose });
    const first = this.moments.findIndex((moment) => moment.time >= this.now - LENGTH_S);
    if (first > 50) this.moments.splice(0, first);
    if (this.now - this.drawn >= 1 || this.now < this.drawn) this.draw();
  }

  /** Shows where the robot stood at a time; null shows now. */
  look(time: number | null): void {
    this.at = time;
    const moment = time === null ? null : this.moments.findLast((moment) => moment.time <= time);
    this.onLook(moment?.pose ?? null);
    this.showText();
    if (time === null) this.slider.value = "0";
  }

  private get length(): number {
    const first = Math.min(this.moments[0]?.time ?? this.now, this.states[0]?.time ?? this.now);
    return Math.max(10, Math.min(LENGTH_S, this.now - first));
  }

  private onInput(): void {
    const back = -Number(this.slider.value);
    this.look(back < 0.5 ? null : this.now - back);
  }

  private showText(): void {
    const isNow = this.at === null;
    element("past-now").hidden = isNow;
    const state = this.at === null ? null : this.states.findLast((state) => state.time <= this.at!);
    const back = this.at === null ? 0 : this.now - this.at;
    const text = isNow ? "now" : `${back.toFixed(0)} s ago${state ? `: ${state.name}` : ""}`;
    element("past-text").textContent = text;
    this.slider.setAttribute("aria-valuetext", text);
  }

  /** The states as colours along the line. */
  draw(): void {
    this.drawn = this.now;
    const length = this.length;
    this.slider.min = String(-length);
    if (this.at !== null) {
      this.slider.value = String(this.at - this.now);
      this.showText();
    }
    const canvas = element<HTMLCanvasElement>("past-line");
    const width = Math.round(canvas.clientWidth * devicePixelRatio);
    if (width === 0) return;
    if (canvas.width !== width) canvas.width = width;
    const context = canvas.getContext("2d")!;
    context.clearRect(0, 0, width, canvas.height);
    const style = getComputedStyle(canvas);
    const x = (time: number) => width * (1 - (this.now - time) / length);
    this.states.forEach((state, i) => {
      const end = this.states[i + 1]?.time ?? this.now;
      if (end < this.now - length) return;
      const tone = TONES[state.name] ?? "idle";
      context.fillStyle = style.getPropertyValue(tone === "busy" ? "--accent" : `--${tone}`);
      const from = Math.max(0, x(state.time));
      context.fillRect(from, 0, Math.max(1, x(end) - from), canvas.height);
    });
  }
}
