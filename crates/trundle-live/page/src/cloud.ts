// The cloud: points of the depth images in the map frame, the newest one of each voxel.

import { DepthRays } from "./depth_rays";
import { build, HEIGHT_M, RAINBOW } from "./shader";
import { VoxelTable } from "./voxel_table";
import { DEPTH_UNIT_M, type DepthMessage } from "./wire";

/** Side of a voxel [m]. */
const VOXEL_M = 0.05;
/** Largest number of points; the oldest go. */
const MAX_POINTS = 200_000;
/** Numbers of a point: x, y, z, and a colour of four bytes. */
const POINT_NUMBERS = 4;
const POINT_BYTES = 4 * POINT_NUMBERS;
/** Points that are sent to the graphics processor together. */
const BLOCK_POINTS = 1024;
/** Depth of a picture that may be any larger one. */
const TOO_FAR = 255;
/** Size of a point in parts of the window's height at 1 m: a little more than a voxel. */
const POINT_SIZE = 0.045;

const VERTEX = `#version 300 es
in vec3 at; in vec4 tint; uniform mat4 view; uniform float size; out vec3 color;${RAINBOW}
void main() {
  gl_Position = view * vec4(at, 1.0);
  gl_PointSize = clamp(size / gl_Position.w, 1.5, 32.0);
  color = tint.a > 0.5 ? tint.rgb : rainbow(clamp(at.z / ${HEIGHT_M}, 0.0, 1.0));
}`;
const FRAGMENT = `#version 300 es
precision mediump float;
in vec3 color; out vec4 pixel;
void main() { pixel = vec4(color, 1.0); }`;

export class Cloud {
  /** x, y, z and colour of each point. */
  readonly points = new Float32Array(POINT_NUMBERS * MAX_POINTS);
  private readonly colors = new Uint32Array(this.points.buffer);
  private readonly voxels = new VoxelTable(MAX_POINTS);
  private readonly rays = new DepthRays();
  /** Blocks of points that the graphics processor lacks. */
  private readonly changed = new Uint8Array(Math.ceil(MAX_POINTS / BLOCK_POINTS));
  private readonly picture = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  private mapNumber = 0;
  private readonly program: WebGLProgram | null;
  private readonly buffer: WebGLBuffer;
  private readonly layout: WebGLVertexArrayObject;
  private readonly view: WebGLUniformLocation | null = null;
  private readonly size: WebGLUniformLocation | null = null;

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.program = build(gl, VERTEX, FRAGMENT);
    this.buffer = gl.createBuffer();
    this.layout = gl.createVertexArray();
    if (!this.program) return;
    this.view = gl.getUniformLocation(this.program, "view");
    this.size = gl.getUniformLocation(this.program, "size");
    const [at, tint] = [gl.getAttribLocation(this.program, "at"), gl.getAttribLocation(this.program, "tint")];
    gl.bindVertexArray(this.layout);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, this.points.byteLength, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, 3, gl.FLOAT, false, POINT_BYTES, 0);
    gl.enableVertexAttribArray(tint);
    gl.vertexAttribPointer(tint, 4, gl.UNSIGNED_BYTE, true, POINT_BYTES, 12);
    gl.bindVertexArray(null);
  }

  /** Number of points. */
  get count(): number {
    return this.voxels.count;
  }

  clear(): void {
    this.voxels.clear();
  }

  /** Gives the memory of the graphics processor back. */
  free(): void {
    this.gl.deleteProgram(this.program);
    this.gl.deleteBuffer(this.buffer);
    this.gl.deleteVertexArray(this.layout);
  }

  /** Adds the points of a depth image, in the colours of its image; without an image they are coloured by height. */
  add({ width, pixels, mapNumber, viewpoint }: DepthMessage, image: HTMLCanvasElement | null): void {
    if (mapNumber !== this.mapNumber) this.clear();
    this.mapNumber = mapNumber;
    const height = Math.floor(pixels.length / Math.max(1, width));
    if (!viewpoint || height === 0) return;
    const rays = this.rays.of(width, width * height, viewpoint);
    const colors = image && this.colorsOf(image, width, height);
    const pose = viewpoint.subarray(9);
    for (let i = 0; i < width * height; i++) {
      const unit = pixels[i]!;
      if (unit === 0 || unit === TOO_FAR) continue;
      // The depth is in the middle of its step.
      const z = (unit - 0.5) * DEPTH_UNIT_M;
      this.put(pose, rays[2 * i]! * z, rays[2 * i + 1]! * z, z, colors ? colors[i]! : 0);
    }
  }

  /** Puts a point of the camera frame into its voxel. */
  private put(pose: Float32Array, x: number, y: number, z: number, color: number): void {
    const mapX = pose[0]! * x + pose[1]! * y + pose[2]! * z + pose[3]!;
    const mapY = pose[4]! * x + pose[5]! * y + pose[6]! * z + pose[7]!;
    const mapZ = pose[8]! * x + pose[9]! * y + pose[10]! * z + pose[11]!;
    const slot = this.voxels.slot(Math.floor(mapX / VOXEL_M), Math.floor(mapY / VOXEL_M), Math.floor(mapZ / VOXEL_M));
    const at = POINT_NUMBERS * slot;
    this.points[at] = mapX;
    this.points[at + 1] = mapY;
    this.points[at + 2] = mapZ;
    this.colors[at + 3] = color;
    this.changed[Math.floor(slot / BLOCK_POINTS)] = 1;
  }

  /** The colour of each pixel of a depth picture, as four bytes. */
  private colorsOf(image: HTMLCanvasElement, width: number, height: number): Uint32Array | null {
    if (!this.picture) return null;
    const { canvas } = this.picture;
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    this.picture.drawImage(image, 0, 0, width, height);
    return new Uint32Array(this.picture.getImageData(0, 0, width, height).data.buffer);
  }

  /** Draws the points by a matrix from the map frame to a window of so many pixels of height. */
  draw(view: Float32Array, height: number): void {
    const { gl } = this;
    if (!this.program || this.count === 0) return;
    this.upload();
    gl.useProgram(this.program);
    gl.uniformMatrix4fv(this.view, false, view);
    gl.uniform1f(this.size, POINT_SIZE * height);
    gl.bindVertexArray(this.layout);
    gl.drawArrays(gl.POINTS, 0, this.count);
    gl.bindVertexArray(null);
  }

  /** Sends changed blocks to the graphics processor, neighbours together. */
  private upload(): void {
    const { gl, changed } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    for (let block = 0; block < changed.length; block++) {
      const first = block;
      while (changed[block]) changed[block++] = 0;
      if (block === first) continue;
      const [from, to] = [first * BLOCK_POINTS, Math.min(block * BLOCK_POINTS, MAX_POINTS)];
      gl.bufferSubData(gl.ARRAY_BUFFER, from * POINT_BYTES, this.points, from * POINT_NUMBERS, (to - from) * POINT_NUMBERS);
    }
  }
}
