// The map, the landmarks and the robot in space, by WebGL: drag turns the view, the wheel zooms.

import { Cloud } from "./cloud";
import type { MapView } from "./map_view";
import { build, HEIGHT_M, RAINBOW } from "./shader";
import type { Chunk } from "./tiles";

type Matrix = Float32Array;

const VERTEX = `#version 300 es
in vec3 at; in vec2 uv; uniform mat4 view; uniform float size; out float height; out vec2 place;
void main() { gl_Position = view * vec4(at, 1.0); gl_PointSize = clamp(size / gl_Position.w, 1.5, 9.0); height = at.z; place = uv; }`;
const FRAGMENT = `#version 300 es
precision mediump float;
in float height; in vec2 place; uniform int mode; uniform vec4 color; uniform sampler2D picture; out vec4 pixel;${RAINBOW}
void main() {
  if (mode == 1) { pixel = texture(picture, place); if (pixel.a < 0.1) discard; }
  else if (mode == 2) {
    if (length(gl_PointCoord - 0.5) > 0.5) discard;
    pixel = vec4(rainbow(clamp(height / ${HEIGHT_M}, 0.0, 1.0)), 1.0);
  } else pixel = color;
}`;

/** Height of the robot as it is drawn [m]. */
const ROBOT_HEIGHT_M = 0.35;

