// SPDX-License-Identifier: BSD-3-Clause
// The lens from the side, with rays. Glass, stop and sensor can be taken by the pointer and moved.
import {becomes, h, s, shown} from "./dom";
import {Incoming} from "./link";
import {Lens} from "./model";

export interface LayoutListener {
  /** A group of surfaces [first, last] moved along the axis; last == number of surfaces: the sensor. */
  moved(first: number, last: number, shift_mm: number, done: boolean): void;
  stopRadius(radius_mm: number, done: boolean): void;
  chosen(surface: number): void;
}

/** z and y [mm] of one point after the other. */
export type Line = number[];

export class LayoutView {
  readonly element = h("div", {class: "layout-box", tabindex: "0", "aria-label": "layout of the lens"});
  private last: Incoming | null = null;
  private lens: Lens | null = null;
  private way: Line[] = [];
  private scale = 1;
  private width = 0;  // asking the element for them would lay out the whole page
  private height = 0;
  private drag: {first: number; last: number; from: number; stop: boolean} | null = null;

  constructor(private readonly listener: LayoutListener) {
    new ResizeObserver(entries => {
      [this.width, this.height] = [entries[0].contentRect.width, entries[0].contentRect.height];
      this.draw();
    }).observe(this.element);
    // Handles are brought up to date in place: what they move stands in them, not in listeners of their own.
    this.element.addEventListener("pointerdown", event => {
      const {stop, first, last} = (event.target as SVGElement).dataset;
      if (stop !== undefined) this.begin(event, Number(stop), Number(stop), true);
      if (first !== undefined) this.begin(event, Number(first), Number(last), false);
    });
  }

  show(message: Incoming, lens: Lens): void {
    this.last = message;
    this.lens = lens;
    this.element.classList.remove("stale");
    this.draw();
  }

  /** The way of a ghost in place of the rays of the picture; empty: none. */
  showWay(way: Line[]): void {
    if (way.length === 0 && this.way.length === 0) return;
    this.way = way;
    this.draw();
  }

  stale(): void { this.element.classList.add("stale"); }

  private draw(): void {
    const data = this.last;
    if (!data || this.width === 0) return;
    const {width, height} = this;
    const z1 = data.image_z as number;
    const lead = 0.22 * z1;
    let reach = data.image_height as number;
    for (const surface of data.surfaces) if (Number.isFinite(surface.height)) reach = Math.max(reach, surface.height);
    if (!(reach > 0)) reach = 1;
    const margin = 18, foot = 22;
    this.scale = Math.min((width - 2 * margin) / (z1 + lead), (height - margin - foot) / (2 * reach));
    const left = (width - this.scale * (z1 + lead)) / 2 + this.scale * lead, middle = (height - foot + margin / 2) / 2;
    const px = (z: number) => left + this.scale * z, py = (y: number) => middle - this.scale * y;
    const short = (at: number) => Math.round(100 * at) / 100;
    const path = (points: Line) => {
      let d = "";
      for (let i = 0; i < points.length; i += 2) d += `${i ? "L" : "M"}${short(px(points[i]))} ${short(py(points[i + 1]))}`;
      return d;
    };

    const outlines = (data.elements as Line[]).map(outline => path(outline) + "Z");
    const svg = s("svg", {class: "layout", viewBox: `0 0 ${width} ${height}`, width, height});
    svg.append(s("path", {class: "axis", d: `M${px(-lead)} ${middle}H${px(z1) + 10}`}));
    for (const d of outlines) svg.append(s("path", {class: "glass", d}));
    svg.append(s("path", {class: "surface", d: data.surfaces.filter((each: any) => !each.stop).map((each: any) => path(each.profile)).join("")}));
    const rays = s("g", {class: this.way.length ? "rays ghost-way" : "rays"});
    // One path for all rays of a field: the browser then has a few things to draw in the frame of a move, not dozens.
    for (const field of this.way.length ? [{rays: this.way, colour: "var(--ghost)"}] : data.fields)
      if (field.rays.length) rays.append(s("path", {class: "ray", d: (field.rays as Line[]).map(path).join(""), stroke: field.colour, "data-rays": field.rays.length}));
    svg.append(rays);
    const tall = Math.max(data.image_height, reach * 0.2) * 1.04;
    svg.append(s("path", {class: "sensor", d: `M${px(z1)} ${py(tall)}V${py(-tall)}`}));
    this.addHandles(svg, outlines, px(data.image_z), py(tall), py(-tall));
    // Above the glass, which may be where its edges are.
    data.surfaces.forEach((surface: any, i: number) => {
      if (surface.stop) svg.append(this.stopMark(px(surface.z), py, data.first_order.stop_semi_diameter_mm ?? surface.height, reach, i));
    });
    for (const {surface} of data.blocked) {
      const at = data.surfaces[surface];
      if (at) svg.append(s("path", {class: "blocked", d: path(at.profile)}));
    }
    svg.append(this.ruler(width, height));
    const legend = this.legend(data), [oldSvg, oldLegend] = this.element.children;
    if (!oldSvg) return this.element.append(svg, legend);
    becomes(oldSvg, svg);
    becomes(oldLegend, legend);
  }

