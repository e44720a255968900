// SPDX-License-Identifier: BSD-3-Clause
// The page: joins what is on the bench, what is shown, and the server.
import {commandLine, focusText} from "./command_line";
import {choice, Slider} from "./controls";
import {h, icon, icons, shown} from "./dom";
import {LayoutView, Line} from "./layout_view";
import {CompareView} from "./compare_view";
import {Dropped, Incoming, Link, takeToken} from "./link";
import {Ghost, ghostTable} from "./ghost_view";
import {coat, copied, History, isCoatable, Lens, mostSuns, newSession, packed, pinAbout, placeOfSun, Session, setValue, Sky, sunAt, sunlight_lx, uncoated, unpacked, usualStray, valueAt} from "./model";
import {isFull, PictureView} from "./picture_view";
import {drawPlots, PlotData} from "./plot_view";
import {PsfView} from "./psf_view";
import {reportOf} from "./report";
import {FoundGlass, TableView} from "./table_view";
import {explainTerms} from "./terms";
import {exercises, Tour} from "./tour";

const shownPlots: [string, string, string][] = [
  ["mtf", "MTF", "mtf"], ["spots", "Spots", "spots"], ["distortion", "Distortion", "distortion"],
  ["illumination", "Illumination", "illumination"], ["field-curvature", "Field curvature", "field-curvature"],
  ["fans", "Ray fans", "fans"], ["colour", "Colour", "colour"], ["vignetting", "Vignetting", "vignetting"],
  ["wavefront", "Wavefront", "wavefront"], ["encircled-energy", "Encircled energy", "encircled-energy"],
  ["ghosts", "Ghosts", "ghosts"],
];

/** While a slider is dragged the rest of the page waits for its rays, but no longer than this. */
const slowRays_ms = 40;
/** What a frame takes from the page's thread to the screen, about; it goes sooner with nothing beside it. */
const presenting_ms = 8;

/** The file that says what it is, and the numbers of an ENVI header or the .json of a .npy, if they came together. */
function withCompanion(files: File[]): [File | undefined, File | undefined] {
  const header = files.find(each => /\.(hdr|npy)$/i.test(each.name));
  if (files.length !== 2 || !header) return [files[0], undefined];
  return [header, files.find(each => each !== header)];
}

class Page {
  private session!: Session;
  private history!: History;
  private welcome: Incoming | null = null;
  private id = 0;
  private pending = false;
  private unanswered_since = 0;
  private uploads = new Map<number, Dropped>();
  private dropped: Dropped[] = [];  ///< scenes
  private glassWaiting = new Map<number, (glasses: FoundGlass[]) => void>();
  private saving = new Map<number, string>();
  private lastPicture: Incoming | null = null;
  private plots = new Map<string, Incoming>();
  private sliders = new Map<string, Slider>();
  private readonly link: Link;
  private readonly compare: CompareView;

  private readonly table = new TableView({
    changed: (alter, gesture) => this.alterLens(alter, gesture),
    pinned: path => this.togglePin(path),
    isPinned: path => this.session.pins.some(pin => pin.path === path),
    searchGlass: (text, show) => {
      const id = ++this.id;
      this.glassWaiting.set(id, show);
      this.link.send({kind: "glasses", id, text});
    },
    refused: text => this.tell(text),
    coatings: () => this.welcome?.coatings ?? [],
  });
  private readonly layout = new LayoutView({
    moved: (first, last, shift, done) => this.moveGroup(first, last, shift, done),
    stopRadius: (radius, done) => this.openStop(radius, done),
    chosen: surface => this.table.select(Math.min(surface, this.session.lens.surfaces.length - 1)),
  });
  private readonly picture = new PictureView({
    placed: (x, y, done) => this.change(() => { this.session.cursor_mm = [x, y]; }, done ? "" : "cursor"),
    sunMoved: (sun, x, y, done) => this.moveSun(sun, sunAt(this.sky, x, y), done),
    focused: (x, y) => this.focusAt(x, y),
  });
  private sky: Sky = [];
  private ghosts: Ghost[] = [];
  private efl_mm = 50;
  private readonly psf = new PsfView();
  private readonly plotBox = h("div", {class: "plot-box"});
  private readonly tabs = h("div", {class: "tabs", role: "tablist"});
  private readonly facts = h("div", {class: "facts"});
  private readonly controls = h("div", {class: "controls"});
  private readonly choices = h("div", {class: "choices"});
  private readonly message = h("div", {class: "message", role: "status", "aria-live": "polite"});
  private readonly banner = h("div", {class: "banner", role: "alert"});
  private readonly timing = h("div", {class: "timing", title: "time of each stage, on the server"});
  private readonly command = h("code", {class: "command"});
  private readonly undoButton = this.button("Undo", "undo", () => this.step(this.history.undo()), "Ctrl+Z");
  private readonly redoButton = this.button("Redo", "redo", () => this.step(this.history.redo()), "Ctrl+Shift+Z");
  private readonly beforeButton = h("button", {type: "button", class: "text-button", id: "before", title: "keep this picture to compare with (B)", "aria-pressed": "false",
    onclick: () => this.toggleBefore()}, "Before / after");
  private readonly compareButton = h("button", {type: "button", class: "text-button", id: "compare", title: "another lens beside this one (C)", "aria-pressed": "false",
    onclick: () => this.toggleCompare()}, "Compare");
  private readonly focusButton = h("button", {type: "button", class: "small-button", id: "focus-here", title: "make the place of the ring sharp (F); a double click does so where it is", "data-term": "defocus",
    onclick: () => this.focusAt(...this.session.cursor_mm)}, "Focus here");
  private times = new Map<string, number>();
  private readonly tour = new Tour(exercise => this.startExercise(exercise));

