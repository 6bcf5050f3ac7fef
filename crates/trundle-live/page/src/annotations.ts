// The card of zones and named places: their list, and the form of the one that is being changed.

import type { MapView } from "./map_view";
import { element } from "./panel";
import type { Place, Point, Pose, Zone, ZoneKind } from "./wire";
import { isInside, kindText, middle, asPose, type Draft } from "./zone_layer";
import { ZoneTool } from "./zone_tool";

/** Speed of a new slow zone [m/s]. */
const NEW_SPEED_M_S = 0.2;
/** Most corners of a zone; the robot refuses more. */
const MAX_CORNERS = 200;

export interface AnnotationEvents {
  /** Sends a request; the reason of a refusal, which is shown beside the place too. */
  ask(request: object, at: Pose): Promise<string | undefined>;
  go(pose: Pose): void;
  note(text: string): void;
  /** Corners are dragged from here on. */
  draw(): void;
  /** The form is closed: the map is moved again. */
  onClosed(): void;
}

type Subject = { zone: Zone } | { place: Place };

export class Annotations {
  readonly tool: ZoneTool;
  private places: Place[] = [];
  private subject: Subject | null = null;

  constructor(
    private readonly map: MapView,
    private readonly robot: () => Pose | null,
    private readonly events: AnnotationEvents,
  ) {
    this.tool = new ZoneTool(map, (draft) => this.onDrawn(draft));
    const form = element<HTMLFormElement>("note-form");
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      void this.save();
    });
    element("note-cancel").addEventListener("click", () => this.close());
    element("note-delete").addEventListener("click", () => void this.remove());
    element("place-here").addEventListener("click", () => {
      const pose = this.robot();
      if (pose) this.newPlace(pose);
    });
    field("note-kind").addEventListener("change", () => this.onKind());
  }

  show(zones: Zone[], places: Place[]): void {
    this.places = places;
    this.map.zones.zones = zones;
    this.map.zones.places = places;
    this.map.dirty();
    const items = [...zones.map((zone) => this.zoneItem(zone)), ...places.map((place) => this.placeItem(place))];
    element("notes").replaceChildren(...items);
    element("notes-none").hidden = items.length > 0;
  }

  /** Begins to draw a zone. */
  beginZone(): void {
    this.close(false);
    this.tool.begin("no_go");
  }

  /** Opens the form of a new place. */
  newPlace([x, y, theta]: Pose): void {
    this.open({ place: { id: 0, name: this.freeName(), pose: { x, y, theta } } });
  }

  /** Forgets what is drawn and not kept. */
  close(isTold = true): void {
    this.subject = null;
    this.tool.end();
    this.map.zones.hidden = 0;
    this.map.ghost = null;
    element("note-form").hidden = true;
    if (isTold) this.events.onClosed();
  }

  private freeName(): string {
    const names = new Set(this.places.map((place) => place.name));
    let number = 1;
    while (names.has(`Place ${number}`)) number++;
    return `Place ${number}`;
  }

  private onDrawn(draft: Draft): void {
    if (this.subject && "zone" in this.subject) this.subject.zone.outline = draft.outline;
    else this.open({ zone: { id: 0, name: "", kind: draft.kind, outline: draft.outline } });
  }

  private open(subject: Subject): void {
    this.subject = subject;
    const isZone = "zone" in subject;
    const entry = isZone ? subject.zone : subject.place;
    field("note-name").value = entry.name;
    element("note-kind-line").hidden = !isZone;
    if (isZone) {
      const { kind } = subject.zone;
      field("note-kind").value = typeof kind === "string" ? kind : "slow";
      field("note-speed").value = String(typeof kind === "string" ? NEW_SPEED_M_S : kind.slow);
      this.map.zones.hidden = entry.id;
    } else {
      this.map.ghost = { pose: asPose(subject.place), kind: "goal" };
    }
    element("note-title").textContent = `${entry.id === 0 ? "New " : ""}${isZone ? "zone" : "place"}`;
    element("note-delete").hidden = entry.id === 0;
    element("note-form").hidden = false;
    // On a phone the form is in a panel that may be closed.
    if (element("note-form").offsetParent === null) element("panel-open").click();
    showProblem("");
    this.onKind();
    element("note-form").scrollIntoView({ block: "nearest" });
    field("note-name").focus({ preventScroll: true });
  }

  private onKind(): void {
    const isZone = this.subject !== null && "zone" in this.subject;
    element("note-speed-line").hidden = !isZone || field("note-kind").value !== "slow";
    if (this.subject && "zone" in this.subject) this.tool.setKind(chosenKind());
  }

  private async save(): Promise<void> {
    const subject = this.subject;
    if (!subject) return;
    const name = field("note-name").value.trim();
    if ("place" in subject) {
      const place = { ...subject.place, name };
      return this.finish(await this.events.ask({ type: "set_place", place }, asPose(place)));
    }
    const kind = chosenKind();
    const zone = { ...subject.zone, name, kind, outline: subject.zone.outline.map(rounded) };
    const x = middle(zone.outline)[0];
    // Above the drawing, which stays in sight.
    const y = Math.max(...zone.outline.map((corner) => corner[1]));
    if (zone.outline.length > MAX_CORNERS) return this.finish(`A zone has at most ${MAX_CORNERS} corners.`);
    if (typeof kind !== "string" && !Number.isFinite(kind.slow)) return this.finish("The speed is a number in m/s.");
    const refusal = await this.events.ask({ type: "set_zone", zone }, [x, y, 0]);
    const robot = this.robot();
    if (!refusal && kind === "no_go" && robot && isInside(zone.outline, [robot[0], robot[1]])) {
      this.events.note("The robot stands in this zone. It leaves it slowly with its next task.");
    }
    this.finish(refusal);
  }

  private async remove(): Promise<void> {
    const subject = this.subject;
    if (!subject) return;
    const [type, entry] = "zone" in subject ? ["remove_zone", subject.zone] : ["remove_place", subject.place];
    const at = "zone" in subject ? middle(subject.zone.outline) : subject.place.pose;
    const [x, y] = Array.isArray(at) ? at : [at.x, at.y];
    this.finish(await this.events.ask({ type, number: entry.id }, [x, y, 0]));
  }

  private finish(refusal: string | undefined): void {
    if (refusal) showProblem(refusal);
    else this.close();
  }

  private zoneItem(zone: Zone): HTMLElement {
    const kind = typeof zone.kind === "string" ? zone.kind : "slow";
    const line = item(kind, zone.name || `Zone ${zone.id}`, kindText(zone.kind));
    line.append(
      button("Edit", `Edit the zone ${zone.name || zone.id}`, () => {
        this.events.draw();
        this.tool.begin(zone.kind, zone.outline);
        this.open({ zone: { ...zone, outline: this.tool.draft!.outline } });
      }),
    );
    return line;
  }

  private placeItem(place: Place): HTMLElement {
    const line = item("place", place.name, `${place.pose.x.toFixed(2)}, ${place.pose.y.toFixed(2)} m`);
    line.append(
      button("Go", `Go to ${place.name}`, () => this.events.go(asPose(place))),
      button("Edit", `Edit the place ${place.name}`, () => {
        this.tool.end();
        this.open({ place });
      }),
    );
    return line;
  }
}

function field(id: string): HTMLInputElement {
  return element<HTMLInputElement>(id);
}

function chosenKind(): ZoneKind {
  const kind = field("note-kind").value;
  if (kind !== "slow") return kind === "area" ? "area" : "no_go";
  return { slow: Number.parseFloat(field("note-speed").value.replace(",", ".")) };
}

/** A corner to a millimetre: what a person draws is no finer. */
function rounded([x, y]: Point): Point {
  return [Math.round(1000 * x) / 1000, Math.round(1000 * y) / 1000];
}

function showProblem(text: string): void {
  const problem = element("note-problem");
  problem.textContent = text;
  problem.hidden = text === "";
}

function item(kind: string, name: string, what: string): HTMLElement {
  const line = document.createElement("li");
  line.className = kind;
  const sign = document.createElement("i");
  const words = document.createElement("span");
  words.textContent = name;
  const small = document.createElement("small");
  small.textContent = what;
  words.append(small);
  line.append(sign, words);
  return line;
}

function button(text: string, label: string, act: () => void): HTMLElement {
  const made = document.createElement("button");
  made.type = "button";
  made.className = "text steers";
  made.textContent = text;
  made.setAttribute("aria-label", label);
  made.addEventListener("click", act);
  return made;
}
