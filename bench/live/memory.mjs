// Whether memory grows: `node memory.mjs TRUNDLE CHROMIUM [MINUTES]` watches a driving robot in Chromium, 10 minutes without MINUTES. Prints the
// memory of program and browser each minute, and their growth after the first third. Ends with 1 above a limit, if MINUTES are 30 or more.
import { mkdtempSync, readdirSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { start } from "./program.mjs";

const [trundle, chromiumPath, minutes = "10"] = process.argv.slice(2);
if (!trundle || !chromiumPath || !(Number(minutes) >= 1)) throw new Error("usage: node memory.mjs TRUNDLE CHROMIUM [MINUTES], MINUTES 1 or more");
const MB = 1e6;
/** Time between two samples [s]. */
const PERIOD_S = 5;
/** Growth above which the program and the page fail [MB/h]. The program's is that of a robot without a page: its logs and its map grow. */
const LIMITS = { program: 10, page: 2 };
/** Shortest run that is judged [min]: the noise of a shorter one is larger than the limits. */
const JUDGED_FROM_MIN = 30;
/** Goals that the robot drives to in turn: x [m], y [m]. */
const GOALS = [[2.5, 0], [0.2, 0]];

/** Resident memory of a process, its part of what it shares with others [bytes]; 0 after its end. */
function resident(pid) {
  try {
    return 1024 * Number(/^Pss:\s+(\d+)/m.exec(readFileSync(`/proc/${pid}/smaps_rollup`, "utf8"))?.[1] ?? 0);
  } catch {
    return 0;
  }
}

/** The processes below this one: of the browser, if `but` is the program. */
function residentBelow(but) {
  const parents = new Map();
  for (const pid of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      parents.set(Number(pid), Number(readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ")[1]));
    } catch {
      // It has ended.
    }
  }
  const isBelow = (pid) => pid === process.pid || (pid > 1 && pid !== but && isBelow(parents.get(pid) ?? 0));
  const below = [...parents.keys()].filter((pid) => pid !== process.pid && pid !== but && isBelow(pid));
  return below.reduce((sum, pid) => sum + resident(pid), 0);
}

/** Growth by the line of least squares through the samples after the first third [MB/h]. */
function growth(samples, of) {
  const late = samples.slice(Math.floor(samples.length / 3));
  const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
  const [t0, m0] = [mean(late.map((sample) => sample.at)), mean(late.map(of))];
  const spread = late.map((sample) => (sample.at - t0) ** 2).reduce((sum, value) => sum + value, 0);
  return (late.map((sample) => (sample.at - t0) * (of(sample) - m0)).reduce((sum, value) => sum + value, 0) / spread) * (3600 / MB);
}

const program = await start(trundle, ["--live", "127.0.0.1:0", "--direct", "--goal", "0.2,0,0"], join(mkdtempSync(join(tmpdir(), "live-memory-")), "run"));
const browser = await chromium.launch({ executablePath: chromiumPath, args: ["--no-sandbox", "--enable-unsafe-swiftshader"] });
const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
let state = null;
let views = 0;
page.on("websocket", (socket) =>
  socket.on("framereceived", ({ payload }) => {
    if (typeof payload !== "string" || !payload.startsWith('{"type":"state"')) return;
    state = JSON.parse(payload);
    views += 1;
  }),
);
/** Longest wait for the page [ms]: a loaded machine draws seldom, which is no growth. */
page.setDefaultTimeout(300_000);
await page.goto(program.drive);
const devtools = await page.context().newCDPSession(page);
await devtools.send("Performance.enable");

/** Memory now, the page's after its garbage is collected. */
async function sample(at) {
  await devtools.send("HeapProfiler.collectGarbage");
  const { usedSize } = await devtools.send("Runtime.getHeapUsage");
  const { metrics } = await devtools.send("Performance.getMetrics");
  const nodes = metrics.find((metric) => metric.name === "Nodes").value;
  return { at, program: resident(program.child.pid), page: usedSize, browser: residentBelow(program.child.pid), nodes };
}

let goals = 0;
/** The next goal, if the robot has none. */
async function drive() {
  if (!state || (state.left.length > 0 && !state.over)) return;
  const [x, y] = GOALS[goals % GOALS.length];
  await page.locator("#goal-x").fill(String(x));
  await page.locator("#goal-y").fill(String(y));
  await page.locator("#goal-form button").click();
  goals += 1;
}

const begin = performance.now();
const seconds = () => (performance.now() - begin) / 1000;
const samples = [];
let shown = -Infinity;
while (seconds() < 60 * Number(minutes)) {
  await new Promise((resolve) => setTimeout(resolve, 1000 * PERIOD_S));
  await drive();
  samples.push(await sample(seconds()));
  const { at, ...now } = samples.at(-1);
  if (at - shown < 60) continue;
  shown = at;
  const mb = (bytes) => (bytes / MB).toFixed(1);
  console.log(`${(at / 60).toFixed(1)} min: program ${mb(now.program)} MB, page ${mb(now.page)} MB and ${now.nodes} nodes, browser ${mb(now.browser)} MB, ${goals} goals, ${views} views, ${state?.state ?? "no state"}`);
}
await browser.close();
await program.end();

console.log(`duration: ${minutes} min, ${goals} goals, ${(views / seconds()).toFixed(1)} views/s`);
const growths = { program: growth(samples, (s) => s.program), page: growth(samples, (s) => s.page), browser: growth(samples, (s) => s.browser) };
for (const [name, value] of Object.entries(growths)) console.log(`${name} grows by: ${value.toFixed(2)} MB/h`);
console.log(`nodes of the page, growth: ${(growth(samples, (s) => s.nodes) * MB).toFixed(0)} 1/h`);
const exceeded = Object.keys(LIMITS).filter((name) => growths[name] > LIMITS[name]);
if (Number(minutes) < JUDGED_FROM_MIN) console.log(`not judged: shorter than ${JUDGED_FROM_MIN} minutes`);
else if (exceeded.length) console.log(`FAIL more than ${exceeded.map((name) => `${LIMITS[name]} MB/h (${name})`).join(", ")}`);
process.exit(Number(minutes) >= JUDGED_FROM_MIN && exceeded.length ? 1 : 0);
