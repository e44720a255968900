#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measured materials, bump maps and chequered coats beside pbrt-v4: the same scene files through both programs.

    python3 bench/surfaces_beside.py build/release/bin/petzval PBRT [--spp 256] [--seeds 4] [--pictures FOLDER]

PBRT is the program of a build of https://github.com/mmp/pbrt-v4. Each scene is a ball or a board under an even sky and a
lamp. Measured materials are files that are made here from a metal of facets (Trowbridge and Reitz, Smith's masking), not
measurements. `means` is our luminance over pbrt's, over what that is in the first row, whose materials are plain: both
state light in units of their own. `+-` is its standard error over the seeds, `pixels` the mean of |ours - pbrt's| over
the mean."""

import argparse
import pathlib
import struct
import tempfile

import light_noise
import numpy as np
import pbrt_beside
import programs_beside


# ------------------------------------------------------------------------------------------------- measured materials
def way(theta, phi):
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)


class Metal:
    """Facets of slopes ax and ay, of index nm/1000 + 3i."""

    def __init__(self, ax, ay):
        self.slopes = np.array([ax, ay])

    def density(self, m):
        ax, ay = self.slopes
        return 1 / (np.pi * ax * ay * ((m[..., 0] / ax) ** 2 + (m[..., 1] / ay) ** 2 + m[..., 2] ** 2) ** 2)

    def masked(self, w):
        across = ((self.slopes * w[..., :2]) ** 2).sum(-1)
        return (np.sqrt(1 + across / np.maximum(w[..., 2], 1e-6) ** 2) - 1) / 2

    @staticmethod
    def reflectance(cos, nm):
        eta = nm / 1000 + 3j
        inside = np.sqrt(eta ** 2 - 1 + cos ** 2)
        across, along = (cos - inside) / (cos + inside), (eta ** 2 * cos - inside) / (eta ** 2 * cos + inside)
        return (abs(across) ** 2 + abs(along) ** 2) / 2


def drawn(table, n):
    """Where the density between the nodes of `table` takes the nodes of an even n x n grid (rows y, columns x)."""
    fine = 40  # places a cell at which integrals are tabled
    rows, columns = table.shape

    def finer(values):
        at = np.linspace(0, len(values) - 1, fine * (len(values) - 1) + 1)
        low = np.minimum(at.astype(int), len(values) - 2)
        part = (at - low).reshape(-1, *[1] * (values.ndim - 1))
        return (1 - part) * values[low] + part * values[low + 1]

    def undone(density, shares):
        sums = np.concatenate([[0], np.cumsum(density[1:] + density[:-1])])
        return np.interp(shares * sums[-1], sums, np.linspace(0, 1, len(density)))

    shares = np.linspace(0, 1, n)
    y = undone(finer((table[:, 1:] + table[:, :-1]).sum(1)), shares)
    low = np.minimum((y * (rows - 1)).astype(int), rows - 2)
    part = (y * (rows - 1) - low)[:, None]
    x = np.array([undone(finer(line), shares) for line in (1 - part) * table[low] + part * table[low + 1]])
    return x, np.repeat(y[:, None], n, 1)


def measured_file(path, metal, thetas, phis, side, n, wavelengths=(400, 500, 600, 700)):
    """Tables of Dupuy and Jakob (2018), exact at their nodes, in the container of their files."""
    theta = np.linspace(0, 1.5, thetas)
    phi = np.linspace(-np.pi, np.pi, phis) if phis > 2 else np.zeros(1)
    nodes = np.linspace(0, 1, side)
    theta_m, phi_m = np.meshgrid(nodes ** 2 * np.pi / 2, (2 * nodes - 1) * np.pi)
    m = way(theta_m, phi_m)
    vndf, spectra = np.zeros((len(phi), thetas, side, side)), np.zeros((len(phi), thetas, len(wavelengths), n, n))
    for i, p in enumerate(phi):
        for j, t in enumerate(theta):
            seen = way(t, p if phis > 2 else 0)
            vndf[i, j] = np.maximum(0, m @ seen) * metal.density(m) * nodes * np.sin(theta_m)
            x, y = drawn(vndf[i, j].astype("f4").astype(float), n)
            facet = way(x ** 2 * np.pi / 2, (2 * y - 1) * np.pi)
            cos = facet @ seen
            lit = 2 * cos[..., None] * facet - seen
            shown = 1 / (1 + metal.masked(seen) + metal.masked(lit))
            # f cos = F D G2 / (4 cos of wo), the area of facets that are seen cos of wo x (1 + Lambda).
            spectra[i, j] = [np.where(lit[..., 2] > 0, metal.reflectance(cos, nm) * shown * (1 + metal.masked(seen)), 0) for nm in wavelengths]
    fields = {"theta_i": theta, "phi_i": phi, "ndf": metal.density(m), "sigma": np.maximum(m[..., 2], 1e-6) * (1 + metal.masked(m)), "vndf": vndf,
              "luminance": spectra.mean(2), "spectra": spectra, "wavelengths": np.array(wavelengths)}
    fields = {name: np.ascontiguousarray(values, "<f4") for name, values in fields.items()}
    fields |= {"jacobian": np.ones(1, "u1"), "description": np.frombuffer(b"a metal of facets", "u1")}
    offset = 18 + sum(13 + len(name) + 8 * values.ndim for name, values in fields.items())
    head = b"tensor_file\0\1\0" + struct.pack("<I", len(fields))
    for name, values in fields.items():
        head += struct.pack("<H", len(name)) + name.encode() + struct.pack("<HBQ", values.ndim, 10 if values.itemsize == 4 else 1, offset)
        head += struct.pack(f"<{values.ndim}Q", *values.shape)
        offset += values.nbytes
    path.write_bytes(head + b"".join(values.tobytes() for values in fields.values()))


# ---------------------------------------------------------------------------------------------------------- scenes
def scene(material, shape='Shape "sphere"'):
    """A ball over a floor, under an even sky and a lamp."""
    return f"""LookAt 0 2.2 -4.5  0 -0.1 0  0 1 0
Camera "perspective" "float fov" 36
Film "rgb" "integer xresolution" 96 "integer yresolution" 72
Integrator "path" "integer maxdepth" 6
WorldBegin
LightSource "infinite" "spectrum L" [ 300 1 900 1 ] "float scale" 0.3
AttributeBegin
AreaLightSource "diffuse" "spectrum L" [ 300 1 900 1 ] "float scale" 40
Translate 2.5 3 -2
Shape "sphere" "float radius" 0.4
AttributeEnd
AttributeBegin
Material "diffuse" "spectrum reflectance" [ 300 0.4 900 0.4 ]
Shape "trianglemesh" "point3 P" [ -6 -1 -6 -6 -1 6 6 -1 6 6 -1 -6 ] "integer indices" [ 0 1 2 0 2 3 ]
AttributeEnd
AttributeBegin
Rotate -90 1 0 0
{material}
{shape}
AttributeEnd
"""


def texts(folder):
    yield "plain", scene('Material "diffuse" "spectrum reflectance" [ 300 0.4 900 0.4 ]')
    measured_file(folder / "metal.bsdf", Metal(0.3, 0.3), 12, 1, 64, 32)
    yield "measured", scene('Material "measured" "string filename" "metal.bsdf"')
    measured_file(folder / "brushed.bsdf", Metal(0.12, 0.4), 12, 65, 48, 24)
    yield "measured, brushed", scene('Material "measured" "string filename" "brushed.bsdf"')
    u, v = np.meshgrid((np.arange(256) + 0.5) / 256, (np.arange(128) + 0.5) / 128)
    light_noise.write_exr(folder / "waves.exr", 1 + np.sin(2 * np.pi * 10 * u) * np.sin(2 * np.pi * 5 * v))
    bumps = 'Texture "waves" "float" "imagemap" "string filename" "waves.exr" "float scale" 0.02\n'
    for name, material in {"diffuse": '"diffuse" "spectrum reflectance" [ 300 0.4 900 0.4 ]',
                           "metal": '"conductor" "spectrum eta" [ 300 0.5 900 0.5 ] "spectrum k" [ 300 3 900 3 ] "float roughness" 0.1',
                           "coated": '"coateddiffuse" "spectrum reflectance" [ 300 0.4 900 0.4 ] "float roughness" 0.1 "float thickness" 0.01'}.items():
        yield f"bumps, {name}", scene(f'{bumps}Material {material} "texture displacement" "waves"')
    board = 'Shape "trianglemesh" "point3 P" [ -1.5 -.9 -.9 1.5 -.9 -.9 1.5 .2 .9 -1.5 .2 .9 ] "point2 uv" [ 0 0 1 0 1 1 0 1 ] "integer indices" [ 0 1 2 0 2 3 ]'
    yield "bumps, board", scene(f'{bumps}Material "diffuse" "texture displacement" "waves"', board)
    squares = 'Texture "t" "float" "checkerboard" "float uscale" 8 "float vscale" 4 "float tex1" 0.05 "float tex2" 0.5\n'
    yield "coat, chequered", scene(squares + 'Material "coateddiffuse" "spectrum reflectance" [ 300 0.7 900 0.7 ] "float roughness" 0.1 '
                                   '"texture thickness" "t" "integer maxdepth" 100 "integer nsamples" 4')
    turbid = ('Texture "a" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 4 "spectrum tex1" [ 300 0.9 900 0.9 ] "spectrum tex2" [ 300 0.4 900 0.4 ]\n'
              'Texture "g" "float" "checkerboard" "float uscale" 2 "float vscale" 4 "float tex1" 0.7 "float tex2" -0.3\n')
    within = '"texture albedo" "a" "texture g" "g" "float thickness" 0.6 "integer maxdepth" 100 "integer nsamples" 4'
    yield "turbid coat", scene(f'{turbid}Material "coateddiffuse" "spectrum reflectance" [ 300 0.7 900 0.7 ] "float roughness" 0 {within}')
    yield "turbid coat, rough", scene(f'{turbid}Material "coateddiffuse" "spectrum reflectance" [ 300 0.2 900 0.2 ] "float roughness" 0.1 {within}')
    yield "turbid coat, metal", scene(f'{turbid}Material "coatedconductor" "spectrum conductor.eta" [ 300 0.5 900 0.5 ] "spectrum conductor.k" [ 300 3 900 3 ] '
                                      f'"float interface.roughness" 0 "float conductor.roughness" 0.1 {within}')
    deep = scene('Material "subsurface" BELOW').replace('"path" "integer maxdepth" 6', '"volpath" "integer maxdepth" 100000')
    deep = deep.replace('"float scale" 40', '"float scale" 0')  # which a smooth boundary lets nobody ask
    colours = 'Texture "r" "spectrum" "checkerboard" "float uscale" 2 "float vscale" 2 "spectrum tex1" [ 300 0.8 900 0.8 ] "spectrum tex2" [ 300 0.3 900 0.3 ]\n'
    lengths = 'Texture "m" "spectrum" "checkerboard" "float uscale" 2 "float vscale" 2 "spectrum tex1" [ 300 0.001 900 0.001 ] "spectrum tex2" [ 300 0.003 900 0.003 ]\n'
    for name, texts_before, below in [("even", "", '"spectrum reflectance" [ 300 0.5 900 0.5 ] "spectrum mfp" [ 300 0.002 900 0.002 ]'),
                                      ("reflectance", colours, '"texture reflectance" "r" "spectrum mfp" [ 300 0.002 900 0.002 ]'),
                                      ("mfp", lengths, '"spectrum reflectance" [ 300 0.5 900 0.5 ] "texture mfp" "m"')]:
        yield f"below, {name}", deep.replace('Material "subsurface" BELOW', f'{texts_before}Material "subsurface" {below}')


# -------------------------------------------------------------------------------------------------------- programs
def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("petzval", type=pathlib.Path)
    parser.add_argument("pbrt", type=pathlib.Path)
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--only", default="", help="scenes whose name has this in it, and the first")
    parser.add_argument("--pictures", type=pathlib.Path, help="a folder for the mean pictures, side by side (takes imageio)")
    options = parser.parse_args()
    programs = [programs_beside.Petzval(options.petzval.resolve(), options.threads), programs_beside.Pbrt(options.pbrt.resolve(), options.threads)]
    one = None
    print(f"{'scene':<24}{'means':>8} {'+-':>6}{'pixels':>8}")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for title, text in texts(folder):
            if one and options.only not in title:
                continue
            pictures = [[program.render(pbrt_beside.for_both(text), False, options.spp, seed, folder)[0] for seed in range(1, options.seeds + 1)]
                        for program in programs]
            means = np.array([[each.mean() for each in of] for of in pictures])
            ours, theirs = means.mean(1)
            error = np.hypot(*(means.std(1, ddof=1) / means.mean(1))) / options.seeds ** 0.5
            one = one or ours / theirs
            sides = [np.mean(of, 0) for of in pictures]
            pixels = abs(sides[0] / one - sides[1]).mean() / sides[1].mean()
            print(f"{title:<24}{ours / theirs / one:>8.4f} {error:.4f}{pixels:>8.4f}", flush=True)
            if options.pictures:
                options.pictures.mkdir(exist_ok=True, parents=True)
                pbrt_beside.save(pictures, options.pictures / f"{title.replace(', ', '-').replace(' ', '-')}.png")


if __name__ == "__main__":
    main()