  constructor() {
    const token = takeToken();
    this.compare = new CompareView(token, {
      chosen: name => this.change(() => { this.session.compared = {name, lens: null}; }),
      read: (name, lens) => this.takeCompared(name, lens),
      plotted: () => this.drawPlot(),
    });
    this.build();
    this.link = new Link(token, {
      opened: async () => {
        this.pending = false;
        this.unanswered_since = 0;
        for (const each of this.dropped) await this.link.upload(each);
        this.link.send({kind: "hello"});
      },
      lost: () => {
        this.banner.textContent = "The server does not answer. Start it again on the same port (petzval live --port …), and this page goes on.";
        document.body.classList.add("offline");
      },
      message: (message, bytes) => this.take(message, bytes),
    });
    (window as any).petzvalPage = this;  // for tests
  }

  // ---- the frame of the page -------------------------------------------------------------------------------------

  private button(label: string, name: keyof typeof icons, act: () => void, key: string): HTMLButtonElement {
    return h("button", {type: "button", class: "icon-button", id: name, title: `${label} (${key})`, "aria-label": label, onclick: act}, icon(icons[name]));
  }

  private build(): void {
    const copy = h("button", {type: "button", class: "text-button", id: "copy-command", onclick: () => this.copy(this.command.textContent ?? "", "command copied")}, "Copy");
    const card = (title: string, term: string, extra: (Node | string)[], ...content: Node[]) => h("section", {class: `card ${term}-card`},
        h("header", {}, h("h2", {"data-term": term, class: "term-mark"}, title), ...extra), ...content);
    document.body.append(
        h("header", {class: "bar"}, h("div", {class: "brand"}, h("img", {src: "/icon.svg", alt: "", width: 22, height: 22}), h("b", {}, "Petzval"), h("span", {}, "live")),
            this.choices, h("div", {class: "spring"}), this.undoButton, this.redoButton, this.beforeButton, this.compareButton, this.saveMenu(),
            h("button", {type: "button", class: "text-button", id: "tour", onclick: () => this.tour.toggle()}, "Tour"),
            h("button", {type: "button", class: "text-button", id: "theme", title: "dark or light (D)", "aria-label": "dark or light", onclick: () => this.toggleTheme()}, "◐")),
        this.banner,
        h("main", {},
            h("div", {class: "column left"},
                card("Prescription", "radius", [h("small", {class: "hint"}, "mm · ↑↓ to nudge · • for a slider")], this.table.element),
                card("Controls", "f-number", [], this.controls)),
            h("div", {class: "column middle"},
                card("Layout", "stop", [this.facts], this.layout.element),
                card("Picture", "preview", [this.picture.detail, this.focusButton, this.picture.badge], h("div", {class: "pictures"}, this.picture.element, this.compare.element))),
            h("div", {class: "column right"},
                card("Point spread", "psf", [], this.psf.element),
                h("section", {class: "card analysis-card"}, this.tabs, this.plotBox))),
        h("footer", {}, h("span", {class: "prompt"}, "$"), this.command, copy, this.timing),
        this.message);
    this.buildTabs();
    document.addEventListener("keydown", event => this.key(event));
    addEventListener("pagehide", () => { if (this.keeping !== undefined) this.keep(); });
    document.addEventListener("dragover", event => { event.preventDefault(); document.body.classList.add("dropping"); });
    document.addEventListener("dragleave", event => { if (!event.relatedTarget) document.body.classList.remove("dropping"); });
    document.addEventListener("drop", event => {
      event.preventDefault();
      document.body.classList.remove("dropping");
      void this.upload([...event.dataTransfer?.files ?? []]);
    });
    new ResizeObserver(entries => {
      const {width, height} = entries[0].contentRect;
      this.plotSize = `${width} ${height}`;
      this.drawPlot();
    }).observe(this.plotBox);
    const theme = localStorage.getItem("petzval-theme");
    if (theme) document.documentElement.dataset.theme = theme;
    explainTerms();
  }

  private saveMenu(): HTMLElement {
    const file = h("input", {type: "file", id: "file", multiple: true, hidden: true, onchange: (event: Event) => {
      const input = event.target as HTMLInputElement;
      void this.upload([...input.files ?? []]);
      input.value = "";
    }});
    const entry = (label: string, id: string, act: () => void) => h("button", {type: "button", role: "menuitem", id, onclick: () => { menu.removeAttribute("open"); act(); }}, label);
    const save = (extension: string) => () => {
      const id = ++this.id;
      this.saving.set(id, extension);
      this.link.send({kind: "save", id, extension});
    };
    const menu: HTMLDetailsElement = h("details", {class: "menu"}, h("summary", {class: "text-button", id: "file-menu"}, "File"),
        h("div", {class: "menu-list", role: "menu"},
            entry("Open a lens, scene or session …", "open", () => file.click()), h("hr"),
            entry("Save lens (.json)", "save-json", save(".json")), entry("Save lens (.zmx)", "save-zmx", save(".zmx")), entry("Save lens (.seq)", "save-seq", save(".seq")), h("hr"),
            entry("Save picture (.png)", "save-png", save(".png")), entry("Save raw image (.dng)", "save-dng", save(".dng")), entry("Save light (.exr)", "save-exr", save(".exr")), h("hr"),
            entry("Save report (.html)", "save-report", () => { this.reporting = true; this.ask(); }),
            entry("Save session (.json)", "save-session", () => this.download(new Blob([JSON.stringify({petzval_session: 1, ...this.session})]), "session.petzval.json")),
            entry("Copy a link to this session", "copy-link", async () => this.copy(`${location.origin}/#session=${await packed(this.session)}`, "link copied; it works while this server runs"))));
    document.addEventListener("pointerdown", event => { if (!menu.contains(event.target as Node)) menu.removeAttribute("open"); });
    return h("div", {}, menu, file);
  }

  private buildTabs(): void {
    this.tabs.replaceChildren(...shownPlots.map(([name, title, term]) => h("button", {type: "button", role: "tab", id: `tab-${name}`, "data-term": term,
      onclick: () => this.change(() => { this.session.plot = name; }, "plot")}, title)));
  }

