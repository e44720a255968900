// SPDX-License-Identifier: BSD-3-Clause
// The image of a point, in colour, on a scale that shows its wings.
import {h, shown} from "./dom";
import {Incoming} from "./link";

export class PsfView {
  readonly element: HTMLElement;
  private readonly canvas = h("canvas", {width: 96, height: 96, class: "psf-canvas", role: "img", "aria-label": "point-spread function"});
  private readonly facts = h("div", {class: "psf-facts"});

  constructor() {
    this.element = h("div", {class: "psf"}, h("div", {class: "psf-frame"}, this.canvas), this.facts);
  }

  show(message: Incoming, bytes: Uint8Array, cursor: [number, number]): void {
    const size = message.size as number;
    const values = new Float32Array(bytes.slice().buffer);
    let most = 0;
    for (const value of values) if (value > most) most = value;
    this.canvas.width = this.canvas.height = size;
    const context = this.canvas.getContext("2d")!;
    const image = context.createImageData(size, size);
    for (let i = 0; i < size * size; ++i) {
      for (let c = 0; c < 3; ++c)
        image.data[4 * i + c] = 255 * Math.pow(Math.max(0, values[3 * i + c]) / (most || 1), 0.4);
      image.data[4 * i + 3] = 255;
    }
    context.putImageData(image, 0, 0);
    // Rows run away from the axis: turned as it lies in the picture.
    const outwards = Math.hypot(...cursor) > 0 ? Math.atan2(cursor[0], cursor[1]) : 0;
    this.canvas.style.transform = `rotate(${outwards}rad)`;
    this.facts.replaceChildren(
        h("div", {}, h("b", {}, shown(size * message.spacing_um, 3)), " µm wide"),
        h("div", {}, h("b", {}, shown(message.height_mm, 3)), " mm from the axis"),
        h("div", {}, h("b", {}, shown(100 * message.captured, 3)), " % of its light in the window"));
    this.element.classList.remove("stale");
  }

  stale(): void { this.element.classList.add("stale"); }
}
