// Features of the camera's last image, drawn over it.

import { element } from "./panel";
import type { ByteMessage } from "./wire";

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
