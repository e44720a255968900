#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Media that shine, media in colours and portals beside pbrt-v4: the same small scenes through both programs, and the pictures side by side.

    python3 bench/lights_beside.py build/release/bin/petzval PBRT [--spp 64] [--seeds 4] [--pictures FOLDER] [--only NAME]

PBRT is the program of a build of https://github.com/mmp/pbrt-v4. Both render the luminance (ours from 31 bands), with box
filters as large as a pixel. `means` is the mean of our pictures over that of pbrt's, over what that is for a grey ball in
even light, with its standard error over the seeds: both state light in units of their own."""

import argparse
import pathlib
import struct
import tempfile

import numpy as np
from programs_beside import Pbrt, Petzval

SIZE, CELLS = (64, 48), 12
GREY = lambda name, value: f'"spectrum {name}" [ 300 {value} 900 {value} ]'


# ---------------------------------------------------------------------------------------------------------- scenes
def cells():
    at = (np.arange(CELLS) + 0.5) / CELLS * 2 - 1
    z, y, x = np.meshgrid(at, at, at, indexing="ij")
    return x, y, z


def numbers(kind, name, values):
    return f'"{kind} {name}" [ ' + " ".join(f"{v:.6g}" for v in np.ravel(values)) + " ]"


def lumps():
    x, y, z = cells()
    grid = np.maximum(0, 1 - (x * x + y * y + z * z)) * (1 + 0.8 * np.sin(5 * x) * np.sin(4 * y + 1) * np.cos(6 * z))
    grid[[0, -1]] = grid[:, [0, -1]] = grid[:, :, [0, -1]] = 0
    return grid


def grid(kind, parameters):
    return (f'MakeNamedMedium "m" "string type" "{kind}" "point3 p0" [ -1 -1 -1 ] "point3 p1" [ 1 1 1 ] '
            f'"integer nx" {CELLS} "integer ny" {CELLS} "integer nz" {CELLS} {parameters}')


BALL_OF_IT = 'AttributeBegin\nMediumInterface "m" ""\nMaterial "interface"\nShape "sphere" "float radius" 1.8\nAttributeEnd'
FLOOR = (f'AttributeBegin\nMaterial "diffuse" {GREY("reflectance", 0.6)}\nTranslate 0 -1.2 0\nRotate -90 1 0 0\n'
         'Shape "disk" "float radius" 6\nAttributeEnd')


def scenes():
    """Name, what the camera looks at, and where it stands."""
    yield "even light", [f'LightSource "infinite" {GREY("L", 1)}', f'Material "diffuse" {GREY("reflectance", 0.5)}', 'Shape "sphere"'], None
    fog = f'{GREY("sigma_a", 0.4)} {GREY("sigma_s", 0.8)} "float g" 0.5 {GREY("Le", 2)} "float Lescale" 3'
    yield "glowing ball", ['MakeNamedMedium "m" "string type" "homogeneous" ' + fog, BALL_OF_IT, FLOOR], None
    x, y, z = cells()
    strength = numbers("float", "Lescale", 2 + np.sin(3 * x + y))
    grey = f'{GREY("sigma_a", 2)} {GREY("sigma_s", 3)} "float g" 0.3 ' + numbers("float", "density", lumps())
    yield "glowing cloud", [grid("uniformgrid", f'{grey} {GREY("Le", 1)} {strength}'), BALL_OF_IT, FLOOR], None
    kelvin = numbers("float", "temperature", 800 + 1400 * np.maximum(0, 1 - x * x - z * z) * np.clip(1 - y, 0, 1))
    yield "fire", [grid("uniformgrid", f'{grey} {kelvin} {strength}'), BALL_OF_IT, FLOOR], None
    rgb = lambda name, r, g, b: numbers("rgb", name, np.stack([lumps() * r, lumps() * g, lumps() * b], -1))
    coloured = f'{rgb("sigma_a", 1, 0.5 + 0.5 * x, 0.4)} {rgb("sigma_s", 2 + 2 * y, 3, 1)} "float g" 0.3'
    lamp = f'LightSource "point" "point3 from" [ 2 2.5 -2 ] {GREY("I", 4)}'
    yield "cloud in colours", [grid("rgbgrid", coloured), lamp, BALL_OF_IT, FLOOR], None
    of_file = f'"string type" "nanovdb" "string filename" "lumps.nvdb" {GREY("sigma_a", 2)} {GREY("sigma_s", 3)} "float g" 0.3'
    yield "cloud of a file", [f'MakeNamedMedium "m" {of_file}', lamp, BALL_OF_IT, FLOOR], None
    sent = numbers("rgb", "Le", np.stack([1 + 0 * x, 0.5 + 0.5 * y, 0.2 + 0 * x], -1))
    yield "glowing, in colours", [grid("rgbgrid", f'{coloured} {sent} "float Lescale" 0.02'), BALL_OF_IT, FLOOR], None

    yield "sky through a portal", [f'LightSource "infinite" "string filename" "sky.hdr" {PORTAL}', *room()], "1.7 1.5 -1.7  -1 0.6 0.8"
    yield "the same, no portal", ['LightSource "infinite" "string filename" "sky.hdr"', *room()], "1.7 1.5 -1.7  -1 0.6 0.8"


PORTAL = '"point3 portal" [ 2 1 -1  2 1 1  2 2 1  2 2 -1 ]'


def room():
    """4 wide and deep, 3 high, with a window in its wall at x = 2."""
    def quad(p, a, b):
        p, a, b = map(np.array, (p, a, b))
        corners = " ".join(f"{v:g}" for v in np.concatenate([p, p + a, p + a + b, p + b]))
        return f'Shape "trianglemesh" "point3 P" [ {corners} ] "integer indices" [ 0 1 2 0 2 3 ]'
    x, y, z = (4, 0, 0), (0, 3, 0), (0, 0, 4)
    return [f'Material "diffuse" {GREY("reflectance", 0.6)}', quad((-2, 0, -2), x, z), quad((-2, 3, -2), x, z), quad((-2, 0, -2), y, z),
            quad((-2, 0, -2), x, y), quad((-2, 0, 2), x, y), quad((2, 0, -2), (0, 1, 0), z), quad((2, 2, -2), (0, 1, 0), z),
            quad((2, 1, -2), (0, 1, 0), (0, 0, 1)), quad((2, 1, 1), (0, 1, 0), (0, 0, 1)),
            'Translate 0.5 0.4 0.5\nShape "sphere" "float radius" 0.4']


def write_nvdb(path, values, voxel, corner):
    """A grid of NanoVDB 32.4 (layout: comments of NanoVDB.h). values[z, y, x], up to 128 along each, are at corner + voxel * index."""
    version, (z, y, x) = 32 << 21 | 4 << 10, values.shape
    floats = lambda *numbers: struct.pack(f"<{len(numbers)}f", *numbers)
    box = struct.pack("<6i", 0, 0, 0, x - 1, y - 1, z - 1)
    parts = [(i, j, k) for i in range(0, x, 8) for j in range(0, y, 8) for k in range(0, z, 8)]
    lower_size, upper_size, leaf_size = 1088 + 8 * 16 ** 3, 8256 + 8 * 32 ** 3, 96 + 4 * 8 ** 3
    padded = np.zeros((128, 128, 128), "<f4")
    padded[:x, :y, :z] = values.transpose(2, 1, 0)

    def node(side, masks_at, children):
        """`children`: place in the table and offset from the node."""
        mask, table = np.zeros(side ** 3 // 8, np.uint8), np.zeros(side ** 3, "<i8")
        for at, offset in children:
            mask[at // 8] |= 1 << at % 8
            table[at] = offset
        head = box + bytes(8) + bytes(side ** 3 // 8) + mask.tobytes() + floats(0, 1, 0, 0)
        return head.ljust(masks_at, b"\0") + table.tobytes()
    upper = node(32, 8256, [(0, upper_size)])
    lower = node(16, 1088, [((i // 8) << 8 | (j // 8) << 4 | k // 8, lower_size + n * leaf_size) for n, (i, j, k) in enumerate(parts)])
    leaves = b"".join(struct.pack("<3i4B", i, j, k, 7, 7, 7, 2) + b"\xff" * 64 + floats(0, 1, 0, 0) + padded[i:i + 8, j:j + 8, k:k + 8].tobytes()
                      for i, j, k in parts)
    root = (box + struct.pack("<I", 1) + floats(0, 0, values.max(), 0, 0)).ljust(64, b"\0") + struct.pack("<QqIf", 0, 96, 0, 0).ljust(32, b"\0")
    tree = struct.pack("<4Q6IQ", 160 + upper_size + lower_size, 160 + upper_size, 160, 64, len(parts), 1, 1, 0, 0, 0, values.size)
    scale = np.eye(3).ravel()
    world = struct.pack("<6d", *corner, *(np.array(corner) + voxel * np.array([x, y, z])))
    maps = floats(*voxel * scale, *scale / voxel, *corner, 1) + struct.pack("<22d", *voxel * scale, *scale / voxel, *corner, 1)
    size = 672 + len(tree) + len(root) + upper_size + lower_size + len(leaves)
    grid = (b"NanoVDB0" + struct.pack("<QIIIIQ", 2 ** 64 - 1, version, 2, 0, 1, size) + b"density".ljust(256, b"\0") + maps + world
            + struct.pack("<3dIIqI", voxel, voxel, voxel, 2, 1, size, 0)).ljust(672, b"\0")
    key = 0
    for letter in b"density":
        key = (key * 67 + letter + (key >> 56)) % 2 ** 64
    about = struct.pack("<QQQQII", size, size, key, values.size, 1, 2) + world + box + struct.pack("<3dI", voxel, voxel, voxel, 8)
    about += struct.pack("<4I3IHHI", len(parts), 1, 1, 1, 0, 0, 0, 0, 0, version)
    path.write_bytes(struct.pack("<8sIHH", b"NanoVDB0", version, 1, 0) + about + b"density\0" + grid + tree + root + upper + lower + leaves)


def write_sky(folder):
    """A square picture of a sky with a wide bright spot that the window shows, as pbrt-v4 lays out all directions."""
    side = 256
    v, u = (np.mgrid[0:side, 0:side] + 0.5) / side * 2 - 1
    from_edge = 1 - (abs(u) + abs(v))
    r = 1 - abs(from_edge)
    phi = (np.where(r == 0, 1, (abs(v) - abs(u)) / np.where(r == 0, 1, r)) + 1) * np.pi / 4
    rho = r * np.sqrt(2 - r * r)
    to = np.stack([np.copysign(np.cos(phi), u) * rho, np.copysign(np.sin(phi), v) * rho, np.copysign(1 - r * r, from_edge)])
    spot = np.array([1, 0.35, 0.1]) / np.linalg.norm([1, 0.35, 0.1])
    light = 0.5 + 30 * np.exp(-(1 - np.tensordot(spot, to, 1)) / 0.02)
    mantissa, exponent = np.frexp(light)
    byte = np.clip(np.round(mantissa * 256), 0, 255)
    pixels = np.stack([byte, byte, byte, exponent + 128], -1).astype(np.uint8)
    (folder / "sky.hdr").write_bytes(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {side} +X {side}\n".encode() + pixels.tobytes())


def text_of(things, eye):
    eye = eye or "0 0.6 -4.5  0 0 0"
    return "\n".join([f"LookAt {eye}  0 1 0", 'Camera "perspective" "float fov" 50',
                      f'Film "rgb" "integer xresolution" {SIZE[0]} "integer yresolution" {SIZE[1]}',
                      'Integrator "volpath" "integer maxdepth" 60', "WorldBegin", *things, ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("pbrt", type=pathlib.Path)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--pictures", type=pathlib.Path)
    parser.add_argument("--only")
    options = parser.parse_args()
    unit = None
    print(f"{'':24}   means   ±       noise of a pixel, ours and pbrt's")
    for name, things, eye in scenes():
        if unit and options.only and name != options.only:
            continue
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            write_sky(folder)
            write_nvdb(folder / "lumps.nvdb", lumps(), 2 / CELLS, 3 * [-1 + 1 / CELLS])
            pictures = [np.array([program.render(text_of(things, eye), False, options.spp, seed, folder)[0] for seed in range(1, options.seeds + 1)])
                        for program in (Petzval(options.program.resolve()), Pbrt(options.pbrt.resolve(), sampler="independent"))]
        ratios = pictures[0].mean((1, 2)) / pictures[1].mean((1, 2))
        unit = unit or ratios.mean()
        noise = [np.sqrt((p.var(0, ddof=1)).mean()) / p.mean() for p in pictures]
        print(f"{name:24} {ratios.mean() / unit:8.4f} {ratios.std(ddof=1) / unit / np.sqrt(options.seeds):.4f}   {noise[0]:.3f} {noise[1]:.3f}", flush=True)
        if options.pictures:
            import matplotlib.pyplot as plt
            options.pictures.mkdir(exist_ok=True)
            both = np.concatenate([pictures[0].mean(0) / unit, pictures[1].mean(0)], 1)
            plt.imsave(options.pictures / f"{name.replace(' ', '-')}.png", np.clip(both / np.percentile(both, 99), 0, 1) ** (1 / 2.2), cmap="gray", vmin=0, vmax=1)


if __name__ == "__main__":
    main()
