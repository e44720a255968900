// SPDX-License-Identifier: BSD-3-Clause
// The image of a point, in colour, on a scale that shows its wings.
import {h, shown} from "./dom";
import {Incoming} from "./link";

export class PsfView {
  readonly element: HTMLElement;
  readonly canvas = h("canvas", {width: 96, height: 96, class: "psf-canvas", role: "img", "aria-label": "point-spread function"});
  readonly facts = h("div", {class: "psf-facts"});

  constructor() {
    this.element = h("div", {class: "psf"}, h("div", {class: "psf-frame"}, this.canvas), this.facts);
  }

  show(message: Incoming, bytes: Uint8Array, cursor: [number, number]): void {
    const size = message.size as number;
    const values = new Float32Array(bytes.slice().buffer);
    let most = 0;
    for (const value of values) if (value > most) most = value;
    // The part about the middle that holds most of the light, and some dark about it.
    const half = this.reach(values, size), edge = Math.floor(size / 2) - half, side = Math.min(size - edge, 2 * half + 1);
    this.canvas.width = this.canvas.height = side;
    const context = this.canvas.getContext("2d")!;
    const image = context.createImageData(side, side);
    for (let row = 0; row < side; ++row)
      for (let column = 0; column < side; ++column) {
        const from = 3 * ((row + edge) * size + column + edge), to = 4 * (row * side + column);
        for (let c = 0; c < 3; ++c) image.data[to + c] = 255 * Math.pow(Math.max(0, values[from + c]) / (most || 1), 0.4);
        image.data[to + 3] = 255;
      }
    context.putImageData(image, 0, 0);
    // Rows run away from the axis: turned as it lies in the picture.
    const outwards = Math.hypot(...cursor) > 0 ? Math.atan2(cursor[0], cursor[1]) : 0;
    this.canvas.style.transform = `rotate(${outwards}rad)`;
    this.facts.replaceChildren(
        h("div", {}, h("b", {}, shown(side * message.spacing_um, 3)), " µm wide"),
        h("div", {}, h("b", {}, shown(message.height_mm, 3)), " mm from the axis"),
        h("div", {}, h("b", {}, shown(100 * message.captured, 3)), " % of its light in the window"));
    this.element.classList.remove("stale");
  }

  /** Cells from the middle to where nine tenths of the light lie within a square, and a half more. */
  private reach(values: Float32Array, size: number): number {
    const middle = Math.floor(size / 2), rings = new Float64Array(size + 1);
    let all = 0;
    for (let row = 0; row < size; ++row)
      for (let column = 0; column < size; ++column) {
        const at = 3 * (row * size + column), light = values[at] + values[at + 1] + values[at + 2];
        rings[Math.max(Math.abs(row - middle), Math.abs(column - middle))] += light;
        all += light;
      }
    let inside = 0, half = 0;
    while (half < middle && (inside += rings[half]) < 0.9 * all) ++half;
    return Math.min(middle, Math.max(6, Math.ceil(1.5 * half)));
  }

  stale(): void { this.element.classList.add("stale"); }
}