  private buildChoices(): void {
    const welcome = this.welcome!, session = this.session;
    const plain = (names: string[]): [string, string][] => names.map(name => [name, name]);
    const lenses: [string, string][] = welcome.lenses.map((lens: any) => [lens.name, lens.name]);
    if (!lenses.some(([name]) => name === session.lensName)) lenses.unshift([session.lensName, session.lensName]);
    this.choices.replaceChildren(
        choice("Lens", "lens", lenses, session.lensName, name => this.link.send({kind: "lens", id: ++this.id, name})),
        choice("Scene", "scene", plain(welcome.scenes), session.scene, scene => this.chooseScene(scene)),
        choice("Light", "illuminant", welcome.illuminants.map((name: string) => [name, name || "own"]), session.illuminant, name => this.change(() => { session.illuminant = name; })),
        choice("Sensor", "sensor", plain(welcome.sensors), session.sensor, sensor => this.change(() => { session.sensor = sensor; })));
  }

  private buildControls(): void {
    const session = this.session;
    const list: (Node | null)[] = [];
    this.sliders.clear();
    const slider = (wish: ConstructorParameters<typeof Slider>[0]) => {
      const made = new Slider(wish);
      this.sliders.set(wish.name, made);
      list.push(made.element);
    };
    const set = <K extends keyof Session>(key: K) => (value: Session[K], done: boolean) => this.change(() => { session[key] = value; }, String(key), done);
    for (const pin of session.pins) {
      slider({label: pin.path.replace("surfaces", "").replace(/_mm$/, "").replace("].", "] "), name: pin.path, unit: pin.path.endsWith("_mm") ? "mm" : "", digits: 5,
        from: pin.from, to: pin.to, value: valueAt(session.lens, pin.path), usual: valueAt(session.base, pin.path),
        changed: (value, done) => this.alterLens(lens => { if (valueAt(lens, pin.path) !== null) setValue(lens, pin.path, value); }, pin.path, done),
        unpin: () => this.togglePin(pin.path),
        ranged: (from, to) => this.change(() => { pin.from = from; pin.to = to; this.buildControls(); })});
    }
    if (session.pins.length) list.push(h("hr"));
    const widest = this.widest();
    slider({label: "f-number", name: "f_number", term: "f-number", from: widest, to: Math.max(22, 2 * widest), log: true, value: session.f_number ?? widest, usual: widest, digits: 3,
      changed: (value, done) => set("f_number")(value === null || value <= widest * 1.003 ? null : value, done)});
    list.push(choice("Blades", "blades", [["", "as prescribed"], ["0", "none, round"], ...[3, 5, 6, 7, 8, 9, 11, 15].map((n): [string, string] => [String(n), String(n)])], String(session.blades ?? ""),
        blades => this.change(() => { session.blades = blades === "" ? null : Number(blades); }), "blades"));
    list.push(choice("Focus", "focus", [["design", "as prescribed"], ["auto", "on the scene"], ["infinity", "infinity"], ["distance", "at a distance"], ["paraxial", "paraxial"], ["best-spot", "least spots"]],
        session.focus, focus => this.change(() => { session.focus = focus; this.buildControls(); }), "focus"));
    if (session.focus === "distance")
      slider({label: "focused at", name: "focus_m", term: "focus", unit: "m", from: 0.2, to: 100, log: true, value: session.focus_m, usual: 2, changed: (value, done) => set("focus_m")(value ?? 2, done)});
    if (!this.isSolid) slider({label: "scene at", name: "distance_m", term: "distance", unit: "m", from: 0.2, to: 100, log: true, end: "∞", value: session.distance_m, usual: null, changed: set("distance_m")});
    slider({label: "sensor shift", name: "defocus_mm", term: "defocus", unit: "mm", from: -0.5, to: 0.5, value: session.defocus_mm, usual: 0, changed: (value, done) => set("defocus_mm")(value ?? 0, done)});
    list.push(h("hr"));
    const shot = (key: "compensation_ev" | "denoise" | "sharpen") => (value: number | null, done: boolean) => this.change(() => { session.shot[key] = value ?? 0; }, key, done);
    slider({label: "exposure", name: "compensation_ev", term: "exposure", unit: "EV", from: -4, to: 4, value: session.shot.compensation_ev, usual: 0, digits: 3, changed: shot("compensation_ev")});
    slider({label: "denoise", name: "denoise", from: 0, to: 3, value: session.shot.denoise, usual: 0, digits: 3, changed: shot("denoise")});
    slider({label: "sharpen", name: "sharpen", from: 0, to: 2, value: session.shot.sharpen, usual: 0, digits: 3, changed: shot("sharpen")});
    list.push(h("div", {class: "pair"},
        h("label", {class: "check", "data-term": "noise"}, h("input", {type: "checkbox", checked: session.shot.noise, "data-check": "noise",
          onchange: (event: Event) => this.change(() => { session.shot.noise = (event.target as HTMLInputElement).checked; })}), "noise"),
        choice("Tone", "tone", this.welcome!.tones.map((tone: string) => [tone, tone]), session.shot.tone, tone => this.change(() => { session.shot.tone = tone; }))));
    list.push(h("hr"));
    const stray = session.stray;
    const check = (label: string, name: string, term: string, checked: boolean, act: (on: boolean) => void) => h("label", {class: "check", "data-term": term},
        h("input", {type: "checkbox", checked, "data-check": name, onchange: (event: Event) => this.change(() => { act((event.target as HTMLInputElement).checked); this.buildControls(); })}), label);
    list.push(h("div", {class: "checks"}, h("button", {type: "button", class: "small-button", id: "add-sun", "data-term": "sun", onclick: () => this.addSun()}, "+ sun"),
        check("ghosts", "ghosts", "ghosts", stray.ghosts, on => { stray.ghosts = on; }),
        check("stars", "starburst", "starburst", stray.starburst, on => { stray.starburst = on; }), this.sourceCount));
    list.push(this.sunRows);
    const sun = stray.suns[stray.sun];
    if (!this.isSolid && (stray.ghosts || stray.starburst || stray.roughness_nm > 0))
      slider({label: "sources from", name: "threshold", term: "threshold", unit: "×", from: 1, to: 10000, log: true, value: stray.threshold, usual: usualStray.threshold, digits: 3,
        changed: (value, done) => this.change(() => { stray.threshold = value ?? usualStray.threshold; }, "threshold", done)});
    if (sun)
      slider({label: "sun's light", name: "sun_lx", term: "sun", unit: "lx", from: 0.1, to: 100000, log: true, value: sun.lx, usual: sunlight_lx, digits: 3,
        changed: (value, done) => this.change(() => { sun.lx = value ?? sunlight_lx; }, "sun light", done)});
    if (sun)
      for (const [i, label] of [[0, "sun right"], [1, "sun up"]] as [0 | 1, string][])
        slider({label, name: `sun_deg[${i}]`, term: "sun", unit: "°", from: -60, to: 60, value: sun.deg[i], usual: 0, digits: 4,
          changed: (value, done) => this.change(() => { sun.deg[i] = value ?? 0; }, `sun slider ${i}`, done)});
    slider({label: "roughness", name: "roughness_nm", term: "roughness", unit: "nm", from: 0, to: 10, value: stray.roughness_nm, usual: 0, digits: 3,
      changed: (value, done) => this.change(() => { stray.roughness_nm = Math.max(0, value ?? 0); }, "roughness", done)});
    this.controls.replaceChildren(...list.filter((each): each is Node => each !== null));
  }

