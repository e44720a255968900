// SPDX-License-Identifier: BSD-3-Clause
// What the words on the page mean, with a drawing where one helps, and the card that shows it.
import {h, s} from "./dom";

interface Term {
  title: string;
  text: string;
  /** Lines of a drawing of 160 × 72: [class, path]. */
  drawing?: [string, string][];
}

const lensShape = "M60 10c10 16 10 36 0 52c-10-16-10-36 0-52z";

export const terms: Record<string, Term> = {
  "radius": {title: "Radius of curvature", text: "Of a surface at its vertex. Positive if the centre lies behind the surface, towards the sensor; empty for a plane.",
    drawing: [["glass", "M40 8c16 14 16 42 0 56h14V8z"], ["axis", "M4 36h152"], ["mark", "M52 36h70"], ["dot", "M122 34v4"]]},
  "thickness": {title: "Thickness", text: "From this vertex to the next along the axis, in millimetres. The last one reaches the sensor."},
  "glass": {title: "Glass", text: "What fills the gap behind the surface. Empty: air. Type a name, nd/Vd such as 1.62/60, or an index alone.", },
  "semi-diameter": {title: "Clear semi-diameter", text: "Rays farther than this from the axis are stopped by the rim. Empty: no rim."},
  "conic": {title: "Conic constant k", text: "0: a sphere. −1: a paraboloid. Below −1: a hyperboloid. Between −1 and 0: an ellipsoid."},
  "stop": {title: "Aperture stop", text: "The surface that limits the cone of light. Closing it makes the picture darker, the depth of field larger, and most aberrations smaller.",
    drawing: [["glass", lensShape], ["stop", "M86 4v20M86 48v20"], ["ray", "M4 22h56L86 28L140 36M4 50h56L86 44L140 36"]]},
  "f-number": {title: "f-number", text: "Focal length over the diameter of the entrance pupil. Twice the f-number is a quarter of the light."},
  "entrance-pupil": {title: "Entrance pupil", text: "The stop as it is seen from the front, through the glass before it: the window through which the lens collects light.",
    drawing: [["glass", lensShape], ["stop", "M86 4v18M86 50v18"], ["mark", "M40 8v12M40 52v12"], ["ray", "M4 20h36L60 22L86 24"]]},
  "exit-pupil": {title: "Exit pupil", text: "The stop as it is seen from the sensor, through the glass behind it. Light seems to come from there."},
  "efl": {title: "Focal length", text: "The effective focal length: an object at infinity at an angle θ is imaged at f·tan θ from the axis."},
  "petzval": {title: "Petzval radius", text: "Curvature of the image that a lens free of astigmatism would have. A flat sensor wants it large."},
  "focus": {title: "Focus", text: "Where the sensor stands: as the prescription has it, sharp where the scene is, sharp at a distance, or where spots are least."},
  "defocus": {title: "Sensor shift", text: "The sensor moved away from the lens after focusing. The depth of focus, to either side, is about twice the wavelength times the f-number squared.",
    drawing: [["glass", lensShape], ["ray", "M4 18h56L130 36L156 43M4 54h56L130 36L156 29"], ["mark", "M130 12v48"], ["stop", "M146 12v48"]]},
  "psf": {title: "Point-spread function", text: "The image of a point of light. The picture is the sum of these. Click on the picture to choose the place; the shape is turned as it lies there.",
    drawing: [["glass", lensShape], ["ray", "M4 36L60 18L150 40M4 36L60 54L150 32M4 36h146"], ["mark", "M150 20v32"]]},
  "mtf": {title: "Modulation transfer", text: "How much contrast of a sine pattern arrives, against its frequency in lines per millimetre. Tangential patterns (dashed) vary away from the axis, sagittal ones across."},
  "spots": {title: "Spot diagram", text: "Where rays of one point meet the sensor, all over the pupil, without diffraction. A perfect lens has a single dot."},
  "coma": {title: "Coma", text: "Zones of the pupil image a point off the axis with different magnifications: a comet that points to or from the axis.",
    drawing: [["glass", lensShape], ["ray", "M4 12L60 20L140 52M4 22L60 36L140 46M4 32L60 52L140 40"]]},
  "distortion": {title: "Distortion", text: "Straight lines bend because magnification changes with the field. Negative: barrel. Positive: pincushion.",
    drawing: [["mark", "M50 8q-10 28 0 56M110 8q10 28 0 56M50 8q30-8 60 0M50 64q30 8 60 0"]]},
  "illumination": {title: "Relative illumination", text: "Light at the corner of an even white wall over light in the middle: the cosine law, vignetting by rims, and distortion."},
  "field-curvature": {title: "Field curvature and astigmatism", text: "Where narrow bundles come to a focus, from the sensor. Tangential and sagittal foci that differ: astigmatism."},
  "fans": {title: "Ray fans", text: "Where a ray lands against where it crosses the pupil. A slope is defocus, a bowl coma, an S spherical aberration."},
  "colour": {title: "Colour errors", text: "Axial: colours focus at different depths. Lateral: they are magnified differently, which makes coloured edges in the corners."},
  "vignetting": {title: "Vignetting", text: "Rims other than the stop cut into the light of points off the axis."},
  "wavefront": {title: "Wavefront and Strehl ratio", text: "Deviation of the wave from a sphere, in wavelengths. A Strehl ratio of 0.8 and more counts as diffraction-limited."},
  "encircled-energy": {title: "Encircled energy", text: "Share of a point's light within a circle, against its radius."},
  "preview": {title: "Preview", text: "Few pixels, three wavelengths and a loose tolerance of the blur, so that it follows the hand. The full picture replaces it when the hand rests."},
  "exposure": {title: "Exposure", text: "More or less light than the automatic exposure takes, in stops: +1 doubles it."},
  "distance": {title: "Distance of the scene", text: "From the sensor. Where nobody says, the scene stands where the lens expects its object."},
  "coating": {title: "Coating", text: "Films on a surface between air and glass that keep it from reflecting. Bare glass reflects four to eight per cent; a quarter wave of magnesium fluoride one or two, three films less, and what is left has a colour."},
  "threshold": {title: "Bright sources", text: "What the scene holds that is brighter than so many times its mean makes ghosts and stars, as the sun does; the picture shows rings about it."},
  "sun": {title: "Suns and lamps", text: "Discs of 0.53° at infinity, of as many lux at the lens as you choose: 100,000 is the sun. Drag them in the picture, also out of the frame: their ghosts may stay in."},
  "blades": {title: "Blades", text: "The iris is a regular polygon of so many edges. It shows in what is out of focus, in stars and in ghosts."},
  "ghosts": {title: "Ghosts", text: "Light that two surfaces reflect, one back and the other on again, and that comes to the sensor after all: patches, often in the shape of the stop. Coatings make them fainter and give them a colour.",
    drawing: [["glass", "M52 10c8 16 8 36 0 52c-8-16-8-36 0-52z"], ["glass", "M98 10c8 16 8 36 0 52c-8-16-8-36 0-52z"], ["ray", "M4 20L96 34L54 44L150 62"], ["mark", "M150 8v56"]]},
  "starburst": {title: "Star", text: "What the edges of the stop diffract: a pair of rays across each edge of a stop with blades, rings for a round one."},
  "roughness": {title: "Roughness", text: "RMS roughness of all polished surfaces that do not say how they scatter. What they scatter is a halo about bright points and a veil over the picture. 0: nothing scatters."},
  "noise": {title: "Noise", text: "Photons arrive at random, and the sensor adds its own. Off: what an average of endless exposures would show."},
};

