// The live page in a real browser: `node test.mjs TRUNDLE CHROMIUM [PICTURES]`. Prints one line for each thing that holds; ends with 1 where one
// does not. A wait ends when its condition holds, so its limit only bounds a failure: a loaded machine needs longer, and is no failure. $CHECKS is a
// pattern of the names of the checks that are run: all without it.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { connect, createServer as createTcpServer } from "node:net";
import { cpus, loadavg, tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { differences, measure, referenceOf } from "./pictures.mjs";
import { start, startCommand } from "./program.mjs";
import { framesOf, median } from "./trace.mjs";

const [trundle, chromiumPath, pictures = mkdtempSync(join(tmpdir(), "live-pictures-"))] = process.argv.slice(2);
for (const file of [trundle, chromiumPath])
  if (!file || !existsSync(file)) throw new Error(`usage: node test.mjs TRUNDLE CHROMIUM [PICTURES]: there is no file ${file}`);
/** Longest wait for a condition [s], also of Playwright itself. */
const PATIENCE_S = 120;
/** Longest wait for the end of a drive [s]: without fresh images the robot waits, and on a loaded machine it often does. */
const DRIVE_S = 400;
/** Silence after which the server lets a viewer go [s]. */
const SILENCE_S = 60;
/** Load a core above which a robot that waits for its own images is starved by other processes, and a check of its motion says nothing. */
const OVERLOAD = 4;
/** Reasons of a robot that gets its images too late: it waits for them, or loses its pose without them. */
const STARVED = /newest image|pose is unknown/;
/** What a browser says of a program that ends, or has ended. */
const LOSS = /ERR_(CONNECTION_(REFUSED|RESET)|EMPTY_RESPONSE)/;
/** Attempts at a figure: the least one is judged, because a loaded machine only adds to it. */
const ATTEMPTS = 5;
/** First byte of a message with the depth of an image. */
const DEPTH_KIND = 8;
/** Period of the views that the page gets [s]. */
const VIEW_PERIOD_S = 0.1;
/** A folder whose page is shown instead of the one in the program, to try a page without a build of the program. */
const assets = process.env.LIVE_ASSETS;
mkdirSync(pictures, { recursive: true });
const place = mkdtempSync(join(tmpdir(), "live-run-"));
mkdirSync(join(place, "maps"));
// A browser does not know where a page of a folder comes from, and would keep it from the robot.
const args = ["--no-sandbox", "--enable-unsafe-swiftshader", ...(assets ? ["--disable-features=LocalNetworkAccessChecks"] : [])];
const browser = await chromium.launch({ executablePath: chromiumPath, args });
const problems = [];

/** A page whose console must stay clean, and the states that it is sent. A link that is still awaited is opened in a page that waits for it.
 * `added` are fields of the state that replace those of the program. */
async function open(link, options = {}, added = null) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, colorScheme: "dark", ...options });
  context.setDefaultTimeout(1000 * PATIENCE_S);
  if (assets) await context.route(/\/(page\.(js|css))?$/, (route) => showAsset(route));
  const page = await context.newPage();
  if (added) await page.routeWebSocket(/\/live$/, (socket) => addToStates(socket, added));
  const watch = { page, context, state: null, states: [], depths: 0, mayFail: false };
  page.on("console", (message) => {
    const isLoss = watch.mayLose && LOSS.test(message.text());
    if (message.type() === "error" && !watch.mayFail && !isLoss) problems.push(`${message.text()} (${message.location().url})`);
  });
  page.on("pageerror", (error) => problems.push(String(error)));
  page.on("websocket", (socket) =>
    socket.on("framereceived", ({ payload }) => {
      if (typeof payload !== "string") watch.depths += payload[0] === DEPTH_KIND ? 1 : 0;
      if (typeof payload !== "string" || !payload.startsWith('{"type":"state"')) return;
      watch.state = JSON.parse(payload);
      watch.states.push({ at: performance.now(), state: watch.state });
    }),
  );
  await page.goto(await link);
  return watch;
}

/** Passes the messages on, with other fields in those of the state. */
function addToStates(socket, added) {
  socket.connectToServer().onMessage((message) => {
    const isState = typeof message === "string" && message.startsWith('{"type":"state"');
    socket.send(isState ? JSON.stringify({ ...JSON.parse(message), ...added }) : message);
  });
}

/** The program's answer with a file of the folder of assets. */
async function showAsset(route) {
  const name = new URL(route.request().url()).pathname.slice(1) || "index.html";
  const response = await route.fetch();
  const { "content-length": _, ...headers } = response.headers();
  await route.fulfill({ response, headers, body: readFileSync(join(assets, name)) });
}