  /** Inside the frame, above: to the right, then to the left, ever nearer to the middle. */
  private firstSun(): [number, number] {
    const n = this.session.stray.suns.length, place = 0.3 * (n % 2 === 0 ? 1 : -1) / (1 + (n >> 1));
    const angle = (side: number) => Number((Math.atan(side / Math.abs(this.efl_mm)) * 180 / Math.PI).toFixed(1));
    const [width, height] = this.picture.size_mm;
    return [angle(place * width), angle(0.3 * height)];
  }

  private readonly sourceCount = h("small", {class: "source-count", "data-term": "threshold"});
  private widestOpen = 2;
  private widest(): number { return this.widestOpen; }

  // ---- changes ---------------------------------------------------------------------------------------------------

  /** Does a change, remembers it, and tells the server. */
  private change(alter: () => void, gesture = "", done = true): void {
    alter();
    this.ask();  // the server works while the page does
    this.history.record(JSON.stringify(this.session), gesture);
    if (done && gesture !== "plot") this.history.endGesture();
    this.stale = true;
    if (done) this.refreshBehindFrame();
    else this.refreshing ??= setTimeout(() => this.refreshBehindFrame(), slowRays_ms);  // behind the rays: takeLayout()
  }

  private refreshBehindFrame(): void {
    requestAnimationFrame(() => setTimeout(() => {
      if (this.lastLayout) this.showFacts(this.lastLayout);
      this.lastLayout = null;
      if (this.stale) this.refresh();
    }, presenting_ms));
  }
  private stale = false;  ///< whether the page shows a session of before
  private refreshing: ReturnType<typeof setTimeout> | undefined;

  private alterLens(alter: (lens: Lens) => void, gesture: string, done = true): void {
    this.change(() => {
      alter(this.session.lens);
      // Where there is no glass any more, or glass on both sides, nothing is coated.
      this.session.lens.surfaces.forEach((surface, i) => { if (surface.coating && !isCoatable(this.session.lens, i)) coat(this.session.lens, i, null); });
    }, gesture, done);
  }

  private moveGroup(first: number, last: number, shift: number, done: boolean): void {
    this.alterLens(lens => {
      const surfaces = lens.surfaces, sensor = first === surfaces.length;
      const before = first > 0 ? surfaces[first - 1] : null, behind = sensor ? null : surfaces[last];
      // Nothing passes through its neighbours.
      let by = before ? Math.max(shift, -before.thickness_mm) : shift;
      if (behind) by = Math.min(by, behind.thickness_mm);
      const tidy = (value: number) => Number(value.toFixed(4));
      if (before) before.thickness_mm = tidy(before.thickness_mm + by);
      if (behind) behind.thickness_mm = tidy(behind.thickness_mm - by);
    }, `move ${first}`, done);
  }

  /** The stop by its radius: as an f-number where that closes it, as the f-number scales with it. */
  private openStop(radius: number, done: boolean): void {
    if (this.stopNow <= 0) return;
    const widest = this.widest(), wished = Math.min(64, Math.max(widest, this.fNumberNow * this.stopNow / radius));
    this.stopNow *= this.fNumberNow / wished;
    this.fNumberNow = wished;
    const value = Number(wished.toPrecision(4));
    this.change(() => { this.session.f_number = value <= widest * 1.003 ? null : value; }, "stop", done);
  }
  private stopNow = 0;
  private fNumberNow = 1;

  private togglePin(path: string): void {
    this.change(() => {
      const at = this.session.pins.findIndex(pin => pin.path === path);
      if (at >= 0) this.session.pins.splice(at, 1);
      else this.session.pins.push(pinAbout(path, valueAt(this.session.lens, path) ?? 0));
      this.buildControls();
    });
  }

  private step(state: string | null): void {
    if (state === null) return;
    this.session = JSON.parse(state) as Session;
    this.rebuild();
    this.ask();
  }

  private start(session: Session): void {
    this.session = session;
    this.history = new History(JSON.stringify(session));
    this.knowsWidest = false;
    this.rebuild();
    this.ask();
  }
  private knowsWidest = false;

  private rebuild(): void {
    this.buildChoices();
    this.buildControls();
    this.refresh();
  }

