// The tiles of the map as pictures: 8 x 8 tiles share one canvas, so that a large map is few pictures.

import { ChunkPainter } from "./chunk_painter";
import { TileHistory, type Cells } from "./tile_history";
import { TILE_CELLS, type Point, type TileMessage } from "./wire";

const CHUNK_TILES = 8;
/** Cells along a side of a picture. */
export const CHUNK_CELLS = CHUNK_TILES * TILE_CELLS;

export interface Chunk {
  column: number;
  row: number;
  /** Counts its changes. */
  version: number;
  canvas: HTMLCanvasElement;
  context: CanvasRenderingContext2D;
}

/** The cells of a tile of which nothing is known. */
const UNKNOWN = new Uint8Array((TILE_CELLS * TILE_CELLS) / 4);

type Rgba = [number, number, number, number];

export class Tiles {
  resolution = 0.05;
  origin: Point = [0, 0];
  private generation = -1;
  private readonly chunks = new Map<string, Chunk>();
  private readonly cells = new Map<string, { column: number; row: number; cells: Uint8Array }>();
  private readonly history = new TileHistory();
  /** The time that is looked at [s]; null: now. */
  private lookedAt: number | null = null;
  /** The tiles that were others at that time. */
  private past = new Map<string, Cells>();
  private readonly painter = new ChunkPainter();
  private readonly image = new ImageData(TILE_CELLS, TILE_CELLS);
  /** The colour of free cells beside unknown ones. */
  private frontier: Rgba = [128, 128, 128, 255];
  private palette: [Rgba, Rgba, Rgba] = [
    [0, 0, 0, 0],
    [128, 128, 128, 255],
    [0, 0, 0, 255],
  ];

  setColors(floor: string, wall: string, frontier: string): void {
    this.frontier = rgba(frontier);
    this.palette = [[0, 0, 0, 0], rgba(floor), rgba(wall)];
    this.cells.forEach((_, key) => this.paint(key));
  }

  /** Takes tiles over that came at a time of the robot [s]. */
  add(message: TileMessage, time: number): void {
    if (message.generation !== this.generation || message.resolution !== this.resolution) {
      this.generation = message.generation;
      this.chunks.clear();
      this.cells.clear();
      this.history.clear();
      this.past.clear();
    }
    this.resolution = message.resolution;
    this.origin = message.origin;
    for (const tile of message.tiles) {
      const key = `${tile.column},${tile.row}`;
      const before = this.cells.get(key)?.cells ?? null;
      this.history.add(time, key, before);
      if (this.lookedAt !== null && !this.past.has(key)) this.past.set(key, before);
      this.cells.set(key, tile);
    }
    this.repaint(message.tiles.map(({ column, row }) => `${column},${row}`));
  }

  /** Shows the map of a time [s]; null shows now. */
  look(time: number | null): void {
    const past = time === null ? new Map<string, Cells>() : this.history.differentAt(time);
    const keys = new Set([...this.past.keys(), ...past.keys()]);
    const before = new Map([...keys].map((key) => [key, this.shown(key)]));
    this.lookedAt = time;
    this.past = past;
    this.repaint([...keys].filter((key) => this.shown(key) !== before.get(key)));
  }

  /** The cells of a tile at the time that is looked at. */
  private shown(key: string): Cells {
    const past = this.past.get(key);
    return past === undefined ? (this.cells.get(key)?.cells ?? null) : past;
  }

