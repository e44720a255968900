# SPDX-License-Identifier: BSD-3-Clause
"""The Cornell box with its measured lamp and walls, through the telephone's lens."""
import json
import re
from statistics import median

from .files import npy, spectra_of
from .sensor import BLACK_DN, calibrated, description

NM = (450, 500, 550, 600, 650, 700)


def box_scene(folder, patch_x=None):
    """The Cornell box with its measured lamp and walls; a white square of 5 cm at x on the floor, or the two blocks."""
    spectra = spectra_of(folder / "box_spectra.csv")

    def words(name):
        return " ".join(f"{nm:g} {value:.6g}" for nm, value in spectra[name] if 390 <= nm <= 720)
    walls = {"LeftWall": "red_wall", "RightWall": "green_wall"}
    scene = ["LookAt 0 0.105 -0.4  0 0.105 0.6  0 1 0", 'Camera "perspective" "float fov" 50',
             'Film "rgb" "integer xresolution" 400 "integer yresolution" 300 "float diagonal" 7.056',
             'Integrator "path" "integer maxdepth" 12', "WorldBegin"]
    text = (folder / "CornellBoxReference_geometry.pbrt").read_text()
    for name in sorted(set(re.findall(r'NamedMaterial "(\w+)"', text))):
        scene.append(f'MakeNamedMaterial "{name}" "string type" "diffuse" "spectrum reflectance" [ {words(walls.get(name, "white_wall"))} ]')
    scene.append('NamedMaterial "TopWall"')
    text = re.sub(r"(#ObjectName AreaLight[^\n]*\n\s*)", rf'\1AreaLightSource "diffuse" "spectrum L" [ {words("lamp")} ] Translate 0 -0.006 0 ', text)
    text = re.sub(r"(#ObjectName CubeLarge[^\n]*\n\s*)", r"\1Translate 0.005 0 0 ", text)
    if patch_x is not None:
        parts = re.split(r"(?=AttributeBegin\s*#ObjectName)", text)
        text = "".join(part for part in parts if "#ObjectName Cube" not in part)
        text += (f'NamedMaterial "BackWall"\nShape "bilinearmesh" "point3 P" [ {patch_x - 0.025} 0.02 0 {patch_x + 0.025} 0.02 0 '
                 f"{patch_x - 0.025} 0.07 0 {patch_x + 0.025} 0.07 0 ]\n")
    return "\n".join(scene) + "\n" + text


def mean_of(picture, top, bottom, left, right):
    cells = [picture[r][c] for r in range(top, bottom) for c in range(left, right)]
    return [sum(values) / len(cells) for values in zip(*cells)]


class Box:
    """Pictures of the box, 200 x 150 pixels of the whole field, through a lens that is focused at 0.5 m."""

    def __init__(self, phone, folder, page):
        self.phone, self.folder, self.page = phone, folder, page

    def render(self, name, lens, patch_x=None, *options):
        scene = self.page.folder / f"{name}.pbrt"
        scene.write_text(box_scene(self.folder, patch_x))
        self.phone.run("render", scene, "--absolute-spectra", "--wavelengths", f"{NM[0]}:50:{NM[-1]}", "--size", "200x150", "--spp", 128,
                       "--lens", lens, "--focus", "0.5m", "-o", self.page.folder / f"{name}.npy", "-o", self.page.folder / f"{name}.png", *options)
        return npy(self.page.folder / f"{name}.npy")


def relative(ratio):
    return [value / ratio[NM.index(550)] for value in ratio]


def measured_on_white(folder):
    """Light of white things in the box over that of the lamp, 1 at 550 nm: what the data hold of interreflection."""
    spectra = spectra_of(folder / "measured_radiances.csv")

    def mean(*names):
        return [sum(dict(spectra[name])[nm] for name in names) / len(names) for nm in NM]
    lights = mean("cbox-lights-1", "cbox-lights-2")
    box = spectra_of(folder / "box_spectra.csv")
    target = [dict(box["illuminant"])[nm] / dict(box["lamp"])[nm] for nm in NM]
    wall = [a / b for a, b in zip(mean("cbox-whitebackwall-1", "cbox-whitebackwall-2"), lights)]
    return {"measured, white target over the lamp": relative(target), "measured, white wall over the lights": relative(wall)}


def shown(values):
    return " ".join(f"{nm}: {value:.3f}" for nm, value in zip(NM, values))


