// SPDX-License-Identifier: BSD-3-Clause
// Plots as the server gives their numbers.
import {h, s, shown} from "./dom";

interface Axis {label: string; unit: string; log: boolean; from: number | null; to: number | null}
interface Series {label: string; x: (number | null)[]; y: (number | null)[]; stroke: number; marker: number; colour: string}
export interface PlotData {
  title: string;
  x: Axis;
  y: Axis;
  series: Series[];
  guides: {x: boolean; value: number; label: string}[];
  equal: boolean;
}

/** 1, 2 or 5 times a power of ten. */
function niceStep(range: number, wanted: number): number {
  const raw = range / wanted, power = Math.pow(10, Math.floor(Math.log10(raw)));
  for (const factor of [1, 2, 5]) if (raw <= factor * power) return factor * power;
  return 10 * power;
}

function rangeOf(axis: Axis, values: number[]): [number, number] {
  let from = axis.from ?? Math.min(...values), to = axis.to ?? Math.max(...values);
  if (!Number.isFinite(from) || !Number.isFinite(to)) [from, to] = [0, 1];
  if (from === to) [from, to] = [from - Math.abs(from) * 0.05 - 0.5, to + Math.abs(to) * 0.05 + 0.5];
  const room = (to - from) * 0.04;
  return [axis.from === null ? from - room : from, axis.to === null ? to + room : to];
}

function ticksOf(from: number, to: number, wanted: number): number[] {
  const step = niceStep(to - from, wanted), list: number[] = [];
  for (let k = Math.ceil(from / step - 1e-9); k * step <= to + step * 1e-9; ++k) list.push(k * step);
  return list;
}

function finite(values: (number | null)[]): number[] {
  return values.filter((v): v is number => v !== null);
}

/** Points joined; a gap where there is none. */
function pathOf(line: Series, px: (v: number) => number, py: (v: number) => number): string {
  let path = "", broken = true;
  for (let i = 0; i < line.x.length; ++i) {
    const x = line.x[i], y = line.y[i];
    if (x === null || y === null) { broken = true; continue; }
    path += `${broken ? "M" : "L"}${px(x).toFixed(1)} ${py(y).toFixed(1)}`;
    broken = false;
  }
  return path;
}

const dashes = ["", "", "6 4", "2 3"];

/** One plot in so many pixels. */
export function drawPlot(plot: PlotData, width: number, height: number, small = false): SVGSVGElement {
  const left = small ? 30 : 46, right = 10, top = small ? 18 : 10, bottom = small ? 20 : 34;
  let [x0, x1] = rangeOf(plot.x, plot.series.flatMap(each => finite(each.x)));
  let [y0, y1] = rangeOf(plot.y, plot.series.flatMap(each => finite(each.y)));
  const w = Math.max(10, width - left - right), t = Math.max(10, height - top - bottom);
  if (plot.equal) {
    const scale = Math.max((x1 - x0) / w, (y1 - y0) / t);
    const xm = (x0 + x1) / 2, ym = (y0 + y1) / 2;
    [x0, x1, y0, y1] = [xm - scale * w / 2, xm + scale * w / 2, ym - scale * t / 2, ym + scale * t / 2];
  }
  const px = (v: number) => left + (v - x0) / (x1 - x0) * w, py = (v: number) => top + (y1 - v) / (y1 - y0) * t;
  const svg = s("svg", {class: "plot", viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": plot.title});
  for (const v of ticksOf(x0, x1, small ? 2 : w / 70)) {
    svg.append(s("path", {class: "grid", d: `M${px(v)} ${top}v${t}`}),
        s("text", {x: px(v), y: top + t + 13, "text-anchor": "middle"}, shown(v, 6)));
  }
  for (const v of ticksOf(y0, y1, small ? 2 : t / 40)) {
    svg.append(s("path", {class: "grid", d: `M${left} ${py(v)}h${w}`}),
        s("text", {x: left - 5, y: py(v) + 3.5, "text-anchor": "end"}, shown(v, 6)));
  }
  if (x0 < 0 && x1 > 0) svg.append(s("path", {class: "zero", d: `M${px(0)} ${top}v${t}`}));
  if (y0 < 0 && y1 > 0) svg.append(s("path", {class: "zero", d: `M${left} ${py(0)}h${w}`}));
  const clip = `clip-${Math.random().toString(36).slice(2)}`;
  svg.append(s("clipPath", {id: clip}, s("rect", {x: left, y: top - 2, width: w, height: t + 4})));
  const lines = s("g", {"clip-path": `url(#${clip})`});
  for (const line of plot.series) {
    const colour = line.colour || "currentColor";
    if (line.stroke > 0)
      lines.append(s("path", {class: "line", d: pathOf(line, px, py), stroke: colour, "stroke-dasharray": dashes[line.stroke]}));
    if (line.marker > 0 && line.x.length < 1500) {
      const size = line.stroke > 0 ? 2.2 : small ? 1 : 1.4;
      let d = "";
      for (let i = 0; i < line.x.length; ++i) {
        const x = line.x[i], y = line.y[i];
        if (x !== null && y !== null) d += `M${(px(x) - size).toFixed(1)} ${py(y).toFixed(1)}h${2 * size}`;
      }
      lines.append(s("path", {d, stroke: colour, "stroke-width": 2 * size, "stroke-linecap": "butt", fill: "none"}));
    }
  }
  svg.append(lines, s("rect", {class: "frame", x: left, y: top, width: w, height: t}));
  if (small) {
    svg.append(s("text", {x: left, y: 12, class: "small-title"}, plot.title));
  } else {
    const unit = (axis: Axis) => axis.unit ? `${axis.label} (${axis.unit})` : axis.label;
    svg.append(s("text", {x: left + w / 2, y: height - 4, "text-anchor": "middle", class: "label"}, unit(plot.x)),
        s("text", {transform: `translate(10 ${top + t / 2}) rotate(-90)`, "text-anchor": "middle", class: "label"}, unit(plot.y)));
  }
  return svg;
}

/** Lines of the legend that say something. */
function legendOf(plot: PlotData): HTMLElement | null {
  const named = plot.series.filter(each => each.label);
  if (named.length < 2 || named.length > 16) return null;
  return h("div", {class: "legend"}, ...named.map(each => {
    const sample = s("svg", {viewBox: "0 0 22 8", width: 22, height: 8},
        s("path", {d: "M1 4h20", stroke: each.colour || "currentColor", "stroke-width": 2, "stroke-dasharray": dashes[each.stroke] || null}));
    return h("span", {}, sample, each.label);
  }));
}

/** All plots of an analysis in the width of their box. */
export function drawPlots(box: HTMLElement, plots: PlotData[], across: number): void {
  const width = Math.max(200, box.clientWidth), height = Math.max(140, box.clientHeight);
  const grid = h("div", {class: "plots"});
  if (plots.length === 1) {
    const legend = legendOf(plots[0]);
    if (legend) grid.append(legend);
    box.replaceChildren(grid);
    grid.prepend(drawPlot(plots[0], width, Math.max(120, height - (legend ? legend.offsetHeight + 4 : 0))));
    return;
  }
  const columns = Math.min(across > 1 ? across : 2, Math.max(1, Math.floor(width / 105)));
  const cell = Math.floor(width / columns) - 4;
  grid.classList.add("many");
  for (const plot of plots) grid.append(drawPlot(plot, cell, Math.max(80, Math.min(cell, 150)), true));
  box.replaceChildren(grid);
}