  private repaint(keys: string[]): void {
    const changed = new Set<string>();
    for (const key of keys) {
      const tile = this.cells.get(key);
      if (!tile) continue;
      // The frontier at the border of a tile depends on the tile beside it.
      for (const [dx, dy] of [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]] as const) changed.add(`${tile.column + dx},${tile.row + dy}`);
    }
    changed.forEach((key) => this.paint(key));
  }

  /** Whether a point of the map frame is in an occupied cell. */
  isWall(p: Point): boolean {
    return this.cellAt(p) === 2;
  }

  /** Whether the cell of a point of the map frame is known. */
  isKnown(p: Point): boolean {
    return this.cellAt(p) !== 0;
  }

  /** The cell of a point of the map frame: 0 unknown, 1 free, 2 occupied. */
  private cellAt(p: Point): number {
    const column = Math.floor((p[0] - this.origin[0]) / this.resolution);
    const row = Math.floor((p[1] - this.origin[1]) / this.resolution);
    const tile = this.cells.get(`${Math.floor(column / TILE_CELLS)},${Math.floor(row / TILE_CELLS)}`);
    if (!tile) return 0;
    const i = (row - tile.row * TILE_CELLS) * TILE_CELLS + (column - tile.column * TILE_CELLS);
    return ((tile.cells[i >> 2] ?? 0) >> (2 * (i & 3))) & 3;
  }

  /** Corners of the cells that are known, map frame; null without one. */
  knownBounds(): { min: Point; max: Point } | null {
    let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
    for (const { column, row, cells } of this.cells.values()) {
      for (let i = 0; i < cells.length; i++) {
        if (cells[i] === 0) continue;
        const [x, y] = [column * TILE_CELLS + 4 * (i % 16), row * TILE_CELLS + Math.floor(i / 16)];
        [x0, y0, x1, y1] = [Math.min(x0, x), Math.min(y0, y), Math.max(x1, x + 4), Math.max(y1, y + 1)];
      }
    }
    if (x0 === Infinity) return null;
    const at = (x: number, y: number): Point => [
      this.origin[0] + x * this.resolution,
      this.origin[1] + y * this.resolution,
    ];
    return { min: at(x0, y0), max: at(x1, y1) };
  }

  /** The pictures, each with its lower left corner in the map frame and its side [m]. */
  *pictures(): Generator<{ chunk: Chunk; corner: Point; side: number }> {
    const side = CHUNK_CELLS * this.resolution;
    for (const chunk of this.chunks.values()) {
      yield { chunk, corner: [this.origin[0] + chunk.column * side, this.origin[1] + chunk.row * side], side };
    }
  }

  /** Draws what is visible. `toScreen` gives the place of a point of the map frame, `scale` pixels a metre. */
  draw(context: CanvasRenderingContext2D, toScreen: (p: Point) => Point, scale: number): void {
    const side = CHUNK_CELLS * this.resolution;
    const size = side * scale;
    const { width, height } = context.canvas;
    this.painter.begin(size);
    for (const chunk of this.chunks.values()) {
      const corner: Point = [this.origin[0] + chunk.column * side, this.origin[1] + (chunk.row + 1) * side];
      const [x, y] = toScreen(corner);
      if (x > width || y > height || x + size < 0 || y + size < 0) continue;
      this.painter.draw(context, chunk, x, y);
    }
    this.painter.end();
  }

  private paint(key: string): void {
    const tile = this.cells.get(key);
    if (!tile) return;
    const { column, row } = tile;
    const cells = this.shown(key) ?? UNKNOWN;
    const data = this.image.data;
    for (let y = 0; y < TILE_CELLS; y++) {
      for (let x = 0; x < TILE_CELLS; x++) {
        const i = y * TILE_CELLS + x;
        const value = ((cells[i >> 2] ?? 0) >> (2 * (i & 3))) & 3;
        const isFrontier = value === 1 && this.isBesideUnknown(column, row, cells, x, y);
        const color = isFrontier ? this.frontier : (this.palette[value as 0 | 1 | 2] ?? this.palette[0]);
        // Pictures begin at the top, tiles at the bottom.
        const at = 4 * ((TILE_CELLS - 1 - y) * TILE_CELLS + x);
        data[at] = color[0];
        data[at + 1] = color[1];
        data[at + 2] = color[2];
        data[at + 3] = color[3];
      }
    }
    const chunk = this.chunk(Math.floor(column / CHUNK_TILES), Math.floor(row / CHUNK_TILES));
    const x = column - chunk.column * CHUNK_TILES;
    const y = CHUNK_TILES - 1 - (row - chunk.row * CHUNK_TILES);
    chunk.version += 1;
    chunk.context.putImageData(this.image, x * TILE_CELLS, y * TILE_CELLS);
  }

  /** Whether a cell beside cell (x, y) of a tile is unknown. */
  private isBesideUnknown(column: number, row: number, cells: Uint8Array, x: number, y: number): boolean {
    const last = TILE_CELLS - 1;
    const value = (of: Cells, i: number) => (of ? ((of[i >> 2] ?? 0) >> (2 * (i & 3))) & 3 : 0);
    const at = (dx: number, dy: number): number => {
      const [cx, cy] = [x + dx, y + dy];
      if (cx >= 0 && cy >= 0 && cx <= last && cy <= last) return value(cells, cy * TILE_CELLS + cx);
      const beside = this.shown(`${column + Math.floor(cx / TILE_CELLS)},${row + Math.floor(cy / TILE_CELLS)}`);
      return value(beside, ((cy + TILE_CELLS) % TILE_CELLS) * TILE_CELLS + ((cx + TILE_CELLS) % TILE_CELLS));
    };
    return at(1, 0) === 0 || at(-1, 0) === 0 || at(0, 1) === 0 || at(0, -1) === 0;
  }

  private chunk(column: number, row: number): Chunk {
    const key = `${column},${row}`;
    const known = this.chunks.get(key);
    if (known) return known;
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = CHUNK_CELLS;
    const context = canvas.getContext("2d")!;
    const chunk = { column, row, version: 0, canvas, context };
    this.chunks.set(key, chunk);
    return chunk;
  }
}

/** A colour of the style sheet as bytes. */
function rgba(color: string): Rgba {
  const context = document.createElement("canvas").getContext("2d")!;
  context.fillStyle = color;
  context.fillRect(0, 0, 1, 1);
  const [r, g, b, a] = context.getImageData(0, 0, 1, 1).data;
  return [r ?? 0, g ?? 0, b ?? 0, a ?? 255];
}
