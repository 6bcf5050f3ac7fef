// The panels: state in words, mission, numbers, what happened.

import type { RobotState, StateEntry } from "./wire";

type Tone = "good" | "busy" | "warn" | "bad" | "idle";

export const TONES: Record<string, Tone> = {
  idle: "idle",
  initializing: "busy",
  planning: "busy",
  driving: "busy",
  "final approach": "busy",
  maneuvering: "busy",
  waiting: "warn",
  recovering: "warn",
  lost: "bad",
  arrived: "good",
  stopped: "bad",
  standing: "idle",
  "driven by hand": "busy",
  tracking: "good",
  "tracking weakly": "warn",
  "dead reckoning": "warn",
};

/** Time between two rates [s]. */
const RATE_PERIOD_S = 1;
/** Number of stages that are shown. */
const SHOWN_STAGES = 6;

export function element<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no element ${id}`);
  return found as T;
}

function setText(id: string, text: string): void {
  const target = element(id);
  if (target.textContent !== text) target.textContent = text;
}

export class Panel {
  private rated: Pick<RobotState, "time" | "counts" | "stages"> | null = null;
  /** Processor time and clock of the program at the last part of a core that was shown. */
  private worked: RobotState["processor"] = null;
  private spoken = "";
  private tasks = "";

  show(state: RobotState): void {
    this.showStatus(state);
    this.showTasks(state);
    this.showNumbers(state);
    this.showRates(state);
    this.showProcessor(state.processor);
    this.showBattery(state);
  }

  /** The first line of the page: what the robot does, and why it does not move on. */
  private showStatus(state: RobotState): void {
    const [name, reason] = words(state);
    const isByHand = state.paused && Math.hypot(...state.command) > 0;
    const tone = isByHand ? "busy" : state.hold ? "warn" : (TONES[state.state] ?? "idle");
    setText("state", name);
    setText("reason", reason);
    element("status").dataset["tone"] = tone;
    const spoken = reason ? `${name}: ${reason}` : name;
    // A number that counts on in the reason is no news for a person who listens.
    const news = spoken.replace(/[\d.]+/g, "");
    if (news !== this.spoken) {
      this.spoken = news;
      setText("spoken", spoken);
    }
  }

  private showTasks(state: RobotState): void {
    const shown = JSON.stringify([state.left, state.ended]);
    if (shown === this.tasks) return;
    this.tasks = shown;
    const items = [
      ...state.ended.slice(-3).map((text) => item("done", "✓", text)),
      ...state.left.map((task, i) => item(i === 0 ? "now" : "next", String(i + 1), task.text)),
    ];
    if (state.left.length === 0) items.push(item("none", "–", "Nothing to do. Choose a goal on the map."));
    element("tasks").replaceChildren(...items);
    setText("queue", state.left.length > 1 ? `${state.left.length} tasks left` : "");
  }

  private showNumbers(state: RobotState): void {
    const [x, y, theta] = state.pose;
    setText("position", `${fixed(x, 2)}, ${fixed(y, 2)} m`);
    setText("heading", `${fixed((theta * 180) / Math.PI, 0)}°`);
    const [xx, xy, yy, heading] = state.covariance;
    const sigma = Math.sqrt(Math.max(0, (xx + yy) / 2 + Math.hypot((xx - yy) / 2, xy)));
    const turn = (Math.sqrt(Math.max(0, heading)) * 180) / Math.PI;
    const far = sigma < 1 ? `${(100 * sigma).toFixed(1)} cm` : `${sigma.toFixed(1)} m`;
    setText("sigma", `${far}, ${turn.toFixed(1)}°`);
    setText("speed", `${fixed(state.twist[0], 2)} m/s, ${fixed((state.twist[1] * 180) / Math.PI, 0)}°/s`);
    setText("clock", clock(state.time));
  }

  private showRates(state: RobotState): void {
    if (!this.rated || state.time < this.rated.time) {
      this.rated = state;
      return;
    }
    const dt = state.time - this.rated.time;
    if (dt < RATE_PERIOD_S) return;
    const rate = (i: 0 | 1 | 2) => `${((state.counts[i] - this.rated!.counts[i]) / dt).toFixed(0)} Hz`;
    setText("rate-slam", rate(0));
    setText("rate-map", rate(1));
    setText("rate-control", rate(2));
    setText("dropped", String(state.counts[3]));
    this.showStages(state, dt);
    this.rated = state;
  }

  /** The part of a core that the program takes by its own clock: a simulated robot has another one, and messages may be late. */
  private showProcessor(now: RobotState["processor"]): void {
    if (!now) return;
    this.worked ??= now;
    const [work, clock] = [now[0] - this.worked[0], now[1] - this.worked[1]];
    if (Math.abs(clock) < RATE_PERIOD_S) return;
    if (clock > 0) setText("processor", `${((100 * work) / clock).toFixed(0)} % of a core`);
    this.worked = now;
  }

  /** The part of a core that each stage of the robot takes, the largest first. */
  private showStages(state: RobotState, dt: number): void {
    const before = new Map(this.rated?.stages);
    const parts = state.stages.map(([name, seconds]) => [name, (seconds - (before.get(name) ?? 0)) / dt] as const);
    const shown = parts.filter(([, part]) => part >= 0.001).sort((a, b) => b[1] - a[1]);
    const lines = shown.slice(0, SHOWN_STAGES).map(([name, part]) => {
      const line = document.createElement("div");
      const bar = document.createElement("b");
      bar.style.width = `${Math.min(100, 100 * part).toFixed(1)}%`;
      const words = document.createElement("span");
      words.textContent = name.replaceAll("_", " ");
      const number = document.createElement("span");
      number.textContent = `${(100 * part).toFixed(1)} %`;
      line.append(words, number, bar);
      return line;
    });
    element("stages").replaceChildren(...lines);
  }

  private showBattery(state: RobotState): void {
    const battery = element("battery");
    battery.hidden = state.voltage === null;
    if (state.voltage === null) return;
    const charge = state.charge;
    const text = charge === null ? `${state.voltage.toFixed(1)} V` : `${(100 * charge).toFixed(0)} %`;
    battery.querySelector("span")!.textContent = state.charging ? `${text}, charging` : text;
    const level = charge ?? 0.5;
    battery.querySelector<HTMLElement>("b")!.style.width = `${100 * level}%`;
    battery.dataset["tone"] = level < 0.15 ? "bad" : level < 0.3 ? "warn" : "good";
    battery.title = `${state.voltage.toFixed(1)} V`;
  }
}

/** A text that begins as a sentence does. */
export function sentence(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** The state and its reason in words. What holds the wheels comes first. */
function words(state: RobotState): [string, string] {
  const name = sentence(state.state);
  const isMoving = Math.hypot(...state.command) > 0;
  if (state.paused && isMoving) return ["Driven by hand", "The mission waits."];
  if (state.paused) return ["Paused", "The wheels are held. Continue, or give a new task."];
  if (state.hold) return ["Held", state.hold];
  const task = sentence(state.left[0]?.text ?? "");
  if (state.reason) return [name, state.reason];
  return [name, state.state === "idle" || state.state === "arrived" ? "" : task];
}

function item(kind: string, mark: string, text: string): HTMLElement {
  const line = document.createElement("li");
  line.className = kind;
  const sign = document.createElement("i");
  sign.textContent = mark;
  const words = document.createElement("span");
  words.textContent = sentence(text);
  line.append(sign, words);
  return line;
}

/** Adds states to what happened, the newest on top. */
export function addToLog(states: StateEntry[], look: (time: number) => void): void {
  const log = element("log");
  for (const state of states) {
    const line = document.createElement("li");
    const time = document.createElement("time");
    time.textContent = clock(state.time);
    const words = document.createElement("div");
    words.textContent = sentence(state.name);
    if (state.reason) {
      const reason = document.createElement("span");
      reason.textContent = ` ${state.reason}`;
      words.append(reason);
    }
    line.append(time, words);
    line.dataset["time"] = String(state.time);
    line.addEventListener("click", () => look(state.time));
    log.prepend(line);
  }
  while (log.children.length > 200) log.lastElementChild?.remove();
}

/** Marks the state of a time in what happened; null marks none. */
export function markLog(time: number | null): void {
  const lines = [...element("log").children] as HTMLElement[];
  const current = time === null ? undefined : lines.find((line) => Number(line.dataset["time"]) <= time);
  lines.forEach((line) => (line === current ? line.setAttribute("aria-current", "time") : line.removeAttribute("aria-current")));
}

function clock(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds)) % 86400;
  const two = (n: number) => String(n).padStart(2, "0");
  return `${whole >= 3600 ? `${Math.floor(whole / 3600)}:` : ""}${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`;
}

/** A number with digits behind the point; none is -0. */
export function fixed(value: number, digits: number): string {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? (0).toFixed(digits) : text;
}
