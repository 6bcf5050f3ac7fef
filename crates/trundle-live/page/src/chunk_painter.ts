// Draws the pictures of the map at the scale of the view. A picture that is drawn smaller than its cells is halved, and a view that only moves
// copies pictures that have its scale, pixel by pixel: no frame computes a cell.

import { CHUNK_CELLS, type Chunk } from "./tiles";

/** A chunk in another size, and the change of the chunk that it shows. */
interface Copy {
  version: number;
  canvas: HTMLCanvasElement;
}

/** Pixels a cell from which cells are drawn as sharp squares. */
const SHARP_PX = 1.5;

export class ChunkPainter {
  /** Each chunk in halves, quarters and so on of its size. */
  private readonly halves = new WeakMap<Chunk, Copy[]>();
  /** The chunks in the size of the view. */
  private readonly fitted = new Map<Chunk, Copy>();
  private readonly drawn = new Set<Chunk>();
  private size = 0;
  private isSteady = false;

  /** Begins a frame in which the side of a chunk has so many pixels. */
  begin(size: number): void {
    this.isSteady = size === this.size;
    if (!this.isSteady) this.fitted.clear();
    this.size = size;
    this.drawn.clear();
  }

  /** Draws a chunk with its upper left corner at (x, y). Corners are whole pixels, so that no seam shows. */
  draw(context: CanvasRenderingContext2D, chunk: Chunk, x: number, y: number): void {
    const [left, top] = [Math.round(x), Math.round(y)];
    this.drawn.add(chunk);
    if (this.isSharp || !this.isSteady) {
      context.imageSmoothingEnabled = !this.isSharp;
      const [width, height] = [Math.round(x + this.size) - left, Math.round(y + this.size) - top];
      context.drawImage(this.source(chunk), left, top, width, height);
    } else {
      context.drawImage(this.fit(chunk), left, top);
    }
  }

  /** Ends a frame: pictures that it did not need are dropped. */
  end(): void {
    for (const chunk of this.fitted.keys()) if (!this.drawn.has(chunk)) this.fitted.delete(chunk);
  }

  private get isSharp(): boolean {
    return this.size >= SHARP_PX * CHUNK_CELLS;
  }

  /** The smallest picture of a chunk with at least the pixels that are drawn. */
  private source(chunk: Chunk): HTMLCanvasElement {
    let canvas = chunk.canvas;
    for (let level = 0; canvas.width >= 2 * this.size; level++) canvas = this.half(chunk, level, canvas);
    return canvas;
  }

  private half(chunk: Chunk, level: number, of: HTMLCanvasElement): HTMLCanvasElement {
    const copies = this.halves.get(chunk) ?? [];
    this.halves.set(chunk, copies);
    return (copies[level] = upToDate(copies[level], chunk, of, of.width / 2)).canvas;
  }

  private fit(chunk: Chunk): HTMLCanvasElement {
    const known = this.fitted.get(chunk);
    if (known?.version === chunk.version) return known.canvas;
    const copy = upToDate(known, chunk, this.source(chunk), Math.ceil(this.size));
    this.fitted.set(chunk, copy);
    return copy.canvas;
  }
}

/** A copy that shows the present chunk: the known one, or `of` drawn into it anew. */
function upToDate(known: Copy | undefined, chunk: Chunk, of: HTMLCanvasElement, side: number): Copy {
  if (known?.version === chunk.version) return known;
  const canvas = known?.canvas ?? document.createElement("canvas");
  canvas.width = canvas.height = side;
  const context = canvas.getContext("2d")!;
  context.drawImage(of, 0, 0, side, side);
  return { version: chunk.version, canvas };
}
