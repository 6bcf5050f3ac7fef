// The directions of the pixels of a depth picture, without the distortion of the lens.

/** Steps of the inverse of a lens, as in the program. */
const LENS_STEPS = 20;
/** Numbers of a camera: focal lengths, principal point, lens. */
const CAMERA_NUMBERS = 9;

export class DepthRays {
  private width = 0;
  private readonly camera = new Float32Array(CAMERA_NUMBERS);
  private rays = new Float32Array();

  /** x and y of each pixel at a depth of 1 m. They are computed anew for another camera only. */
  of(width: number, pixels: number, camera: Float32Array): Float32Array {
    const isSame = width === this.width && this.rays.length === 2 * pixels && this.camera.every((n, i) => n === camera[i]);
    if (isSame) return this.rays;
    this.width = width;
    this.camera.set(camera.subarray(0, CAMERA_NUMBERS));
    this.rays = new Float32Array(2 * pixels);
    for (let i = 0; i < pixels; i++) this.rays.set(ray(this.camera, i % width, Math.floor(i / width)), 2 * i);
    return this.rays;
  }
}

/** The place of a pixel at a depth of 1 m [m]. */
function ray([fx, fy, cx, cy, ...lens]: Float32Array, column: number, row: number): [x: number, y: number] {
  const [rawX, rawY] = [(column - cx!) / fx!, (row - cy!) / fy!];
  let [x, y] = [rawX, rawY];
  if (lens.every((n) => n === 0)) return [x, y];
  for (let i = 0; i < LENS_STEPS; i++) {
    const [bentX, bentY] = distorted(lens, x, y);
    [x, y] = [x + rawX - bentX, y + rawY - bentY];
  }
  return [x, y];
}

/** The lens of Brown and Conrady. */
function distorted([k1, k2, p1, p2, k3]: number[], x: number, y: number): [x: number, y: number] {
  const r2 = x * x + y * y;
  const radial = 1 + r2 * (k1! + r2 * (k2! + r2 * k3!));
  return [
    x * radial + 2 * p1! * x * y + p2! * (r2 + 2 * x * x),
    y * radial + p1! * (r2 + 2 * y * y) + 2 * p2! * x * y,
  ];
}
