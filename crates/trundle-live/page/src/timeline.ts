// The time line of the last ten minutes: what the robot did, and where it stood.

import type { Moment, Moments } from "./moments";
import { element, sentence, TONES } from "./panel";

export class Timeline {
  private drawn = 0;
  /** The time that is looked at; null: now. */
  private at: number | null = null;
  private readonly slider = element<HTMLInputElement>("past");

  /** `onLook`: a time is looked at, and the moment at it; null: now. */
  constructor(
    private readonly moments: Moments,
    private readonly onLook: (time: number | null, moment: Moment | null) => void,
  ) {
    this.slider.addEventListener("input", () => this.onInput());
    element("past-now").addEventListener("click", () => this.look(null));
    element("past-back").addEventListener("click", () => this.look(null));
  }

  /** The moments have grown. */
  moved(): void {
    const { now } = this.moments;
    if (now - this.drawn >= 1 || now < this.drawn) this.draw();
  }

  /** Shows a time of the past; null shows now. */
  look(time: number | null): void {
    this.at = time;
    this.onLook(time, time === null ? null : (this.moments.at(time) ?? this.moments.list[0] ?? null));
    this.showText();
    if (time === null) this.slider.value = "0";
    else this.slider.value = String(time - this.moments.now);
  }

  private onInput(): void {
    const back = -Number(this.slider.value);
    this.look(back < 0.5 ? null : this.moments.now - back);
  }

  /** The state at the time with its reason: above the map, beside the line, and for a person who listens. */
  private showText(): void {
    const isNow = this.at === null;
    element("past-now").hidden = isNow;
    element("past-flag").hidden = isNow;
    const state = this.at === null ? undefined : this.moments.stateAt(this.at);
    const back = this.at === null ? "now" : `${(this.moments.now - this.at).toFixed(0)} s ago`;
    const name = state ? sentence(state.name) : "";
    element("past-text").textContent = back;
    element("past-when").textContent = back;
    element("past-state").textContent = name;
    element("past-reason").textContent = state?.reason ?? "";
    this.slider.setAttribute("aria-valuetext", [back, name, state?.reason].filter(Boolean).join(", "));
  }

  /** The states as colours along the line. */
  draw(): void {
    const { now, length, states } = this.moments;
    this.drawn = now;
    this.slider.min = String(-length);
    if (this.at !== null) {
      this.slider.value = String(this.at - now);
      this.showText();
    }
    const canvas = element<HTMLCanvasElement>("past-line");
    const width = Math.round(canvas.clientWidth * devicePixelRatio);
    if (width === 0) return;
    if (canvas.width !== width) canvas.width = width;
    const context = canvas.getContext("2d")!;
    context.clearRect(0, 0, width, canvas.height);
    const style = getComputedStyle(canvas);
    const x = (time: number) => width * (1 - (now - time) / length);
    states.forEach((state, i) => {
      const end = states[i + 1]?.time ?? now;
      if (end < now - length) return;
      const tone = TONES[state.name] ?? "idle";
      context.fillStyle = style.getPropertyValue(tone === "busy" ? "--accent" : `--${tone}`);
      const from = Math.max(0, x(state.time));
      context.fillRect(from, 0, Math.max(1, x(end) - from), canvas.height);
    });
  }
}
