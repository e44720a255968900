#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What `render --denoise-light` gains: error against a converged reference, with it and without, by samples a pixel.

    python3 bench/denoised_light.py build/release/bin/petzval [--reference 4096] [--pictures FOLDER] [scene...]

The error is the RMS over pixels and bands of (light − reference) over √(reference² + (a tenth of the band's mean)²), of
160 x 120 pixels in eight bands. `samples` is how many a pixel the picture as it comes needs for the same error, by
interpolation between those that were rendered. `light` is the sum of the picture over that of the reference. `CPU` is
that of the program in seconds. --pictures writes each reference, 16 samples as they come, and denoised, side by side."""

import argparse
import pathlib
import resource
import subprocess
import tempfile

import numpy as np

FEW, MANY = (16, 64, 256), (16, 64, 256, 1024)
PHOTOGRAPH = pathlib.Path(__file__).resolve().parents[1] / "docs/pictures/render-vases.png"
TEXTURES = f"""LookAt 0 1.1 3.2  0 0.35 0  0 1 0
Camera "perspective" "float fov" 36
WorldBegin
LightSource "infinite" "rgb L" [ .06 .08 .12 ]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 9 8.5 8 ]
Translate 1.2 2.4 1.2
Rotate 90 1 0 0
Shape "disk" "float radius" .12
AttributeEnd
Texture "photograph" "spectrum" "imagemap" "string filename" "{PHOTOGRAPH}"
Texture "fine" "spectrum" "checkerboard" "float uscale" 60 "float vscale" 60 "rgb tex1" [ .75 .7 .6 ] "rgb tex2" [ .15 .2 .3 ]
Material "diffuse" "texture reflectance" "fine"
Shape "bilinearmesh" "point3 P" [ -3 0 3  3 0 3  -3 0 -2  3 0 -2 ] "point2 uv" [ 0 0 1 0 0 1 1 1 ]
Material "diffuse" "texture reflectance" "photograph"
Shape "bilinearmesh" "point3 P" [ -1.6 0 -1.2  1.6 0 -1.2  -1.6 1.5 -1.2  1.6 1.5 -1.2 ] "point2 uv" [ 0 0 1 0 0 1 1 1 ]
AttributeBegin
Material "conductor" "float roughness" .08
Translate -.55 .35 .2
Shape "sphere" "float radius" .35
AttributeEnd
AttributeBegin
Translate .45 .3 .3
Shape "sphere" "float radius" .3
AttributeEnd
AttributeBegin
Material "dielectric"
Translate 0 .15 .9
Shape "sphere" "float radius" .15
AttributeEnd
"""
SCENES = {"spheres, pinhole": ["spheres", "--pinhole"],
          "spheres, lens": ["spheres", "--lens", "dgauss-50mm", "--focus", "1.2m"],
          "lamps, lens": ["lamps", "--lens", "dgauss-50mm", "--focus", "0.6m", "--f-number", "2.8", "--blades", "6"],
          "textures, pinhole": ["textures.pbrt", "--pinhole"],
          "textures, lens": ["textures.pbrt", "--lens", "dgauss-50mm", "--focus", "2.4m"]}


def render(program, folder, scene, samples, *more, seed=1):
    """Light, rows x columns x bands, and the CPU time that it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program, "render", *SCENES[scene], "--wavelengths", "420:40:700", "--size", "160x120", "--spp", str(samples),
                    "--seed", str(seed), *more, "--quiet", "-o", "light.npy"], cwd=folder, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return np.load(folder / "light.npy").astype(float), after.ru_utime - before.ru_utime


def error(light, reference):
    least = 0.1 * reference.mean((0, 1))
    return np.sqrt(((light - reference) ** 2 / (reference ** 2 + least ** 2)).mean())


def shown(light, white):
    """Thirds of the bands as red, green and blue."""
    rgb = np.stack([third.mean(-1) for third in np.array_split(light, 3, -1)][::-1], -1)
    return np.clip(rgb / white, 0, 1) ** (1 / 2.2)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("scenes", nargs="*", choices=[[], *SCENES], default=[])
    parser.add_argument("--reference", type=int, default=4096)
    parser.add_argument("--pictures", type=pathlib.Path)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "textures.pbrt").write_text(TEXTURES)
        print(f"{'':18} {'spp':>4}  {'error':>6} {'denoised':>8}  {'samples':>7}  {'light':>6} {'denoised':>8}  {'CPU':>5} {'denoised':>8}")
        for scene in given.scenes or SCENES:
            reference, _ = render(given.program, folder, scene, given.reference, seed=99)
            plain = {samples: render(given.program, folder, scene, samples) for samples in MANY}
            errors = [error(plain[samples][0], reference) for samples in MANY]
            smooth = {samples: render(given.program, folder, scene, samples, "--denoise-light") for samples in FEW}
            for samples in FEW:
                light, seconds = smooth[samples]
                now = error(light, reference)
                equal = np.exp(np.interp(-np.log(now), -np.log(errors), np.log(MANY)))
                same = f"{'>' if now < errors[-1] else ''}{equal:.0f}"
                print(f"{scene:18} {samples:4}  {errors[MANY.index(samples)]:6.4f} {now:8.4f}  {same:>7}  "
                      f"{plain[samples][0].sum() / reference.sum():6.4f} {light.sum() / reference.sum():8.4f}  "
                      f"{plain[samples][1]:5.1f} {seconds:8.1f}", flush=True)
            if given.pictures:
                from PIL import Image

                given.pictures.mkdir(parents=True, exist_ok=True)
                white = np.percentile(reference.mean(-1), 99)
                row = np.concatenate([shown(each, white) for each in (reference, plain[16][0], smooth[16][0])], 1)
                Image.fromarray((255 * row).astype("uint8")).save(given.pictures / f"{scene.replace(', ', '-')}.png")


if __name__ == "__main__":
    main()