  /** Everything that follows from the session alone. */
  private refresh(): void {
    this.stale = false;
    clearTimeout(this.refreshing);
    this.refreshing = undefined;
    const session = this.session;
    this.table.show(session.lens);
    this.picture.setCursor(session.cursor_mm);
    this.showSuns();
    this.layout.showWay(session.stray.ghost ? this.way : []);
    this.sliders.get("roughness_nm")?.show(session.stray.roughness_nm);
    this.sliders.get("threshold")?.show(session.stray.threshold);
    const sun = session.stray.suns[session.stray.sun];
    this.sliders.get("sun_lx")?.show(sun?.lx ?? sunlight_lx);
    for (const i of [0, 1]) this.sliders.get(`sun_deg[${i}]`)?.show(sun?.deg[i] ?? 0);
    for (const pin of session.pins) this.sliders.get(pin.path)?.show(valueAt(session.lens, pin.path));
    this.sliders.get("f_number")?.show(session.f_number ?? this.widest());
    for (const name of ["distance_m", "defocus_mm", "focus_m"] as const) this.sliders.get(name)?.show(session[name]);
    for (const name of ["compensation_ev", "denoise", "sharpen"] as const) this.sliders.get(name)?.show(session.shot[name]);
    this.undoButton.disabled = !this.history.canUndo;
    this.redoButton.disabled = !this.history.canRedo;
    this.tabs.querySelectorAll("button").forEach(tab => tab.setAttribute("aria-selected", String(tab.id === `tab-${session.plot}`)));
    this.compareButton.setAttribute("aria-pressed", String(session.compared !== null));
    this.compare.open(session.compared, (this.welcome?.lenses ?? []).map((lens: any) => lens.name));
    this.drawPlot();
    this.command.textContent = commandLine(session, this.lastPicture, this.isSolid);
    this.command.title = this.command.textContent;
    this.keepSoon();
  }

  private showSuns(): void {
    const {suns, sun} = this.session.stray, focused = (document.activeElement as HTMLElement | null)?.dataset.sunRow;
    this.picture.setSuns(suns.map(each => placeOfSun(this.sky, each.deg)), sun);
    this.sunRows.replaceChildren(...suns.map((each, i) => h("div", {class: i === sun ? "sun-row chosen" : "sun-row"},
        h("button", {type: "button", class: "sun-choice", "data-sun-row": String(i), "aria-pressed": String(i === sun), title: "its sliders; the way of a ghost is of its light", onclick: () => this.chooseSun(i)},
            h("b", {}, `☀ ${i + 1}`), h("span", {}, `${shown(each.deg[0])}°, ${shown(each.deg[1])}°`), h("span", {}, `${shown(each.lx, 3)} lx`)),
        h("button", {type: "button", class: "unpin", "data-sun-less": String(i), title: "remove it", "aria-label": `remove sun ${i + 1}`, onclick: () => this.removeSun(i)}, "×"))));
    if (focused !== undefined) this.sunRows.querySelector<HTMLElement>(`[data-sun-row="${focused}"]`)?.focus();
  }
  private readonly sunRows = h("div", {class: "sun-rows"});

  private moveSun(i: number, deg: [number, number], done: boolean): void {
    const stray = this.session.stray, other = stray.sun !== i;
    this.change(() => {
      stray.sun = i;
      stray.suns[i].deg = deg;
    }, `sun ${i}`, done);
    if (other) this.buildControls();
  }

  private chooseSun(i: number): void {
    this.change(() => { this.session.stray.sun = i; });
    this.buildControls();
  }

  private addSun(): void {
    const stray = this.session.stray;
    if (stray.suns.length === mostSuns) return this.tell(`there are at most ${mostSuns} suns`, true);
    this.change(() => {
      stray.sun = stray.suns.push({deg: this.firstSun(), lx: sunlight_lx}) - 1;
      stray.ghosts ||= stray.suns.length === 1;
    });
    this.buildControls();
  }

  private removeSun(i: number): void {
    const stray = this.session.stray;
    this.change(() => {
      stray.suns.splice(i, 1);
      stray.sun = Math.max(0, Math.min(stray.sun > i ? stray.sun - 1 : stray.sun, stray.suns.length - 1));
    });
    this.buildControls();
  }

  private way: Line[] = [];
  private toldOfGhost = "";
  private takeStray(message: Incoming): void {
    this.sky = message.sky;
    this.ghosts = message.ghosts;
    this.way = message.way;
    const ghost = this.session.stray.ghost;
    if (ghost && this.way.length === 0 && String(ghost) !== this.toldOfGhost) this.tell(`no light from there comes to the sensor by surfaces ${ghost[0]} and ${ghost[1]}`);
    this.toldOfGhost = ghost && this.way.length === 0 ? String(ghost) : "";
    this.layout.showWay(this.session.stray.ghost ? this.way : []);
    this.showSuns();
    if (this.session.plot === "ghosts") this.drawPlot();
  }

  /** Keeps the session for a reload, once the hand rests or the page goes. */
  private keepSoon(): void {
    const rest_ms = 200;
    clearTimeout(this.keeping);
    this.keeping = setTimeout(() => this.keep(), rest_ms);
  }
  private keep(): void {
    clearTimeout(this.keeping);
    this.keeping = undefined;
    sessionStorage.setItem("petzval-session", JSON.stringify({start: this.startKey(), session: this.session}));
  }
  private keeping: ReturnType<typeof setTimeout> | undefined;

  private startKey(): string { return JSON.stringify([this.welcome?.lens_name, this.welcome?.lens?.surfaces]); }

  // ---- the server ------------------------------------------------------------------------------------------------

  /** Sends the state once the last one has been answered by rays, or has not been for long. */
  private ask(): void {
    const patience_ms = 120;
    if (this.pending) return;
    const since = performance.now() - this.unanswered_since;
    if (this.unanswered_since > 0 && since < patience_ms) {
      this.pending = true;
      setTimeout(() => { if (this.pending) { this.pending = false; this.unanswered_since = 0; this.ask(); } }, patience_ms - since);
      return;
    }
    this.sendState();
  }

