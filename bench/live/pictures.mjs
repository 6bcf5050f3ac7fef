// Pictures of the page compared with what they looked like: of each part the mean colour, the spread of brightness, and the share of it that is no
// empty ground. Fonts, the scene before the camera and the drawn part of the map change these little; a blank page, another theme and a missing
// part change them much.
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

/** Parts of a page of 1440 x 900 pixels: left, top, right, bottom. */
const PARTS = {
  brand: [12, 12, 150, 64],
  status: [420, 12, 1000, 64],
  meters: [1200, 12, 1428, 64],
  rail: [12, 160, 80, 740],
  map: [90, 120, 1090, 790],
  "panel, top": [1106, 80, 1428, 310],
  "panel, middle": [1106, 310, 1428, 545],
  "panel, bottom": [1106, 545, 1428, 770],
  corner: [1106, 810, 1428, 886],
  actions: [450, 820, 980, 886],
};
/** Largest difference of a mean colour, of 255. The camera's image, on top of the panel, and the map depend on where the robot stands. */
const MEAN_LIMIT = 26;
const SCENE_MEAN_LIMIT = 60;
/** Largest factor between two spreads, and the spread below which a part counts as empty, of 255. */
const SPREAD_FACTOR = 3;
const EMPTY_SPREAD = 2.5;
const SCENES = ["map", "panel, top"];
/** Least share of the filled cells of a scene in its reference: a note beside the map fills at most six of 36 cells, whatever is below it. */
const FILLED_PART = 0.5;

const references = join(import.meta.dirname, "pictures");

/** Mean colour and spread of brightness of each part of a picture; `page` is any page of a browser. */
export const measure = (page, png) =>
  page.evaluate(
    async ([base64, parts, empty]) => {
      const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
      const context = new OffscreenCanvas(image.width, image.height).getContext("2d", { willReadFrequently: true });
      context.drawImage(image, 0, 0);
      const CELLS = 6;
      const look = ([left, top, right, bottom]) => {
        const { data } = context.getImageData(left, top, right - left, bottom - top);
        const sum = [0, 0, 0];
        let [light, square] = [0, 0];
        for (let i = 0; i < data.length; i += 4) {
          for (let k = 0; k < 3; k++) sum[k] += data[i + k];
          const brightness = (data[i] + data[i + 1] + data[i + 2]) / 3;
          light += brightness;
          square += brightness ** 2;
        }
        const count = data.length / 4;
        const spread = Math.sqrt(Math.max(0, square / count - (light / count) ** 2));
        return { mean: sum.map((one) => Math.round(one / count)), spread: Number(spread.toFixed(1)) };
      };
      const filled = ([left, top, right, bottom]) => {
        const [width, height] = [(right - left) / CELLS, (bottom - top) / CELLS];
        const cells = Array.from({ length: CELLS ** 2 }, (_, i) => [left + width * (i % CELLS), top + height * Math.floor(i / CELLS)]);
        const isFilled = ([x, y]) => look([x, y, x + width, y + height].map(Math.round)).spread >= empty;
        return Number((cells.filter(isFilled).length / cells.length).toFixed(2));
      };
      return Object.fromEntries(Object.entries(parts).map(([name, box]) => [name, { ...look(box), filled: filled(box) }]));
    },
    [png.toString("base64"), PARTS, EMPTY_SPREAD],
  );

/** What differs between a measured picture and one of the references; empty if it looks the same. */
export function differences(measured, reference) {
  return Object.entries(reference).flatMap(([name, expected]) => {
    const { mean, spread, filled } = measured[name];
    const isScene = SCENES.includes(name);
    const limit = isScene ? SCENE_MEAN_LIMIT : MEAN_LIMIT;
    const apart = Math.max(...mean.map((one, i) => Math.abs(one - expected.mean[i])));
    const isEmpty = (spread < EMPTY_SPREAD && expected.spread > EMPTY_SPREAD) || (isScene && filled < FILLED_PART * expected.filled);
    const factor = Math.max(spread, EMPTY_SPREAD) / Math.max(expected.spread, EMPTY_SPREAD);
    if (apart <= limit && !isEmpty && Math.max(factor, 1 / factor) <= SPREAD_FACTOR) return [];
    const text = (part) => `colour ${part.mean}, spread ${part.spread}, filled ${part.filled}`;
    return [`${name}: ${text(measured[name])}, expected about ${text(expected)}`];
  });
}

/** The reference of a state, or null; with $UPDATE_PICTURES `measured` becomes it. */
export function referenceOf(state, measured) {
  const file = join(references, `${state}.json`);
  if (process.env.UPDATE_PICTURES && measured) {
    const lines = Object.entries(measured).map(([name, part]) => `  ${JSON.stringify(name)}: ${JSON.stringify(part)}`);
    writeFileSync(file, `{\n${lines.join(",\n")}\n}\n`);
  }
  return existsSync(file) ? JSON.parse(readFileSync(file, "utf8")) : null;
}
