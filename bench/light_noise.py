# SPDX-License-Identifier: BSD-3-Clause
"""Noise of rendered pictures at equal samples: six scenes, two builds of petzval, and Mitsuba 3 (PyPI) where it is there.

    python3 bench/light_noise.py build/release/bin/petzval [ANOTHER/petzval ...]

For each scene and program: pictures of as many samples with different seeds; of each pixel the variance over the seeds
over its squared mean (relative variance, of the light summed over bands); then the root of the mean over pixels (rms),
the root of the median, and the mean of all pictures with its standard error, which no sampler may change. Mitsuba renders
the scenes that are made here, which are grey; its means are those of its own path tracer (3.9.1, `path`, max_depth one
more than ours, sampler `independent`, box filter)."""

import argparse
import pathlib
import struct
import subprocess
import tempfile

import numpy as np

SIZE, SAMPLES, SEEDS, DEPTH = (96, 72), 16, 24, 6


# ---------------------------------------------------------------------------------------------------------- scenes
class Scene:
    """Quads, spheres and lights, all grey; as text for pbrt, and as a dictionary for Mitsuba."""

    def __init__(self, eye, target, fov):
        self.eye, self.target, self.fov, self.parts = eye, target, fov, []

    def quad(self, corner, along, across, reflectance=0.5, radiance=0.0):
        """Its light, if any, goes to the side of along x across."""
        self.parts.append(("quad", np.array(corner, float), np.array(along, float), np.array(across, float), reflectance, radiance))

    def sphere(self, centre, radius, reflectance=0.5, radiance=0.0):
        self.parts.append(("sphere", np.array(centre, float), radius, reflectance, radiance))

    def box(self, low, high, reflectance=0.5, skip=()):
        """Six quads that face inwards; `skip` names walls to leave out."""
        (a, b, c), (x, y, z) = low, high
        for name, quad in {"left": ((a, b, c), (0, y - b, 0), (0, 0, z - c)), "right": ((x, b, c), (0, 0, z - c), (0, y - b, 0)),
                           "floor": ((a, b, c), (0, 0, z - c), (x - a, 0, 0)), "ceiling": ((a, y, c), (x - a, 0, 0), (0, 0, z - c)),
                           "front": ((a, b, z), (0, y - b, 0), (x - a, 0, 0)), "back": ((a, b, c), (x - a, 0, 0), (0, y - b, 0))}.items():
            if name not in skip:
                self.quad(*quad, reflectance)

    def sky(self, radiance):
        self.parts.append(("sky", radiance))

    def sky_picture(self, radiances):
        """A function of unit directions (arrays x, y, z; y is up)."""
        self.parts.append(("picture", radiances))

    def pbrt(self, folder, scale=1.0):
        """`scale` of sky pictures: pbrt's are of the illuminant D65, in photometric units."""
        def numbers(v):
            return " ".join(f"{x:.9g}" for x in np.ravel(v))
        text = [f"LookAt {numbers(self.eye)} {numbers(self.target)} 0 1 0", f'Camera "perspective" "float fov" {self.fov}',
                f'Film "rgb" "integer xresolution" {SIZE[0]} "integer yresolution" {SIZE[1]}',
                f'Integrator "path" "integer maxdepth" {DEPTH}', "WorldBegin"]
        for part in self.parts:
            kind = part[0]
            if kind == "sky":
                text.append(f'LightSource "infinite" "spectrum L" [ 300 {part[1]} 900 {part[1]} ]')
                continue
            if kind == "picture":
                write_exr(folder / "sky.exr", octahedral(part[1], 256))
                text.append(f'LightSource "infinite" "string filename" "sky.exr" "float scale" {scale}')
                continue
            reflectance, radiance = part[-2:]
            text.append("AttributeBegin")
            if radiance:
                text.append(f'AreaLightSource "diffuse" "spectrum L" [ 300 {radiance} 900 {radiance} ]')
            text.append(f'Material "diffuse" "spectrum reflectance" [ 300 {reflectance} 900 {reflectance} ]')
            if kind == "sphere":
                text.append(f'Translate {numbers(part[1])}\nShape "sphere" "float radius" {part[2]}')
            else:
                o, a, b = part[1:4]
                text.append(f'Shape "trianglemesh" "point3 P" [ {numbers([o, o + a, o + a + b, o + b])} ] "integer indices" [ 0 1 2 0 2 3 ]')
            text.append("AttributeEnd")
        path = folder / "scene.pbrt"
        path.write_text("\n".join(text) + "\n")
        return path

    def mitsuba(self, mi):
        scene = {"type": "scene", "integrator": {"type": "path", "max_depth": DEPTH + 1, "rr_depth": 100},
                 "sensor": {"type": "perspective", "fov": self.fov, "fov_axis": "smaller",
                            "to_world": mi.ScalarTransform4f().look_at(list(self.eye), list(self.target), [0, 1, 0]),
                            "film": {"type": "hdrfilm", "width": SIZE[0], "height": SIZE[1], "rfilter": {"type": "box"}},
                            "sampler": {"type": "independent"}}}
        for i, part in enumerate(self.parts):
            kind = part[0]
            if kind == "sky":
                scene[f"p{i}"] = {"type": "constant", "radiance": part[1]}
                continue
            if kind == "picture":
                values = np.repeat(latitudes(part[1], 512)[:, :, None], 3, 2).astype(np.float32)
                scene[f"p{i}"] = {"type": "envmap", "bitmap": mi.Bitmap(values)}
                continue
            reflectance, radiance = part[-2:]
            bsdf = {"type": "diffuse", "reflectance": {"type": "rgb", "value": [reflectance] * 3}}
            if kind == "sphere":
                shape = {"type": "sphere", "center": list(part[1]), "radius": part[2], "bsdf": bsdf}
            else:
                o, a, b = part[1:4]
                to = np.eye(4)
                to[:3, 0], to[:3, 1], to[:3, 2], to[:3, 3] = a / 2, b / 2, np.cross(a, b) / np.linalg.norm(np.cross(a, b)), o + a / 2 + b / 2
                shape = {"type": "rectangle", "to_world": mi.ScalarTransform4f(to), "bsdf": {"type": "twosided", "bsdf": bsdf}}
            if radiance:
                shape["emitter"] = {"type": "area", "radiance": {"type": "rgb", "value": [radiance] * 3}}
            scene[f"p{i}"] = shape
        return scene


