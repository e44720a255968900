// SPDX-License-Identifier: BSD-3-Clause
// What is on the bench, and its history.

/** A material as lens files have it: a name, or numbers; absent: air. */
export type Glass = string | {[key: string]: unknown};

export interface Surface {
  radius_mm: number | null;
  thickness_mm: number;
  glass?: Glass;
  stop?: boolean;
  semi_diameter_mm?: number;
  coating?: string;  ///< a bundled one; what else a lens file may say of a surface stays as it is
  conic?: number;
  asphere?: Record<string, number>;
  [key: string]: unknown;
}

/** A lens in the native format, "petzval-lens/1". */
export interface Lens {
  name: string;
  object_distance_mm: number | null;
  aperture: Record<string, number>;
  fields: {type: string; values: number[]};
  wavelengths_nm: number[];
  reference_wavelength_nm: number;
  surfaces: Surface[];
  [key: string]: unknown;
}

/** Whether light passes between air and glass there, which is where films lie. */
export function isCoatable(lens: Lens, i: number): boolean {
  const surface = lens.surfaces[i];
  return !surface.mirror && (surface.glass === undefined) !== (i === 0 || lens.surfaces[i - 1].glass === undefined);
}

/** Coats a surface; null: bare. */
export function coat(lens: Lens, i: number, coating: string | null): void {
  if (coating === null) delete lens.surfaces[i].coating;
  else lens.surfaces[i].coating = coating;
}

/** The lens as its file has it, without the coatings that the page keeps at its surfaces. */
export function uncoated(lens: Lens): Lens {
  return {...lens, surfaces: lens.surfaces.map(({coating, ...surface}) => (typeof coating === "string" || coating === undefined ? surface : {...surface, coating}) as Surface)};
}

/** The bundled coating that all surfaces between air and glass have; null: they are bare, or not alike. */
export function commonCoating(lens: Lens): string | null {
  const coats = lens.surfaces.filter((each, i) => isCoatable(lens, i) || each.coating !== undefined).map(each => each.coating);
  return coats[0] !== undefined && coats.every(each => each === coats[0]) ? coats[0] : null;
}

/** A number of the lens that has a slider: its path in the file, and its range. */
export interface Pin {
  path: string;
  from: number;
  to: number;
}

export interface Shot {
  exposure: string;
  compensation_ev: number;
  noise: boolean;
  denoise: number;
  sharpen: number;
  tone: string;
}

/** A sun or a lamp, far away. */
export interface Sun {
  deg: [number, number];  ///< to the right and up
  lx: number;  ///< at the lens
}

export const mostSuns = 16, sunlight_lx = 100000;

/** Light that goes astray: as the server is told. */
export interface Stray {
  suns: Sun[];
  sun: number;  ///< which of them is chosen: its light shows the way of a ghost
  ghosts: boolean;  ///< of suns and of what the scene holds
  starburst: boolean;
  threshold: number;  ///< times the mean of the scene, above which it holds a source
  roughness_nm: number;  ///< 0: nothing scatters
  ghost: [number, number] | null;  ///< whose way the layout shows
}

export const usualStray: Stray = {suns: [], sun: 0, ghosts: false, starburst: false, threshold: 100, roughness_nm: 0, ghost: null};

/** Where on the sensor light from infinity lands: pairs of the tangent of its angle from the axis and its height [mm]. */
export type Sky = [number, number][];

/** A curve through points whose abscissae grow; straight beyond the last. */
function along(points: [number, number][], x: number): number {
  let i = 1;
  while (i + 1 < points.length && points[i][0] < x) ++i;
  const [x0, y0] = points[i - 1], [x1, y1] = points[i];
  return y0 + (y1 - y0) * (x - x0) / (x1 - x0);
}

const radian = Math.PI / 180;

export function placeOfSun(sky: Sky, deg: [number, number]): [number, number] | null {
  if (sky.length < 2) return null;
  const x = Math.tan(deg[0] * radian), y = Math.tan(deg[1] * radian), far = Math.hypot(x, y);
  const scale = far > 0 ? along(sky, far) / far : 0;
  return [x * scale, y * scale];
}

export function sunAt(sky: Sky, x_mm: number, y_mm: number): [number, number] {
  const height = Math.hypot(x_mm, y_mm);
  const far = along(sky.map(([t, h]): [number, number] => [h, t]), height);
  const angle = (part: number) => {
    const most_deg = 79, deg = height > 0 ? Math.atan(far * part / height) / radian : 0;
    return Number(Math.min(most_deg, Math.max(-most_deg, deg)).toFixed(2));
  };
  return [angle(x_mm), angle(y_mm)];
}

export interface Session {
  lensName: string;
  base: Lens;  ///< as it was read
  lens: Lens;
  f_number: number | null;
  blades: number | null;  ///< of the stop; 0: it is round; null: as prescribed
  focus: string;  ///< "design", "auto", "infinity", "best-spot", "paraxial", or "distance"
  focus_m: number;
  distance_m: number | null;  ///< null: infinity
  defocus_mm: number;
  scene: string;
  illuminant: string;
  sensor: string;
  shot: Shot;
  stray: Stray;
  compared: {name: string; lens: Lens | null} | null;  ///< what is beside it; a lens of null is not read yet
  cursor_mm: [number, number];
  plot: string;
  pins: Pin[];
}

