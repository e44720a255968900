// SPDX-License-Identifier: BSD-3-Clause
// The picture, what it was before, and the place that the PSF is asked at.
import {h, shown} from "./dom";
import {Incoming} from "./link";

export interface PictureListener {
  placed(x_mm: number, y_mm: number, done: boolean): void;
  sunMoved(sun: number, x_mm: number, y_mm: number, done: boolean): void;
  focused(x_mm: number, y_mm: number): void;
}

/** Whether it is as good as files of it are to be. */
export function isFull(message: Incoming): boolean { return message.quality === "full" || message.quality === "finest"; }

/** "31 bands, 1500 × 1000 of 6000 × 4000 pixels" */
function detailOf(message: Incoming): string {
  const [columns, rows] = message.whole as [number, number], part = message.pixels_added > 1 ? ` of ${columns} × ${rows}` : "";
  return `${message.bands} band${message.bands === 1 ? "" : "s"}, ${message.columns} × ${message.rows}${part}`;
}

interface Kept {
  canvas: HTMLCanvasElement;
  caption: string;
}

export class PictureView {
  readonly element: HTMLElement;
  readonly badge = h("span", {class: "badge", "data-term": "preview"});
  /** Of how many bands and pixels, and of how many the sensor has. */
  readonly detail = h("small", {class: "hint detail"});
  private readonly stage = h("div", {class: "picture-stage"});
  private readonly now = h("canvas", {class: "picture", role: "img", "aria-label": "the picture"});
  private readonly mark = h("div", {class: "cursor-mark"});
  private readonly sources = h("div", {class: "sources"});
  private readonly suns: HTMLButtonElement[] = [];
  private sunPlaces: ([number, number] | null)[] = [];
  private readonly divider = h("div", {class: "divider", role: "slider", tabindex: "0", "aria-label": "before and after",
    "aria-valuemin": "0", "aria-valuemax": "100"});
  private readonly captions = h("div", {class: "captions"});
  private kept: Kept | null = null;
  private split = 0.5;
  private frame_mm: [number, number] = [36, 24];
  private box = {width: 0, height: 0};
  private cursor: [number, number] = [0, 0];

  constructor(private readonly listener: PictureListener) {
    this.stage.append(this.now, this.sources, this.mark, this.divider, this.captions);
    this.element = h("div", {class: "picture-box", tabindex: "0", "aria-label": "picture; arrow keys move the place of the point-spread function"}, this.stage);
    this.divider.hidden = true;
    new ResizeObserver(entries => {
      this.box = entries[0].contentRect;
      this.fit();
    }).observe(this.element);
    this.stage.addEventListener("pointerdown", event => this.down(event));
    this.stage.addEventListener("dblclick", () => this.listener.focused(...this.cursor));
    this.divider.addEventListener("pointerdown", event => this.dragDivider(event));
    this.divider.addEventListener("keydown", event => {
      const step = event.key === "ArrowLeft" ? -0.02 : event.key === "ArrowRight" ? 0.02 : 0;
      if (!step) return;
      event.preventDefault();
      event.stopPropagation();
      this.setSplit(this.split + step);
    });
    this.element.addEventListener("keydown", event => this.key(event));
  }

  show(message: Incoming, pixels: Uint8Array): void {
    const {columns, rows} = message as unknown as {columns: number; rows: number};
    this.now.width = columns;
    this.now.height = rows;
    this.now.getContext("2d")!.putImageData(new ImageData(new Uint8ClampedArray(pixels), columns, rows), 0, 0);
    this.frame_mm = [columns * message.pitch_um / 1000, rows * message.pitch_um / 1000];
    this.badge.textContent = message.quality === "refining" ? `${message.samples} of ${message.samples_wanted} rays` : message.quality;
    this.badge.classList.toggle("is-preview", !isFull(message));
    this.detail.textContent = detailOf(message);
    this.sources.replaceChildren(...message.sources.map((source: {name: string; x_mm: number; y_mm: number}) => {
      const mark = h("div", {class: "source-mark", title: source.name});
      mark.style.left = `${50 + 100 * source.x_mm / this.frame_mm[0]}%`;
      mark.style.top = `${50 - 100 * source.y_mm / this.frame_mm[1]}%`;
      return mark;
    }));
    this.badge.title = `${columns} × ${rows} pixels, ${message.bands} bands, ${message.samples ? `${message.samples} rays a pixel` : `estimated error ${shown(100 * message.estimated_error, 2)} %`}`;
    this.element.dataset.quality = message.quality;
    this.element.classList.remove("stale");
    this.fit();
  }

