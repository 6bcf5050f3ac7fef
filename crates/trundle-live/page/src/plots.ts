// The plots of the panel: speed, bounds of the pose, and load of the stages. A press on a plot looks at its time.

import type { Moments } from "./moments";
import { element, fixed } from "./panel";
import { Plot, type PlotFacts, type PlotWindow } from "./plot";

/** Time that the plots show [s]. */
const SHOWN_S = 60;
/** Time that a press of an arrow key moves [s]. */
const STEP_S = 1;

const SOLID: number[] = [];
const DASHED = [6, 3];
const DOTTED = [1.6, 2.4];
/** Bounds from which on the pose counts as unknown: a gap in the plot [m], [rad]. */
const UNKNOWN_M = 5;
const UNKNOWN_RAD = Math.PI;
const known = (value: number, limit: number) => (value < limit ? value : NaN);
const degrees = (angle: number) => `${((angle * 180) / Math.PI).toFixed(1)}°`;
const length = (metres: number) => (Math.abs(metres) < 1 ? `${(100 * metres).toFixed(Math.abs(metres) < 0.1 ? 1 : 0)} cm` : `${metres.toFixed(1)} m`);
const percent = (part: number) => `${(100 * part).toFixed(part < 0.1 ? 1 : 0)} %`;

const PLOTS: PlotFacts[] = [
  {
    title: "Speed",
    audience: "for-base",
    lines: [
      { name: "measured", color: "--accent", dash: SOLID, of: (numbers) => numbers.measured },
      { name: "commanded", color: "--map-plan", dash: DASHED, of: (numbers) => numbers.commanded },
    ],
    isFilled: false,
    unit: 1,
    least: 0.2,
    text: (speed) => `${fixed(speed, 2)} m/s`,
  },
  {
    title: "Position",
    audience: "for-robot",
    lines: [{ name: "95 % radius", color: "--accent", dash: SOLID, of: (numbers) => known(numbers.position, UNKNOWN_M) }],
    isFilled: true,
    unit: 1,
    least: 0.05,
    text: length,
  },
  {
    title: "Heading",
    audience: "for-robot",
    lines: [{ name: "95 % bound", color: "--map-area", dash: SOLID, of: (numbers) => known(numbers.heading, UNKNOWN_RAD) }],
    isFilled: true,
    unit: Math.PI / 180,
    least: 1,
    text: degrees,
  },
  {
    title: "Load of a core",
    audience: "for-robot",
    lines: [
      { name: "SLAM", color: "--accent", dash: SOLID, of: (numbers) => numbers.loads[0]! },
      { name: "map", color: "--map-plan", dash: DASHED, of: (numbers) => numbers.loads[1]! },
      { name: "plan", color: "--warn", dash: DOTTED, of: (numbers) => numbers.loads[2]! },
      { name: "control", color: "--map-scan", dash: SOLID, of: (numbers) => numbers.loads[3]! },
    ],
    isFilled: false,
    unit: 1,
    least: 0.05,
    text: percent,
  },
];

export class Plots {
  private readonly plots: Plot[];
  private at: number | null = null;

  /** `look` shows a time of the past; null shows now. */
  constructor(
    private readonly moments: Moments,
    private readonly look: (time: number | null) => void,
  ) {
    this.plots = PLOTS.map((facts) => new Plot(element("plots"), facts));
    this.plots.forEach((plot) => {
      plot.canvas.addEventListener("pointerdown", (event) => this.onPointer(plot, event));
      plot.canvas.addEventListener("pointermove", (event) => event.buttons > 0 && this.onPointer(plot, event));
      plot.canvas.addEventListener("keydown", (event) => this.onKey(event));
    });
  }

  /** Shows a time of the past as a line; null removes it. */
  mark(time: number | null): void {
    this.at = time;
    this.draw();
  }

  draw(): void {
    const { window } = this;
    const shown = this.moments.list.filter(({ time }) => time >= window.from && time <= window.to);
    this.plots.forEach((plot) => plot.draw(shown, window));
  }

  /** The last minute, or a minute around a time before it. */
  private get window(): PlotWindow {
    const { now } = this.moments;
    const isOld = this.at !== null && this.at < now - SHOWN_S;
    const to = isOld ? Math.min(now, this.at! + SHOWN_S / 2) : now;
    return { from: to - SHOWN_S, to, now, at: this.at };
  }

  private onPointer(plot: Plot, event: PointerEvent): void {
    const time = plot.timeAt(event.clientX, this.window);
    this.look(time > this.moments.now - 0.5 ? null : time);
  }

  private onKey(event: KeyboardEvent): void {
    const steps: Record<string, number> = { ArrowLeft: -STEP_S, ArrowRight: STEP_S, End: Infinity };
    const step = steps[event.key];
    // The arrow keys drive while a person drives by hand.
    if (step === undefined || document.body.dataset["tool"] === "drive") return;
    event.preventDefault();
    const time = (this.at ?? this.moments.now) + step;
    this.look(time > this.moments.now - 0.5 ? null : Math.max(time, this.moments.now - this.moments.length));
  }
}