def octahedral(radiances, side):
    """Square picture in the equal-area octahedral layout of pbrt-v4 (Clarberg 2008), z of its space."""
    at = (np.arange(side) + 0.5) / side * 2 - 1
    a, b = np.meshgrid(at, at)
    from_edge = 1 - (abs(a) + abs(b))
    r = 1 - abs(from_edge)
    phi = np.where(r == 0, 1, (abs(b) - abs(a)) / np.where(r == 0, 1, r) + 1) * np.pi / 4
    z, rho = np.copysign(1 - r * r, from_edge), r * np.sqrt(np.maximum(0, 2 - r * r))
    return radiances(np.copysign(np.cos(phi), a) * rho, np.copysign(np.sin(phi), b) * rho, z)


def latitudes(radiances, width):
    """Mitsuba's layout: columns by azimuth about y, rows from +y down."""
    phi, theta = np.meshgrid((np.arange(width) + 0.5) / width * 2 * np.pi, (np.arange(width // 2) + 0.5) / (width // 2) * np.pi)
    return radiances(np.sin(phi) * np.sin(theta), np.cos(theta), -np.cos(phi) * np.sin(theta))


def write_exr(path, values):
    """Grey as R, G and B, 32-bit floats, not compressed."""
    height, width = values.shape
    def attribute(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data
    channel = struct.pack("<iB3xii", 2, 0, 1, 1)
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2) + attribute("channels", "chlist", b"".join(c + b"\0" + channel for c in (b"B", b"G", b"R")) + b"\0")
    header += attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box)
    header += attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0)) + attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    size = 8 + 12 * width
    table = b"".join(struct.pack("<Q", len(header) + 8 * height + row * size) for row in range(height))
    rows = b"".join(struct.pack("<ii", row, 12 * width) + np.repeat(values[row][None].astype("<f4"), 3, 0).tobytes() for row in range(height))
    path.write_bytes(header + table + rows)


def room():
    """Sky through a window, and a lamp."""
    scene = Scene((1.2, 1.3, -1.9), (-0.6, 1, 1), 60)
    scene.box((-2, 0, -2), (2, 2.6, 2), 0.6, skip=("left",))
    for corner, along, across in [((-2, 0, -2), (0, 0.9, 0), (0, 0, 4)), ((-2, 2, -2), (0, 0.6, 0), (0, 0, 4)),
                                  ((-2, 0.9, -2), (0, 1.1, 0), (0, 0, 1.3)), ((-2, 0.9, 0.7), (0, 1.1, 0), (0, 0, 1.3))]:
        scene.quad(corner, along, across, 0.6)
    scene.quad((-0.3, 2.59, -0.3), (0.6, 0, 0), (0, 0, 0.6), 0, 4)
    scene.sphere((-0.6, 0.4, 0.6), 0.4, 0.7)
    scene.sky(1)
    return scene


def plain(size):
    """Balls under a sky and a lamp, on a floor of this half side."""
    scene = Scene((0, 0.5, -2.2), (0, 0.2, 0), 35)
    scene.quad((-size, 0, -size), (0, 0, 2 * size), (2 * size, 0, 0), 0.5)
    for i in range(-2, 3):
        scene.sphere((0.4 * i, 0.15, 0.1 * (i % 3)), 0.15, 0.7)
    scene.sphere((0.8, 1.4, -0.6), 0.12, 0, 20)
    scene.sky(0.3)
    return scene