  get canvas(): HTMLCanvasElement { return this.now; }
  get caption(): string { return `${this.badge.textContent}`; }

  stale(): void { this.element.classList.add("stale"); }

  /** Keeps the picture as it is, to be compared with what follows; or lets the kept one go. */
  toggleBefore(caption: string): boolean {
    if (this.kept) {
      this.kept.canvas.remove();
      this.kept = null;
    } else {
      const canvas = h("canvas", {class: "picture before", width: this.now.width, height: this.now.height});
      canvas.getContext("2d")!.drawImage(this.now, 0, 0);
      this.kept = {canvas, caption};
      this.now.after(canvas);
    }
    this.divider.hidden = !this.kept;
    this.captions.replaceChildren(...(this.kept ? [h("span", {}, `before · ${caption}`), h("span", {}, "now")] : []));
    this.setSplit(0.5);
    this.fit();
    return this.kept !== null;
  }

  setCursor(cursor: [number, number]): void {
    this.cursor = cursor;
    this.mark.style.left = `${50 + 100 * cursor[0] / this.frame_mm[0]}%`;
    this.mark.style.top = `${50 - 100 * cursor[1] / this.frame_mm[1]}%`;
    this.mark.title = `${shown(cursor[0], 3)}, ${shown(cursor[1], 3)} mm`;
  }

  /** Where suns are imaged, within the frame or beside it; null: that is not known. */
  setSuns(places_mm: ([number, number] | null)[], chosen: number): void {
    this.sunPlaces = places_mm;
    if (places_mm.length === 0 && this.suns.length === 0) return;
    while (this.suns.length < places_mm.length) this.suns.push(this.newSun(this.suns.length));
    for (const mark of this.suns.splice(places_mm.length)) mark.remove();
    // Beyond the box they wait at its edge.
    const box = this.element.getBoundingClientRect(), stage = this.stage.getBoundingClientRect(), room = 12;
    const within = (v: number, most: number) => Math.min(most - room, Math.max(room, v));
    places_mm.forEach((place, i) => {
      const mark = this.suns[i];
      mark.hidden = !place;
      mark.classList.toggle("chosen", i === chosen);
      if (!place) return;
      mark.style.left = `${within(stage.left - box.left + stage.width * (0.5 + place[0] / this.frame_mm[0]), box.width)}px`;
      mark.style.top = `${within(stage.top - box.top + stage.height * (0.5 - place[1] / this.frame_mm[1]), box.height)}px`;
    });
    this.chosenSun = chosen;
  }
  private chosenSun = 0;

  private newSun(i: number): HTMLButtonElement {
    const mark = h("button", {type: "button", class: "sun-mark", "data-term": "sun", "data-sun": String(i), "aria-label": `sun ${i + 1}; drag it, or move it by arrow keys`}, "☀");
    mark.addEventListener("pointerdown", event => this.dragSun(i, event));
    mark.addEventListener("keydown", event => {
      const move = this.stepOf(event), place = this.sunPlaces[i];
      if (!move || !place) return;
      event.preventDefault();
      event.stopPropagation();
      this.listener.sunMoved(i, place[0] + move[0] * this.frame_mm[0], place[1] + move[1] * this.frame_mm[1], true);
    });
    this.element.append(mark);
    return mark;
  }

