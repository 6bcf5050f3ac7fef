// Starts trundle with `--live` and finds the links that it prints.
import { spawn } from "node:child_process";

/** `trundle demo` with its links. */
export const start = (trundle, args, out) => startCommand(trundle, ["demo", "--out", out, "--record", "none", ...args]);

/** Niceness of the program where root starts it: a robot in real time that other processes starve loses its pose, which is no fault of the page. */
const NICENESS = -10;

/** Longest wait for the links of a program, and for its end [ms]. */
const LINK_MS = 300_000;
const END_MS = 120_000;

/** A program with its links, that which drives where there is one; `end` stops it by Ctrl-C. */
export async function startCommand(trundle, args) {
  const [command, ...before] = process.getuid?.() === 0 ? ["nice", "-n", String(NICENESS), trundle] : [trundle];
  const child = spawn(command, [...before, ...args], { stdio: ["ignore", "pipe", "pipe"] });
  let text = "";
  const links = new Promise((resolve, reject) => {
    const read = (chunk) => {
      text += chunk;
      const drive = /Live page: (\S+)/.exec(text)?.[1];
      const view = /to view only: (\S+)/.exec(text)?.[1];
      if (view) resolve({ drive, view });
    };
    child.stdout.on("data", read);
    child.stderr.on("data", read);
    child.on("exit", (code) => reject(new Error(`trundle ended with ${code}: ${text}`)));
    setTimeout(() => reject(new Error(`no link after ${LINK_MS / 1000} s: ${text}`)), LINK_MS).unref();
  });
  const exited = new Promise((resolve) => child.on("exit", resolve));
  const end = async (signal = "SIGINT") => {
    child.kill(signal);
    const last = setTimeout(() => child.kill("SIGKILL"), END_MS);
    await exited;
    clearTimeout(last);
  };
  return { ...(await links), end, child, output: () => text };
}
