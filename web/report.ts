// SPDX-License-Identifier: BSD-3-Clause
// What is on the bench as one page to keep: it needs nothing else, and no script.
import {h, shown} from "./dom";
import {Incoming} from "./link";
import {Lens, Surface} from "./model";
import {drawPlots, PlotData} from "./plot_view";

export interface ReportParts {
  title: string;
  command: string;
  lens: Lens;
  facts: HTMLElement;
  layout: SVGSVGElement;
  picture: HTMLCanvasElement;
  pictureCaption: string;
  psf: HTMLCanvasElement;
  psfCaption: string;
  plots: [string, Incoming][];  ///< titles, and what the server gave
}

const style = `body { display: block; height: auto; max-width: 1080px; margin: 0 auto; padding: 28px; overflow: visible; background: #fff; }
html { height: auto; } h1 { font-size: 22px; margin: 0 0 4px; } h2 { font-size: 15px; margin: 26px 0 8px; break-after: avoid; }
.facts { display: flex; flex-wrap: wrap; justify-content: flex-start; gap: 4px 18px; } figure { margin: 0; break-inside: avoid; } figcaption { color: #586576; font-size: 12px; margin-top: 4px; }
.pair { display: flex; gap: 20px; align-items: flex-start; } .pair img { max-width: 100%; border-radius: 6px; display: block; } .pair figure:first-child { flex: 3; } .pair figure:last-child { flex: 1; }
.pair img { width: 100%; } table.report { border-collapse: collapse; width: 100%; font-size: 12px; } .report th, .report td { padding: 3px 10px; border-bottom: 1px solid #dde3ea; text-align: right; }
.report th:nth-child(4), .report td:nth-child(4) { text-align: left; } code { font-size: 11px; overflow-wrap: anywhere; } .report-plots { display: grid; grid-template-columns: 1fr 1fr; gap: 12px 24px; }
.report-plots .plots { display: block; overflow: visible; } svg { max-width: 100%; height: auto; }`;

function glassText(surface: Surface): string {
  if (surface.mirror) return "mirror";
  return surface.glass === undefined ? "" : typeof surface.glass === "string" ? surface.glass : JSON.stringify(surface.glass);
}

function prescription(lens: Lens): HTMLElement {
  const number = (value: number | null | undefined) => value === undefined ? "" : value === null ? "∞" : shown(value, 7);
  const row = (surface: Surface, i: number) => h("tr", {}, ...[`${i}${surface.stop ? " stop" : ""}`, number(surface.radius_mm), number(surface.thickness_mm), glassText(surface),
    number(surface.semi_diameter_mm), number(surface.conic), surface.asphere ? Object.entries(surface.asphere).map(([k, v]) => `${k} ${v}`).join(", ") : "",
    typeof surface.coating === "string" ? surface.coating : surface.coating ? "own" : ""].map(text => h("td", {}, text)));
  return h("table", {class: "report"}, h("thead", {}, h("tr", {}, ...["surface", "radius, mm", "thickness, mm", "glass", "semi-diameter, mm", "conic", "asphere", "coating"].map(text => h("th", {}, text)))),
      h("tbody", {}, ...lens.surfaces.map(row)));
}

function canvasFigure(canvas: HTMLCanvasElement, caption: string): HTMLElement {
  return h("figure", {}, h("img", {src: canvas.toDataURL("image/png"), alt: caption}), h("figcaption", {}, caption));
}

export function reportOf(parts: ReportParts): Blob {
  // Plots are drawn as wide as their box, which is nowhere to be seen.
  const workshop = h("div", {class: "workshop"}), width = 500, height = 300;
  workshop.style.cssText = `position: fixed; left: -9999px; top: 0; width: ${width}px`;
  document.body.append(workshop);
  const plots = parts.plots.map(([title, plot]) => {
    const box = h("div");
    box.style.cssText = `width: ${width}px; height: ${height}px`;
    workshop.append(box);
    drawPlots(box, plot.plots as PlotData[], plot.across);
    box.removeAttribute("style");
    return h("figure", {}, h("h2", {}, title), box);
  });
  workshop.remove();
  const body = h("body", {}, h("h1", {}, parts.title), parts.facts.cloneNode(true), h("h2", {}, "Layout"), parts.layout.cloneNode(true), h("h2", {}, "Picture and point spread"),
      h("div", {class: "pair"}, canvasFigure(parts.picture, parts.pictureCaption), canvasFigure(parts.psf, parts.psfCaption)), h("h2", {}, "Prescription"), prescription(parts.lens),
      h("div", {class: "report-plots"}, ...plots), h("h2", {}, "The same picture"), h("code", {}, parts.command));
  const rules = [...document.styleSheets].flatMap(sheet => [...sheet.cssRules].map(rule => rule.cssText)).join("\n");
  const title = h("title", {}, parts.title);
  return new Blob([`<!doctype html>\n<html lang="en" data-theme="light"><head><meta charset="utf-8">${title.outerHTML}<style>${rules}\n${style}</style></head>${body.outerHTML}</html>\n`], {type: "text/html"});
}
