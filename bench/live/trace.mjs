// Frames of a page from Chromium's trace: the work of the page's main thread, and of the threads that compose and show what it draws.

/** Categories of the trace: the tasks of each thread, and the marks of the page. */
const CATEGORIES = ["toplevel", "devtools.timeline", "__metadata"];
/** Tasks of a thread. No task contains another one. */
const TASKS = ["ThreadControllerImpl::RunTask", "ThreadPool_RunTask"];
/** The mark of a frame in the trace. */
const MARK = "trundle-frame";

/**
 * The frames of `page` while `draw` runs there: it gets the mark, and calls console.timeStamp with it at the end of each frame. The result:
 * `work` is the processor time of the main thread in each frame, with script, layout, paint and the raster of canvases; `wall` is the time by
 * the clock of the same tasks, which contains waits for other threads and programs; `period` is the time between two frames; `others` is the
 * mean processor time per frame of each other thread [ms].
 */
export async function framesOf(browser, page, draw, argument) {
  await browser.startTracing(page, { categories: CATEGORIES });
  let trace;
  try {
    await page.evaluate(draw, [MARK, argument]);
  } finally {
    trace = await browser.stopTracing();
  }
  return frames(JSON.parse(trace).traceEvents);
}

export const median = (numbers) => numbers.toSorted((a, b) => a - b)[numbers.length >> 1];

function frames(events) {
  const marks = events.filter((event) => event.name === "TimeStamp" && event.args.data?.message === MARK);
  if (marks.length < 2) throw new Error(`the trace has ${marks.length} frames`);
  const times = marks.map((mark) => mark.ts).sort((a, b) => a - b);
  const page = threadOf(marks[0]);
  const count = times.length - 1;
  const [work, wall, others] = [new Array(count).fill(0), new Array(count).fill(0), {}];
  const names = new Map(events.filter(({ name }) => name === "thread_name").map((event) => [threadOf(event), event.args.name]));
  for (const task of events) {
    const frame = TASKS.includes(task.name) && task.ph === "X" ? times.findLastIndex((time) => time <= task.ts) : -1;
    if (frame < 0 || frame >= count) continue;
    const busy = (task.tdur ?? task.dur) / 1000;
    const thread = threadOf(task);
    if (thread === page) {
      work[frame] += busy;
      wall[frame] += task.dur / 1000;
    } else {
      const name = names.get(thread) ?? "unnamed";
      others[name] = (others[name] ?? 0) + busy / count;
    }
  }
  return { work, wall, period: times.slice(1).map((time, i) => (time - times[i]) / 1000), others };
}

const threadOf = ({ pid, tid }) => `${pid}:${tid}`;
