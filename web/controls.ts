// SPDX-License-Identifier: BSD-3-Clause
// Sliders with a number beside them.
import {h, shown, typed} from "./dom";

export interface SliderWish {
  label: string;
  term?: string;
  unit?: string;
  from: number;
  to: number;
  log?: boolean;
  /** What stands at the right end, beyond all numbers: "∞". */
  end?: string;
  value: number | null;
  /** What a double click and the dot go back to. */
  usual: number | null;
  digits?: number;
  name: string;
  /** null: the end. */
  changed(value: number | null, done: boolean): void;
  unpin?(): void;
  ranged?(from: number, to: number): void;
}

const steps = 1000;

/** One slider in a row: its name, its range, its number. */
export class Slider {
  readonly element: HTMLElement;
  private readonly range: HTMLInputElement;
  private readonly number: HTMLInputElement;

  constructor(private readonly wish: SliderWish) {
    this.range = h("input", {type: "range", min: 0, max: steps, step: 1, "aria-label": wish.label, "data-slider": wish.name});
    this.number = h("input", {type: "text", inputmode: "decimal", class: "slider-number", "aria-label": `${wish.label}, number`, "data-number": wish.name, autocomplete: "off"});
    const name = h("label", {class: "slider-label", "data-term": wish.term}, wish.label);
    const reset = h("button", {type: "button", class: "reset", title: "back to where it was", "aria-label": `${wish.label}: back`,
      onclick: () => { this.show(wish.usual); wish.changed(wish.usual, true); }}, "↺");
    this.element = h("div", {class: "slider"}, name, this.range, this.number, h("span", {class: "unit"}, wish.unit ?? ""), reset);
    if (wish.unpin) this.element.append(h("button", {type: "button", class: "unpin", title: "no slider for this", "aria-label": `${wish.label}: no slider`, onclick: wish.unpin}, "×"));
    if (wish.ranged) {
      name.title = `${shown(wish.from)} to ${shown(wish.to)}; double-click for another range`;
      name.addEventListener("dblclick", () => {
        const text = prompt("Range of the slider: from, to", `${wish.from}, ${wish.to}`);
        const [from, to] = (text ?? "").split(/[ ,;]+/).map(typed);
        if (Number.isFinite(from) && Number.isFinite(to) && from < to) wish.ranged!(from, to);
      });
    }
    this.range.addEventListener("input", () => {
      wish.changed(this.valueOf(Number(this.range.value)), false);  // whoever is told shows the number
    });
    this.range.addEventListener("change", () => wish.changed(this.valueOf(Number(this.range.value)), true));
    this.range.addEventListener("dblclick", () => { this.show(wish.usual); wish.changed(wish.usual, true); });
    const commit = () => {
      const text = this.number.value.trim();
      if (text === this.number.dataset.shown) return;
      const value = wish.end && (text === wish.end || /^inf/i.test(text)) ? null : typed(text);
      if (value !== null && !Number.isFinite(value)) return this.show(wish.value);
      this.show(value);
      wish.changed(value, true);
    };
    this.number.addEventListener("change", commit);
    this.number.addEventListener("focus", () => this.number.select());
    this.show(wish.value);
  }

  show(value: number | null): void {
    this.wish.value = value;
    if (document.activeElement !== this.range || Number(this.range.value) !== this.stepOf(value)) this.range.value = String(this.stepOf(value));
    this.range.style.setProperty("--share", `${this.stepOf(value) / steps * 100}%`);
    this.showNumber(value);
  }

  private showNumber(value: number | null): void {
    this.range.style.setProperty("--share", `${this.stepOf(value) / steps * 100}%`);
    const text = value === null ? this.wish.end ?? "" : shown(value, this.wish.digits ?? 4).replace("−", "-");
    if (document.activeElement !== this.number) this.number.value = text;
    this.number.dataset.shown = text;
    this.element.classList.toggle("changed", value !== this.wish.usual);
  }

  private stepOf(value: number | null): number {
    const {from, to, log, end} = this.wish;
    if (value === null) return end ? steps : 0;
    const share = log ? Math.log(Math.max(value, 1e-12) / from) / Math.log(to / from) : (value - from) / (to - from);
    return Math.round(Math.min(1, Math.max(0, share)) * (end ? steps - 20 : steps));
  }

  private valueOf(step: number): number | null {
    const {from, to, log, end} = this.wish;
    if (end && step > steps - 20) return null;
    const share = step / (end ? steps - 20 : steps);
    const value = log ? from * Math.pow(to / from, share) : from + (to - from) * share;
    return Number(value.toPrecision(log ? 3 : 5));
  }
}

/** A choice among names, with its label. */
export function choice(label: string, name: string, options: [string, string][], value: string, changed: (value: string) => void, term?: string): HTMLElement {
  const select = h("select", {"aria-label": label, "data-choice": name, onchange: (event: Event) => changed((event.target as HTMLSelectElement).value)},
      ...options.map(([key, text]) => h("option", {value: key, selected: key === value}, text)));
  return h("label", {class: "choice", "data-term": term}, h("span", {}, label), select);
}
