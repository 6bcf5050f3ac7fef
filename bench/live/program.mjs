// Starts trundle with `--live` and finds the links that it prints.
import { spawn } from "node:child_process";

/** `trundle demo` with its links. */
export const start = (trundle, args, out) => startCommand(trundle, ["demo", "--out", out, "--record", "none", ...args]);

/** A program with its links, that which drives where there is one; `end` stops it by Ctrl-C. */
export async function startCommand(trundle, args) {
  const child = spawn(trundle, args, { stdio: ["ignore", "pipe", "pipe"] });
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
    setTimeout(() => reject(new Error(`no link after 60 s: ${text}`)), 60_000).unref();
  });
  const exited = new Promise((resolve) => child.on("exit", resolve));
  const end = async (signal = "SIGINT") => {
    child.kill(signal);
    await exited;
  };
  return { ...(await links), end, child, output: () => text };
}
