// What viewers cost: `node load.mjs TRUNDLE [SECONDS]` measures the processor time of the page's thread with 0, 1 and 10 viewers and one that
// reads nothing, and how late the robot's commands are. Ends with 1 above a limit.
import { mkdtempSync, readdirSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import WebSocket from "ws";
import { start } from "./program.mjs";

const [trundle, seconds = "20"] = process.argv.slice(2);
const place = mkdtempSync(join(tmpdir(), "live-load-"));
const TICKS_PER_S = 100;
/** Largest part of a core for viewers by their number [%]. Without viewers it is the least that a clock of 10 ms shows. */
const LIMITS = { 0: 0.1, 1: 3 };
const wire = readFileSync(new URL("../../crates/trundle-live/page/src/wire.ts", import.meta.url), "utf8");
const version = Number(/WIRE_VERSION = (\d+)/.exec(wire)[1]);

/** Processor time of the threads of a name so far [s]. */
function threadTime(pid, name) {
  const tasks = readdirSync(`/proc/${pid}/task`).filter((task) => {
    return readFileSync(`/proc/${pid}/task/${task}/comm`, "utf8").trim() === name;
  });
  const time = (task) => {
    const fields = readFileSync(`/proc/${pid}/task/${task}/stat`, "utf8").split(") ")[1].split(" ");
    return (Number(fields[11]) + Number(fields[12])) / TICKS_PER_S;
  };
  return tasks.map(time).reduce((sum, one) => sum + one, 0);
}

function view(link, draws) {
  const { host, hash, origin } = new URL(link);
  const socket = new WebSocket(`ws://${host}/live`, { origin });
  const viewer = { socket, states: 0, bytes: 0 };
  socket.on("open", () => {
    socket.send(JSON.stringify({ type: "hello", version, token: hash.slice(1), name: "load" }));
    socket.send(JSON.stringify({ type: "camera", on: true }));
    if (!draws) socket.pause();
  });
  socket.on("message", (data, isBinary) => {
    viewer.bytes += data.length;
    if (isBinary) return;
    const message = JSON.parse(data);
    if (message.type !== "state") return;
    viewer.states += 1;
    socket.send(JSON.stringify({ type: "seen", batch: message.batch }));
  });
  return viewer;
}

const wait = (s) => new Promise((resolve) => setTimeout(resolve, 1000 * s));
const program = await start(trundle, ["--live", "127.0.0.1:0"], join(place, "run"));
await wait(5);
const faults = [];
for (const count of [0, 1, 10]) {
  const viewers = Array.from({ length: count }, () => view(program.view, true));
  if (count === 10) viewers.push(view(program.view, false));
  await wait(2);
  const before = threadTime(program.child.pid, "live-page");
  const sent = viewers.map((viewer) => [viewer.states, viewer.bytes]);
  await wait(Number(seconds));
  const percent = (100 * (threadTime(program.child.pid, "live-page") - before)) / Number(seconds);
  const rates = viewers.map((viewer, i) => (viewer.states - sent[i][0]) / Number(seconds));
  const kB = viewers.map((viewer, i) => (viewer.bytes - sent[i][1]) / 1000 / Number(seconds));
  if (rates.slice(0, count).some((rate) => rate === 0)) throw new Error(`a viewer of ${count} gets no views: it was not let in, or the robot stands still`);
  const of = (list) => list.slice(0, count).map((x) => x.toFixed(1)).join(" ");
  console.log(`${count} viewers: ${percent.toFixed(2)} % of a core; views/s ${of(rates)}; kB/s ${of(kB)}`);
  if (percent > (LIMITS[count] ?? Infinity)) faults.push(`${count} viewers take ${percent.toFixed(2)} % of a core: expected at most ${LIMITS[count]} %`);
  viewers.forEach((viewer) => viewer.socket.terminate());
  await wait(1);
}
await program.end();
const summary = JSON.parse(readFileSync(join(place, "run", "summary.json"), "utf8"));
const { steps, missed_deadlines, jitter_p999_ms } = summary.wall_clock.real_time.control;
if (missed_deadlines > 0) faults.push(`${missed_deadlines} commands missed their deadlines: expected none`);
console.log(`missed deadlines: ${missed_deadlines} of ${steps} commands; jitter p99.9: ${jitter_p999_ms.toFixed(2)} ms`);
faults.forEach((fault) => console.log(`FAIL ${fault}`));
process.exit(faults.length > 0 ? 1 : 0);