  private sendState(): void {
    if (!this.link?.isOpen || !this.welcome) return;
    this.unanswered_since = performance.now();
    const session = this.session;
    const state = {kind: "state", id: ++this.id, lens: uncoated(session.lens), coatings: session.lens.surfaces.map(each => typeof each.coating === "string" ? each.coating : null),
      camera: {f_number: session.f_number, blades: session.blades, focus: focusText(session), distance_m: session.distance_m, defocus_mm: session.defocus_mm},
      scene: session.scene, illuminant: session.illuminant, sensor: session.sensor, shot: session.shot, stray: session.stray,
      cursor_mm: session.cursor_mm, plots: this.reporting ? shownPlots.map(([name]) => name) : [session.plot], picture: true};
    this.link.send(state);
    this.compare.show(state);
    document.body.dataset.busy = "1";
  }

  private answered(): void {
    this.unanswered_since = 0;
    if (!this.pending) return;
    this.pending = false;
    this.ask();
  }

  private take(message: Incoming, bytes: Uint8Array | null): void {
    switch (message.kind) {
      case "welcome": return void this.greeted(message);
      case "lens": return this.takeLens(message);
      case "scenes": return this.takeScene(message);
      case "layout": return this.takeLayout(message);
      case "plots":
        this.plots.set(message.analysis, message);
        return this.drawPlot();
      case "stray": return this.takeStray(message);
      case "psf": return this.psf.show(message, bytes!, this.session.cursor_mm);
      case "picture":
        this.picture.show(message, bytes!);
        this.sourceCount.textContent = this.isSolid ? "" : this.session.stray.ghosts || this.session.stray.starburst || this.session.stray.roughness_nm > 0 ? `${message.sources.length || "no"} source${message.sources.length === 1 ? "" : "s"} in the scene` : "";
        if (isFull(message)) this.lastPicture = message;
        if (this.focusNext && message.id === this.id) {
          this.focusNext = false;
          this.focusAt(0, -this.picture.size_mm[1] / 6);
        }
        this.command.textContent = commandLine(this.session, this.lastPicture, this.isSolid);
        document.body.dataset[message.quality] = String(message.id);
        return;
      case "glasses":
        this.glassWaiting.get(message.id!)?.(message.glasses);
        this.glassWaiting.delete(message.id!);
        return;
      case "focused": return message.distance_m ? this.takeDistance(message.distance_m) : this.takeFocus(message.shift_mm);
      case "file": return this.takeFile(message, bytes!);
      case "stage": return this.took(message);
      case "problem": return this.takeProblem(message);
      case "refused": return this.tell(message.text, true);
      case "idle":
        if (message.id === this.id || !this.pending) delete document.body.dataset.busy;
        if (message.id === this.id && this.reporting) this.saveReport();
        document.body.dataset.idle = String(message.id);
        return;
    }
  }

  private async greeted(welcome: Incoming): Promise<void> {
    const first = this.welcome === null;
    this.welcome = welcome;
    document.body.classList.remove("offline");
    this.banner.textContent = "";
    if (!first) {  // a server that came back
      this.plots.clear();
      this.buildChoices();
      return this.ask();
    }
    const fresh = newSession(welcome.lens_name, welcome.lens as Lens, welcome.scene, welcome.sensor);
    this.start(await this.restored() ?? fresh);
    document.body.dataset.ready = "1";
  }

  /** From the address, or from this tab before it was loaded anew. */
  private async restored(): Promise<Session | null> {
    try {
      const parts = new URLSearchParams(location.hash.slice(1));
      const link = parts.get("session");
      if (link) {
        history.replaceState(null, "", location.pathname);
        return this.checked(await unpacked(link));
      }
      const kept = JSON.parse(sessionStorage.getItem("petzval-session") ?? "null");
      if (kept && kept.start === this.startKey()) return this.checked(kept.session);
    } catch {
      this.tell("the session could not be restored", true);
    }
    return null;
  }

  /** What the server knows by name now; all else is checked by the server. */
  private checked(session: Session): Session {
    const welcome = this.welcome!;
    const usual = newSession(welcome.lens_name, session.lens, welcome.scene, welcome.sensor);
    const whole = {...usual, ...session, shot: {...usual.shot, ...session.shot}, stray: {...usualStray, ...session.stray}} as Session;
    for (const key of Object.keys(whole.stray)) if (!(key in usualStray)) delete (whole.stray as unknown as Record<string, unknown>)[key];  // of an older version
    if (!welcome.scenes.includes(whole.scene)) whole.scene = welcome.scene;
    if (!welcome.sensors.includes(whole.sensor)) whole.sensor = welcome.sensor;
    return whole;
  }

  private takeScene(message: Incoming): void {
    const scene = this.uploads.get(message.id!);
    if (!scene) return;  // given again to a server that came back
    this.uploads.delete(message.id!);
    this.dropped.push(scene);
    this.compare.drop(scene);
    this.welcome!.scenes = message.scenes;
    for (const note of message.notes) this.tell(note);
    this.chooseScene(message.scene);
    this.buildChoices();
  }

  private takeLens(message: Incoming): void {
    for (const note of message.notes ?? []) this.tell(note);
    const session = newSession(message.name, message.lens as Lens, this.session.scene, message.sensor);
    const {illuminant, shot, stray, plot} = this.session;
    const next = {...session, compared: this.session.compared, illuminant, shot: copied(shot), stray: {...copied(stray), ghost: null}, plot};
    this.knowsWidest = false;
    this.session = next;
    this.history.record(JSON.stringify(next));
    this.plots.clear();
    this.rebuild();
    this.ask();
  }

  private takeLayout(message: Incoming): void {
    this.layout.show(message, this.session.lens);
    const first = message.first_order;
    this.stopNow = first.stop_semi_diameter_mm ?? 0;
    this.fNumberNow = first.f_number ?? 1;
    this.efl_mm = first.efl_mm ?? 50;
    if (!this.knowsWidest && this.session.f_number === null && first.f_number) {
      this.knowsWidest = true;
      this.widestOpen = Number(first.f_number.toPrecision(4));
      this.buildControls();
    }
    this.answered();
    document.body.dataset.layout = String(message.id);
    this.lastLayout = message;
    this.refreshBehindFrame();  // the rays are drawn first
  }
  private lastLayout: Incoming | null = null;  ///< whose facts are not shown yet

