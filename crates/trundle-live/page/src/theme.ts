// Dark and light: the system's choice until the person chooses; the colours of the canvas come from the style sheet.

export interface Colors {
  floor: string;
  wall: string;
  grid: string;
  gridStrong: string;
  trail: string;
  plan: string;
  planCase: string;
  scan: string;
  robot: string;
  robotEdge: string;
  sigma: string;
  goal: string;
  text: string;
  ghost: string;
  noGo: string;
  slow: string;
  area: string;
  frontier: string;
}

const KEY = "trundle-theme";
const dark = window.matchMedia("(prefers-color-scheme: dark)");

export function startTheme(onChange: () => void): void {
  apply();
  dark.addEventListener("change", () => {
    apply();
    onChange();
  });
}

export function toggleTheme(): void {
  const next = document.documentElement.dataset["theme"] === "dark" ? "light" : "dark";
  localStorage.setItem(KEY, next);
  apply();
}

function apply(): void {
  document.documentElement.dataset["theme"] = localStorage.getItem(KEY) ?? (dark.matches ? "dark" : "light");
}

export function colors(): Colors {
  const style = getComputedStyle(document.documentElement);
  const of = (name: string) => style.getPropertyValue(name).trim();
  return {
    floor: of("--map-floor"),
    wall: of("--map-wall"),
    grid: of("--map-grid"),
    gridStrong: of("--map-grid-strong"),
    trail: of("--map-trail"),
    plan: of("--map-plan"),
    planCase: of("--map-plan-case"),
    scan: of("--map-scan"),
    robot: of("--map-robot"),
    robotEdge: of("--map-robot-edge"),
    sigma: of("--map-sigma"),
    goal: of("--map-goal"),
    text: of("--text"),
    ghost: of("--map-ghost"),
    noGo: of("--bad"),
    slow: of("--warn"),
    area: of("--map-area"),
    frontier: of("--map-frontier"),
  };
}
