#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Media beside Mitsuba 3 (PyPI): mean radiance of three small scenes at three wavelengths, and the pictures side by side.

    python3 bench/media_beside.py build/release/bin/petzval [--spp 64] [--seeds 4] [--pictures FOLDER]

Coefficients differ from wavelength to wavelength; lights and surfaces are grey. `fog`: a lamp and a ball in a globe of
fog. `cloud`: a grid of density under sun and sky. `milk`: a glass ball full of what scatters forwards. Mitsuba takes the
three wavelengths for its red, green and blue (`scalar_rgb`, `volpathmis`, sampler `independent`, box filter). What is
printed are means over the picture with their standard errors over the seeds, and their ratio."""

import argparse
import pathlib
import subprocess
import tempfile

import numpy as np

SIZE, DEPTH, WAVELENGTHS = (64, 48), 100, (450, 550, 650)
EYE, TARGET, FOV = (0, 0.6, -4.5), (0, 0, 0), 40
CELLS = 12


def density():
    """Lumps that fall to 0 at the border of the grid, z slowest."""
    at = (np.arange(CELLS) + 0.5) / CELLS * 2 - 1
    z, y, x = np.meshgrid(at, at, at, indexing="ij")
    inside = np.maximum(0, 1 - (x * x + y * y + z * z))
    grid = inside * (1 + 0.8 * np.sin(5 * x) * np.sin(4 * y + 1) * np.cos(6 * z))
    grid[[0, -1]] = grid[:, [0, -1]] = grid[:, :, [0, -1]] = 0
    return grid


#            absorption        scattering          g
MEDIA = {"fog": ((0.02, 0.1, 0.3), (0.2, 0.6, 1.0), 0.3),
         "cloud": ((0.1, 0.3, 1.0), (8.0, 5.0, 3.0), 0.6),
         "milk": ((0.01, 0.05, 0.3), (3.0, 4.0, 5.0), 0.8)}


def pbrt(name, folder):
    absorption, scattering, g = MEDIA[name]
    table = lambda values: " ".join(f"{nm} {v}" for nm, v in zip(WAVELENGTHS, values))
    grey = lambda v: f"[ 300 {v} 900 {v} ]"
    kind = "uniformgrid" if name == "cloud" else "homogeneous"
    medium = (f'MakeNamedMedium "m" "string type" "{kind}" "spectrum sigma_a" [ {table(absorption)} ] '
              f'"spectrum sigma_s" [ {table(scattering)} ] "float g" {g}')
    if name == "cloud":
        medium += f' "point3 p0" [ -1 -1 -1 ] "point3 p1" [ 1 1 1 ] "integer nx" {CELLS} "integer ny" {CELLS} "integer nz" {CELLS} "float density" [ '
        medium += " ".join(f"{v:.6g}" for v in density().ravel()) + " ]"
    text = [f"LookAt {EYE[0]} {EYE[1]} {EYE[2]} {TARGET[0]} {TARGET[1]} {TARGET[2]} 0 1 0", f'Camera "perspective" "float fov" {FOV}',
            f'Film "rgb" "integer xresolution" {SIZE[0]} "integer yresolution" {SIZE[1]}', f'Integrator "volpath" "integer maxdepth" {DEPTH}',
            "WorldBegin", medium, f'LightSource "infinite" "spectrum L" {grey(0.2)}']
    if name == "fog":
        text += ["AttributeBegin", 'MediumInterface "m" ""', 'Material "interface"', 'Shape "sphere" "float radius" 1.6', "AttributeEnd",
                 'MediumInterface "m" "m"', f'Material "diffuse" "spectrum reflectance" {grey(0.6)}',
                 'AttributeBegin', "Translate -0.5 -0.3 0", 'Shape "sphere" "float radius" 0.4', "AttributeEnd",
                 f'AttributeBegin\nAreaLightSource "diffuse" "spectrum L" {grey(20)}\nTranslate 0.6 0.4 0.2', 'Shape "sphere" "float radius" 0.15', "AttributeEnd"]
    else:
        if name == "cloud":
            text.append(f'LightSource "distant" "spectrum L" {grey(3)} "point3 from" [ -1 2 -1 ] "point3 to" [ 0 0 0 ]')
        else:
            text += [f'AttributeBegin\nAreaLightSource "diffuse" "spectrum L" {grey(10)}\nTranslate -1.5 2 -1', 'Shape "sphere" "float radius" 0.4', "AttributeEnd"]
        material = 'Material "interface"' if name == "cloud" else 'Material "dielectric" "float eta" 1.5'
        text += ["AttributeBegin", 'MediumInterface "m" ""', material, 'Shape "sphere" "float radius" 1', "AttributeEnd",
                 f'Material "diffuse" "spectrum reflectance" {grey(0.5)}',
                 'Shape "trianglemesh" "point3 P" [ -5 -1.2 -5  -5 -1.2 5  5 -1.2 5  5 -1.2 -5 ] "integer indices" [ 0 1 2 0 2 3 ]']
    path = folder / f"{name}.pbrt"
    path.write_text("\n".join(text) + "\n")
    return path


def by_petzval(program, name, folder, seed, samples):
    out = folder / "out.npy"
    subprocess.run([program, "render", pbrt(name, folder), "--absolute-spectra", "--wavelengths", ",".join(map(str, WAVELENGTHS)),
                    "--spp", str(samples), "--seed", str(seed), "--quiet", "-o", out], check=True)
    picture = np.load(out)
    return np.moveaxis(picture, 0, -1) if picture.shape[0] == 3 else picture


def mitsuba_scene(mi, name):
    absorption, scattering, g = (np.array(v) for v in MEDIA[name])
    rgb = lambda v: {"type": "rgb", "value": [float(x) for x in np.broadcast_to(v, 3)]}
    extinction = absorption + scattering
    at = mi.ScalarTransform4f
    phase = {"type": "hg", "g": float(g)}
    if name == "cloud":
        colours = density()[..., None] * extinction / extinction.max()
        sigma = {"type": "gridvolume", "grid": mi.VolumeGrid(colours.astype(np.float32)), "raw": True,
                 "to_world": at().translate([-1, -1, -1]).scale([2, 2, 2])}
        albedo = {"type": "constvolume", "value": rgb(scattering / extinction)}
        medium = {"type": "heterogeneous", "sigma_t": sigma, "albedo": albedo, "scale": float(extinction.max()), "phase": phase}
    else:
        medium = {"type": "homogeneous", "sigma_t": rgb(extinction / extinction.max()), "scale": float(extinction.max()),
                  "albedo": rgb(scattering / extinction), "phase": phase}
    scene = {"type": "scene", "integrator": {"type": "volpathmis", "max_depth": DEPTH + 1, "rr_depth": 1000},
             "sensor": {"type": "perspective", "fov": FOV, "fov_axis": "smaller", "to_world": at().look_at(EYE, TARGET, [0, 1, 0]),
                        "film": {"type": "hdrfilm", "width": SIZE[0], "height": SIZE[1], "rfilter": {"type": "box"}},
                        "sampler": {"type": "independent"}},
             "sky": {"type": "constant", "radiance": rgb(0.2)}, "m": medium}
    inside = {"type": "ref", "id": "m"}
    if name == "fog":
        scene["globe"] = {"type": "sphere", "radius": 1.6, "bsdf": {"type": "null"}, "interior": inside}
        scene["ball"] = {"type": "sphere", "center": [-0.5, -0.3, 0], "radius": 0.4, "bsdf": {"type": "diffuse", "reflectance": rgb(0.6)}, "exterior": inside}
        scene["lamp"] = {"type": "sphere", "center": [0.6, 0.4, 0.2], "radius": 0.15, "bsdf": {"type": "diffuse", "reflectance": rgb(0.6)},
                         "emitter": {"type": "area", "radiance": rgb(20)}, "exterior": inside}
        return scene
    if name == "cloud":
        scene["sun"] = {"type": "directional", "direction": [1, -2, 1], "irradiance": rgb(3)}
    else:
        scene["lamp"] = {"type": "sphere", "center": [-1.5, 2, -1], "radius": 0.4, "emitter": {"type": "area", "radiance": rgb(10)},
                         "bsdf": {"type": "diffuse", "reflectance": rgb(0.5)}}
    bsdf = {"type": "null"} if name == "cloud" else {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}
    scene["globe"] = {"type": "sphere", "radius": 1.0, "bsdf": bsdf, "interior": inside}
    scene["floor"] = {"type": "rectangle", "to_world": at().translate([0, -1.2, 0]).rotate([1, 0, 0], -90).scale([5, 5, 1]),
                      "bsdf": {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": rgb(0.5)}}}
    return scene


def by_mitsuba(mi, name, seed, samples):
    scene = mi.load_dict(mitsuba_scene(mi, name), optimize=False)
    return np.array(mi.render(scene, seed=seed, spp=samples))


def write_side_by_side(path, ours, theirs):
    white = np.percentile(ours, 99.5)
    both = np.concatenate([ours, theirs], 1)[..., ::-1]  # the longest wavelength is red
    eight = (255 * np.clip(both / white, 0, 1) ** (1 / 2.2)).astype(np.uint8)
    path.write_bytes(b"P6 %d %d 255\n" % (eight.shape[1], eight.shape[0]) + eight.tobytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("petzval")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--scenes", default="fog,cloud,milk")
    parser.add_argument("--pictures", type=pathlib.Path)
    options = parser.parse_args()
    import mitsuba as mi
    mi.set_variant("scalar_rgb")
    for name in options.scenes.split(","):
        with tempfile.TemporaryDirectory() as folder:
            ours = np.array([by_petzval(options.petzval, name, pathlib.Path(folder), s, options.spp) for s in range(1, options.seeds + 1)])
        theirs = np.array([by_mitsuba(mi, name, s, options.spp) for s in range(1, options.seeds + 1)])
        if options.pictures:
            write_side_by_side(options.pictures / f"{name}.ppm", ours.mean(0), theirs.mean(0))
        for band, nm in enumerate(WAVELENGTHS):
            means = [each[..., band].mean((1, 2)) for each in (ours, theirs)]
            (a, da), (b, db) = ((m.mean(), m.std(ddof=1) / np.sqrt(len(m))) for m in means)
            print(f"{name:6} {nm} nm  petzval {a:.5f} +- {da:.5f}  mitsuba {b:.5f} +- {db:.5f}  ratio {a / b:.4f} +- {np.hypot(da / a, db / b):.4f}", flush=True)


if __name__ == "__main__":
    main()