async function until(what, is, seconds = PATIENCE_S) {
  const start = performance.now();
  while (!(await is())) {
    assert(performance.now() - start < 1000 * seconds, `${what}: not within ${seconds} s`);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
  return (performance.now() - start) / 1000;
}

/** Waits until the map has drawn what it shows: a point of it stays in its place of the window. */
async function settled(of = page) {
  const place = () =>
    of.evaluate(async () => {
      for (let i = 0; i < 3; i++) await new Promise(requestAnimationFrame);
      return window.trundle.map.toWindow([0, 0]);
    });
  let last = await place();
  await until("a map at rest", async () => {
    const before = last;
    last = await place();
    return Math.hypot(last[0] - before[0], last[1] - before[1]) < 0.5;
  });
}

const isShown = (page, selector) => page.locator(selector).first().isVisible();
const text = (page, id) => page.locator(`#${id}`).innerText();
const speed = (watch) => Math.hypot(...watch.state.command);
let failures = 0;
let skips = 0;

/** A way to the program that carries so many bytes per second. `mute` lets the present connections carry nothing more, without a close. */
async function throttle(url, bytesPerSecond) {
  const TICK_MS = 50;
  const sockets = new Set();
  const timers = new Set();
  const server = createTcpServer((client) => {
    const robot = connect(Number(url.port), url.hostname);
    const slowly = (from, to) => {
      let waiting = Buffer.alloc(0);
      from.on("data", (data) => {
        waiting = Buffer.concat([waiting, data]);
        if (waiting.length > 16_000) from.pause();
      });
      const timer = setInterval(() => {
        const part = waiting.subarray(0, (bytesPerSecond * TICK_MS) / 1000);
        waiting = waiting.subarray(part.length);
        if (part.length) to.write(part);
        if (waiting.length <= 16_000) from.resume();
      }, TICK_MS);
      timers.add(timer);
      from.on("error", () => {});
      from.on("close", () => (clearInterval(timer), to.end(waiting)));
    };
    slowly(robot, client);
    slowly(client, robot);
    sockets.add(client).add(robot);
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const close = () => (sockets.forEach((socket) => socket.destroy()), server.close());
  const mute = () => timers.forEach(clearInterval);
  return { link: `http://127.0.0.1:${server.address().port}/${url.hash}`, close, mute };
}

async function check(name, work) {
  if (!new RegExp(process.env.CHECKS ?? "").test(name)) return;
  const start = performance.now();
  try {
    const note = await work();
    console.log(`ok   ${name}${note ? `: ${note}` : ""} (${((performance.now() - start) / 1000).toFixed(1)} s)`);
  } catch (error) {
    const isStarved = loadavg()[0] > OVERLOAD * cpus().length && STARVED.test(main.state?.reason ?? "");
    if (isStarved) skips += 1;
    else failures += 1;
    const doing = main.state ? ` (the robot: ${main.state.state}, ${main.state.reason ?? main.state.hold ?? "no reason"})` : "";
    const verdict = isStarved ? `skipped (the load of ${loadavg()[0].toFixed(0)} on ${cpus().length} cores starves the robot):` : "FAIL";
    console.log(`${verdict} ${name}: ${error.message}${doing}`);
    // What follows begins without keys that are down, and without other pages.
    await page.keyboard.up("w");
    await page.keyboard.press("Escape");
    for (const context of browser.contexts()) if (!kept.has(context)) await context.close();
  }
}

const tokens = join(place, "tokens");
const zones = join(place, "zones.geojson");
const quiet = ["--direct", "--goal", "0.2,0,0", "--zones", zones, "--maps", join(place, "maps")];
let program = await start(trundle, ["--live", "127.0.0.1:0", "--live-tokens", tokens, ...quiet], join(place, "run"));
const main = await open(program.drive);
const { page } = main;
/** The page that measures pictures, so that a page that drives has no load of it. */
const gauge = await (await browser.newContext()).newPage();
/** Contexts that a failed check leaves open. */
const kept = new Set([main.context, gauge.context()]);
/** The pictures so far by their names. */
const taken = new Map();
/** The states whose pictures are compared with references. */
const STATES = ["goal", "refused", "explore-dark", "explore-light", "sim", "slam", "experiment"];
/** The pictures that docs show: with $UPDATE_PICTURES they are replaced. */
const SHOWN = { "explore-dark": "live.png", goal: "live-goal.png", "zone-drawing": "live-zone.png", past: "live-past.png" };
const picture = async (name, of = page) => {
  if (STATES.includes(name)) await of.evaluate(() => document.getElementById("side").scrollTo(0, 0));
  const png = await of.screenshot({ path: join(pictures, `${name}.png`) });
  taken.set(name, png);
  if (process.env.UPDATE_PICTURES && SHOWN[name]) writeFileSync(join(import.meta.dirname, "../../docs/pictures", SHOWN[name]), png);
};

await check("the page loads and says what the robot does", async () => {
  await until("a state", () => main.state !== null);
  assert.equal(await page.locator("body").getAttribute("data-link"), "open");
  assert.match(await page.title(), /demo/);
});

await check("the map appears", async () => {
  const known = () =>
    page.evaluate(() => {
      const canvas = document.getElementById("map");
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      for (let i = 3; i < data.length; i += 4) count += data[i] === 255 ? 1 : 0;
      return count;
    });
  await until("floor on the canvas", async () => (await known()) > 20_000);
  return `${await known()} pixels`;
});

/** Sends a goal by its numbers. */
async function sendGoal([x, y, theta = 0]) {
  await page.locator("#goal-x").fill(String(x));
  await page.locator("#goal-y").fill(String(y));
  await page.locator("#goal-heading").fill(String((180 * theta) / Math.PI));
  await page.locator("#goal-form button").click();
}

/** Waits for what a mission brings about. A robot that gets no images in time gives its mission up: it gets the mission `again`. */
async function untilDriven(what, is, again) {
  let asked = performance.now();
  return until(
    what,
    async () => {
      if (await is()) return true;
      const isDue = performance.now() - asked > 5000;
      if (!isDue || main.state.left.length > 0) return false;
      asked = performance.now();
      await again();
      return false;
    },
    DRIVE_S,
  );
}

await check("a click sends a goal and the robot arrives", async () => {
  await until("rest", () => main.state.over || main.state.state === "arrived", DRIVE_S);
  await page.keyboard.press("g");
  await page.keyboard.press("f");
  await page.keyboard.press("f");
  await settled();
  const [x, y, theta] = main.state.pose;
  const robot = await page.evaluate(([x, y]) => window.trundle.map.toWindow([x, y]), [x, y]);
  const ahead = await page.evaluate(([x, y]) => window.trundle.map.toWindow([x, y]), [
    x + 0.8 * Math.cos(theta),
    y + 0.8 * Math.sin(theta),
  ]);
  assert(Math.hypot(ahead[0] - robot[0], ahead[1] - robot[1]) > 10);
  await page.mouse.move(...ahead);
  await page.mouse.down();
  await page.mouse.move(ahead[0], ahead[1] - 60, { steps: 5 });
  await picture("goal");
  await page.mouse.up();
  await until("the goal", () => main.state.left.length > 0);
  const goal = main.state.left[0].goal;
  assert(Math.abs(goal[2] - Math.PI / 2) < 0.1, `heading ${goal[2]} rad`);
  const distance = () => Math.hypot(main.state.pose[0] - goal[0], main.state.pose[1] - goal[1]);
  const again = () => sendGoal(goal);
  const seconds = await untilDriven("arrival", () => main.state.over && distance() < 0.05, again);
  const away = distance();
  return `${(1000 * away).toFixed(0)} mm from the goal after ${seconds.toFixed(1)} s`;
});

/** Waits for a refusal beside the map; it stays for seconds only, its text stays in the page. */
const refusal = (pattern) => until(`a refusal like ${pattern}`, async () => pattern.test(await page.locator("#bubble").textContent()));

await check("a goal in a wall is refused with the reason beside the click", async () => {
  await page.keyboard.press("0");
  await settled();
  const wall = await page.evaluate(() => window.trundle.wallPixel());
  assert(wall, "a wall is in sight");
  await page.keyboard.press("g");
  await page.mouse.click(wall[0], wall[1]);
  await refusal(/obstacle reaches \d+ cm/);
  await picture("refused");
});

await check("a picture of a blank page, another theme or a missing part differs from its reference", async () => {
  const known = referenceOf("refused", await measure(gauge, taken.get("refused")));
  // The page refuses further style elements.
  const show = (style) =>
    page.evaluate((style) => {
      const sheet = new CSSStyleSheet();
      sheet.replaceSync(style);
      document.adoptedStyleSheets = [sheet];
    }, style);
  const found = {};
  const damages = {
    "a blank page": "body > * { visibility: hidden !important; }",
    "no panel": "#side { visibility: hidden !important; }",
    "no map": "#map { visibility: hidden !important; }",
    "no stop": "#stop { visibility: hidden !important; }",
    "no style": "* { all: revert !important; }",
  };
  for (const [name, style] of Object.entries(damages)) {
    await show(style);
    found[name] = differences(await measure(gauge, await page.screenshot()), known);
  }
  await show("");
  await page.locator("#theme").click();
  found["another theme"] = differences(await measure(gauge, await page.screenshot()), known);
  await page.locator("#theme").click();
  const missed = Object.keys(found).filter((name) => found[name].length === 0);
  assert.deepEqual(missed, [], "damages that the comparison does not see");
  return Object.entries(found).map(([name, all]) => `${name}: ${all.length} parts`).join(", ");
});

/** Places of the window for points of the robot's frame. */
const windowOf = (points) => {
  const [x, y, theta] = main.state.pose;
  const [cos, sin] = [Math.cos(theta), Math.sin(theta)];
  const places = points.map(([ahead, left]) => [x + cos * ahead - sin * left, y + sin * ahead + cos * left]);
  return page.evaluate((places) => places.map((place) => window.trundle.map.toWindow(place)), places);
};
const drag = async ([from, to]) => {
  await page.mouse.move(...from);
  await page.mouse.down();
  await page.mouse.move(...to, { steps: 6 });
  await page.mouse.up();
};
const entries = () => page.locator("#notes li").allInnerTexts();
const readZones = () => JSON.parse(readFileSync(zones, "utf8")).features;

await check("people with their way, loops, battery and dropped images are shown", async () => {
  const [x, y] = main.state.pose;
  const added = { movers: [], loops: [], voltage: null };
  const viewer = await open(program.view, {}, added);
  const { page } = viewer;
  await until("a state", () => viewer.state !== null);
  /** Pixels of the map about a point. */
  const pixelsAt = (p) =>
    page.evaluate((p) => {
      const [left, top] = window.trundle.map.toWindow(p).map((at) => at * devicePixelRatio);
      const context = document.getElementById("map").getContext("2d");
      return [...context.getImageData(Math.round(left) - 40, Math.round(top) - 40, 80, 80).data];
    }, p);
  // The second person is where the first one goes within a second.
  const [person, later] = [[x + 1, y + 0.5], [x + 1, y + 1.5]];
  const places = [person, later];
  await settled(page);
  const before = await Promise.all(places.map(pixelsAt));
  assert(!(await isShown(page, "#battery")), "a battery that no body reports");
  const changed = async () => {
    const now = await Promise.all(places.map(pixelsAt));
    return now.map((pixels, i) => pixels.filter((value, k) => Math.abs(value - before[i][k]) > 8).length / pixels.length);
  };
  const counts = [100, 50, 1000, 123];
  await page.waitForTimeout(1000);
  const still = await changed();
  assert(still.every((part) => part < 0.005), `the map changes without people: ${still}`);
  Object.assign(added, { movers: [[...person, 0.3, ...later]], counts, voltage: 14.4, charge: 0.62, charging: true });
  let parts;
  await until("both discs", async () => (parts = await changed()).every((part) => part > 0.02));
  await until("the battery", async () => (await text(page, "battery")).trim() === "62 %, charging");
  await until("dropped images", async () => (await page.locator("#dropped").textContent()) === "123");
  added.loops = [[main.state.time + 1, x, y]];
  await until("a note of the loop", async () => /A loop was closed/.test(await text(page, "toasts")));
  await picture("people", page);
  await viewer.context.close();
  return `${parts.map((part) => `${(100 * part).toFixed(0)} %`).join(" and ")} of the pixels at the person and on its way`;
});

await check("a no-go zone is drawn, kept in its file, and no goal is set in it", async () => {
  await page.keyboard.press("Escape");
  await page.keyboard.press("z");
  const corners = await windowOf([[0.5, -0.4], [1.1, -0.4], [1.1, 0.4], [0.5, 0.4]]);
  for (const corner of [...corners, corners[0]]) await page.mouse.click(...corner);
  await page.locator("#note-name").fill("rug");
  await picture("zone-drawing");
  await page.locator("#note-form button[type=submit]").click();
  await until("the zone in the list", async () => (await entries()).some((text) => text.includes("rug")));
  const [zone] = readZones();
  assert.deepEqual([zone.properties.kind, zone.properties.name, zone.geometry.coordinates[0].length], ["no_go", "rug", 5]);
  const [inside] = await windowOf([[0.8, 0]]);
  await page.keyboard.press("g");
  await page.mouse.click(...inside);
  await refusal(/no-go zone 'rug'/);
  await picture("zone-refused");
});

await check("a plan leads around a no-go zone", async () => {
  const [beyond] = await windowOf([[1.9, 0]]);
  await page.keyboard.press("g");
  await page.mouse.click(...beyond);
  const missed = () =>
    page.evaluate((beyond) => {
      const { map } = window.trundle;
      const [x, y] = map.toMap(...beyond);
      const { plan } = map.seen;
      return plan.length < 8 ? Infinity : Math.hypot(plan.at(-2) - x, plan.at(-1) - y);
    }, beyond);
  await until("a plan to the click", async () => (await missed()) < 0.1);
  const inside = await page.evaluate(() => {
    const { map } = window.trundle;
    const { outline } = map.zones.zones[0];
    const { plan } = map.seen;
    let count = 0;
    for (let i = 0; i + 1 < plan.length; i += 2) {
      const [x, y] = [plan[i], plan[i + 1]];
      const crossings = outline.filter(([ax, ay], k) => {
        const [bx, by] = outline[(k + 1) % outline.length];
        return ay > y !== by > y && x < ax + ((bx - ax) * (y - ay)) / (by - ay);
      });
      count += crossings.length % 2;
    }
    return count;
  });
  const { points, ring } = await page.evaluate(() => {
    const { waypoints, plan } = window.trundle.map.seen;
    return { points: waypoints.length / 2, ring: Math.hypot(waypoints.at(-2) - plan.at(-2), waypoints.at(-1) - plan.at(-1)) };
  });
  await picture("zone-plan");
  await page.keyboard.press(" ");
  await until("no mission", () => main.state.left.length === 0);
  assert.equal(inside, 0, `${inside} points of the plan are in the zone`);
  assert(points > 2 && ring < 0.01, `${points} way-points, the last ${ring} m from the end of the curve`);
  return `${points} way-points`;
});

await check("a zone whose sides cross is refused beside the drawing, and a zone is changed and deleted", async () => {
  await page.keyboard.press("z");
  const corners = await windowOf([[-0.5, 0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, -0.5]]);
  for (const corner of corners) await page.mouse.click(...corner);
  await page.mouse.click(...corners[0]);
  await page.locator("#note-form button[type=submit]").click();
  await page.locator("#note-problem").waitFor({ state: "visible" });
  assert.match(await text(page, "note-problem"), /crossed by itself/);
  await refusal(/crossed by itself/);
  await picture("zone-crossed");
  await page.locator("#note-cancel").click();
  await page.locator("#notes li", { hasText: "rug" }).getByText("Edit").click();
  await page.locator("#note-kind").selectOption("slow");
  await page.locator("#note-speed").fill("0.15");
  await page.locator("#note-form button[type=submit]").click();
  await until("a slow zone", async () => (await entries()).some((text) => text.includes("0.15 m/s")));
  assert.equal(readZones()[0].properties.speed_m_s, 0.15);
  await page.keyboard.press("z");
  const [[left, top], [right, bottom]] = await windowOf([[-0.3, 0.3], [-1.2, 1]]);
  await drag([[left, top], [Math.abs(right - left) < 20 ? left + 40 : right, Math.abs(bottom - top) < 20 ? top + 40 : bottom]]);
  await page.locator("#note-name").fill("hall");
  await page.locator("#note-kind").selectOption("area");
  await page.locator("#note-form button[type=submit]").click();
  await until("a named area", async () => (await entries()).some((text) => text.includes("hall")));
  await picture("zone-slow");
  await page.locator("#notes li", { hasText: "hall" }).getByText("Edit").click();
  await page.locator("#note-delete").click();
  await until("one zone", async () => (await entries()).length === 1);
  await page.locator("#notes li", { hasText: "rug" }).getByText("Edit").click();
  await page.locator("#note-delete").click();
  await until("no zone", async () => (await entries()).length === 0);
  assert.deepEqual(readZones(), []);
});

await check("a place is named, found in the list, and driven to", async () => {
  await page.keyboard.press("n");
  await drag(await windowOf([[0.4, 0], [0.4, 0.5]]));
  await page.locator("#note-name").fill("desk");
  await page.locator("#note-form button[type=submit]").click();
  await until("the place", async () => (await entries()).some((text) => text.includes("desk")));
  const goal = readZones()[0].geometry.coordinates;
  await page.locator("#notes li", { hasText: "desk" }).getByText("Go").click();
  const isThere = ([x, y]) => Math.hypot(x - goal[0], y - goal[1]) < 1e-6;
  await until("the goal", () => main.state.left.some((task) => task.goal && isThere(task.goal)));
  await picture("place");
  await page.keyboard.press(" ");
  await until("no mission", () => main.state.left.length === 0);
});

await check("a setting changes within its range, and is refused beyond it", async () => {
  const form = page.locator("#settings form", { has: page.locator("[data-setting='limits.v_m_s']") });
  await form.locator("input").fill("99");
  await form.locator("button").click();
  await form.locator(".problem").waitFor({ state: "visible" });
  assert.match(await form.locator(".problem").innerText(), /99 m\/s, expected 0.05 to/);
  const value = () => page.evaluate(() => window.trundle.settings.find((setting) => setting.key === "limits.v_m_s")?.value);
  await until("the present value", async () => (await value()) !== undefined);
  const present = await value();
  await form.locator("input").fill(String(present));
  await form.locator("button").click();
  await until("no refusal", async () => !(await form.locator(".problem").isVisible()));
});

await check("the map is saved as files", async () => {
  const names = new Set();
  page.on("download", (download) => names.add(download.suggestedFilename()));
  await page.locator("#map-save").click();
  await until("three files", () => names.size === 3);
  assert.deepEqual([...names].sort(), ["map.pgm", "map.yaml", "zones.geojson"]);
});

await check("a map of the folder is loaded by two presses, and the robot gets its pose", async () => {
  const maps = join(place, "maps");
  const headers = { Authorization: `Bearer ${new URL(program.drive).hash.slice(1)}` };
  for (const [from, to] of [["map.pgm", "map.pgm"], ["map.yaml", "home.yaml"], ["zones.geojson", "home.geojson"]]) {
    const response = await fetch(new URL(`/files/${from}`, program.drive), { headers });
    writeFileSync(join(maps, to), Buffer.from(await response.arrayBuffer()));
  }
  await page.reload();
  await page.locator("#map-name").waitFor();
  const [x, y, theta] = main.state.pose;
  await page.locator("#map-load").click();
  await page.waitForTimeout(300);
  assert(!main.state.reason?.includes("map"), "one press does nothing");
  const before = main.states.length;
  const isUnknown = () => main.states.slice(before).some(({ state }) => state.covariance[0] > 0.5);
  // Where the second press comes too late, it is a first one.
  for (let press = 1; press <= ATTEMPTS && !isUnknown(); press++) {
    await page.locator("#map-load").click();
    await until("an unknown pose", isUnknown, PATIENCE_S / ATTEMPTS).catch((error) => assert(press < ATTEMPTS, error.message));
  }
  await picture("map-loaded");
  const robot = await page.evaluate(([x, y]) => (window.trundle.map.fit(), window.trundle.map.toWindow([x, y])), [x, y]);
  await page.keyboard.press("p");
  await page.mouse.move(...robot);
  await page.mouse.down();
  await page.mouse.move(robot[0] + 60 * Math.cos(theta), robot[1] - 60 * Math.sin(theta), { steps: 4 });
  await page.mouse.up();
  await until("a pose", () => Math.hypot(main.state.pose[0] - x, main.state.pose[1] - y) < 0.3 && main.state.covariance[0] < 0.1);
  await page.keyboard.press("Escape");
  await until("the place of the map's file", async () => (await entries()).some((text) => text.includes("desk")));
  return `${main.state.state}, ${main.state.reason ?? "no reason"}`;
});

/** From the space bar to the page that shows the command 0 [s], while the robot drives to a goal. */
async function stopOnce() {
  const far = main.state.pose[0] < 1.5 ? 2.5 : 0.2;
  await sendGoal([far, 0]);
  await untilDriven("motion", () => main.state.command[0] > 0.15, () => sendGoal([far, 0]));
  const before = main.states.length;
  const pressed = performance.now();
  await page.keyboard.press(" ");
  const isZero = ({ state }) => Math.hypot(...state.command) === 0;
  await until("zero", () => main.states.slice(before).some(isZero));
  await until("no mission", () => main.state.left.length === 0);
  return (main.states.slice(before).find(isZero).at - pressed) / 1000;
}

await check("the space bar stops the robot within 0.2 s", async () => {
  const limit = 0.2 + VIEW_PERIOD_S;
  const times = [];
  while (times.length < 2 || (Math.min(...times) > limit && times.length < ATTEMPTS)) times.push(await stopOnce());
  const shown = times.map((time) => time.toFixed(2)).join(", ");
  assert(Math.min(...times) <= limit, `${shown} s until the page shows it, expected at most ${limit} s once`);
  return `${shown} s from the key to the page that shows zero, up to ${VIEW_PERIOD_S} s of it the period of views`;
});

/**
 * A page that computes sends nothing while its key is down. Returns the robot's time from the last view before it computes to the first view at
 * rest, and the time between two views at that end [s].
 */
async function silentOnce(other) {
  await page.keyboard.down("w");
  await until("motion", () => other.state.command[0] > 0.1, DRIVE_S);
  await picture("drive");
  // A picture takes the page so long that the robot may stop: it drives again.
  await until("motion", () => other.state.command[0] > 0.1, DRIVE_S);
  const from = other.states.length - 1;
  const silent = page.evaluate(() => {
    const start = performance.now();
    while (performance.now() - start < 2500);
  });
  await until("stop", () => other.states.slice(from).some(({ state }) => Math.hypot(...state.command) === 0));
  await silent;
  await page.keyboard.up("w");
  await until("rest", () => speed(other) === 0);
  const stop = other.states.findIndex(({ state }, i) => i > from && Math.hypot(...state.command) === 0);
  const time = (i) => other.states[i].state.time;
  return { seconds: time(stop) - time(from), gap: time(stop) - time(stop - 1) };
}

await check("driving by keys, and silence stops", async () => {
  const other = await open(program.view);
  await until("a state", () => other.state !== null);
  await page.bringToFront();
  await page.keyboard.press("t");
  // 0.3 s of silence, and a view before and after it.
  const limit = 0.3 + 4 * VIEW_PERIOD_S;
  const tries = [];
  do tries.push(await silentOnce(other));
  while (Math.min(...tries.map((one) => one.seconds)) > limit && tries.length < ATTEMPTS);
  await page.keyboard.press("Escape");
  await other.context.close();
  const shown = tries.map(({ seconds, gap }) => `${seconds.toFixed(2)} (views ${gap.toFixed(2)} apart)`).join(", ");
  const least = Math.min(...tries.map((one) => one.seconds));
  assert(least > 0.05 && least <= limit, `${shown} s`);
  return `${shown} s of the robot's time until a viewer sees it at rest`;
});

/** The answer to a stop by an own link with the token of a viewer's link. */
async function stopByLink(url) {
  const { host, hash } = new URL(url);
  const socket = new WebSocket(`ws://${host}/live`);
  const answer = new Promise((resolve) => {
    socket.onopen = () => socket.send(JSON.stringify({ type: "hello", version: window.trundle.wireVersion, token: hash.slice(1), name: "viewer" }));
    socket.onmessage = ({ data }) => {
      const message = typeof data === "string" ? JSON.parse(data) : {};
      if (message.type === "welcome") socket.send(JSON.stringify({ type: "stop", id: 1 }));
      if (message.type === "answer" || message.type === "refused") resolve(message.refusal ?? "not refused");
    };
    socket.onclose = () => resolve("closed");
  });
  const text = await answer;
  socket.close();
  return text;
}

/** Ends a pause, so that a stop has an effect that can be seen. Returns what such a stop would change. */
async function stoppable() {
  if (main.state.paused) await page.locator("#pause").click();
  await until("no pause", () => !main.state.paused && speed(main) === 0, DRIVE_S);
  return { paused: false, left: main.state.left };
}

/** Asserts that the robot has not been stopped since `before`. */
async function assertNotStopped(before) {
  const seen = main.states.length;
  await until("three more states", () => main.states.length > seen + 3);
  assert.deepEqual({ paused: main.state.paused, left: main.state.left }, before);
}

await check("the stick and a gamepad drive, and their release stops", async () => {
  await page.keyboard.press("t");
  const box = await page.locator("#stick").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y - 0.4 * box.height, { steps: 4 });
  await until("motion ahead", () => main.state.command[0] > 0.1, DRIVE_S);
  await picture("stick");
  await page.mouse.up();
  await until("rest after the stick", () => speed(main) === 0);
  const hold = (axes) => page.evaluate((axes) => (navigator.getGamepads = () => (axes ? [{ connected: true, axes }] : [null])), axes);
  await hold([-1, 0, 0]);
  await until("a turn to the left", () => main.state.command[1] > 0.1, DRIVE_S);
  await hold([0.05, 0.05, 0.05]);
  await until("rest in the dead zone", () => speed(main) === 0);
  await hold([0, 1, 0]);
  await until("motion back", () => main.state.command[0] < -0.05, DRIVE_S);
  await hold(null);
  await until("rest without a gamepad", () => speed(main) === 0);
  await page.keyboard.press("Escape");
});

await check("goals are queued without the shift key, paused, and dropped by the stop", async () => {
  await page.keyboard.press("0");
  await settled();
  await page.keyboard.press("g");
  await page.locator("#queue-toggle").click();
  for (const place of await windowOf([[0.4, 0], [0.3, 0.2]])) {
    const before = main.state.left.length;
    await page.mouse.click(...place);
    await until("one more goal", () => main.state.left.length === before + 1);
  }
  assert.equal(main.state.left.length, 2);
  await page.locator("#pause").click();
  await until("a pause with both goals", () => main.state.paused && main.state.left.length === 2);
  await page.keyboard.press(" ");
  await until("no mission", () => main.state.left.length === 0);
  await page.locator("#queue-toggle").click();
  assert.equal(await page.locator("#queue-toggle").getAttribute("aria-pressed"), "false");
  await page.keyboard.press("Escape");
});

await check("a second viewer sees who holds the wheel and drives nothing", async () => {
  const viewer = await open(program.view);
  await until("the wheel", async () => (await text(viewer.page, "wheel-text")).includes("holds the wheel"));
  assert.equal(await viewer.page.locator("#stop").isVisible(), false);
  assert.equal(await viewer.page.locator("#explore").isVisible(), false);
  // The keys of a viewer's page, a request and a message of its link: none of them stops the robot.
  const before = await stoppable();
  await viewer.page.keyboard.press(" ");
  const { origin, hash } = new URL(program.view);
  const request = await fetch(`${origin}/stop`, { method: "POST", headers: { Origin: origin, Authorization: `Bearer ${hash.slice(1)}` } });
  assert.equal(request.status, 403);
  assert.match(await viewer.page.evaluate(stopByLink, program.view), /viewing only/);
  await assertNotStopped(before);
  await picture("view-only", viewer.page);
  await viewer.context.close();
  const driver = await open(program.drive);
  await until("a state", () => driver.state !== null);
  await driver.page.locator("#wheel-take").click();
  await until("the wheel", () => driver.state.wheel?.is_you === true);
  await until("the other sees it", () => main.state.wheel?.is_you === false);
  await driver.context.close();
  await until("a free wheel", () => main.state.wheel === null);
});

await check("a page of another origin can neither look nor drive", async () => {
  const server = createServer((_, response) => response.end("<!doctype html><title>foreign</title>"));
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const context = await browser.newContext();
  const foreign = await context.newPage();
  await foreign.goto(`http://127.0.0.1:${server.address().port}/`);
  const { host, hash } = new URL(program.drive);
  const before = await stoppable();
  const result = await foreign.evaluate(
    async ([host, token]) => {
      const socket = new WebSocket(`ws://${host}/live`);
      const link = await new Promise((resolve) => {
        socket.onopen = () => resolve("open");
        socket.onerror = () => resolve("refused");
      });
      const read = await fetch(`http://${host}/`).then(() => "read", () => "refused");
      const stop = await fetch(`http://${host}/stop`, { method: "POST", mode: "no-cors" }).then((r) => r.type, () => "refused");
      const token_stop = await fetch(`http://${host}/stop`, { method: "POST", headers: { Authorization: `Bearer ${token}` } }).then(() => "sent", () => "refused");
      return { link, read, stop, token_stop };
    },
    [host, hash.slice(1)],
  );
  assert.deepEqual({ ...result, stop: "" }, { link: "refused", read: "refused", stop: "", token_stop: "refused" });
  // The browser sends the plain request and hides the answer: the robot must not have stopped.
  await assertNotStopped(before);
  await context.close();
  server.close();
});

/** A page whose scripts rest, as those of a computer that sleeps. Other checks go on while the server waits for it. */
let sleeper = null;
await check("a page falls asleep", async () => {
  const viewer = await open(program.view);
  await until("a state", () => viewer.state !== null);
  const debug = await viewer.context.newCDPSession(viewer.page);
  await debug.send("Debugger.enable");
  await debug.send("Debugger.pause");
  await page.bringToFront();
  viewer.since = performance.now();
  viewer.wake = async () => {
    viewer.woken = performance.now();
    await debug.send("Debugger.resume");
    await debug.send("Debugger.disable");
  };
  kept.add(viewer.context);
  sleeper = viewer;
});

await check("exploring: the map grows", async () => {
  await page.locator("#explore").click();
  await until("exploring", () => main.state.left.some((task) => task.text === "explore"));
  await page.keyboard.press("m");
  const area = () =>
    page.evaluate(() => {
      const { min, max } = window.trundle.map.tiles.knownBounds();
      return (max[0] - min[0]) * (max[1] - min[1]);
    });
  const before = await area();
  await untilDriven("a larger map", async () => (await area()) > 1.2 * before, () => page.locator("#explore").click());
  await page.locator("#fit").click();
  await settled();
  await picture("explore-dark");
  await page.locator("#theme").click();
  await page.waitForTimeout(300);
  await picture("explore-light");
  await page.locator("#theme").click();
  assert(await page.locator("#camera").isVisible(), "the camera's image is shown");
  return `from ${before.toFixed(1)} to ${(await area()).toFixed(1)} m^2 within its bounds`;
});

await check("features over the camera's image, and the time of the stages", async () => {
  await page.locator("#features-toggle").click();
  const drawn = () =>
    page.evaluate(() => {
      const canvas = document.getElementById("camera-features");
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      return data.filter((value, i) => i % 4 === 3 && value > 0).length;
    });
  await until("features", async () => (await drawn()) > 200);
  await page.locator("#camera-card").scrollIntoViewIfNeeded();
  await picture("features");
  await page.locator("#features-toggle").click();
  await until("the stages", async () => /slam\s+[\d.]+ %/.test(await text(page, "stages")));
  const stages = await text(page, "stages");
  return stages.split("\n").slice(0, 2).join(" ");
});

/** Pixels of a plot that differ from its ground. */
const plotted = (i) =>
  page.evaluate((i) => {
    const canvas = document.querySelectorAll(".plot canvas")[i];
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return data.filter((value, k) => k % 4 === 3 && value > 0).length;
  }, i);

await check("plots of speed, bounds of the pose and load of the stages, in words too", async () => {
  const words = () => page.locator(".plot canvas").evaluateAll((all) => all.map((canvas) => canvas.getAttribute("aria-label")));
  await page.locator("#plots-card").scrollIntoViewIfNeeded();
  const expected = [
    /^Speed, now: measured -?[\d.]+ m\/s, commanded -?[\d.]+ m\/s$/,
    /^Position, now: 95 % radius [\d.]+ c?m$/,
    /^Heading, now: 95 % bound [\d.]+°$/,
    /^Load of a core, now: SLAM [\d.]+ %, map [\d.]+ %, plan [\d.]+ %, control [\d.]+ %$/,
  ];
  await until("numbers", async () => (await words()).every((text, i) => expected[i].test(text)));
  for (let i = 0; i < expected.length; i++) assert((await plotted(i)) > 300, `plot ${i} is empty`);
  const { position, covariance } = await page.evaluate(() => window.trundle.moments.list.at(-1).numbers);
  const [xx, xy, yy] = covariance;
  const sigma = Math.sqrt((xx + yy) / 2 + Math.hypot((xx - yy) / 2, xy));
  assert(Math.abs(position / sigma - 2.448) < 1e-6, `${position} m for a standard deviation of ${sigma} m`);
  await picture("plots");
  return (await words()).join("; ");
});

await check("the time line moves pose, ellipse, path, state and plots back", async () => {
  const past = () => page.evaluate(() => window.trundle.map.past);
  await until("three seconds of moments", () => page.evaluate(() => {
    const { list } = window.trundle.moments;
    const known = list.filter((moment) => moment.numbers);
    return known.length > 0 && known.at(-1).time - known[0].time > 3;
  }));
  await page.locator(".plot canvas").first().focus();
  for (let i = 0; i < 2; i++) await page.keyboard.press("ArrowLeft");
  const shown = await past();
  const same = await page.evaluate((time) => {
    const moment = window.trundle.moments.at(time);
    return { pose: moment.pose, covariance: moment.numbers.covariance, state: window.trundle.moments.stateAt(time) };
  }, shown.time);
  assert.deepEqual([shown.pose, shown.covariance], [same.pose, same.covariance]);
  await until("another scan than that of now", () => page.evaluate(() => {
    const { map, moments } = window.trundle;
    const [then, now] = [map.past.seen, map.seen];
    return then === moments.at(map.past.time).seen && then.scan.length > 0 && then.scan !== now.scan && then.state.time < now.state.time;
  }));
  assert(await page.locator("#past-flag").isVisible(), "the time is named above the map");
  assert.equal((await text(page, "past-state")).toLowerCase(), same.state.name);
  assert.equal(await page.locator("#past-reason").textContent(), same.state.reason ?? "");
  const words = await page.locator(".plot canvas").nth(1).getAttribute("aria-label");
  assert.match(words, /^Position, \d+ s ago: 95 % radius [\d.]+ c?m$/);
  assert.match(await page.locator("#past").getAttribute("aria-valuetext"), /^\d+ s ago, \w+/);
  await picture("past");
  // The drawing of the map's beginning shows less than that of now. A camera without an image of that time says so.
  const drawn = () => page.evaluate(() => {
    let count = 0;
    for (const { chunk } of window.trundle.map.tiles.pictures()) {
      const { width, height } = chunk.canvas;
      const { data } = chunk.context.getImageData(0, 0, width, height);
      for (let i = 3; i < data.length; i += 4) count += data[i] > 0 ? 1 : 0;
    }
    return count;
  });
  const now = await drawn();
  await page.evaluate(() => {
    const slider = document.getElementById("past");
    slider.value = slider.min;
    slider.dispatchEvent(new Event("input"));
  });
  const then = await drawn();
  assert(then < 0.9 * now, `${then} cells at the beginning, ${now} now`);
  await page.keyboard.press("End");
  // On a loaded machine it is drawn later; it grows meanwhile.
  await until("the map of now is back", async () => (await drawn()) >= now);
  assert.equal(await past(), null);
  assert.equal(await page.locator("#past-flag").isVisible(), false);
  return `${words}; ${same.state.name}, ${same.state.reason ?? "no reason"}; ${then} cells at the beginning, ${now} now`;
});

/** Number of pixels of the depth image that are drawn with a depth. */
const depths = (page) =>
  page.evaluate(() => {
    const canvas = document.getElementById("camera-depth");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return data.filter((value, i) => i % 4 === 1 && value > 0).length;
  });

await check("the camera's image as depth, sent only while it is chosen", async () => {
  const messages = () => main.depths;
  const none = messages();
  await page.locator("#depth-choice").click();
  await until("depth", async () => (await depths(page)) > 5000);
  await page.locator("#camera-card").scrollIntoViewIfNeeded();
  await picture("depth");
  await page.locator("#color-choice").click();
  assert.equal(await page.locator("#camera-depth").isVisible(), false);
  assert.equal(none, 0, `${none} depth images before the choice`);
  return `${messages()} depth images`;
});

await check("a recording is switched on and off", async () => {
  const card = page.locator("#recording-card");
  await card.scrollIntoViewIfNeeded();
  await until("no recording", async () => /Off/.test(await text(page, "recording")));
  await until("the free space", async () => /^\d+ (MB|GB) free$/.test(await text(page, "recording-free")));
  await page.locator("#recording-switch").click();
  await until("a recording", async () => /Recording into recording-2\.mcap/.test(await text(page, "recording")));
  await page.waitForTimeout(3000);
  await picture("recording");
  await page.locator("#recording-switch").click();
  await until("its end", async () => /^Off\. The last part is recording-2\.mcap/.test(await text(page, "recording")));
});

await check("landmarks and keyframes", async () => {
  await page.evaluate(() => document.querySelector("[data-layer=visual]").click());
  const count = () => page.evaluate(() => window.trundle.map.landmarks.length / 3);
  await until("landmarks", async () => (await count()) > 100, DRIVE_S);
  await page.waitForTimeout(300);
  await picture("landmarks");
  const landmarks = await count();
  await page.evaluate(() => document.querySelector("[data-layer=visual]").click());
  await page.keyboard.press("3");
  await page.waitForTimeout(1500);
  await picture("space");
  const drawn = await page.evaluate(() => !document.getElementById("space").hidden);
  await page.keyboard.press("3");
  return `${landmarks} landmarks, ${drawn ? "in space too" : "no WebGL here"}`;
});

/** Points of the cloud: their number, and the parts within the room, on its floor, and of those above known cells, at a wall of the map. */
const cloudOf = (page) =>
  page.evaluate(() => {
    const { map, space } = window.trundle;
    if (!space.cloud?.count) return { count: 0 };
    const { count, points } = space.cloud;
    const { min, max } = map.tiles.knownBounds();
    // Depth is seen 2 m farther than the map is drawn.
    const isWithin = (p, axis) => p[axis] > min[axis] - 2 && p[axis] < max[axis] + 2;
    const around = [-0.1, -0.05, 0, 0.05, 0.1].flatMap((dx) => [-0.1, -0.05, 0, 0.05, 0.1].map((dy) => [dx, dy]));
    const [all, found] = [{ room: count, floor: count, wall: 0 }, { room: 0, floor: 0, wall: 0 }];
    for (let i = 0; i < count; i++) {
      const p = points.subarray(4 * i, 4 * i + 3);
      if (isWithin(p, 0) && isWithin(p, 1) && p[2] > -0.3 && p[2] < 2.8) found.room += 1;
      if (Math.abs(p[2]) < 0.1) found.floor += 1;
      const cells = around.map(([dx, dy]) => [p[0] + dx, p[1] + dy]);
      if (p[2] < 0.2 || p[2] > 0.6 || !cells.some((cell) => map.tiles.isKnown(cell))) continue;
      all.wall += 1;
      if (cells.some((cell) => map.tiles.isWall(cell))) found.wall += 1;
    }
    return { count, room: found.room / all.room, floor: found.floor / all.floor, wall: found.wall / Math.max(1, all.wall) };
  });

await check("a cloud of the depth images in space: its points lie in the room, and depth is sent only while it is on", async () => {
  assert.equal(await page.locator("#cloud-toggle").isVisible(), false, "the cloud is offered beside the map");
  await page.keyboard.press("3");
  if (!(await page.locator("#space").isVisible())) return "no WebGL here";
  const before = main.depths;
  await page.locator("#cloud-toggle").click();
  assert.equal(await page.locator("#cloud-toggle").getAttribute("aria-pressed"), "true");
  let cloud;
  await until("1000 points", async () => (cloud = await cloudOf(page)).count > 1000, DRIVE_S);
  await page.waitForTimeout(1500);
  await picture("cloud");
  const parts = ["room", "floor", "wall"].map((part) => `${part} ${(100 * cloud[part]).toFixed(0)} %`).join(", ");
  assert(cloud.room > 0.95 && cloud.floor > 0.02 && cloud.wall > 0.5, `${cloud.count} points: ${parts}`);
  await page.keyboard.press("c");
  assert.equal((await cloudOf(page)).count, 0);
  // What was under way when the cloud was switched off has come by then.
  await page.waitForTimeout(3000);
  const messages = main.depths;
  await page.waitForTimeout(3000);
  assert.equal(main.depths, messages, "depth is sent without a cloud");
  await page.keyboard.press("3");
  assert.equal(await page.locator("#cloud-toggle").isVisible(), false);
  return `${cloud.count} points: ${parts}; ${messages - before} depth images`;
});

/** Rate of the states of a viewer [1/s], and how old they are beside those of this page [s]: the median and the most. */
async function lateness(viewer) {
  const [before, start, lags] = [viewer.states.length, performance.now(), []];
  for (let i = 0; i < 20; i++) {
    await page.waitForTimeout(200);
    lags.push(main.state.time - viewer.state.time);
  }
  lags.sort((a, b) => a - b);
  return { rate: (1000 * (viewer.states.length - before)) / (performance.now() - start), median: lags[10], most: lags.at(-1) };
}

await check("a network of 40 kB/s gets fewer views, none of them old", async () => {
  const slow = await throttle(new URL(program.view), 40_000);
  const viewer = await open(slow.link);
  await until("a state", () => viewer.state !== null);
  await page.waitForTimeout(6000);
  const tries = [];
  const isGood = ({ rate, most }) => most < 4 && rate > 0.3;
  do tries.push(await lateness(viewer));
  while (!isGood(tries.at(-1)) && tries.length < ATTEMPTS);
  await viewer.context.close();
  slow.close();
  const shown = tries.map(({ rate, median, most }) => `${rate.toFixed(1)} views/s, late by ${median.toFixed(1)} s, at most ${most.toFixed(1)} s`);
  assert(isGood(tries.at(-1)), shown.join("; "));
  return `with the camera's image ${shown.join("; ")}`;
});

await check("a network that goes without a word: the page says so and comes back by itself", async () => {
  const way = await throttle(new URL(program.view), 1_000_000);
  const viewer = await open(way.link);
  const link = () => viewer.page.locator("body").getAttribute("data-link");
  await until("a state", () => viewer.state !== null);
  way.mute();
  const noticed = await until("a lost link", async () => (await link()) !== "open");
  const before = viewer.states.length;
  const seconds = await until("states again", () => viewer.states.length > before + 3);
  await until("an open link", async () => (await link()) === "open");
  await viewer.context.close();
  way.close();
  return `noticed after ${noticed.toFixed(1)} s, back after ${seconds.toFixed(1)} s more`;
});

await check("a page that sleeps longer than the server waits comes back by itself", async () => {
  assert(sleeper, "no page sleeps");
  const rest = SILENCE_S - (performance.now() - sleeper.since) / 1000;
  await until("its leave", () => main.state.viewers === 1, Math.max(0, rest) + PATIENCE_S);
  const before = sleeper.states.length;
  await sleeper.wake();
  const seconds = await until("states again", () => sleeper.states.length > before + 3 && sleeper.states.at(-1).at > sleeper.woken);
  await until("both viewers", () => main.state.viewers === 2);
  assert.equal(await sleeper.page.locator("body").getAttribute("data-link"), "open");
  await sleeper.context.close();
  return `after ${seconds.toFixed(1)} s`;
});

/** A map of 100 x 100 m with a path of 6000 points, at so many pixels per metre; null shows it as a whole. */
const showHall = (page, scale) =>
  page.evaluate(async (scale) => {
    const { map } = window.trundle;
    const cells = new Uint8Array(1024).map((_, i) => (i % 37 === 0 ? 0xaa : 0x55));
    const tiles = [];
    for (let row = -16; row < 16; row++) for (let column = -16; column < 16; column++) tiles.push({ column, row, cells });
    map.tiles.add({ kind: "tiles", generation: 99, resolution: 0.05, origin: [0, 0], tiles }, 0);
    const path = Array.from({ length: 6000 }, (_, i) => [40 * Math.cos(i / 300) * Math.cos(i / 2000), 40 * Math.sin(i / 300), 0, i / 10]);
    map.setTrail(new Float32Array(path.flat()));
    map.fit();
    if (scale) map.zoom((scale * map.metresOf100Pixels) / 100);
    for (let i = 0; i < 5; i++) await new Promise(requestAnimationFrame);
    return 100 / map.metresOf100Pixels;
  }, scale);

/** Pans a page's map for 120 frames. */
const panned = (page) =>
  framesOf(browser, page, async ([mark]) => {
    for (let i = 0; i < 120; i++) {
      const way = i % 40 < 20 ? 1 : -1;
      window.trundle.map.pan(6 * way, 3 * way);
      await new Promise(requestAnimationFrame);
      console.timeStamp(mark);
    }
  });

await check("a map of 100 x 100 m pans with at most 16.7 ms of the main thread's work a frame", async () => {
  const LIMIT_MS = 1000 / 60;
  const viewer = await open(program.view);
  await until("a state", () => viewer.state !== null);
  await viewer.page.bringToFront();
  const shown = [];
  let worst = 0;
  for (const wanted of [null, 10, 29, 60]) {
    const scale = await showHall(viewer.page, wanted);
    const { work, wall, period, others } = await panned(viewer.page);
    worst = Math.max(worst, median(work));
    const rest = Object.values(others).reduce((sum, one) => sum + one, 0);
    const figures = [median(work), median(wall), median(period), rest].map((ms) => ms.toFixed(1));
    shown.push(`${scale.toFixed(0)} px/m: ${figures[0]} ms (${figures[1]} by the clock, a frame each ${figures[2]}, other threads ${figures[3]})`);
  }
  await viewer.context.close();
  await page.bringToFront();
  assert(worst <= LIMIT_MS, shown.join("; "));
  return `medians at ${shown.join("; ")}`;
});

await check("on a phone", async () => {
  const phone = await open(program.drive, { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true });
  await until("a state", () => phone.state !== null);
  await phone.page.waitForTimeout(1500);
  await picture("phone", phone.page);
  await phone.page.locator("#panel-open").click();
  await phone.page.waitForTimeout(800);
  await picture("phone-panel", phone.page);
  // A program that reads aloud needs a name of each control, also of those that are hidden.
  const nameless = await phone.page.evaluate(() =>
    [...document.querySelectorAll("button, input, select, canvas")]
      .filter((one) => !one.closest("[aria-hidden=true]"))
      .filter((one) => ![one.getAttribute("aria-label"), one.textContent, one.labels?.[0]?.textContent, one.title].some((name) => name?.trim()))
      .map((one) => one.id || one.outerHTML.slice(0, 80)),
  );
  assert.deepEqual(nameless, [], "controls without a name");
  const stop = await phone.page.locator("#stop").boundingBox();
  assert(stop.width >= 80 && stop.height >= 80, "the stop is large enough for a thumb");
  await phone.context.close();
});

await check("the page comes back after a restart of the program", async () => {
  main.mayFail = true;
  const { host } = new URL(program.drive);
  await program.end();
  await until("the end", async () => (await page.locator("body").getAttribute("data-link")) === "ended");
  assert.match(await page.locator("#reason").textContent(), /The program has ended/);
  await picture("lost");
  const part = join(place, "run", "recording-2.mcap");
  assert(existsSync(part) && !existsSync(join(place, "run", "recording.mcap")), "the recording that was switched on is a file of its own");
  const replay = spawnSync(trundle, ["replay", part, "--out", join(place, "replay")], { encoding: "utf8" });
  assert(replay.status !== 0 && /begins \d+\.\d s after the start of its run/.test(replay.stderr), replay.stderr);
  program = await start(trundle, ["--live", host, "--live-tokens", tokens, ...quiet], join(place, "run"));
  const before = main.states.length;
  const seconds = await until("states again", () => main.states.length > before);
  main.mayFail = false;
  await until("the place of the file", async () => (await entries()).some((text) => text.includes("desk")));
  return `after ${seconds.toFixed(1)} s`;
});

main.mayFail = true;
await program.end();

/** Another command with its page, until the program is ended. */
async function withCommand(args, work) {
  const starting = startCommand(trundle, [...args, "--live", "127.0.0.1:0"]);
  const viewer = await open(starting.then((started) => started.drive ?? started.view));
  const other = await starting;
  // The page of a command that ends by itself finds no server any more.
  viewer.mayLose = true;
  try {
    await until("a state", () => viewer.state !== null);
    return await work(viewer, other);
  } catch (error) {
    const end = other.child.exitCode === null ? "" : `, and the program ended with ${other.child.exitCode}`;
    error.message += ` (its page: ${viewer.state?.state}, ${viewer.state?.reason ?? "no reason"}${end})`;
    throw error;
  } finally {
    await viewer.context.close();
    await other.end();
  }
}
/** Length of the images for `slam` [s]: the page is looked at while they are processed. */
const TRACKED_S = 60;
/** Way-points at the start of the office: the robot turns there. World frame: m, m, deg. */
const TURNS = "2.35 5.34 90\n2.05 5.34 -90\n".repeat(20);

await check("sim: the page drives by keys, shows camera and depth, and offers no missions", () =>
  withCommand(["sim", "office", "--laser", "rplidar-a1", "--duration", "900"], async (viewer) => {
    const { page } = viewer;
    for (const absent of ["#explore", "[data-tool=goal]", "#mission-card", "#settings-card"])
      assert(!(await isShown(page, absent)), `${absent} is offered`);
    assert((await isShown(page, "#stop")) && (await isShown(page, "[data-tool=drive]")));
    const [x, y] = viewer.state.pose;
    await page.locator("#depth-choice").click();
    await until("depth", async () => (await depths(page)) > 5000);
    // At the start the camera looks into the room: before a wall the points would be few.
    await page.keyboard.press("3");
    if (await isShown(page, "#space")) {
      await page.locator("#cloud-toggle").click();
      let cloud;
      await until("1000 points", async () => (cloud = await cloudOf(page)).count > 1000, DRIVE_S);
      assert(cloud.room > 0.95 && cloud.floor > 0.02, `cloud of the simulator: room ${cloud.room}, floor ${cloud.floor}, wall ${cloud.wall}`);
      await page.keyboard.press("3");
    }
    await page.keyboard.down("w");
    await until("motion", () => speed(viewer) > 0.1);
    await until("driving by hand", () => viewer.state.state === "driven by hand");
    const driven = () => Math.hypot(viewer.state.pose[0] - x, viewer.state.pose[1] - y);
    await until("a way of 0.3 m", () => driven() > 0.3, DRIVE_S);
    await picture("sim", page);
    await until("a way of 0.6 m", () => driven() > 0.6, DRIVE_S);
    const heading = viewer.state.pose[2];
    await page.keyboard.down("a");
    await until("a turn", () => Math.abs(Math.sin(viewer.state.pose[2] - heading)) > 0.3, DRIVE_S);
    await page.keyboard.up("a");
    await page.keyboard.up("w");
    const seconds = await until("rest", () => speed(viewer) === 0);
    await page.keyboard.down("w");
    await until("motion", () => speed(viewer) > 0.1);
    await page.keyboard.press("Space");
    const stopped = await until("stop", () => speed(viewer) === 0);
    await page.keyboard.up("w");
    return `${driven().toFixed(1)} m, at rest ${seconds.toFixed(2)} s after the keys, ${stopped.toFixed(2)} s after STOP`;
  }),
);

await check("slam: features, landmarks, map and progress, and nothing that drives", () => {
  const [tracked, way] = [join(place, "tracked"), join(place, "way.txt")];
  writeFileSync(way, TURNS);
  // It ends before the last way-point.
  spawnSync(trundle, ["sim", "office", "--follow", way, "--record", tracked, "--rate", "10", "--duration", `${TRACKED_S}`, "--quiet"]);
  return withCommand(["slam", tracked, "--height", "0.45", "--tilt", "8", "--out", join(place, "slam")], async (viewer) => {
    const { page } = viewer;
    for (const absent of ["#stop", "#explore", "[data-tool=drive]", "#mission-card", "#notes-card"])
      assert(!(await isShown(page, absent)), `${absent} is offered`);
    const landmarks = () => page.evaluate(() => window.trundle.map.landmarks.length / 3);
    await until("landmarks", async () => (await landmarks()) > 100, DRIVE_S);
    await until("thirty images", async () => parseInt(await text(page, "series-count")) > 30, DRIVE_S);
    await until("the camera's image", () => isShown(page, "#camera"));
    await picture("slam", page);
    return `${await text(page, "series-count")}, ${await landmarks()} landmarks`;
  });
});

await check("experiment: the run that goes on, and the results of those that have ended", () =>
  // With 800 runs, some are left when a slow browser has opened the page of a fast program.
  withCommand(["experiment", "poses", "--seeds", "100", "--out", join(place, "poses")], async (viewer) => {
    const { page } = viewer;
    assert(!(await isShown(page, "#stop")) && (await isShown(page, "#mission-card")));
    let first = "";
    await until("a shown run", async () => /Shown: \d, seed \d+/.test((first = await text(page, "series-shown"))));
    await until("a drive", () => speed(viewer) > 0.3, DRIVE_S);
    await picture("experiment", page);
    await until("a result", async () => (await page.locator("#series-ended li").count()) > 0, DRIVE_S);
    await until("another run", async () => (await text(page, "series-shown")) !== first, DRIVE_S);
    return `${await text(page, "series-count")}; ${await page.locator("#series-ended li").first().innerText()}`;
  }),
);

await check("an encrypted page: the certificate's origin, a link, and nothing in the clear", async () => {
  const data = join(import.meta.dirname, "../../crates/trundle-live/tests/data");
  const files = ["--live-certificate", join(data, "certificate.pem"), "--live-key", join(data, "key.pem")];
  const other = await start(trundle, ["--live", "127.0.0.1:0", ...files, ...quiet.slice(0, 3)], join(place, "encrypted"));
  // The test's certificate is signed by nobody whom a browser knows.
  const viewer = await open(other.drive, { ignoreHTTPSErrors: true });
  try {
    assert.match(other.drive, /^https:/);
    await until("a state", () => viewer.state !== null);
    assert(await viewer.page.evaluate(() => window.isSecureContext));
    const clear = await fetch(other.drive.replace("https:", "http:"));
    assert.equal(clear.status, 400);
    assert.match(await clear.text(), new RegExp(`^This page is encrypted.*${new URL(other.drive).origin}/#`));
    return new URL(other.drive).origin.replace(/\d+$/, "PORT");
  } finally {
    await viewer.context.close();
    await other.end();
  }
});

for (const state of STATES)
  await check(`the picture of ${state} looks like its reference`, async () => {
    if (skips > 0 && !taken.has(state)) return "not taken, because its check was skipped";
    assert(taken.has(state), "it was not taken");
    const measured = await measure(gauge, taken.get(state));
    const reference = referenceOf(state, measured);
    assert(reference, `no reference: run with UPDATE_PICTURES=1, and look at ${state}.png`);
    const found = differences(measured, reference);
    assert.deepEqual(found, [], `${found.join("; ")} (${join(pictures, `${state}.png`)})`);
  });

await check("no error in the console", async () => assert.deepEqual(problems, []));

await browser.close();
console.log(`pictures: ${pictures}`);
process.exit(failures ? 1 : 0);
