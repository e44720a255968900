// SPDX-License-Identifier: BSD-3-Clause
// The prescription, every number of which can be altered, and pinned to have a slider.
import {h, shown, typed} from "./dom";
import {coat, commonCoating, Glass, isCoatable, Lens, Surface} from "./model";

export interface TableListener {
  changed(alter: (lens: Lens) => void, gesture: string): void;
  pinned(path: string): void;
  isPinned(path: string): boolean;
  searchGlass(text: string, show: (glasses: FoundGlass[]) => void): void;
  refused(text: string): void;
  /** What can be chosen. */
  coatings(): {name: string; title: string}[];
}

export interface FoundGlass {
  name: string;
  nd: number;
  vd: number;
  status: string;
}

export function glassText(glass: Glass | undefined): string {
  if (glass === undefined) return "";
  if (typeof glass === "string") return glass;
  if (typeof glass.index === "number") return `n ${glass.index}`;
  if (typeof glass.nd === "number") return `${glass.nd}/${glass.vd}`;
  return "table";
}

/** What was typed: a name, nd/Vd, or an index; undefined is air, null is nothing that makes sense. */
export function glassOf(text: string): Glass | undefined | null {
  const plain = text.trim();
  if (plain === "" || /^air$/i.test(plain)) return undefined;
  const pair = /^([\d.]+)\s*[/ ]\s*([\d.]+)$/.exec(plain);
  if (pair) return {nd: Number(pair[1]), vd: Number(pair[2])};
  const index = /^n?\s*(\d(\.\d*)?)$/.exec(plain);
  if (index) return {index: Number(index[1])};
  return plain === "table" ? null : plain;
}

interface Column {
  key: "radius_mm" | "thickness_mm" | "semi_diameter_mm" | "conic";
  title: string;
  term: string;
  empty: string;
}

/** A number in as many digits as a column holds, which has no room for a tenth of them more. */
function fitting(value: number): string {
  const room = 7, fewest = 3;
  let digits = room;
  while (digits > fewest && shown(value, digits).length > room) --digits;
  return shown(value, digits).replace("−", "-");
}

/** Stands for coatings that differ. */
const keptCoating = "\u0000";

const columns: Column[] = [
  {key: "radius_mm", title: "radius", term: "radius", empty: "∞"},
  {key: "thickness_mm", title: "thickness", term: "thickness", empty: ""},
  {key: "semi_diameter_mm", title: "semi-⌀\u200a", term: "semi-diameter", empty: "–"},
  {key: "conic", title: "conic", term: "conic", empty: "0"},
];

export class TableView {
  readonly element = h("div", {class: "table-box"});
  private lens: Lens | null = null;
  private list: HTMLElement | null = null;
  private selected = -1;
  private shape = "";

  constructor(private readonly listener: TableListener) {}

  show(lens: Lens): void {
    this.lens = lens;
    const shape = JSON.stringify(lens.surfaces.map(each => [each.stop ?? false, each.asphere ? Object.keys(each.asphere) : 0, each.glass === undefined, each.coating === undefined]));
    if (shape !== this.shape) {
      this.shape = shape;
      this.build();
    }
    this.refresh();
  }

  select(surface: number): void {
    this.selected = surface;
    this.element.querySelectorAll("tr[data-surface]").forEach(row =>
      row.classList.toggle("selected", Number(row.getAttribute("data-surface")) === surface));
    this.element.querySelector(`tr[data-surface="${surface}"]`)?.scrollIntoView({block: "nearest"});
  }

  /** Marks the surfaces that keep light from its way. */
  blame(surfaces: number[]): void {
    this.element.querySelectorAll("tr[data-surface]").forEach(row =>
      row.classList.toggle("blamed", surfaces.includes(Number(row.getAttribute("data-surface")))));
  }

  private build(): void {
    const head = h("tr", {}, h("th", {}, ""), ...columns.slice(0, 2).map(c => h("th", {"data-term": c.term}, c.title)),
        h("th", {"data-term": "glass", class: "left"}, "glass"), h("th", {"data-term": "coating", class: "left"}, this.coatingChoice(-1)), ...columns.slice(2).map(c => h("th", {"data-term": c.term}, c.title)), h("th", {}, ""));
    const body = h("tbody");
    this.lens!.surfaces.forEach((surface, i) => {
      body.append(this.row(surface, i));
      for (const power of Object.keys(surface.asphere ?? {})) body.append(this.asphereRow(i, power));
    });
    this.element.replaceChildren(h("table", {class: "prescription"}, h("thead", {}, head), body));
    this.select(this.selected);
  }

