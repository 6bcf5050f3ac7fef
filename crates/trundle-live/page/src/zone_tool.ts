// Drawing of a zone: a drag gives a rectangle, clicks give corners, corners can be dragged.

import type { MapView } from "./map_view";
import { CORNER_PX, type Draft } from "./zone_layer";
import type { Point, ZoneKind } from "./wire";

/** Length of a drag from which on it gives a rectangle [pixels]. */
const RECTANGLE_DRAG_PX = 12;

export class ZoneTool {
  /** What is being drawn. */
  draft: Draft | null = null;
  private pressed: { at: Point; start: Point } | null = null;
  private corner = -1;

  constructor(
    private readonly map: MapView,
    /** Called when the outline is closed, or a closed one has changed. */
    private readonly onClosed: (draft: Draft) => void,
  ) {}

  /** Begins a new zone, or the change of an outline. */
  begin(kind: ZoneKind, outline: Point[] = []): void {
    this.draft = { kind, outline: outline.map(([x, y]) => [x, y]), isClosed: outline.length > 2, pointer: null };
    this.show();
  }

  end(): void {
    this.draft = null;
    this.pressed = null;
    this.corner = -1;
    this.show();
  }

  setKind(kind: ZoneKind): void {
    if (this.draft) this.draft.kind = kind;
    this.show();
  }

  down(x: number, y: number): void {
    if (!this.draft) this.begin("no_go");
    this.corner = this.cornerAt(x, y);
    this.pressed = { at: this.map.toMap(x, y), start: [x, y] };
  }

  move(x: number, y: number): void {
    const draft = this.draft;
    if (!draft) return;
    const at = this.map.toMap(x, y);
    draft.pointer = draft.isClosed ? null : at;
    if (this.pressed && this.corner >= 0) draft.outline[this.corner] = at;
    if (this.pressed && draft.outline.length === 0 && this.isDrag(x, y)) {
      this.map.zones.draft = { ...draft, outline: rectangle(this.pressed.at, at), isClosed: true, pointer: null };
      this.map.dirty();
      return;
    }
    this.show();
  }

  up(x: number, y: number): void {
    const { draft, pressed, corner } = this;
    this.pressed = null;
    this.corner = -1;
    if (!draft || !pressed) return;
    const at = this.map.toMap(x, y);
    const [dx, dy] = [x - pressed.start[0], y - pressed.start[1]];
    const isDrag = Math.hypot(dx, dy) >= RECTANGLE_DRAG_PX;
    if (draft.isClosed) {
      if (corner >= 0) this.onClosed(draft);
    } else if (draft.outline.length === 0 && isDrag) {
      draft.outline = rectangle(pressed.at, at);
      this.close();
    } else if (corner === 0 && draft.outline.length > 2) {
      this.close();
    } else if (corner < 0) {
      draft.outline.push(at);
    }
    this.show();
  }

  /** Joins the last corner to the first, where there are three. */
  close(): void {
    const draft = this.draft;
    if (!draft || draft.isClosed || draft.outline.length < 3) return;
    draft.isClosed = true;
    draft.pointer = null;
    this.show();
    this.onClosed(draft);
  }

  private isDrag(x: number, y: number): boolean {
    const start = this.pressed?.start;
    return start !== undefined && Math.hypot(x - start[0], y - start[1]) >= RECTANGLE_DRAG_PX;
  }

  /** The corner at a place of the window; -1 for none. */
  private cornerAt(x: number, y: number): number {
    return (this.draft?.outline ?? []).findIndex((corner) => {
      const [cx, cy] = this.map.toWindow(corner);
      return Math.hypot(cx - x, cy - y) <= 2 * CORNER_PX;
    });
  }

  private show(): void {
    this.map.zones.draft = this.draft;
    this.map.dirty();
  }
}

function rectangle([ax, ay]: Point, [bx, by]: Point): Point[] {
  return [
    [ax, ay],
    [bx, ay],
    [bx, by],
    [ax, by],
  ];
}
