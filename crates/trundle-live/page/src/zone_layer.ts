// Zones and named places on the map, and the one that is being drawn.

import type { Colors } from "./theme";
import type { Place, Point, Pose, Zone, ZoneKind } from "./wire";

/** A zone that is being drawn or changed. */
export interface Draft {
  kind: ZoneKind;
  outline: Point[];
  /** Whether the last corner is joined to the first. */
  isClosed: boolean;
  /** The place of the pointer, to which the next side leads. */
  pointer: Point | null;
}

export interface ZoneScene {
  zones: Zone[];
  places: Place[];
  draft: Draft | null;
  /** Number of the zone that is being changed: its draft is drawn instead. */
  hidden: number;
}

/** Radius of a corner that can be taken [CSS pixels]. */
export const CORNER_PX = 7;

export function zoneColor(kind: ZoneKind, colors: Colors): string {
  return kind === "no_go" ? colors.noGo : kind === "area" ? colors.area : colors.slow;
}

export function kindText(kind: ZoneKind): string {
  return kind === "no_go" ? "no-go" : kind === "area" ? "area" : `slow, ${kind.slow} m/s`;
}

export class ZoneLayer {
  private hatch: { color: string; pattern: CanvasPattern } | null = null;

  constructor(private readonly context: CanvasRenderingContext2D) {}

  draw(scene: ZoneScene, colors: Colors, toScreen: (p: Point) => Point): void {
    for (const zone of scene.zones) {
      if (zone.id === scene.hidden) continue;
      this.area(zone.outline, zone.kind, colors, toScreen, true);
      this.label(zone.name || (zone.kind === "no_go" ? "" : kindText(zone.kind)), middle(zone.outline), colors, toScreen);
    }
    for (const place of scene.places) this.place(place, colors, toScreen);
    if (scene.draft) this.draft(scene.draft, colors, toScreen);
  }

  private area(outline: Point[], kind: ZoneKind, colors: Colors, toScreen: (p: Point) => Point, isClosed: boolean): void {
    const { context } = this;
    const ratio = devicePixelRatio;
    context.beginPath();
    outline.forEach((corner) => context.lineTo(...toScreen(corner)));
    if (isClosed) context.closePath();
    const color = zoneColor(kind, colors);
    context.save();
    if (outline.length > 2) {
      context.fillStyle = color;
      context.globalAlpha = kind === "area" ? 0.08 : 0.16;
      context.fill();
      if (kind === "no_go") {
        context.globalAlpha = 0.45;
        context.fillStyle = this.hatched(color);
        context.fill();
      }
    }
    context.globalAlpha = 0.95;
    context.strokeStyle = color;
    context.lineJoin = "round";
    context.lineWidth = 1.6 * ratio;
    if (kind === "area") context.setLineDash([5 * ratio, 4 * ratio]);
    context.stroke();
    context.restore();
  }

  /** Lines at 45 degrees. */
  private hatched(color: string): CanvasPattern {
    if (this.hatch?.color === color) return this.hatch.pattern;
    const size = 10 * devicePixelRatio;
    const tile = document.createElement("canvas");
    tile.width = tile.height = size;
    const context = tile.getContext("2d")!;
    context.strokeStyle = color;
    context.lineWidth = 1.5 * devicePixelRatio;
    context.beginPath();
    for (const shift of [-size, 0, size]) {
      context.moveTo(shift, size);
      context.lineTo(shift + size, 0);
    }
    context.stroke();
    const pattern = this.context.createPattern(tile, "repeat")!;
    this.hatch = { color, pattern };
    return pattern;
  }

  private label(text: string, at: Point, colors: Colors, toScreen: (p: Point) => Point): void {
    if (!text) return;
    const { context } = this;
    const ratio = devicePixelRatio;
    const [x, y] = toScreen(at);
    context.save();
    context.font = `600 ${12 * ratio}px system-ui, sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.lineJoin = "round";
    context.lineWidth = 3.5 * ratio;
    context.strokeStyle = colors.floor;
    context.strokeText(text, x, y);
    context.fillStyle = colors.text;
    context.fillText(text, x, y);
    context.restore();
  }

  /** A flag with its heading and its name beside it. */
  private place(place: Place, colors: Colors, toScreen: (p: Point) => Point): void {
    const { context } = this;
    const ratio = devicePixelRatio;
    const { x, y, theta } = place.pose;
    const [left, top] = toScreen([x, y]);
    context.save();
    context.translate(left, top);
    context.rotate(-theta);
    context.fillStyle = colors.area;
    context.strokeStyle = colors.floor;
    context.lineWidth = 2 * ratio;
    context.beginPath();
    context.moveTo(13 * ratio, 0);
    context.arc(0, 0, 6 * ratio, 0.55, 2 * Math.PI - 0.55);
    context.closePath();
    context.stroke();
    context.fill();
    context.restore();
    const beside = toScreen([x, y]);
    this.label(place.name, [x, y], colors, () => [beside[0], beside[1] + 18 * ratio]);
  }

  private draft(draft: Draft, colors: Colors, toScreen: (p: Point) => Point): void {
    const { context } = this;
    const ratio = devicePixelRatio;
    const points = draft.pointer && !draft.isClosed ? [...draft.outline, draft.pointer] : draft.outline;
    this.area(points, draft.kind, colors, toScreen, draft.isClosed);
    for (const corner of draft.outline) {
      context.beginPath();
      context.arc(...toScreen(corner), 0.75 * CORNER_PX * ratio, 0, 2 * Math.PI);
      context.fillStyle = colors.floor;
      context.fill();
      context.lineWidth = 2 * ratio;
      context.strokeStyle = zoneColor(draft.kind, colors);
      context.stroke();
    }
  }
}

/** The middle of an outline's box. */
export function middle(outline: Point[]): Point {
  const [xs, ys] = [outline.map((p) => p[0]), outline.map((p) => p[1])];
  return [(Math.min(...xs) + Math.max(...xs)) / 2, (Math.min(...ys) + Math.max(...ys)) / 2];
}

/** Whether a point is inside an outline. */
export function isInside(outline: Point[], [x, y]: Point): boolean {
  let is = false;
  outline.forEach(([ax, ay], i) => {
    const [bx, by] = outline[(i + 1) % outline.length]!;
    if (ay > y !== by > y && x < ax + ((bx - ax) * (y - ay)) / (by - ay)) is = !is;
  });
  return is;
}

export function asPose(place: Place): Pose {
  return [place.pose.x, place.pose.y, place.pose.theta];
}