  private row(surface: Surface, i: number): HTMLElement {
    const row = h("tr", {"data-surface": i, class: surface.stop ? "is-stop" : ""});
    row.addEventListener("focusin", () => { if (this.selected !== i) this.select(i); });
    const mark = h("button", {class: "stop-mark", type: "button", title: surface.stop ? "the aperture stop" : "make this the aperture stop",
      "aria-label": `surface ${i}: stop`, "aria-pressed": surface.stop ? "true" : "false", onclick: () => this.makeStop(i)}, String(i));
    row.append(h("td", {class: "number"}, mark), this.cell(i, columns[0]), this.cell(i, columns[1]), this.glassCell(i),
        h("td", {}, isCoatable(this.lens!, i) || surface.coating !== undefined ? this.coatingChoice(i) : null), this.cell(i, columns[2]), this.cell(i, columns[3]), h("td", {class: "row-menu"}, this.menu(i)));
    return row;
  }

  /** Of one surface; −1: of all between air and glass at once. */
  private coatingChoice(i: number): HTMLSelectElement {
    const all = i < 0;
    const choose = (event: Event) => {
      const name = (event.target as HTMLSelectElement).value;
      delete (event.target as HTMLSelectElement).dataset.shown;
      if (name === keptCoating) return this.refresh();
      this.listener.changed(lens => lens.surfaces.forEach((_, k) => {
        if (all ? isCoatable(lens, k) : k === i) coat(lens, k, name === "" ? null : name);
      }), "");
    };
    return h("select", {class: "coating", "data-coating": all ? "all" : i, "aria-label": all ? "coating of all surfaces" : `surface ${i}, coating`,
      title: all ? "coat all surfaces at once" : null, onchange: choose});
  }

  /** As it is now, among what there is. */
  private showCoating(select: HTMLSelectElement): void {
    const lens = this.lens!, all = select.dataset.coating === "all";
    const own = all ? commonCoating(lens) : lens.surfaces[Number(select.dataset.coating)]?.coating ?? null;
    const mixed = all && own === null && lens.surfaces.some(each => each.coating !== undefined);
    const state = JSON.stringify([own, mixed, this.listener.coatings().length]);
    if (select.dataset.shown === state) return;
    select.dataset.shown = state;
    const options: [string, string, string][] = [...(mixed ? [[keptCoating, "…", ""] as [string, string, string]] : []), ["", all ? "bare" : "–", "bare glass"],
      ...this.listener.coatings().map((each): [string, string, string] => [each.name, each.name, each.title])];
    select.replaceChildren(...(all ? [h("option", {disabled: true}, "coating of all")] : []), ...options.map(([value, text, title]) => h("option", {value, title}, text)));
    select.value = mixed ? keptCoating : own ?? "";
    select.classList.toggle("is-bare", select.value === "");
    if (!all) select.title = this.listener.coatings().find(each => each.name === own)?.title ?? "bare glass";
  }

  private cell(i: number, column: Column): HTMLElement {
    return h("td", {}, this.input(`surfaces[${i}].${column.key}`, column.empty, `surface ${i}, ${column.title}`,
        column.key === "radius_mm" ? null : column.key === "thickness_mm" ? 0 : undefined));
  }

  private asphereRow(i: number, power: string): HTMLElement {
    return h("tr", {class: "asphere", "data-of": i}, h("td"), h("td", {class: "left", colspan: "2"}, h("span", {}, "r", h("sup", {}, power))),
        h("td", {colspan: "4"}, this.input(`surfaces[${i}].asphere.${power}`, "0", `surface ${i}, coefficient of r^${power}`, 0)), h("td"));
  }