def white_back_wall(box):
    """The white back wall over the lamp, which a white surface alone would not colour."""
    picture = box.render("box", box.phone.lens)
    box.page.picture("box.png", "The box through the telephone's ray transfer.")
    lamp = dict(spectra_of(box.folder / "box_spectra.csv")["lamp"])
    places = {"high": (30, 50), "middle": (60, 80)}
    ours = {f"ours, back wall, {name}": relative([a / lamp[nm] for a, nm in zip(mean_of(picture, top, bottom, 90, 110), NM)])
            for name, (top, bottom) in places.items()}
    curves = ours | measured_on_white(box.folder)
    print("white surfaces in the box, light over that of the lamp, 1 at 550 nm")
    for name, values in curves.items():
        print(f"  {name:50} {shown(values)}")
    first = next(iter(ours.values()))
    off = {name: max(abs(a - b) for a, b in zip(first, values)) for name, values in curves.items() if name not in ours}
    print("  largest difference of ours, high on the wall: " + ", ".join(f"{value:.3f} ({name})" for name, value in off.items()))
    for nm in (450, 650, 700):
        k = NM.index(nm)
        target = curves["measured, white target over the lamp"][k]
        box.page.summary(f"white in the box over the lamp, {nm} over 550 nm", f"{first[k]:.3f}", "not in the data", f"{target:.3f}", f"{first[k] - target:+.3f}")
    box.page.plot("White surfaces in the box, over the lamp, 1 at 550 nm", "wavelength [nm]",
                  {name: list(zip(NM, values)) for name, values in curves.items()},
                  "Coloured walls colour white ones. Measured with a spectroradiometer by the authors; the data do not say where on the wall it looked, nor how the "
                  "target stood. Largest differences: " + ", ".join(f"{value:.3f} ({name})" for name, value in off.items())
                  + ". The published simulation's numbers are not in the data.")


def patch_beside_walls(box):
    """A white square beside the red wall, in the middle and beside the green one: light, and what the sensor makes of it."""
    sensor = box.page.folder / "box-sensor.json"
    # Pixels as large as those of the picture; their well is of no interest here.
    pixels = description("pixels of the picture", 200, 150, calibrated(box.folder)) | {"pitch_um": 7.056 / 250 * 1000}
    sensor.write_text(json.dumps(pixels))
    print("white square beside coloured walls, light over that in the middle of the box, 1 at 550 nm")
    seen, raw = {}, {}
    for name, x in (("left", -0.1), ("middle", 0.0), ("right", 0.1)):
        column = 100 + round(x / 0.4 * 4.35 / (7.056 / 250))
        light = box.page.folder / f"{name}.exr"
        seen[name] = mean_of(box.render(name, box.phone.lens, x, "-o", light), 94, 102, column - 5, column + 5)
        raw[name] = raw_colours(box, light, sensor, column)
        box.page.picture(f"{name}.png", f"The white square, {name}.")
    ratio = {name: relative([a / b for a, b in zip(seen[name], seen["middle"])]) for name in ("left", "right")}
    rows = []
    for name, place in (("left", "beside the red wall"), ("middle", "in the middle"), ("right", "beside the green wall")):
        r, g, b = raw[name]
        rows.append([place, f"{r / g:.3f}", f"{b / g:.3f}"])
        print(f"  {place:22} raw R/G {r / g:.3f}, B/G {b / g:.3f}" + (f"   {shown(ratio[name])}" if name in ratio else ""))
    for name, wall in (("left", "red"), ("right", "green")):
        box.page.summary(f"white square beside the {wall} wall over the middle, 650 over 550 nm", f"{ratio[name][NM.index(650)]:.3f}", "not in the data",
                         "not in the data", "")
    box.page.plot("White square beside coloured walls, over the middle, 1 at 550 nm", "wavelength [nm]",
                  {name: list(zip(NM, values)) for name, values in ratio.items()}, "Left is the red wall, right the green one.")
    box.page.table("The white square in raw numbers of the calibrated sensor", ["", "R/G", "B/G"], rows,
                   "Raw values of the telephone and of the published simulation are not in the data.")


def raw_colours(box, light, sensor, column):
    raw = light.with_suffix(".raw.npy")
    box.phone.run("sense", light, "--sensor", sensor, "--without", "shot,dark,read,dsnu,prnu", "-o", raw)
    rows, sums = npy(raw), [[], [], []]
    for r in range(94, 102):
        for c in range(column - 5, column + 5):
            sums[r % 2 + c % 2].append(rows[r][c][0] - BLACK_DN)
    # A path that meets the lamp by chance is bright: one pixel then says nothing of the square.
    return [median(each) for each in sums]


def glass_and_fit(box):
    """A lens of glass of the same field, and what is fitted to it."""
    fit = box.page.folder / "fit.json"
    box.phone.run("lens", "transfer", "m12-4mm", "--bands", "450,575,700", "--tolerance", "1e-3", "-o", fit)
    light = [mean_of(box.render(name, lens), 0, 150, 0, 200) for name, lens in (("glass", "m12-4mm"), ("fit", fit))]
    off = [b / a - 1 for a, b in zip(*light)]
    print("the box through m12-4mm and through a ray transfer fitted to it: light differs by " + " ".join(f"{value:+.1e}" for value in off))
    box.page.picture("fit.png", "The box through a ray transfer fitted to m12-4mm.")