  private stopMark(x: number, py: (y: number) => number, radius: number, reach: number, surface: number): SVGGElement {
    const far = Math.min(reach, radius + reach * 0.28);
    const d = `M${x} ${py(far)}V${py(radius)}M${x - 4} ${py(radius)}h8M${x} ${py(-far)}V${py(-radius)}M${x - 4} ${py(-radius)}h8`;
    const group = s("g", {}, s("path", {class: "stop", d}));
    for (const side of [1, -1]) {
      group.append(s("rect", {class: "handle vertical", x: x - 8, y: py(side * radius) - 8, width: 16, height: 16, "data-stop": surface},
          s("title", {}, `stop, surface ${surface}: drag to open or close`)));
    }
    return group;
  }

  /** Elements that touch are cemented and move together. */
  private addHandles(svg: SVGSVGElement, outlines: string[], sensor: number, top: number, bottom: number): void {
    const surfaces = this.lens!.surfaces;
    let element = 0;
    for (let first = 0; first < surfaces.length; ++first) {
      if (!surfaces[first].glass) continue;
      let last = first;
      while (last < surfaces.length && surfaces[last].glass) ++last;
      for (let i = first; i < last; ++i)
        svg.append(s("path", {class: "handle", d: outlines[element++] ?? "", "data-first": first, "data-last": last},
            s("title", {}, `surfaces ${first} to ${last}: drag along the axis`)));
      first = last;
    }
    const end = surfaces.length;
    svg.append(s("rect", {class: "handle", x: sensor - 7, y: top, width: 14, height: bottom - top, "data-first": end, "data-last": end},
        s("title", {}, "sensor: drag along the axis")));
  }

  private begin(event: PointerEvent, first: number, last: number, stop: boolean): void {
    event.preventDefault();
    this.listener.chosen(first);
    const start = stop ? event.clientY : event.clientX;
    this.drag = {first, last, from: start, stop};
    // The drawing is made anew while it moves: the window listens.
    const move = (next: PointerEvent) => this.follow(next, false);
    const end = (next: PointerEvent) => {
      this.follow(next, true);
      this.drag = null;
      removeEventListener("pointermove", move);
      removeEventListener("pointerup", end);
      removeEventListener("pointercancel", end);
    };
    addEventListener("pointermove", move);
    addEventListener("pointerup", end);
    addEventListener("pointercancel", end);
  }

  private follow(event: PointerEvent, done: boolean): void {
    const drag = this.drag;
    if (!drag) return;
    if (drag.stop) {
      const box = this.element.getBoundingClientRect();
      const middle = (this.height - 22 + 9) / 2;
      return this.listener.stopRadius(Math.max(0.02, Math.abs(event.clientY - box.top - middle) / this.scale), done);
    }
    const shift = (event.clientX - drag.from) / this.scale;
    drag.from = event.clientX;
    this.listener.moved(drag.first, drag.last, shift, done);
  }

  private ruler(width: number, height: number): SVGGElement {
    const wanted = width / 6 / this.scale, power = Math.pow(10, Math.floor(Math.log10(wanted)));
    const length = [5, 2, 1].map(f => f * power).find(f => f <= wanted) ?? power;
    const x = width - 16 - length * this.scale, y = height - 10;
    return s("g", {class: "ruler"}, s("path", {d: `M${x} ${y - 4}v4h${length * this.scale}v-4`}),
        s("text", {x: x + length * this.scale / 2, y: y - 5, "text-anchor": "middle"}, `${shown(length)} mm`));
  }

  private legend(data: Incoming): HTMLElement {
    return h("div", {class: "legend over"}, ...data.fields.map((field: any) => h("span", {},
        s("svg", {viewBox: "0 0 14 8", width: 14, height: 8}, s("path", {d: "M1 4h12", stroke: field.colour, "stroke-width": 2.4})),
        `${shown(field.value)}${field.unit === "deg" ? "°" : ` ${field.unit}`}${field.rays.length === 0 ? " no ray" : ""}`)));
  }
}