  private input(path: string, empty: string, label: string, whenEmpty: number | null | undefined): HTMLElement {
    const field = h("input", {type: "text", inputmode: "decimal", "data-path": path, placeholder: empty, "aria-label": label,
      spellcheck: "false", autocomplete: "off"});
    const commit = () => {
      const text = field.value.trim();
      if (text === field.dataset.shown) return;
      const value = text === "" || text === "∞" ? whenEmpty : typed(text);
      if (typeof value === "number" && !Number.isFinite(value)) {
        this.listener.refused(`“${text}” is not a number`);
        return this.refresh();
      }
      this.alter(path, value, "");
    };
    field.addEventListener("change", commit);
    field.addEventListener("keydown", event => {
      if (event.key === "Enter") commit();
      if (event.key === "Escape") { this.refresh(true); field.select(); }
      if (event.key === "ArrowUp" || event.key === "ArrowDown") {
        event.preventDefault();
        const value = typed(field.value);
        if (!Number.isFinite(value)) return;
        const step = Math.pow(10, Math.floor(Math.log10(Math.abs(value) || 1)) - 1) * (event.shiftKey ? 0.1 : 1);
        const next = Number((value + (event.key === "ArrowUp" ? step : -step)).toPrecision(12));
        this.alter(path, next, path);
        field.value = field.dataset.shown = String(next);
      }
    });
    field.addEventListener("focus", () => { this.refresh(true); field.select(); });
    field.addEventListener("blur", () => this.refresh());
    const pin = h("button", {type: "button", class: "pin", tabindex: "-1", title: "a slider for this number", "aria-label": `pin ${label}`,
      onclick: () => { this.listener.pinned(path); this.refresh(); }}, "•");
    return h("span", {class: "cell"}, field, pin);
  }

  private alter(path: string, value: number | null | undefined, gesture: string): void {
    const key = path.slice(path.lastIndexOf(".") + 1);
    const surface = Number(/\[(\d+)\]/.exec(path)![1]);
    this.listener.changed(lens => {
      const target: any = path.includes(".asphere.") ? lens.surfaces[surface].asphere : lens.surfaces[surface];
      if (value === undefined) delete target[key];
      else target[key] = value;
    }, gesture);
  }

  private glassCell(i: number): HTMLElement {
    const field = h("input", {type: "text", "data-glass": i, placeholder: "air", "aria-label": `surface ${i}, glass`, spellcheck: "false", autocomplete: "off"});
    const commit = (text: string) => {
      const glass = glassOf(text);
      if (glass === null || text === field.dataset.shown) return;
      field.dataset.shown = text;
      this.listener.changed(lens => {
        if (glass === undefined) delete lens.surfaces[i].glass;
        else lens.surfaces[i].glass = glass;
      }, "");
    };
    field.addEventListener("input", () => this.search(field, commit));
    field.addEventListener("focus", () => field.select());
    // What was typed to search by is no glass yet while one is chosen from the list.
    field.addEventListener("change", () => setTimeout(() => { if (!this.list?.contains(document.activeElement)) commit(field.value); }));
    field.addEventListener("blur", event => { if (!this.list?.contains(event.relatedTarget as Node | null)) this.closeList(); });
    field.addEventListener("keydown", event => {
      const items = [...(this.list?.querySelectorAll("button") ?? [])] as HTMLElement[];
      if (event.key === "ArrowDown" && items[0]) { event.preventDefault(); items[0].focus(); }
      if (event.key === "Escape") this.closeList();
    });
    return h("td", {class: "glass-cell"}, field);
  }

