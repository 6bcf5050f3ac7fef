// Driving by hand: keys, a stick on the screen, a gamepad. Twists are sent ten times a second; silence stops the robot.

const PERIOD_MS = 100;
const DEAD_ZONE = 0.12;
const KEYS: Record<string, [v: number, omega: number]> = {
  ArrowUp: [1, 0],
  KeyW: [1, 0],
  ArrowDown: [-1, 0],
  KeyS: [-1, 0],
  ArrowLeft: [0, 1],
  KeyA: [0, 1],
  ArrowRight: [0, -1],
  KeyD: [0, -1],
};

export class Teleop {
  private isOn = false;
  private readonly keys = new Set<string>();
  private stick: [number, number] = [0, 0];
  /** Zero twists that are still to be sent after the last one, so that release is no silence. */
  private zeros = 0;

  constructor(
    private readonly pad: HTMLElement,
    private readonly knob: HTMLElement,
    private readonly send: (v: number, omega: number) => void,
  ) {
    setInterval(() => this.tick(), PERIOD_MS);
    window.addEventListener("keydown", (event) => this.onKey(event, true));
    window.addEventListener("keyup", (event) => this.onKey(event, false));
    window.addEventListener("blur", () => this.release());
    document.addEventListener("visibilitychange", () => document.hidden && this.release());
    pad.addEventListener("pointerdown", (event) => {
      pad.setPointerCapture(event.pointerId);
      this.moveStick(event);
    });
    pad.addEventListener("pointermove", (event) => pad.hasPointerCapture(event.pointerId) && this.moveStick(event));
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"] as const) {
      pad.addEventListener(name, () => this.centerStick());
    }
  }

  set enabled(isOn: boolean) {
    this.isOn = isOn;
    if (!isOn) this.release();
  }

  release(): void {
    this.keys.clear();
    this.centerStick();
  }

  private onKey(event: KeyboardEvent, isDown: boolean): void {
    if (!this.isOn || !(event.code in KEYS) || event.target instanceof HTMLInputElement) return;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    // A key that repeats was down before a stop, which released it.
    if (isDown && event.repeat) return;
    if (isDown) this.keys.add(event.code);
    else if (this.keys.delete(event.code) && this.keys.size === 0) this.tick();
  }

  private moveStick(event: PointerEvent): void {
    const box = this.pad.getBoundingClientRect();
    const radius = box.width / 2;
    let x = (event.clientX - box.left - radius) / radius;
    let y = (event.clientY - box.top - radius) / radius;
    const length = Math.hypot(x, y);
    if (length > 1) [x, y] = [x / length, y / length];
    this.stick = [-y, -x];
    this.knob.style.transform = `translate(${x * radius * 0.62}px, ${y * radius * 0.62}px)`;
  }

  private centerStick(): void {
    this.stick = [0, 0];
    this.knob.style.transform = "";
  }

  private tick(): void {
    if (!this.isOn) return;
    let [v, omega] = this.stick;
    for (const key of this.keys) {
      v += KEYS[key]?.[0] ?? 0;
      omega += KEYS[key]?.[1] ?? 0;
    }
    const pad = navigator.getGamepads?.().find((one) => one?.connected);
    if (pad) {
      const of = (axis: number) => (Math.abs(pad.axes[axis] ?? 0) > DEAD_ZONE ? (pad.axes[axis] ?? 0) : 0);
      v -= of(1);
      omega -= of(0) + of(2);
    }
    const is = Math.hypot(v, omega) > 0.02;
    if (is) this.zeros = 3;
    else if (this.zeros-- <= 0) return;
    const clamp = (x: number) => Math.max(-1, Math.min(1, x));
    // Backing up, the stick turns the way it points.
    this.send(clamp(v), clamp(omega) * (v < -0.1 ? -1 : 1) * 0.6);
  }
}
