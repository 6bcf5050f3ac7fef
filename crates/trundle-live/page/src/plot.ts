// A plot of numbers over time with its legend. Lines differ in colour and dashes.

import type { Moment, Numbers } from "./moments";

export interface Line {
  name: string;
  /** A colour of the style sheet. */
  color: string;
  dash: number[];
  of: (numbers: Numbers) => number;
}

export interface PlotFacts {
  title: string;
  /** Class of the runs that have it. */
  audience: string;
  lines: Line[];
  /** Whether the area below the first line is filled, as that of a bound. */
  isFilled: boolean;
  /** The unit of its scale, and the least upper end of the scale in it. */
  unit: number;
  least: number;
  text: (value: number) => string;
}

/** The part of time that is shown, and the time that is looked at. */
export interface PlotWindow {
  from: number;
  to: number;
  now: number;
  at: number | null;
}

const HEIGHT_PX = 62;
/** Space above and below the lines, and below for the times [pixels]. */
const PAD_PX = 5;
const TIMES_PX = 13;

export class Plot {
  readonly canvas = document.createElement("canvas");
  private readonly values: HTMLElement[] = [];

  constructor(
    parent: HTMLElement,
    private readonly facts: PlotFacts,
  ) {
    const figure = document.createElement("figure");
    figure.className = `plot ${facts.audience}`;
    const caption = document.createElement("figcaption");
    const title = document.createElement("strong");
    title.textContent = facts.title;
    caption.append(title, ...facts.lines.map((line) => this.legend(line)));
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-description", "The arrow keys move the time line, End goes back to now.");
    figure.append(caption, this.canvas);
    parent.append(figure);
  }

  /** The time at a place of the window [CSS pixels]. */
  timeAt(x: number, { from, to }: PlotWindow): number {
    const box = this.canvas.getBoundingClientRect();
    return from + ((x - box.left) / Math.max(1, box.width)) * (to - from);
  }

  /** Draws the moments of a window. */
  draw(moments: Moment[], window: PlotWindow): void {
    const shown = moments.flatMap(({ time, numbers }) => (numbers ? [{ time, values: this.facts.lines.map((line) => line.of(numbers)) }] : []));
    this.showValues(shown, window);
    const context = this.begin();
    if (!context) return;
    const style = getComputedStyle(this.canvas);
    const all = shown.flatMap(({ values }) => values.filter(Number.isFinite));
    const { unit, least } = this.facts;
    const top = unit * roundUp(Math.max(least, ...all.map((value) => value / unit)));
    const lowest = Math.min(0, ...all);
    const bottom = lowest < -0.01 * top ? -unit * roundUp(-lowest / unit) : 0;
    const height = HEIGHT_PX - PAD_PX - TIMES_PX;
    const x = (time: number) => ((time - window.from) / (window.to - window.from)) * this.canvas.clientWidth;
    const y = (value: number) => PAD_PX + height - ((value - bottom) / (top - bottom)) * height;
    const marks = [...new Set([bottom, 0, top])];
    this.drawScale(context, style, marks.map(y));
    this.facts.lines.forEach((line, i) => {
      const points = shown.map(({ time, values }): [number, number] => [x(time), y(values[i]!)]);
      context.strokeStyle = context.fillStyle = style.getPropertyValue(line.color);
      if (this.facts.isFilled && i === 0) fill(context, points, y(0));
      stroke(context, points, line.dash);
    });
    if (window.at !== null) this.drawCursor(context, style, x(window.at));
    this.drawWords(context, style, marks.filter((value) => value !== 0), y, window);
  }

  private legend(line: Line): HTMLElement {
    const entry = document.createElement("span");
    const mark = document.createElement("i");
    mark.style.borderTopColor = `var(${line.color})`;
    mark.style.borderTopStyle = line.dash.length === 0 ? "solid" : line.dash[0]! > 2 ? "dashed" : "dotted";
    const value = document.createElement("b");
    this.values.push(value);
    entry.append(mark, line.name, " ", value);
    return entry;
  }

