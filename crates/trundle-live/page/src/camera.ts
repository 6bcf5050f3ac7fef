// The camera's last image, its depth and its features.

import { element } from "./panel";
import { DEPTH_UNIT_M, type ByteMessage, type DepthMessage } from "./wire";

let isDecoding = false;

/** What became of an image; a busy page draws the next one. */
export type ImageEnd = "drawn" | "busy" | "broken";

/** Draws an image. A browser keeps the pictures of an <img> for minutes, a canvas keeps the last one. */
export async function drawImage(jpeg: Uint8Array<ArrayBuffer>): Promise<ImageEnd> {
  if (isDecoding) return "busy";
  isDecoding = true;
  try {
    const image = await createImageBitmap(new Blob([jpeg], { type: "image/jpeg" }));
    const canvas = element<HTMLCanvasElement>("camera");
    if (canvas.width !== image.width) canvas.width = image.width;
    if (canvas.height !== image.height) canvas.height = image.height;
    canvas.getContext("bitmaprenderer")!.transferFromImageBitmap(image);
    canvas.hidden = false;
    element("camera-none").hidden = true;
    return "drawn";
  } catch {
    // A broken image is not shown; the next one comes soon.
    return "broken";
  } finally {
    isDecoding = false;
  }
}

/** Shows a text in place of the image. */
export function hideImage(text: string): void {
  element("camera").hidden = true;
  element("camera-none").textContent = text;
  element("camera-none").hidden = false;
}

export function clearFeatures(): void {
  const canvas = element<HTMLCanvasElement>("camera-features");
  canvas.getContext("2d")!.clearRect(0, 0, canvas.width, canvas.height);
}

export function drawFeatures(message: Extract<ByteMessage, { kind: "features" }>): void {
  const canvas = element<HTMLCanvasElement>("camera-features");
  if (canvas.hidden || message.width === 0) return;
  const width = Math.round(canvas.clientWidth * devicePixelRatio);
  const height = Math.round(canvas.clientHeight * devicePixelRatio);
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
  const context = canvas.getContext("2d")!;
  context.clearRect(0, 0, width, height);
  // As the picture below: it covers its frame.
  const scale = Math.max(width / message.width, height / message.height);
  const [left, top] = [(width - scale * message.width) / 2, (height - scale * message.height) / 2];
  const style = getComputedStyle(canvas);
  const size = 3 * devicePixelRatio;
  message.tracked.forEach((isTracked, i) => {
    context.fillStyle = style.getPropertyValue(isTracked ? "--good" : "--idle");
    const [x, y] = [left + scale * message.spots[2 * i]!, top + scale * message.spots[2 * i + 1]!];
    context.fillRect(x - size / 2, y - size / 2, size, size);
  });
}

/** Depth of the last colour [m]. */
const FAR_M = 6;

export function drawDepth(message: DepthMessage): void {
  const canvas = element<HTMLCanvasElement>("camera-depth");
  const height = Math.floor(message.pixels.length / Math.max(1, message.width));
  if (canvas.hidden || height === 0) return;
  if (canvas.width !== message.width) canvas.width = message.width;
  if (canvas.height !== height) canvas.height = height;
  const context = canvas.getContext("2d")!;
  const picture = context.createImageData(message.width, height);
  const colors = depthColors();
  for (let i = 0; i < message.width * height; i++) {
    const color = 3 * message.pixels[i]!;
    picture.data[4 * i] = colors[color]!;
    picture.data[4 * i + 1] = colors[color + 1]!;
    picture.data[4 * i + 2] = colors[color + 2]!;
    picture.data[4 * i + 3] = 255;
  }
  context.putImageData(picture, 0, 0);
}

let colorTable: Uint8ClampedArray | null = null;

/** The colour of each depth, near yellow, far violet: viridis, which the colour blind read too. Without depth: black. */
function depthColors(): Uint8ClampedArray {
  if (colorTable) return colorTable;
  const stops = [
    [253, 231, 37],
    [94, 201, 98],
    [33, 145, 140],
    [59, 82, 139],
    [68, 1, 84],
  ];
  const table = new Uint8ClampedArray(3 * 256);
  for (let unit = 1; unit < 256; unit++) {
    const at = Math.min(0.9999, (unit * DEPTH_UNIT_M) / FAR_M) * (stops.length - 1);
    const [near, far] = [stops[Math.floor(at)]!, stops[Math.floor(at) + 1]!];
    for (let part = 0; part < 3; part++) table[3 * unit + part] = near[part]! + (at % 1) * (far[part]! - near[part]!);
  }
  colorTable = table;
  return table;
}
