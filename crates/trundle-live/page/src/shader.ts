// Programs of the graphics processor, and what they share.

/** GLSL: the colour of a height as a part of HEIGHT_M. */
export const RAINBOW = `
vec3 rainbow(float h) { return clamp(vec3(1.6 * h - 0.2, 1.0 - abs(2.0 * h - 0.8), 1.1 - 1.6 * h), 0.12, 1.0); }`;
/** GLSL: the height of the last colour [m]. */
export const HEIGHT_M = "2.2";

/** The program of two shaders; null where this browser cannot build it. */
export function build(gl: WebGL2RenderingContext, vertex: string, fragment: string): WebGLProgram | null {
  const program = gl.createProgram();
  for (const [kind, source] of [
    [gl.VERTEX_SHADER, vertex],
    [gl.FRAGMENT_SHADER, fragment],
  ] as const) {
    const shader = gl.createShader(kind)!;
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  return gl.getProgramParameter(program, gl.LINK_STATUS) ? program : null;
}
