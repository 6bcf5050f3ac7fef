// The card of the recording: what is written, the free space of its disk, and the switch.

import { element } from "./panel";
import type { Recording } from "./wire";

/** The recording of a run without a switch, in words. */
const WORDS: Record<string, string> = {
  none: "Nothing is recorded.",
  events: "Events are recorded, images are not.",
  all: "Everything is recorded.",
};

export class RecordingSwitch {
  private state: Recording | null = null;

  constructor(turn: (on: boolean) => void) {
    element("recording-switch").addEventListener("click", () => this.state && turn(!this.state.on));
  }

  /** The recording with which the run began. Without a word there is none to show. */
  begin(content: string): void {
    this.state = null;
    const words = WORDS[content] ?? "";
    element("recording").textContent = words;
    element("recording-free").textContent = "";
    element("recording-switch").hidden = true;
    this.mark(words !== "", content !== "none");
  }

  show(state: Recording): void {
    this.state = state;
    element("recording").textContent = sentence(state);
    element("recording-free").textContent = state.free_mb === null ? "" : `${space(state.free_mb)} free`;
    const button = element("recording-switch");
    button.hidden = false;
    button.textContent = state.on ? "End" : "Record";
    this.mark(true, state.on);
  }

  private mark(isShown: boolean, isOn: boolean): void {
    element("recording-card").hidden = !isShown;
    element("recording-card").dataset["on"] = String(isOn);
  }
}

function sentence({ on, file, reason }: Recording): string {
  if (on) return `Recording into ${file ?? "a file"}.`;
  const last = file ? `The last part is ${file}.` : "Nothing is recorded.";
  return reason ? `Off: ${reason}. ${last}` : `Off. ${last}`;
}

function space(mb: number): string {
  return mb < 10_000 ? `${mb} MB` : `${(mb / 1000).toFixed(0)} GB`;
}