export class SpaceView {
  private readonly gl: WebGL2RenderingContext | null;
  private readonly program: WebGLProgram | null = null;
  private readonly buffer: WebGLBuffer | null = null;
  private readonly textures = new Map<Chunk, { texture: WebGLTexture; version: number }>();
  /** The points of depth images; null while they are not collected. */
  cloud: Cloud | null = null;
  private isOn = false;
  private turn = -2.2;
  private tilt = 0.85;
  private distance = 6;
  private drag: [number, number] | null = null;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly map: MapView,
  ) {
    this.gl = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: false });
    if (!this.gl) return;
    this.program = build(this.gl, VERTEX, FRAGMENT);
    this.buffer = this.gl.createBuffer();
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.drag = [event.clientX, event.clientY];
    });
    canvas.addEventListener("pointermove", (event) => this.onDrag(event));
    canvas.addEventListener("pointerup", () => (this.drag = null));
    canvas.addEventListener("pointercancel", () => (this.drag = null));
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.zoom(Math.exp(event.deltaY * 0.0016));
      },
      { passive: false },
    );
  }

  /** Whether this browser can draw it. */
  get isPossible(): boolean {
    return this.program !== null;
  }

  get isShown(): boolean {
    return this.isOn;
  }

  show(isOn: boolean): void {
    this.isOn = isOn && this.isPossible;
    this.canvas.hidden = !this.isOn;
    if (this.isOn) requestAnimationFrame(() => this.frame());
  }

  /** Begins a cloud, or forgets it with its points. */
  collect(isOn: boolean): void {
    this.cloud?.free();
    this.cloud = isOn && this.gl ? new Cloud(this.gl) : null;
  }

  zoom(factor: number): void {
    this.distance = Math.max(0.8, Math.min(60, this.distance * factor));
  }

  private onDrag(event: PointerEvent): void {
    if (!this.drag) return;
    this.turn -= (event.clientX - this.drag[0]) * 0.006;
    this.tilt = Math.max(0.12, Math.min(1.55, this.tilt + (event.clientY - this.drag[1]) * 0.006));
    this.drag = [event.clientX, event.clientY];
  }

  private frame(): void {
    if (!this.isOn || !this.gl || !this.program) return;
    this.resize();
    this.draw(this.gl, this.program);
    requestAnimationFrame(() => this.frame());
  }

  private resize(): void {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight].map((n) => Math.round(n * devicePixelRatio));
    if (this.canvas.width !== width) this.canvas.width = width ?? 1;
    if (this.canvas.height !== height) this.canvas.height = height ?? 1;
  }

  private draw(gl: WebGL2RenderingContext, program: WebGLProgram): void {
    const scene = this.map.scene;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.useProgram(program);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    const view = this.view(scene.robot ?? [0, 0, 0]);
    gl.uniformMatrix4fv(gl.getUniformLocation(program, "view"), false, view);
    gl.uniform1f(gl.getUniformLocation(program, "size"), 0.022 * this.canvas.height);
    for (const { chunk, corner, side } of this.map.tiles.pictures()) {
      this.bind(gl, chunk);
      const [x, y] = corner;
      const [u, v] = [x + side, y + side];
      this.mesh(gl, program, 1, gl.TRIANGLE_STRIP, [x, y, 0, 0, 1, u, y, 0, 1, 1, x, v, 0, 0, 0, u, v, 0, 1, 0], 5);
    }
    const flat = (points: ArrayLike<number>, z: number) => {
      const mesh: number[] = [];
      for (let i = 0; i + 1 < points.length; i += 2) mesh.push(points[i]!, points[i + 1]!, z);
      return mesh;
    };
    const color = (r: number, g: number, b: number, a = 1) => gl.uniform4f(gl.getUniformLocation(program, "color"), r, g, b, a);
    color(0.24, 0.86, 0.75, 0.6);
    this.mesh(gl, program, 0, gl.LINE_STRIP, flat(scene.trail, 0.01), 3);
    color(0.35, 0.66, 1);
    this.mesh(gl, program, 0, gl.LINE_STRIP, flat(scene.plan, 0.02), 3);
    color(1, 0.48, 0.61);
    this.mesh(gl, program, 0, gl.POINTS, flat(scene.scan, 0.12), 3);
    this.mesh(gl, program, 2, gl.POINTS, scene.landmarks, 3);
    if (scene.robot) this.drawRobot(gl, program, scene.robot, scene.reach, color);
    this.cloud?.draw(view, this.canvas.height);
  }

  /** A cylinder with an arrow on its top. */
  private drawRobot(
    gl: WebGL2RenderingContext,
    program: WebGLProgram,
    [x, y, theta]: [number, number, number],
    radius: number,
    color: (r: number, g: number, b: number) => void,
  ): void {
    const wall: number[] = [];
    const top: number[] = [x, y, ROBOT_HEIGHT_M];
    for (let i = 0; i <= 36; i++) {
      const a = (i * Math.PI) / 18;
      const [px, py] = [x + radius * Math.cos(a), y + radius * Math.sin(a)];
      wall.push(px, py, 0, px, py, ROBOT_HEIGHT_M);
      top.push(px, py, ROBOT_HEIGHT_M);
    }
    color(0.13, 0.58, 0.5);
    this.mesh(gl, program, 0, gl.TRIANGLE_STRIP, wall, 3);
    color(0.24, 0.86, 0.75);
    this.mesh(gl, program, 0, gl.TRIANGLE_FAN, top, 3);
    color(0.02, 0.14, 0.12);
    const z = ROBOT_HEIGHT_M + 0.004;
    const corner = (far: number, side: number) => [
      x + radius * (far * Math.cos(theta) - side * Math.sin(theta)),
      y + radius * (far * Math.sin(theta) + side * Math.cos(theta)),
      z,
    ];
    const arrow = [...corner(0.7, 0), ...corner(-0.35, 0.45), ...corner(-0.35, -0.45)];
    this.mesh(gl, program, 0, gl.TRIANGLES, arrow, 3);
  }

  /** Draws numbers as vertices of `stride` numbers: a point, and the place in a picture. */
  private mesh(
    gl: WebGL2RenderingContext,
    program: WebGLProgram,
    mode: number,
    shape: number,
    numbers: ArrayLike<number>,
    stride: 3 | 5,
  ): void {
    if (numbers.length < stride) return;
    gl.uniform1i(gl.getUniformLocation(program, "mode"), mode);
    gl.bufferData(gl.ARRAY_BUFFER, Float32Array.from(numbers), gl.STREAM_DRAW);
    const [at, uv] = [gl.getAttribLocation(program, "at"), gl.getAttribLocation(program, "uv")];
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, 3, gl.FLOAT, false, 4 * stride, 0);
    if (stride === 5) {
      gl.enableVertexAttribArray(uv);
      gl.vertexAttribPointer(uv, 2, gl.FLOAT, false, 4 * stride, 12);
    } else {
      gl.disableVertexAttribArray(uv);
    }
    gl.drawArrays(shape, 0, Math.floor(numbers.length / stride));
  }

  /** The picture of a chunk as the texture, uploaded where it has changed. */
  private bind(gl: WebGL2RenderingContext, chunk: Chunk): void {
    const known = this.textures.get(chunk);
    const texture = known?.texture ?? gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    if (known?.version === chunk.version) return;
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, chunk.canvas);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    this.textures.set(chunk, { texture, version: chunk.version });
  }

  /** From the map frame to the screen: the robot in the middle, seen from `distance`. */
  private view([x, y]: [number, number, number]): Matrix {
    const [ct, st] = [Math.cos(this.turn), Math.sin(this.turn)];
    const [cp, sp] = [Math.cos(this.tilt), Math.sin(this.tilt)];
    const back = [cp * ct, cp * st, sp];
    const right = [-st, ct, 0];
    const up = [-sp * ct, -sp * st, cp];
    const eye = [x + this.distance * back[0]!, y + this.distance * back[1]!, 0.2 + this.distance * back[2]!];
    const dot = (a: number[], b: number[]) => a[0]! * b[0]! + a[1]! * b[1]! + a[2]! * b[2]!;
    const [near, far, f] = [0.05, 200, 1.5];
    const aspect = this.canvas.width / Math.max(1, this.canvas.height);
    const [a, b] = [(far + near) / (near - far), (2 * far * near) / (near - far)];
    const rows = [
      [...right.map((n) => (n * f) / aspect), (-dot(right, eye) * f) / aspect],
      [...up.map((n) => n * f), -dot(up, eye) * f],
      [...back.map((n) => n * a), -dot(back, eye) * a + b],
      [...back.map((n) => -n), dot(back, eye)],
    ];
    return Float32Array.from({ length: 16 }, (_, i) => rows[i % 4]![Math.floor(i / 4)]!);
  }
}
