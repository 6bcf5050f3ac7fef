// What the map's tiles were: each replaced tile of the last minutes, up to a bound of memory.

import { LENGTH_S } from "./moments";

/** The cells of a tile; null where none were known. */
export type Cells = Uint8Array | null;

/** Largest number of replaced tiles that are kept, 1 kB each. */
const MAX_CHANGES = 20_000;

export class TileHistory {
  private changes: { time: number; key: string; before: Cells }[] = [];

  /** A tile was replaced. */
  add(time: number, key: string, before: Cells): void {
    this.changes.push({ time, key, before });
    const excess = this.changes.length - MAX_CHANGES;
    const first = this.changes.findIndex((change) => change.time >= time - LENGTH_S);
    // Some at a time: each cut moves all that is kept.
    if (Math.max(excess, first) > MAX_CHANGES / 20) this.changes.splice(0, Math.max(excess, first));
  }

  /** The tiles that were others at a time, and their cells then. Before the first change that is kept, those of that change. */
  differentAt(time: number): Map<string, Cells> {
    const different = new Map<string, Cells>();
    for (let i = this.changes.length - 1; i >= 0 && this.changes[i]!.time > time; i--) {
      different.set(this.changes[i]!.key, this.changes[i]!.before);
    }
    return different;
  }

  clear(): void {
    this.changes = [];
  }
}