def hall():
    """Four hundred lamps of unequal strength over a long floor."""
    scene = Scene((0, 1.6, -1), (0, 0.6, 8), 60)
    scene.box((-10, 0, -2), (10, 4, 42), 0.4)
    random = np.random.default_rng(5)
    for x in range(20):
        for z in range(20):
            scene.sphere((x - 9.5, 3.6, 2 * z), 0.05, 0, float(np.exp(random.normal()) * 20))
    scene.sphere((-1, 0.7, 5), 0.7, 0.7)
    return scene


def day():
    """A sky picture with a sun of two degrees, and a lamp under a roof."""
    scene = Scene((0.4, 1, -3), (0, 0.5, 0), 45)
    scene.quad((-5, 0, -5), (0, 0, 10), (10, 0, 0), 0.5)
    scene.quad((-2, 1.6, -0.2), (2, 0, 0), (0, 0, 2), 0.6)
    for i in range(-2, 3):
        scene.sphere((0.5 * i, 0.25, 0.3 * (i % 2)), 0.2, 0.7)
    scene.sphere((-1, 1.45, 0.8), 0.08, 0, 60)
    sun = np.array([0.5, 0.7, -0.5]) / np.linalg.norm([0.5, 0.7, -0.5])

    def radiances(x, y, z):
        cos = sun[0] * x + sun[1] * y + sun[2] * z
        return np.where(y > 0, 0.3 + 0.4 * (1 - np.maximum(0, y)), 0.05) + 3000 * np.clip((cos - 0.9988) / 0.0006, 0, 1)
    scene.sky_picture(radiances)
    return scene


SCENES = {"spheres (bundled)": "spheres", "lamps (bundled)": "lamps", "sky and lamp in a room": room(), "floor": plain(2),
          "floor 100 times larger": plain(200), "hall of 400 lamps": hall(), "sky picture and lamp": day()}


# --------------------------------------------------------------------------------------------------------- figures
def by_petzval(program, scene, folder, seeds, samples):
    for seed in range(1, seeds + 1):
        size = ["--absolute-spectra"] if isinstance(scene, pathlib.Path) else ["--size", f"{SIZE[0]}x{SIZE[1]}"]
        subprocess.run([program, "render", str(scene), "--pinhole", "--wavelengths", "450:50:650", "--spp", str(samples),
                        "--seed", str(seed), "--quiet", "-o", str(folder / "out.npy"), *size], check=True, stdout=subprocess.DEVNULL)
        yield np.load(folder / "out.npy").sum(-1) / 5


def scale_of_pictures(program, folder):
    """That makes a sky picture of 1 a radiance of 1, over the bands of by_petzval()."""
    scene = Scene((0, 0, 0), (0, 0, 1), 40)
    scene.sky_picture(lambda x, y, z: np.ones_like(x))
    return 1 / float(next(by_petzval(program, scene.pbrt(folder), folder, 1, 1)).mean())


def by_mitsuba(mi, scene, seeds, samples):
    built = mi.load_dict(scene.mitsuba(mi), optimize=False)  # merged shapes (3.9.1) drop out of the box that a sky shines from
    for seed in range(1, seeds + 1):
        yield np.array(mi.render(built, spp=samples, seed=seed))[:, :, 1]


def figures(pictures):
    pictures = np.array(list(pictures), float)
    mean = pictures.mean(0)
    relative = pictures.var(0, ddof=1) / np.maximum(mean, 1e-3 * mean.max()) ** 2
    means = pictures.mean((1, 2))
    return np.sqrt(relative.mean()), np.sqrt(np.median(relative)), means.mean(), means.std(ddof=1) / np.sqrt(len(means))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+", metavar="PETZVAL")
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--spp", type=int, default=SAMPLES)
    parser.add_argument("--only", help="scenes whose name has this in it")
    options = parser.parse_args()
    try:
        import mitsuba as mi
        mi.set_variant("scalar_rgb")
    except ImportError:
        mi = None
    print(f"{'scene':<24}{'program':<10}{'rms':>8}{'median':>8}{'mean':>11} +-")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scale = scale_of_pictures(options.programs[0], folder)
        for title, scene in SCENES.items():
            if options.only and options.only not in title:
                continue
            written = scene if isinstance(scene, str) else scene.pbrt(folder, scale)
            rows = [(f"petzval {i + 1}" if len(options.programs) > 1 else "petzval", by_petzval(program, written, folder, options.seeds, options.spp))
                    for i, program in enumerate(options.programs)]
            if mi and not isinstance(scene, str):
                rows.append(("mitsuba", by_mitsuba(mi, scene, options.seeds, options.spp)))
            for program, pictures in rows:
                rms, median, mean, error = figures(pictures)
                print(f"{title:<24}{program:<10}{rms:>8.3f}{median:>8.3f}{mean:>11.5f} {error:.5f}", flush=True)


if __name__ == "__main__":
    main()