let card: HTMLElement | null = null;

function hide(): void {
  card?.remove();
  card = null;
}

function show(name: string, at: Element): void {
  hide();
  const term = terms[name];
  if (!term) return;
  card = h("div", {class: "term", role: "tooltip", id: "term"}, h("strong", {}, term.title));
  if (term.drawing)
    card.append(s("svg", {viewBox: "0 0 160 72", class: "term-drawing", "aria-hidden": "true"},
        ...term.drawing.map(([kind, d]) => s("path", {class: kind, d}))));
  card.append(h("p", {}, term.text));
  document.body.append(card);
  const place = at.getBoundingClientRect(), own = card.getBoundingClientRect(), gap = 8;
  const below = place.bottom + gap + own.height < innerHeight;
  card.style.left = `${Math.max(gap, Math.min(innerWidth - own.width - gap, place.left))}px`;
  card.style.top = `${Math.max(gap, below ? place.bottom + gap : place.top - gap - own.height)}px`;
}

/** Cards for every element that says data-term, on hover and on keyboard focus. */
export function explainTerms(): void {
  let timer = 0;
  const target = (event: Event) => (event.target as Element | null)?.closest?.("[data-term]") ?? null;
  document.addEventListener("pointerover", event => {
    clearTimeout(timer);
    const at = target(event);
    if (!at) return hide();
    timer = window.setTimeout(() => show(at.getAttribute("data-term")!, at), 450);
  });
  document.addEventListener("pointerdown", () => { clearTimeout(timer); hide(); });
  document.addEventListener("focusin", event => {
    const at = target(event);
    if (at && at.matches(":focus-visible") && at.classList.contains("term-mark")) show(at.getAttribute("data-term")!, at);
    else hide();
  });
  document.addEventListener("keydown", event => { if (event.key === "Escape") hide(); });
}