  get size_mm(): [number, number] { return this.frame_mm; }

  private dragSun(i: number, event: PointerEvent): void {
    const mark = this.suns[i];
    if (event.button !== 0) return;
    event.preventDefault();
    event.stopPropagation();
    mark.focus();
    mark.setPointerCapture(event.pointerId);
    const place = (next: PointerEvent, done: boolean) => {
      const stage = this.stage.getBoundingClientRect();
      this.listener.sunMoved(i, ((next.clientX - stage.left) / stage.width - 0.5) * this.frame_mm[0],
          (0.5 - (next.clientY - stage.top) / stage.height) * this.frame_mm[1], done);
    };
    const move = (next: PointerEvent) => place(next, false);
    mark.addEventListener("pointermove", move);
    mark.addEventListener("pointerup", next => {
      mark.removeEventListener("pointermove", move);
      place(next, true);
    }, {once: true});
  }

  /** As large as the box takes, in the sensor's own proportions. */
  private fit(): void {
    const scale = Math.min(this.box.width / this.frame_mm[0], this.box.height / this.frame_mm[1]);
    this.stage.style.width = `${Math.floor(scale * this.frame_mm[0])}px`;
    this.stage.style.height = `${Math.floor(scale * this.frame_mm[1])}px`;
    this.setCursor(this.cursor);
    this.setSuns(this.sunPlaces, this.chosenSun);
  }

  private setSplit(split: number): void {
    this.split = Math.min(1, Math.max(0, split));
    this.divider.style.left = `${100 * this.split}%`;
    this.divider.setAttribute("aria-valuenow", String(Math.round(100 * this.split)));
    if (this.kept) this.kept.canvas.style.clipPath = `inset(0 ${100 * (1 - this.split)}% 0 0)`;
  }

  private dragDivider(event: PointerEvent): void {
    event.preventDefault();
    event.stopPropagation();
    this.divider.setPointerCapture(event.pointerId);
    const move = (next: PointerEvent) => {
      const box = this.stage.getBoundingClientRect();
      this.setSplit((next.clientX - box.left) / box.width);
    };
    this.divider.addEventListener("pointermove", move);
    this.divider.addEventListener("pointerup", () => this.divider.removeEventListener("pointermove", move), {once: true});
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0) return;
    this.stage.setPointerCapture(event.pointerId);
    const place = (next: PointerEvent, done: boolean) => {
      const box = this.stage.getBoundingClientRect();
      const clamp = (v: number) => Math.min(0.5, Math.max(-0.5, v));
      const x = clamp((next.clientX - box.left) / box.width - 0.5), y = clamp(0.5 - (next.clientY - box.top) / box.height);
      this.setCursor([x * this.frame_mm[0], y * this.frame_mm[1]]);
      this.listener.placed(this.cursor[0], this.cursor[1], done);
    };
    place(event, false);
    const move = (next: PointerEvent) => place(next, false);
    this.stage.addEventListener("pointermove", move);
    this.stage.addEventListener("pointerup", next => {
      this.stage.removeEventListener("pointermove", move);
      place(next, true);
    }, {once: true});
  }

  /** What an arrow key moves, in frames. */
  private stepOf(event: KeyboardEvent): [number, number] | undefined {
    const step = event.shiftKey ? 0.1 : 0.02;
    const moves: Record<string, [number, number]> = {
      ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step]};
    return moves[event.key];
  }

  private key(event: KeyboardEvent): void {
    const move = this.stepOf(event);
    if (!move) return;
    event.preventDefault();
    const limit = (v: number, half: number) => Math.min(half, Math.max(-half, v));
    this.setCursor([limit(this.cursor[0] + move[0] * this.frame_mm[0], this.frame_mm[0] / 2),
      limit(this.cursor[1] + move[1] * this.frame_mm[1], this.frame_mm[1] / 2)]);
    this.listener.placed(this.cursor[0], this.cursor[1], true);
  }
}