  private showFacts(message: Incoming): void {
    const first = message.first_order;
    const fact = (label: string, term: string, text: string) => h("span", {"data-term": term}, h("i", {}, label), text);
    this.facts.replaceChildren(
        fact("f", "efl", `${shown(first.efl_mm, 4)} mm`), fact("f/", "f-number", shown(first.f_number, 3)),
        fact("entrance pupil", "entrance-pupil", `${shown(first.entrance_pupil_diameter_mm, 3)} mm`),
        fact("exit pupil", "exit-pupil", `${shown(first.exit_pupil_mm, 3)} mm`),
        fact("field", "distortion", `${shown(first.field_of_view_deg, 3)}°`), fact("Petzval", "petzval", `${shown(first.petzval_radius_mm, 3)} mm`));
    this.table.blame(message.blocked.map((each: any) => each.surface));
    const dark = message.blocked.length === message.fields.length;
    this.showProblem("layout", message.blocked.length === 0 ? "" : dark
      ? `No ray passes: ${message.blocked[0].text}.`
      : `No ray passes at field ${message.blocked.map((each: any) => shown(each.field)).join(", ")}: ${message.blocked[0].text}.`);
    for (const stage of ["lens", "camera"]) this.showProblem(stage, "");
  }

  private problems = new Map<string, string>();

  private takeProblem(message: Incoming): void {
    if (["upload", "save", "focus"].includes(message.stage)) return this.tell(message.text, true);
    this.showProblem(message.stage, message.text);
    if (["lens", "camera", "layout"].includes(message.stage)) {
      this.layout.stale();
      this.psf.stale();
      this.picture.stale();
      this.answered();
      delete document.body.dataset.busy;
    }
    if (message.stage === "psf") this.psf.stale();
    if (["preview", "picture", "finest"].includes(message.stage)) this.picture.stale();
    if (message.stage.startsWith("plot:")) {
      this.plots.delete(message.stage.slice(5));
      this.drawPlot(message.text);
    }
  }

  /** What is wrong stays until it is right: the first stage that failed tells why. */
  private showProblem(stage: string, text: string): void {
    if (text) this.problems.set(stage, text);
    else this.problems.delete(stage);
    const order = ["lens", "camera", "layout", "preview", "picture", "finest", "psf"];
    const worst = order.find(each => this.problems.has(each));
    this.banner.textContent = worst ? this.problems.get(worst)! : "";
    document.body.classList.toggle("has-problem", worst !== undefined);
  }

  private took(message: Incoming): void {
    if (message.stage === "preview") for (const later of ["picture", "finest"]) this.times.delete(later);  // of what is no more
    this.times.set(message.stage, message.ms);
    this.showProblem(message.stage, message.stage === "layout" ? this.problems.get("layout") ?? "" : "");
    if (this.timesWaiting) return;
    this.timesWaiting = true;
    const glance_ms = 150;  // nobody reads numbers that change with every frame
    setTimeout(() => this.showTimes(), glance_ms);
  }
  private timesWaiting = false;

  private showTimes(): void {
    this.timesWaiting = false;
    const names: [string, string][] = [["layout", "rays"], ["psf", "PSF"], ["preview", "preview"], [`plot:${this.session.plot}`, "plot"], ["picture", "full"], ["finest", "finest"]];
    this.timing.replaceChildren(...names.filter(([stage]) => this.times.has(stage)).map(([stage, name]) =>
      h("span", {}, h("i", {}, name), `${shown(this.times.get(stage)!, 3)} ms`)));
  }

  private takeFile(message: Incoming, bytes: Uint8Array): void {
    this.saving.delete(message.id!);
    this.download(new Blob([bytes.slice()]), `${this.fileName()}${message.extension}`);
    if ([".zmx", ".seq"].includes(message.extension) && this.session.lens.surfaces.some(each => each.coating))
      this.tell(`a ${message.extension} file does not hold coatings; .json does`);
  }

  private reporting = false;  ///< once all is shown
  private saveReport(): void {
    this.reporting = false;
    const layout = this.layout.element.querySelector("svg");
    if (!layout) return this.tell("there is no lens to be reported", true);
    const plots = shownPlots.flatMap(([name, title]): [string, Incoming][] => this.plots.has(name) ? [[title, this.plots.get(name)!]] : []);
    const report = reportOf({title: this.session.lens.name || this.session.lensName, command: this.command.textContent ?? "", lens: this.session.lens, facts: this.facts, layout,
      picture: this.picture.canvas, pictureCaption: `${this.session.scene} on ${this.session.sensor}: ${this.picture.badge.title}`, psf: this.psf.canvas, psfCaption: this.psf.facts.textContent ?? "", plots});
    this.download(report, `${this.fileName()}-report.html`);
  }

  // ---- files, keys, messages -------------------------------------------------------------------------------------

  private fileName(): string { return this.session.lensName.replace(/[^\w.-]+/g, "-") || "lens"; }

  private download(blob: Blob, name: string): void {
    const url = URL.createObjectURL(blob);
    h("a", {href: url, download: name}).click();
    setTimeout(() => URL.revokeObjectURL(url), 10_000);
    this.tell(`saved ${name}`);
  }

  /** One file, or a spectral one and what is read with it. */
  private async upload(files: File[]): Promise<void> {
    const most_mib = 64, [file, companion] = withCompanion(files);
    if (!file) return;
    if (files.length > 2 || (files.length === 2 && !companion)) return this.tell("one file at a time, or an ENVI .hdr with its numbers, or a .npy with its .json", true);
    if (files.reduce((sum, each) => sum + each.size, 0) > most_mib * 1024 * 1024) return this.tell(`${file.name}: is too large; ${most_mib} MiB are the most`, true);
    if (file.name.endsWith(".json") && file.size < 1e6) {
      try {
        const read = JSON.parse(await file.text());
        if (read.petzval_session === 1) return this.start(this.checked(read as Session));
      } catch { /* the server says what is wrong with it */ }
    }
    const id = ++this.id, header = {kind: "upload" as const, id, name: file.name, ...companion ? {companion: companion.name, companion_bytes: companion.size} : {}};
    const dropped = {header, bytes: new Blob(companion ? [file, companion] : [file])};
    this.uploads.set(id, dropped);
    void this.link.upload(dropped);
  }

