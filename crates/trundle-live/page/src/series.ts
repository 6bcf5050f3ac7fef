// How far a series of images or runs has come: the run that is shown, and the results of those that have ended.

import { element } from "./panel";
import type { Series } from "./wire";

export class SeriesCard {
  private number: number | null = null;

  /** `onOther`: another run is shown from now on. */
  constructor(private readonly onOther: () => void) {}

  show(series: Series): void {
    element("series-card").hidden = false;
    const of = series.total === null ? "" : ` of ${series.total}`;
    element("series-count").textContent = `${series.done}${of} ${series.unit}`;
    const bar = element<HTMLProgressElement>("series-bar");
    bar.hidden = series.total === null;
    bar.max = Math.max(1, series.total ?? 1);
    bar.value = series.done;
    element("series-shown").textContent = series.shown ? `Shown: ${series.shown}` : "";
    const failed = series.last.filter((run) => !run.is_success).length;
    const held = series.last.length < series.ended ? `the last ${series.last.length} of ${series.ended} runs: ` : "";
    element("series-failed").textContent = series.ended ? `${held}${series.last.length - failed} good, ${failed} failed` : "";
    const lines = series.last.map((run) => line(run.name, run.text, run.is_success));
    element("series-ended").replaceChildren(...lines.reverse());
    if (this.number !== null && this.number !== series.number) this.onOther();
    this.number = series.number;
  }
}

function line(name: string, text: string, isSuccess: boolean): HTMLElement {
  const item = document.createElement("li");
  item.dataset["tone"] = isSuccess ? "good" : "bad";
  const mark = document.createElement("i");
  mark.textContent = isSuccess ? "✓" : "✗";
  mark.setAttribute("aria-label", isSuccess ? "good" : "failed");
  const words = document.createElement("span");
  const strong = document.createElement("strong");
  strong.textContent = name;
  words.append(strong, ` ${text}`);
  item.append(mark, words);
  return item;
}
