// SPDX-License-Identifier: BSD-3-Clause
// The ghosts of a lens as a table; a click shows the way of one in the layout.
import {h, shown} from "./dom";

export interface Ghost {
  first: number;
  second: number;
  focus_mm: number | null;
  diameter_mm: number | null;
  relative_irradiance: number | null;
}

/** `chosen`: the pair whose way is shown; `choose`: null for none. */
export function ghostTable(ghosts: Ghost[], chosen: [number, number] | null, choose: (pair: [number, number] | null) => void): HTMLElement {
  const most = 60;
  const row = (ghost: Ghost) => {
    const isChosen = chosen !== null && chosen[0] === ghost.first && chosen[1] === ghost.second;
    return h("tr", {"data-ghost": `${ghost.first},${ghost.second}`, class: isChosen ? "selected" : null},
        h("td", {}, h("button", {type: "button", "aria-pressed": String(isChosen), title: isChosen ? "show the rays of the picture again" : "show its way in the layout",
          onclick: () => choose(isChosen ? null : [ghost.first, ghost.second])}, `${ghost.first} → ${ghost.second}`)),
        h("td", {}, shown(ghost.focus_mm, 3)), h("td", {}, shown(ghost.diameter_mm, 3)), h("td", {}, ghost.relative_irradiance?.toExponential(1).replace("-", "−") ?? "–"));
  };
  return h("div", {class: "ghost-box"}, h("table", {class: "ghosts"},
      h("thead", {}, h("tr", {}, h("th", {"data-term": "ghosts"}, "surfaces"), h("th", {}, "focus, mm"), h("th", {}, "diameter, mm"), h("th", {}, "of the image"))),
      h("tbody", {}, ...ghosts.slice(0, most).map(row))));
}
