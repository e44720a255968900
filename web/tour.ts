// SPDX-License-Identifier: BSD-3-Clause
// Five exercises for a lesson: a lens, a thing to do, a thing to see.
import {h} from "./dom";

export const exercises: {title: string; lens: string; plot: string; scene?: string; steps: string[]; question: string}[] = [
  {title: "Defocus", lens: "dgauss-50mm", plot: "spots", scene: "studio",
    steps: ["Move “sensor shift” slowly to one side, then to the other.", "Close the stop to f/8 and do it again.", "Watch the point spread and the fine bars of the picture."],
    question: "By how much may the sensor be off before you see it, at f/2 and at f/8?"},
  {title: "Coma", lens: "coma-singlet", plot: "spots", scene: "points",
    steps: ["Click on a point near the corner of the picture.", "Look at the shape of the point spread, and which way its tail lies.", "Click on the middle, then on the opposite corner."],
    question: "How does the length of the tail grow with the distance from the axis?"},
  {title: "Field curvature", lens: "petzval-lens", plot: "field-curvature", scene: "grid",
    steps: ["Keep the picture by “Before / after”.", "Move the sensor a little towards the lens.", "Compare the middle and the corners with the divider."],
    question: "Can one place of the sensor make both sharp? What would the sensor have to look like?"},
  {title: "Vignetting", lens: "double-gauss", plot: "illumination", scene: "wall",
    steps: ["Make the semi-diameters of the first surfaces smaller in the table.", "Watch which rays are lost in the layout.", "Then close the stop."],
    question: "Why does vignetting go when the stop is closed, but the cosine law stays?"},
  {title: "Colour", lens: "plano-convex", plot: "colour", scene: "slanted-edge",
    steps: ["Look at the colours of the point spread.", "Shift the sensor and watch them change.", "Choose the lens “achromat-50mm” and compare."],
    question: "Which colour is in focus nearest to the lens, and why?"},
];

/** The strip of the tour below the views, none of which it covers; an exercise at a time. */
export class Tour {
  private card: HTMLElement | null = null;
  private at = 0;

  constructor(private readonly start: (exercise: (typeof exercises)[number]) => void) {}

  toggle(): void {
    if (this.card) {
      this.card.remove();
      this.card = null;
      return;
    }
    this.card = h("aside", {class: "tour", "aria-label": "exercises"});
    document.querySelector("body > footer")!.before(this.card);
    this.show(this.at);
  }

  private show(at: number): void {
    this.at = (at + exercises.length) % exercises.length;
    const exercise = exercises[this.at];
    this.start(exercise);
    this.card?.replaceChildren(
        h("header", {}, h("small", {}, `Exercise ${this.at + 1} of ${exercises.length}`), h("h3", {}, exercise.title)),
        h("ol", {}, ...exercise.steps.map(step => h("li", {}, step))), h("p", {}, exercise.question),
        h("div", {class: "steps"}, h("button", {type: "button", class: "text-button", id: "tour-back", onclick: () => this.show(this.at - 1)}, "Back"),
            h("button", {type: "button", class: "text-button primary", id: "tour-next", onclick: () => this.show(this.at + 1)}, "Next"),
            h("button", {type: "button", class: "icon-button", "aria-label": "close the tour", onclick: () => this.toggle()}, "×")));
  }
}
