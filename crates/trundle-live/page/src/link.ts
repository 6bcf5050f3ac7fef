// The link to the server: connects, says hello, and connects again when it is lost.

import { readBytes, WIRE_VERSION, type ByteMessage, type Reply } from "./wire";

export type LinkState = "connecting" | "open" | "lost" | "ended" | "refused";

export interface LinkEvents {
  onState(state: LinkState, reason: string): void;
  onReply(reply: Reply): void;
  onBytes(message: ByteMessage): void;
}

type Answer = { refusal?: string; goal?: number };

/** Wait before the first new attempt, and the longest one [ms]. */
const FIRST_WAIT_MS = 500;
const LONGEST_WAIT_MS = 5000;
/** Without any message for this time the link counts as lost [ms], also while it is opened: the server sends something each second while the robot steps. */
const SILENCE_MS = 8000;

/** Close code of a link that ended without a close. */
const NO_CLOSE = 1006;
/** Close code of a program that has ended as it should. */
const PROGRAM_ENDED = 1001;

export class Link {
  private socket: WebSocket | null = null;
  private wait = FIRST_WAIT_MS;
  private nextId = 1;
  /** Whether the program said that it ends; attempts to connect again do not change that. */
  private hasEnded = false;
  private heard = 0;
  private readonly waiting = new Map<number, (answer: Answer) => void>();

  constructor(
    private readonly token: string,
    private readonly name: string,
    private readonly events: LinkEvents,
  ) {
    window.addEventListener("online", () => this.hurry());
    document.addEventListener("visibilitychange", () => document.hidden || this.hurry());
    setInterval(() => this.checkSilence(), 2000);
  }

  connect(): void {
    this.events.onState("connecting", "");
    const socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live`);
    this.socket = socket;
    this.heard = performance.now();
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.send({ type: "hello", version: WIRE_VERSION, token: this.token, name: this.name });
    socket.onmessage = (event) => socket === this.socket && this.receive(event.data as string | ArrayBuffer);
    socket.onclose = (event) => this.onClose(socket, event.code, event.reason);
  }

  /** Whether messages arrive. */
  get isOpen(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  /** Sends a request without an answer. */
  send(request: object): void {
    if (this.isOpen) this.socket?.send(JSON.stringify(request));
  }

  /** Sends a request; its answer. */
  ask(request: object): Promise<Answer> {
    if (!this.isOpen) return Promise.resolve({ refusal: "There is no link to the robot." });
    const id = this.nextId++;
    return new Promise((resolve) => {
      this.waiting.set(id, resolve);
      this.send({ ...request, id });
    });
  }

  /** Stops the robot by the link, and beside it by a request of its own in case the link hangs. */
  stop(): Promise<Answer> {
    const done = new AbortController();
    const headers = { Authorization: `Bearer ${this.token}` };
    const beside = fetch("/stop", { method: "POST", headers, signal: done.signal }).then(async (response) =>
      failUnlessObeyed(response.ok ? {} : { refusal: await response.text() }),
    );
    const asked = this.ask({ type: "stop" }).then(failUnlessObeyed);
    // A late second stop would end what is asked for next.
    asked.then(
      () => done.abort(),
      () => {},
    );
    return Promise.any([asked, beside]).catch((error: AggregateError) => ({
      refusal: String((error.errors[0] as Error | undefined)?.message ?? error),
    }));
  }

  private receive(data: string | ArrayBuffer): void {
    this.heard = performance.now();
    if (typeof data !== "string") {
      const message = readBytes(data);
      if (message) this.events.onBytes(message);
      return;
    }
    const reply = JSON.parse(data) as Reply;
    if (reply.type === "welcome") {
      this.wait = FIRST_WAIT_MS;
      this.hasEnded = false;
      this.events.onState("open", "");
    } else if (reply.type === "state") {
      this.send({ type: "seen", batch: reply.batch });
    } else if (reply.type === "answer") {
      this.waiting.get(reply.id)?.(reply);
      this.waiting.delete(reply.id);
    }
    this.events.onReply(reply);
  }

  private onClose(socket: WebSocket, code: number, reason: string): void {
    if (socket !== this.socket) return;
    this.socket = null;
    this.waiting.forEach((resolve) => resolve({ refusal: "The link to the robot was lost." }));
    this.waiting.clear();
    if (code === 4401) return this.events.onState("refused", reason);
    if (code === 4406) return location.reload();
    this.hasEnded ||= code === PROGRAM_ENDED;
    this.events.onState(this.hasEnded ? "ended" : "lost", reason);
    setTimeout(() => this.socket || this.connect(), this.wait);
    this.wait = Math.min(2 * this.wait, LONGEST_WAIT_MS);
  }

  /** Gives a silent link up at once: a network that is gone never confirms its close. */
  private checkSilence(): void {
    const { socket } = this;
    if (!socket || performance.now() - this.heard < SILENCE_MS) return;
    this.onClose(socket, NO_CLOSE, "");
    socket.close();
  }

  private hurry(): void {
    this.wait = FIRST_WAIT_MS;
  }
}

function failUnlessObeyed(answer: Answer): Answer {
  if (answer.refusal) throw new Error(answer.refusal);
  return answer;
}