  /** The values at the time that is looked at: in the legend, and in words. */
  private showValues(shown: { time: number; values: number[] }[], { at, now }: PlotWindow): void {
    const moment = at === null ? shown.at(-1) : shown.findLast(({ time }) => time <= at);
    const texts = this.facts.lines.map((_, i) => {
      const value = moment?.values[i] ?? NaN;
      return Number.isFinite(value) ? this.facts.text(value) : "–";
    });
    texts.forEach((text, i) => this.values[i]!.textContent !== text && (this.values[i]!.textContent = text));
    const words = this.facts.lines.map((line, i) => `${line.name} ${texts[i] === "–" ? "not known" : texts[i]}`).join(", ");
    const when = at === null ? "now" : `${(now - at).toFixed(0)} s ago`;
    this.canvas.setAttribute("aria-label", `${this.facts.title}, ${when}: ${words}`);
  }

  private begin(): CanvasRenderingContext2D | null {
    const ratio = devicePixelRatio;
    const [width, height] = [Math.round(this.canvas.clientWidth * ratio), Math.round(HEIGHT_PX * ratio)];
    if (width === 0) return null;
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    const context = this.canvas.getContext("2d")!;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    return context;
  }

  private drawScale(context: CanvasRenderingContext2D, style: CSSStyleDeclaration, rows: number[]): void {
    context.lineWidth = 1;
    context.strokeStyle = style.getPropertyValue("--edge");
    context.beginPath();
    for (const row of rows) {
      context.moveTo(0, Math.round(row) + 0.5);
      context.lineTo(this.canvas.clientWidth, Math.round(row) + 0.5);
    }
    context.stroke();
  }

  /** The ends of the scale and the times, over the lines with a rim of the ground. */
  private drawWords(context: CanvasRenderingContext2D, style: CSSStyleDeclaration, values: number[], y: (v: number) => number, window: PlotWindow): void {
    const { from, to, now } = window;
    const time = (time: number) => (now - time < 0.5 ? "now" : `−${(now - time).toFixed(0)} s`);
    context.font = "10px system-ui, sans-serif";
    context.textBaseline = "middle";
    context.lineJoin = "round";
    context.lineWidth = 3;
    context.strokeStyle = style.getPropertyValue("--plot-ground");
    context.fillStyle = style.getPropertyValue("--text");
    const write = (text: string, x: number, row: number, align: CanvasTextAlign) => {
      context.textAlign = align;
      context.strokeText(text, x, row);
      context.fillText(text, x, row);
    };
    for (const value of values) write(this.facts.text(value), 3, y(value) + (value > 0 ? 8 : -7), "left");
    write(time(from), 3, HEIGHT_PX - 6, "left");
    write(time(to), this.canvas.clientWidth - 3, HEIGHT_PX - 6, "right");
  }

  private drawCursor(context: CanvasRenderingContext2D, style: CSSStyleDeclaration, x: number): void {
    context.strokeStyle = style.getPropertyValue("--text");
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x, HEIGHT_PX - TIMES_PX);
    context.stroke();
  }
}

/** The least of 1, 2 and 5 times a power of ten that is not less than a value. */
function roundUp(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((step) => step * power).find((step) => step >= value * (1 - 1e-9)) ?? value;
}

/** Draws a line through points; a gap where a value is not known. */
function stroke(context: CanvasRenderingContext2D, points: [number, number][], dash: number[]): void {
  context.beginPath();
  let isDrawing = false;
  for (const [x, y] of points) {
    if (Number.isFinite(y) && isDrawing) context.lineTo(x, y);
    else if (Number.isFinite(y)) context.moveTo(x, y);
    isDrawing = Number.isFinite(y);
  }
  context.lineWidth = 1.6;
  context.setLineDash(dash);
  context.stroke();
  context.setLineDash([]);
}

/** Fills the area below a line, between two points that are both known. */
function fill(context: CanvasRenderingContext2D, points: [number, number][], base: number): void {
  context.beginPath();
  for (let i = 1; i < points.length; i++) {
    const [[x0, y0], [x1, y1]] = [points[i - 1]!, points[i]!];
    if (!Number.isFinite(y0 + y1)) continue;
    context.moveTo(x0, base);
    for (const [x, y] of [[x0, y0], [x1, y1], [x1, base]] as const) context.lineTo(x, y);
  }
  context.globalAlpha = 0.2;
  context.fill();
  context.globalAlpha = 1;
}
