// Pictures of the camera in the last ten minutes, one a second, and the camera's card at a time of the past.

import { clearFeatures, drawDepth, drawImage, hideImage, type ImageEnd } from "./camera";
import { LENGTH_S } from "./moments";
import type { DepthMessage } from "./wire";

/** Time between two pictures that are kept [s]: 600 pictures of 20 kB with their depth of 20 kB. */
const PERIOD_S = 1;
/** Largest age of a picture that is shown for a time [s]. */
const MAX_AGE_S = 2;

interface Picture {
  time: number;
  jpeg: Uint8Array<ArrayBuffer>;
  depth: DepthMessage | null;
}

export class PastCamera {
  private pictures: Picture[] = [];
  private newest: Picture | null = null;
  /** The time that is looked at; null: now. */
  private at: number | null = null;
  private shown: Picture | null = null;

  /** Keeps an image, and draws it if now is looked at. */
  async add(time: number, jpeg: Uint8Array<ArrayBuffer>): Promise<ImageEnd> {
    this.newest = { time, jpeg, depth: null };
    const last = this.pictures.at(-1);
    if (last && time < last.time) this.pictures = [];
    if (!last || time < last.time || time - last.time >= PERIOD_S) this.pictures.push(this.newest);
    while (this.pictures[0] && this.pictures[0].time < time - LENGTH_S) this.pictures.shift();
    return this.at === null ? drawImage(jpeg) : "busy";
  }

  /** Keeps the depth of the last image, and draws it if now is looked at. */
  addDepth(depth: DepthMessage): void {
    if (this.newest) this.newest.depth = depth;
    if (this.at === null) drawDepth(depth);
  }

  /** Shows the picture of a time; null shows now. */
  look(time: number | null): void {
    this.at = time;
    const kept = time === null ? this.newest : this.pictures.findLast((picture) => picture.time <= time);
    const picture = kept && (time === null || time - kept.time <= MAX_AGE_S) ? kept : null;
    if (time !== null) clearFeatures();
    if (picture === this.shown && time !== null) return;
    this.shown = picture;
    if (picture) void this.draw(picture);
    else if (time !== null) hideImage("no image of this time");
  }

  forget(): void {
    this.pictures = [];
    this.newest = this.shown = null;
  }

  /** Draws a picture as soon as none is being decoded, unless another one is looked at by then. */
  private async draw(picture: Picture): Promise<void> {
    while (this.shown === picture && (await drawImage(picture.jpeg)) === "busy") {
      await new Promise(requestAnimationFrame);
    }
    if (this.shown === picture && picture.depth) drawDepth(picture.depth);
  }
}