  private search(field: HTMLInputElement, commit: (text: string) => void): void {
    if (field.value.trim().length < 2) return this.closeList();
    this.listener.searchGlass(field.value.trim(), glasses => {
      if (document.activeElement !== field) return;  // one is being chosen from the list of a shorter text, or none is wanted
      this.closeList();
      if (glasses.length === 0) return;
      const left = (event: FocusEvent) => {
        const to = event.relatedTarget as Node | null;
        if (!this.list || to === field || this.list.contains(to)) return;
        this.closeList();
        field.value = field.dataset.shown ?? "";
      };
      this.list = h("div", {class: "glass-list", role: "listbox", onfocusout: left}, ...glasses.map(glass => {
        const choose = () => { field.value = glass.name; commit(glass.name); this.closeList(); field.focus(); };
        return h("button", {type: "button", role: "option", onpointerdown: (event: Event) => { event.preventDefault(); choose(); },
          onkeydown: (event: KeyboardEvent) => {
            const at = event.currentTarget as HTMLElement;
            if (event.key === "Enter") { event.preventDefault(); choose(); }
            if (event.key === "Escape") { this.closeList(); field.focus(); }
            if (event.key === "ArrowDown") (at.nextElementSibling as HTMLElement | null)?.focus();
            if (event.key === "ArrowUp") ((at.previousElementSibling ?? field) as HTMLElement).focus();
          }},
          h("span", {}, glass.name), h("small", {}, `${glass.nd.toFixed(4)}  ${glass.vd.toFixed(1)}`));
      }));
      document.body.append(this.list);
      const place = field.getBoundingClientRect(), tall = this.list.getBoundingClientRect().height;
      this.list.style.left = `${place.left}px`;
      this.list.style.top = `${place.bottom + 2 + tall < innerHeight ? place.bottom + 2 : place.top - 2 - tall}px`;
    });
  }

  private closeList(): void {
    const list = this.list;
    this.list = null;
    list?.remove();
  }

  private makeStop(i: number): void {
    this.listener.changed(lens => lens.surfaces.forEach((each, k) => {
      if (k === i) each.stop = true;
      else delete each.stop;
    }), "");
  }

  private menu(i: number): HTMLElement {
    const button = (text: string, title: string, alter: (lens: Lens) => void) => h("button", {type: "button", title, "aria-label": `surface ${i}: ${title}`,
      onclick: () => this.listener.changed(alter, "")}, text);
    return h("span", {},
        button("+", "add a surface behind", lens => {
          const gap = lens.surfaces[i].thickness_mm;
          lens.surfaces[i].thickness_mm = gap / 2;
          lens.surfaces.splice(i + 1, 0, {radius_mm: null, thickness_mm: gap / 2});
        }),
        button("a", "add an aspheric term", lens => {
          const surface = lens.surfaces[i];
          surface.asphere ??= {};
          let power = 4;
          while (surface.asphere[String(power)] !== undefined) power += 2;
          surface.asphere[String(power)] = 0;
        }),
        button("×", "remove this surface", lens => {
          if (lens.surfaces.length < 2) return this.listener.refused("a lens has at least one surface");
          if (lens.surfaces[i].stop) return this.listener.refused("this is the stop: make another surface the stop first");
          const gap = lens.surfaces[i].thickness_mm;
          lens.surfaces.splice(i, 1);
          if (i > 0) lens.surfaces[i - 1].thickness_mm += gap;
        }));
  }

  /** Numbers and choices as they are now; a field that is being typed into stays. */
  private refresh(all = false): void {
    const lens = this.lens!;
    this.element.querySelectorAll<HTMLInputElement>("input[data-path]").forEach(field => {
      if (field === document.activeElement && !all && field.value !== field.dataset.shown) return;
      const path = field.dataset.path!;
      const [, index, rest] = /\[(\d+)\]\.(.+)/.exec(path)!;
      const surface: any = lens.surfaces[Number(index)] ?? {};
      const value = rest.startsWith("asphere.") ? surface.asphere?.[rest.slice(8)] : surface[rest];
      const text = value === null || value === undefined || (rest === "conic" && value === 0) ? ""
          : field === document.activeElement ? String(Number(value.toPrecision(12))) : fitting(value);
      field.parentElement!.classList.toggle("pinned", this.listener.isPinned(path));
      if (field.dataset.shown === text && field.value === text) return;
      field.value = field.dataset.shown = text;
      field.title = typeof value === "number" ? String(value) : "";
    });
    this.element.querySelectorAll<HTMLInputElement>("input[data-glass]").forEach(field => {
      if (field === document.activeElement && !all && field.value !== field.dataset.shown) return;
      const text = glassText(lens.surfaces[Number(field.dataset.glass)]?.glass);
      if (field.dataset.shown === text && field.value === text) return;
      field.value = field.dataset.shown = field.title = text;
    });
    this.element.querySelectorAll<HTMLSelectElement>("select.coating").forEach(select => this.showCoating(select));
  }
}
