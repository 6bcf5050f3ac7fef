// What a press on the map does: move it, set a goal with its heading, say where the robot stands, draw a zone, set a place.

import type { MapView } from "./map_view";
import type { Point, Pose } from "./wire";
import type { ZoneTool } from "./zone_tool";

export type Tool = "move" | "goal" | "pose" | "drive" | "zone" | "place";

/** Length of a drag from which on it gives a heading [pixels]. */
const HEADING_DRAG_PX = 12;

export interface ToolEvents {
  onGoal(pose: Pose, append: boolean): void;
  onPose(pose: Pose): void;
  onPlace(pose: Pose): void;
}

export class MapTools {
  tool: Tool = "move";
  private readonly pointers = new Map<number, Point>();
  private pressed: { at: Point; start: Point } | null = null;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly map: MapView,
    private readonly heading: () => number,
    private readonly zones: ZoneTool,
    private readonly events: ToolEvents,
  ) {
    canvas.addEventListener("dblclick", () => this.isDrawing && this.zones.close());
    canvas.addEventListener("pointerdown", (event) => this.onDown(event));
    canvas.addEventListener("pointermove", (event) => this.onMove(event));
    canvas.addEventListener("pointerup", (event) => this.onUp(event));
    canvas.addEventListener("pointercancel", (event) => this.cancel(event.pointerId));
    canvas.addEventListener("wheel", (event) => this.onWheel(event), { passive: false });
  }

  /** Forgets a drag. */
  cancel(pointer?: number): void {
    if (pointer !== undefined) this.pointers.delete(pointer);
    else this.pointers.clear();
    this.pressed = null;
    this.map.ghost = null;
    this.map.dirty();
  }

  private get isPointing(): boolean {
    return this.tool === "goal" || this.tool === "pose" || this.tool === "place";
  }

  private get isDrawing(): boolean {
    return this.tool === "zone";
  }

  private onDown(event: PointerEvent): void {
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (this.pointers.size > 1) {
      // Two fingers zoom, whatever the tool.
      this.pressed = null;
      this.map.ghost = null;
    } else if (this.isDrawing && event.button === 0) {
      this.zones.down(event.clientX, event.clientY);
    } else if (this.isPointing && event.button === 0) {
      this.pressed = { at: this.map.toMap(event.clientX, event.clientY), start: [event.clientX, event.clientY] };
      this.showGhost(event);
    }
  }

  private onMove(event: PointerEvent): void {
    const before = this.pointers.get(event.pointerId);
    if (this.isDrawing && this.pointers.size < 2) this.zones.move(event.clientX, event.clientY);
    if (!before) return;
    const now: Point = [event.clientX, event.clientY];
    if (this.pointers.size === 2) {
      const other = [...this.pointers].find(([id]) => id !== event.pointerId)?.[1];
      if (other) {
        const distance = (p: Point) => Math.max(1, Math.hypot(p[0] - other[0], p[1] - other[1]));
        this.map.zoom(distance(now) / distance(before), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
        this.map.pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
      }
    } else if (this.pressed) {
      this.showGhost(event);
    } else if (!this.isDrawing || event.buttons !== 1) {
      this.map.pan(now[0] - before[0], now[1] - before[1]);
    }
    this.pointers.set(event.pointerId, now);
  }

  private onUp(event: PointerEvent): void {
    const pose = this.pressed && this.pointedPose(event);
    const isAppended = event.shiftKey;
    const isDrawn = this.isDrawing && this.pointers.size === 1 && event.button === 0;
    this.cancel(event.pointerId);
    if (isDrawn) this.zones.up(event.clientX, event.clientY);
    if (!pose) return;
    if (this.tool === "place") this.events.onPlace(pose);
    if (this.tool === "goal") this.events.onGoal(pose, isAppended);
    if (this.tool === "pose") this.events.onPose(pose);
  }

  /** The place that was pressed, its heading that of the drag; without a drag from the robot to there. */
  private pointedPose(event: PointerEvent): Pose | null {
    if (!this.pressed) return null;
    const { at, start } = this.pressed;
    const [dx, dy] = [event.clientX - start[0], start[1] - event.clientY];
    const theta = Math.hypot(dx, dy) < HEADING_DRAG_PX ? this.heading() : Math.atan2(dy, dx);
    return [at[0], at[1], theta];
  }

  private showGhost(event: PointerEvent): void {
    const pose = this.pointedPose(event);
    this.map.ghost = pose && { pose, kind: this.tool === "pose" ? "pose" : "goal" };
    this.map.dirty();
  }

  private onWheel(event: WheelEvent): void {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
    this.map.zoom(Math.exp(-event.deltaY * lines * 0.0016), event.clientX, event.clientY);
  }
}
