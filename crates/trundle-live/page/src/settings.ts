// The settings that may change while the robot runs: text, range, present value.

import { element } from "./panel";
import type { Setting } from "./wire";

export class Settings {
  constructor(private readonly ask: (request: object) => Promise<string | undefined>) {}

  show(settings: Setting[]): void {
    element("settings").replaceChildren(...settings.map((setting) => this.line(setting)));
  }

  private line(setting: Setting): HTMLElement {
    const form = document.createElement("form");
    const label = document.createElement("label");
    label.textContent = setting.text.split(/(?<=[.])\s/)[0] ?? setting.key;
    label.title = setting.text;
    const input = document.createElement("input");
    input.inputMode = "decimal";
    input.value = String(Number(setting.value.toFixed(4)));
    input.dataset["setting"] = setting.key;
    input.setAttribute("aria-label", setting.key);
    const range = document.createElement("small");
    range.textContent = `${setting.key}: ${setting.min} to ${setting.max} ${setting.unit}`;
    const button = document.createElement("button");
    button.textContent = "Set";
    button.className = "steers";
    const problem = document.createElement("p");
    problem.className = "problem";
    problem.setAttribute("role", "alert");
    problem.hidden = true;
    form.append(label, input, button, range, problem);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const value = Number(input.value.trim().replace(",", "."));
      const isNumber = input.value.trim() !== "" && Number.isFinite(value);
      const asked = isNumber ? this.ask({ type: "change", key: setting.key, value }) : Promise.resolve("Not a number.");
      void asked.then((refusal) => {
        problem.textContent = refusal ?? "";
        problem.hidden = !refusal;
      });
    });
    return form;
  }
}
