# SPDX-License-Identifier: BSD-3-Clause
"""Rendered scenes for autofocus, and where they are sharpest.

TRUTH was found by brute force, with this command (some minutes), which prints it anew:

    PETZVAL_PROGRAM=build/release/bin/petzval PETZVAL_DATA=data python3 tests/cli/autofocus_scenes.py

That is `petzval focus --focus-search scan`: 21 film distances over two depths of focus about the peak at 256 paths a pixel (the searches
under test take 16), and the cubic that fits the logarithm of the measure best above four fifths of the peak. The scatter of the scan about
that cubic, some 3e-4, leaves the peak uncertain by about 0.01 depths.
"""

import json
import os
import pathlib
import subprocess
import tempfile

SINGLET = {
    "format": "petzval-lens/1", "name": "plano-convex singlet 50 mm f/2.5", "source": "made up: 2 mm of spherical aberration, 1 mm of colour",
    "aperture": {"entrance_pupil_diameter_mm": 20}, "fields": {"type": "angle_deg", "values": [0, 5]},
    "wavelengths_nm": [486.13, 587.56, 656.27], "reference_wavelength_nm": 587.56,
    "surfaces": [{"radius_mm": None, "thickness_mm": 1, "stop": True},
                 {"radius_mm": 25.84, "thickness_mm": 6, "glass": "SCHOTT:N-BK7", "semi_diameter_mm": 11},
                 {"radius_mm": None, "thickness_mm": 46, "semi_diameter_mm": 11}]}

HEAD = """Camera "perspective"
Film "rgb" "integer xresolution" 480 "integer yresolution" 320 "float diagonal" 43.27
WorldBegin
"""
SKY = 'LightSource "infinite" "rgb L" [ 1 1 1 ]\n'


def boards():
    """A material of checker boards of three sizes, one over the other: detail of every size."""
    text, before = "", None
    for i, scale in enumerate((211, 73, 23)):
        text += (f'Texture "c{i}" "spectrum" "checkerboard" "float uscale" {scale} "float vscale" {scale} '
                 '"rgb tex1" [ .9 .9 .9 ] "rgb tex2" [ .1 .1 .1 ]\n')
        if before:
            text += f'Texture "m{i}" "spectrum" "mix" "texture tex1" "{before}" "texture tex2" "c{i}" "float amount" {1 / (i + 1):.6f}\n'
        before = f"m{i}" if before else "c0"
    return text + f'MakeNamedMaterial "boards" "string type" "diffuse" "texture reflectance" "{before}"\n'


def wall(z, half, x=0, turn_deg=17):
    """Metres; turned, so that no edge runs along the pixels."""
    return (f'AttributeBegin\nNamedMaterial "boards"\nTranslate {x} 0 {z}\nRotate {turn_deg} 0 0 1\n'
            f'Shape "bilinearmesh" "point3 P" [ {-half} {-half} 0  {half} {-half} 0  {-half} {half} 0  {half} {half} 0 ]\nAttributeEnd\n')


LAMP = """AttributeBegin
AreaLightSource "diffuse" "float scale" 20
Translate 0.6 0.8 0.3
Shape "sphere" "float radius" 0.25
AttributeEnd
LightSource "infinite" "rgb L" [ .05 .05 .05 ]
"""

MIDDLE = ["0.4,0.6,0.4,0.6"]

# name: (scene, options, zones)
SCENES = {
    "near": (HEAD + SKY + boards() + wall(0.5, 0.25), ["--lens", "dgauss-50mm"], MIDDLE),
    "far": (HEAD + SKY + boards() + wall(20, 10), ["--lens", "dgauss-50mm"], MIDDLE),
    # A card at 0.9 m on the left, a wall at 3 m behind it: the larger zone decides.
    "two zones, the wall's larger": (HEAD + SKY + boards() + wall(3, 1.5) + wall(0.9, 0.19, -0.19, 3), ["--lens", "dgauss-50mm"],
                                     ["0.2,0.25,0.4,0.6", "0.6,0.75,0.4,0.7"]),
    "two zones, the card's larger": (HEAD + SKY + boards() + wall(3, 1.5) + wall(0.9, 0.19, -0.19, 3), ["--lens", "dgauss-50mm"],
                                     ["0.15,0.35,0.4,0.6", "0.6,0.65,0.4,0.5"]),
    "singlet": (HEAD + SKY + boards() + wall(2, 1), ["--lens", "singlet.json"], MIDDLE),
    "Petzval's lens, f/1.6": (HEAD + SKY + boards() + wall(3, 0.75), ["--lens", "petzval-lens"], MIDDLE),
    "telephoto": (HEAD + SKY + boards() + wall(12, 1.2), ["--lens", "telephoto-250mm"], MIDDLE),
    "noisy": (HEAD + LAMP + boards() + wall(1.2, 0.6), ["--lens", "dgauss-50mm", "--focus-spp", "4"], MIDDLE),
    # 19 um: the range is 200 depths of focus.
    "small pixels": (HEAD + SKY + boards() + wall(1, 0.12), ["--lens", "dgauss-50mm", "--size", "1920x1280"], ["0.47,0.53,0.47,0.53"]),
}

# Film distances [mm]
TRUTH = {
    "near": 42.4121,
    "far": 36.2613,
    "two zones, the wall's larger": 37.0532,
    "two zones, the card's larger": 39.3256,
    "singlet": 45.6292,
    "Petzval's lens, f/1.6": 18.8327,
    "telephoto": 109.6185,
    "noisy": 38.3964,
    "small pixels": 38.8876,
}


def write_scenes(folder):
    """The scenes as <number>.pbrt in their order, and the singlet."""
    folder = pathlib.Path(folder)
    (folder / "singlet.json").write_text(json.dumps(SINGLET))
    for number, (text, _, _) in enumerate(SCENES.values()):
        (folder / f"{number}.pbrt").write_text(text)


def arguments(name, *more):
    """Of petzval, to focus on a scene in the folder of write_scenes()."""
    _, options, zones = SCENES[name]
    if "--focus-spp" in more and "--focus-spp" in options:
        options = options[:options.index("--focus-spp")]  # it stands last
    given = ["focus", f"{list(SCENES).index(name)}.pbrt", *options]
    for zone in zones:
        given += ["--zone", zone]
    return [*given, "--quiet", *map(str, more)]


def brute_force(name, folder):
    def focus(*more):
        done = subprocess.run([os.path.abspath(os.environ["PETZVAL_PROGRAM"]), *arguments(name, *more), "--json"], cwd=folder,
                              stdout=subprocess.PIPE, check=True, text=True)
        return json.loads(done.stdout)

    about = focus()
    middle, depth = about["film_distance_mm"], about["depth_mm"]
    about = focus("--focus-search", "scan", "--focus-evaluations", 21, "--focus-from", middle - depth, "--focus-to", middle + depth,
                  "--focus-depth", depth, "--focus-spp", 256)
    if about["at_the_end"]:
        raise SystemExit(f"{name}: the search ended more than a depth of focus away from the peak of the scan")
    return about["film_distance_mm"]


if __name__ == "__main__":
    import sys
    os.environ["PETZVAL_DATA"] = os.path.abspath(os.environ["PETZVAL_DATA"])
    with tempfile.TemporaryDirectory() as scratch:
        write_scenes(scratch)
        for each in sys.argv[1:] or SCENES:
            print(f'    "{each}": {brute_force(each, scratch):.4f},', flush=True)