  private copy(text: string, done: string): void {
    navigator.clipboard.writeText(text).then(() => this.tell(done), () => this.tell("the browser does not let this page copy", true));
  }

  private tell(text: string, bad = false): void {
    const note = h("div", {class: bad ? "note bad" : "note"}, text);
    this.message.append(note);
    setTimeout(() => note.remove(), bad ? 9000 : 4000);
  }

  private toggleTheme(): void {
    const root = document.documentElement;
    const dark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    root.dataset.theme = dark ? "light" : "dark";
    localStorage.setItem("petzval-theme", root.dataset.theme);
  }

  /** The sensor to where this place of the picture is sharpest. */
  private focusAt(x_mm: number, y_mm: number): void {
    this.link.send({kind: "focus", id: ++this.id, place_mm: [x_mm, y_mm]});
  }

  private chooseScene(scene: string): void {
    this.lastPicture = null;
    this.change(() => { this.session.scene = scene; });
    // On what stands below the middle of a scene of three dimensions, as soon as it is seen.
    this.focusNext = this.isSolid && this.session.focus !== "distance";
    this.buildControls();
  }
  private focusNext = false;

  /** As far as what was clicked on, in a scene of three dimensions. */
  private takeDistance(distance_m: number): void {
    this.change(() => {
      this.session.focus = "distance";
      this.session.focus_m = Number(distance_m.toPrecision(4));
      this.session.defocus_mm = 0;
    });
    this.buildControls();
  }

  private get isSolid(): boolean { return (this.welcome?.solid_scenes ?? []).includes(this.session.scene); }

  private takeFocus(shift_mm: number): void {
    const most_mm = 100, there = Number((this.session.defocus_mm + shift_mm).toFixed(4));
    if (Math.abs(there) > most_mm) return this.tell("nothing is sharp there within reach of the sensor", true);
    this.change(() => { this.session.defocus_mm = there; });
  }

  /** Beside the lens as it was read, to begin with. */
  private toggleCompare(): void {
    this.change(() => { this.session.compared = this.session.compared ? null : {name: this.session.lensName, lens: uncoated(this.session.base)}; });
  }

  private takeCompared(name: string, lens: Lens): void {
    if (this.session.compared?.name !== name || this.session.compared.lens) return;
    this.session.compared.lens = lens;
    this.history.complete(JSON.stringify(this.session));
    this.refresh();
    this.ask();
  }

  private toggleBefore(): void {
    const kept = this.picture.toggleBefore(this.session.lensName);
    this.beforeButton.setAttribute("aria-pressed", String(kept));
  }

  private key(event: KeyboardEvent): void {
    const field = event.target instanceof HTMLInputElement && event.target.type === "text" || event.target instanceof HTMLSelectElement;
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" && !field) {
      event.preventDefault();
      return this.step(event.shiftKey ? this.history.redo() : this.history.undo());
    }
    if (field || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "b") this.toggleBefore();
    if (event.key === "c") this.toggleCompare();
    if (event.key === "f") this.focusAt(...this.session.cursor_mm);
    if (event.key === "d") this.toggleTheme();
    const tab = shownPlots[Number(event.key) - 1];
    if (tab) this.change(() => { this.session.plot = tab[0]; }, "plot");
  }

  private drawPlot(problem = ""): void {
    const plots = this.plots.get(this.session?.plot);
    const ofGhosts = this.session?.plot === "ghosts" ? [this.ghosts, JSON.stringify(this.session.stray.ghost)] : [];
    const other = this.session?.compared && this.compare.plots?.analysis === this.session.plot ? this.compare.plots : null;
    const drawn = [plots, other, this.plotSize, ...ofGhosts];
    if (plots && drawn.length === this.drawnPlot.length && drawn.every((each, i) => each === this.drawnPlot[i])) return;
    this.drawnPlot = drawn;
    if (plots && ofGhosts.length > 0) return this.drawGhosts(plots);
    if (plots && other) return this.drawBoth(plots, other);
    if (plots) return drawPlots(this.plotBox, plots.plots as PlotData[], plots.across);
    this.plotBox.replaceChildren(h("p", {class: "nothing"}, problem || "…"));
  }

  /** One below the other, for the same analysis of both lenses. */
  private drawBoth(plots: Incoming, other: Incoming): void {
    const half = (caption: string) => h("div", {class: "half"}, h("h3", {}, caption), h("div", {class: "half-plot"}));
    const [here, there] = [half(this.session.lensName), half(this.session.compared!.name)];
    this.plotBox.replaceChildren(here, there);
    for (const [box, drawn] of [[here, plots], [there, other]] as [HTMLElement, Incoming][])
      drawPlots(box.querySelector<HTMLElement>(".half-plot")!, drawn.plots as PlotData[], drawn.across);
  }

  private drawGhosts(plots: Incoming): void {
    const plot = h("div", {class: "ghost-plot"}), scrolled = this.plotBox.querySelector(".ghost-box")?.scrollTop ?? 0;
    const table = ghostTable(this.ghosts, this.session.stray.ghost, pair => this.change(() => { this.session.stray.ghost = pair; }));
    this.plotBox.replaceChildren(plot, table);
    drawPlots(plot, plots.plots as PlotData[], plots.across);
    table.scrollTop = scrolled;
  }

  private plotSize = "";
  private drawnPlot: unknown[] = [];  ///< what drawPlot() drew last, and in how many pixels

  private startExercise(exercise: (typeof exercises)[number]): void {
    const id = ++this.id;
    this.link.send({kind: "lens", id, name: exercise.lens});
    this.change(() => { this.session.plot = exercise.plot; }, "plot");
    if (exercise.scene) this.change(() => { this.session.scene = exercise.scene!; });
  }
}

new Page();
