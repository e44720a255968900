// SPDX-License-Identifier: BSD-3-Clause
// Another lens beside the one on the bench: the same camera before the same scene, on a bench of its own at the server.
import {h, shown} from "./dom";
import {Dropped, Incoming, Link} from "./link";
import {Lens} from "./model";
import {isFull} from "./picture_view";
import {PsfView} from "./psf_view";

export interface CompareListener {
  /** The lens of this name, as the server has it. */
  read(name: string, lens: Lens): void;
  chosen(name: string): void;
  plotted(): void;
}

export interface Compared {
  name: string;
  lens: Lens | null;  ///< null: not read yet
}

export class CompareView {
  readonly element: HTMLElement;
  plots: Incoming | null = null;
  private link: Link | null = null;
  private compared: Compared | null = null;
  private state: object | null = null;
  private cursor: [number, number] = [0, 0];
  private readonly stage = h("div", {class: "picture-stage"});
  private readonly canvas = h("canvas", {class: "picture", role: "img", "aria-label": "the picture through the other lens"});
  private readonly psf = new PsfView();
  private readonly facts = h("span");
  private readonly badge = h("span", {class: "badge"});
  private readonly problem = h("p", {class: "compare-problem", role: "status"});
  private readonly select = h("select", {"aria-label": "the lens to compare with", "data-choice": "compare",
    onchange: (event: Event) => this.listener.chosen((event.target as HTMLSelectElement).value)});
  private aspect = 1.5;

  constructor(private readonly token: string, private readonly listener: CompareListener) {
    this.stage.append(this.canvas, h("div", {class: "compare-psf"}, this.psf.element), this.problem);
    const box = h("div", {class: "picture-box"}, this.stage);
    this.element = h("div", {class: "compare"}, h("div", {class: "compare-head"}, this.select, this.facts, this.badge), box);
    this.element.hidden = true;
    new ResizeObserver(() => this.fit(box)).observe(box);
  }

  /** Shows this lens from now on; null: none. */
  open(compared: Compared | null, names: string[]): void {
    this.element.hidden = compared === null;
    if (compared?.name !== this.compared?.name) {
      this.plots = null;
      this.facts.textContent = this.badge.textContent = this.problem.textContent = "";
      this.canvas.width = this.canvas.height = 0;
    }
    const known = this.compared?.name === compared?.name && (this.compared?.lens === null) === (compared?.lens === null);
    this.compared = compared;
    if (compared === null) {
      this.link?.close();
      this.link = null;
      return;
    }
    const all = names.includes(compared.name) ? names : [compared.name, ...names];
    this.select.replaceChildren(...all.map(name => h("option", {value: name, selected: name === compared.name}, name)));
    this.link ??= new Link(this.token, {
      opened: async () => {
        for (const each of this.dropped) await this.link?.upload(each);
        this.ask();
      },
      lost: () => {},
      message: (message, bytes) => this.take(message, bytes),
    });
    if (!known) this.ask();
  }

  /** The bench's state, in which the other lens takes the place of the first. */
  show(state: {cursor_mm: [number, number]; [key: string]: unknown}): void {
    this.cursor = state.cursor_mm;
    this.state = state;
    this.ask();
  }

  /** A scene that may be chosen from now on. */
  drop(scene: Dropped): void {
    this.dropped.push(scene);
    if (this.link?.isOpen) void this.link.upload(scene).then(() => this.ask());
  }
  private readonly dropped: Dropped[] = [];

  private ask(): void {
    if (!this.link?.isOpen || !this.compared) return;
    const {name, lens} = this.compared;
    if (lens === null) this.link.send({kind: "lens", id: 1, name});
    else if (this.state) this.link.send({...this.state, lens, coatings: lens.surfaces.map(() => null)});
  }

  private take(message: Incoming, bytes: Uint8Array | null): void {
    if (!this.compared) return;
    switch (message.kind) {
      case "lens": return this.listener.read(message.name, message.lens as Lens);
      case "layout":
        this.facts.textContent = `${shown(message.first_order.efl_mm, 3)} mm f/${shown(message.first_order.f_number, 3)}`;
        this.problem.textContent = message.blocked.length ? `No ray passes: ${message.blocked[0].text}.` : "";
        return;
      case "psf": return this.psf.show(message, bytes!, this.cursor);
      case "plots":
        this.plots = message;
        return this.listener.plotted();
      case "picture": {
        this.canvas.width = message.columns;
        this.canvas.height = message.rows;
        this.canvas.getContext("2d")!.putImageData(new ImageData(new Uint8ClampedArray(bytes!), message.columns, message.rows), 0, 0);
        this.aspect = message.columns / message.rows;
        this.badge.textContent = message.quality;
        this.badge.classList.toggle("is-preview", !isFull(message));
        this.fit(this.stage.parentElement!);
        return;
      }
      case "problem":
      case "refused":
        this.problem.textContent = message.text;
        return;
      case "idle":
        this.element.dataset.idle = String(message.id);
        return;
    }
  }

  private fit(box: Element): void {
    const {width, height} = box.getBoundingClientRect();
    const wide = Math.min(width, height * this.aspect);
    this.stage.style.width = `${Math.floor(wide)}px`;
    this.stage.style.height = `${Math.floor(wide / this.aspect)}px`;
  }
}