export function newSession(lensName: string, lens: Lens, scene: string, sensor: string): Session {
  return {
    lensName, base: lens, lens: copied(lens), f_number: null, blades: null, focus: "design", focus_m: 2, distance_m: null,
    defocus_mm: 0, scene, illuminant: "", sensor,
    shot: {exposure: "auto", compensation_ev: 0, noise: true, denoise: 0, sharpen: 0, tone: "none"},
    stray: copied(usualStray), compared: null, cursor_mm: [0, 0], plot: "mtf", pins: usualPins(lens),
  };
}

/** The widest air gaps inside a lens: what is most worth moving. */
function usualPins(lens: Lens): Pin[] {
  const gaps = lens.surfaces.map((surface, i) => ({i, surface})).slice(0, -1).filter(each => !each.surface.glass);
  gaps.sort((a, b) => b.surface.thickness_mm - a.surface.thickness_mm);
  return gaps.slice(0, 2).sort((a, b) => a.i - b.i).map(
      ({i, surface}) => pinAbout(`surfaces[${i}].thickness_mm`, surface.thickness_mm));
}

/** A range about a number that is wide enough to see something and narrow enough to aim. */
export function pinAbout(path: string, value: number): Pin {
  const half = value === 0 ? 1 : Math.abs(value) * (path.endsWith("radius_mm") ? 0.3 : 0.5);
  const tidy = (x: number) => Number(x.toPrecision(3));
  const from = tidy(value - half);
  return {path, from: path.endsWith("thickness_mm") && value >= 0 ? Math.max(0, from) : from, to: tidy(value + half)};
}

export function copied<T>(value: T): T {
  return JSON.parse(JSON.stringify(value)) as T;
}

/** "surfaces[4].thickness_mm" → ["surfaces", 4, "thickness_mm"] */
function steps(path: string): (string | number)[] {
  return path.split(/[.[\]]+/).filter(part => part !== "").map(part => /^\d+$/.test(part) ? Number(part) : part);
}

export function valueAt(lens: Lens, path: string): number | null {
  let at: any = lens;
  for (const step of steps(path)) at = at?.[step];
  return typeof at === "number" ? at : null;
}

export function setValue(lens: Lens, path: string, value: unknown): void {
  const all = steps(path);
  let at: any = lens;
  for (const step of all.slice(0, -1)) at = at[step] ??= {};
  const last = all[all.length - 1];
  if (value === undefined) delete at[last];
  else at[last] = value;
}

/** What `--set` would alter to make one lens of the other; null if surfaces came or went. */
export function settingsBetween(base: Lens, lens: Lens): string[] | null {
  if (base.surfaces.length !== lens.surfaces.length) return null;
  const found: string[] = [];
  let impossible = false;
  const compare = (a: any, b: any, path: string) => {
    if (JSON.stringify(a) === JSON.stringify(b)) return;
    const objects = a && b && typeof a === "object" && typeof b === "object" && Array.isArray(a) === Array.isArray(b);
    if (b === undefined) {
      // A key that is gone: there is no setting for that, but for a glass.
      impossible = true;
    } else if (objects && (!Array.isArray(a) || a.length === b.length)) {
      for (const key of new Set([...Object.keys(a), ...Object.keys(b)]))
        compare(a[key], b[key], Array.isArray(a) ? `${path}[${key}]` : path ? `${path}.${key}` : key);
    } else {
      found.push(`${path}=${JSON.stringify(b)}`);
    }
  };
  compare(base, lens, "");
  return impossible ? null : found;
}

/** States that can be gone back to. A gesture of many moves is one step. */
export class History {
  private past: string[] = [];
  private future: string[] = [];
  constructor(private now: string) {}

  /** After a change; `gesture`: the same as that of the change before, or "" for one that stands alone. */
  private gesture = "";
  record(state: string, gesture = ""): void {
    if (state === this.now) return;
    if (gesture === "" || gesture !== this.gesture) {
      this.past.push(this.now);
      const most = 200;
      if (this.past.length > most) this.past.shift();
    }
    this.gesture = gesture;
    this.future = [];
    this.now = state;
  }
  /** The state is as it was meant now: no step of its own. */
  complete(state: string): void { this.now = state; }
  endGesture(): void { this.gesture = ""; }
  get canUndo(): boolean { return this.past.length > 0; }
  get canRedo(): boolean { return this.future.length > 0; }
  undo(): string | null {
    const before = this.past.pop();
    if (before === undefined) return null;
    this.future.push(this.now);
    this.gesture = "";
    return this.now = before;
  }
  redo(): string | null {
    const after = this.future.pop();
    if (after === undefined) return null;
    this.past.push(this.now);
    this.gesture = "";
    return this.now = after;
  }
}

/** A session as a part of an address, and back. */
export async function packed(session: Session): Promise<string> {
  const stream = new Blob([JSON.stringify(session)]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}

export async function unpacked(text: string): Promise<Session> {
  const bytes = Uint8Array.from(atob(text.replace(/-/g, "+").replace(/_/g, "/")), c => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return JSON.parse(await new Response(stream).text()) as Session;
}
