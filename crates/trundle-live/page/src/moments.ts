// The last ten minutes of the run, as far as this page knows them.

import { headingBound, positionEllipse, type Covariance } from "./uncertainty";
import type { Seen } from "./map_view";
import type { Pose, RobotState, StateEntry } from "./wire";

/** Time that the time line and all that it shows keep [s]. */
export const LENGTH_S = 600;
/** Time between two moments that are kept [s]. */
const PERIOD_S = 0.2;
/** A time that is so much before the last one is that of another run [s]. */
const RESTART_S = 1;
/** Time over which the load of a stage is taken [s], and the least time that gives one. */
const LOAD_S = 2;
const LEAST_LOAD_S = 0.5;

/** Stages whose load is shown, by the names of the server. */
export const LOADS = ["slam", "mapping", "planning", "control"] as const;

/** What the page was told at a moment. */
export interface Numbers {
  covariance: Covariance;
  /** Measured and commanded speed [m/s]. */
  measured: number;
  commanded: number;
  /** 95 % radius of the position [m], and of the heading [rad]. */
  position: number;
  heading: number;
  /** Part of a core that each of LOADS takes; NaN where it is not known. */
  loads: number[];
  name: string;
  reason: string | null;
}

export interface Moment {
  time: number;
  pose: Pose;
  /** null before this page came: the server keeps poses and states alone. */
  numbers: Numbers | null;
  /** What the map showed; null before this page came. */
  seen: Seen | null;
}

export class Moments {
  list: Moment[] = [];
  states: StateEntry[] = [];
  now = 0;
  private busy: Pick<RobotState, "time" | "stages">[] = [];

  /** The path before this page came: x, y, heading and time of each point. */
  begin(poses: Float32Array): void {
    this.list = [];
    this.states = [];
    this.busy = [];
    for (let i = 0; i + 3 < poses.length; i += 4) {
      this.list.push({ time: poses[i + 3]!, pose: [poses[i]!, poses[i + 1]!, poses[i + 2]!], numbers: null, seen: null });
    }
  }

  /** States that were entered, the newest last; the one in force at the beginning of what is kept stays. */
  enter(states: StateEntry[]): void {
    this.states.push(...states);
    const first = this.states.findIndex((state) => state.time >= this.now - LENGTH_S);
    const passed = first < 0 ? this.states.length - 1 : first - 1;
    if (passed > 0) this.states.splice(0, passed);
  }

  /** Takes a state over, with what the map shows; whether it is a new moment. */
  add(state: RobotState, seen: Seen): boolean {
    this.now = state.time;
    const last = this.list[this.list.length - 1];
    const dt = last ? state.time - last.time : Infinity;
    if (dt < -RESTART_S) this.list = [];
    else if (dt < PERIOD_S) return false;
    this.list.push({ time: state.time, pose: state.pose, numbers: this.numbers(state), seen });
    const first = this.list.findIndex((moment) => moment.time >= this.now - LENGTH_S);
    if (first > 50) this.list.splice(0, first);
    return true;
  }

  /** The last moment at or before a time. */
  at(time: number): Moment | undefined {
    return this.list.findLast((moment) => moment.time <= time);
  }

  /** The state at a time and its reason; without one, the reason of the change to it. */
  stateAt(time: number): { name: string; reason: string | null } | undefined {
    const known = this.at(time)?.numbers;
    const state = this.states.findLast((state) => state.time <= time);
    if (!known) return state && { name: state.name, reason: state.reason ?? null };
    const change = state?.name === known.name ? state.reason : undefined;
    return { name: known.name, reason: known.reason ?? change ?? null };
  }

  /** Time from the first moment to now [s]. */
  get length(): number {
    const first = Math.min(this.list[0]?.time ?? this.now, this.states[0]?.time ?? this.now);
    return Math.max(10, Math.min(LENGTH_S, this.now - first));
  }

  private numbers(state: RobotState): Numbers {
    return {
      covariance: state.covariance,
      measured: state.twist[0],
      commanded: state.command[0],
      position: positionEllipse(state.covariance).long,
      heading: headingBound(state.covariance),
      loads: this.loads(state),
      name: state.state,
      reason: state.hold ?? state.reason,
    };
  }

  private loads(state: RobotState): number[] {
    if (this.busy.length > 0 && state.time < this.busy[0]!.time) this.busy = [];
    this.busy.push({ time: state.time, stages: state.stages });
    while (this.busy[0]!.time < state.time - LOAD_S) this.busy.shift();
    const before = this.busy[0]!;
    const dt = state.time - before.time;
    const seconds = (of: RobotState["stages"], name: string) => of.find(([stage]) => stage === name)?.[1] ?? NaN;
    return LOADS.map((name) => (dt < LEAST_LOAD_S ? NaN : (seconds(state.stages, name) - seconds(before.stages, name)) / dt));
  }
}
