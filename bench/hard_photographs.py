#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Errors of `petzval sfr` by cause: a photograph of 100 edges, exact as `petzval target` draws it, made hard in the ways that
photographs are, each by code of this file that knows nothing of how `sfr` measures. The true MTF50 of every edge is Airy's
transfer function times the photosite's, and that of the sharpening. `bench/hard_photographs.py build/release/bin/petzval
[--json] [--quality N]`, of the JPEG pictures, which ImageMagick writes where it is there."""

import json
import math
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np

SIDE, PITCH, ACROSS, F_NUMBER, WAVELENGTH_UM, PIXEL_UM = 70, 140, 5, 8, 0.55, 4.73
SIZE = PITCH * ACROSS
DARK, BRIGHT = 0.06, 0.7
SHARPEN_SIGMA, SHARPEN_AMOUNT = 1.0, 0.8


def squares(seen=lambda x, y: (x, y)):
    lines = []
    for i in range(ACROSS * ACROSS):
        x, y = PITCH * (i % ACROSS + 0.5) + 0.13 * (i % 7), PITCH * (i // ACROSS + 0.5) + 0.17 * (i % 5)
        angle = math.radians(3 + 0.4 * i)
        c, s = 0.5 * SIDE * math.cos(angle), 0.5 * SIDE * math.sin(angle)
        corners = [(x - c + s, y - s - c), (x + c + s, y + s - c), (x + c - s, y + s + c), (x - c - s, y - s + c)]
        lines.append("4 " + " ".join(f"{a:.6f} {b:.6f}" for a, b in (seen(*corner) for corner in corners)))
    return "\n".join(lines) + "\n"


def in_perspective(x, y):
    """A chart turned by some 20 degrees about an upright and 10 degrees about a level line."""
    u, v = (x - SIZE / 2) / SIZE, (y - SIZE / 2) / SIZE
    depth = 1 + 0.25 * u - 0.12 * v
    return SIZE * (0.5 + 0.92 * u / depth), SIZE * (0.5 + 0.95 * (v + 0.03 * u) / depth)


def true_mtf50(angle_deg, sharpened=False):
    """By bisection. Airy: 2/pi (acos s - s sqrt(1 - s^2)), s the frequency over 1/(lambda N)."""
    cutoff = PIXEL_UM / (WAVELENGTH_UM * F_NUMBER)
    c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))

    def mtf(f):
        share = min(1, f / cutoff)
        airy = 2 / math.pi * (math.acos(share) - share * math.sqrt(1 - share * share))
        filtered = 1
        if sharpened:  # separable kernels: their transforms along both axes
            filtered = 1 + SHARPEN_AMOUNT * (1 - transform(f * c) * transform(f * s))
        return airy * float(np.sinc(f * c) * np.sinc(f * s)) * filtered

    low, high = 0.05, 0.9
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if mtf(middle) > 0.5 else (low, middle)
    return low


def kernel():
    at = np.arange(-5, 6)
    weights = np.exp(-0.5 * (at / SHARPEN_SIGMA) ** 2)
    return weights / weights.sum()


def transform(f):
    at = np.arange(-5, 6)
    return float(np.sum(kernel() * np.cos(2 * np.pi * f * at)))


def blurred(picture):
    weights, reach = kernel(), 5
    for axis in (0, 1):
        padded = np.pad(picture, [(reach, reach) if a == axis else (0, 0) for a in (0, 1)], mode="edge")
        picture = sum(w * np.take(padded, range(i, i + picture.shape[axis]), axis) for i, w in enumerate(weights))
    return picture


def srgb(light):
    light = np.clip(light, 0, 1)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def write_png(path, codes, bits, colours=(b"sRGB", b"\0")):
    """Grey, ISO/IEC 15948, with this chunk for what the codes mean."""
    def chunk(name, payload):
        return struct.pack(">I", len(payload)) + name + payload + struct.pack(">I", zlib.crc32(name + payload))

    whole = np.round(codes * (2 ** bits - 1)).astype(">u2" if bits == 16 else "u1")
    lines = b"".join(b"\0" + row.tobytes() for row in whole)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", *codes.shape[::-1], bits, 0, 0, 0, 0)) +
                     chunk(*colours) + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))


LUMINANCE = """16 11 10 16 24 40 51 61 12 12 14 19 26 58 60 55 14 13 16 24 40 57 69 56 14 17 22 29 51 87 80 62
18 22 37 56 68 109 103 77 24 35 55 64 81 104 113 92 49 64 78 87 103 121 120 101 72 92 95 98 112 100 103 99"""


def as_jpeg(codes, quality=85):
    """What a decoder makes of grey codes of 8 bits: ITU-T T.81, the table K.1 scaled as libjpeg scales it."""
    table = np.floor((np.array(LUMINANCE.split(), float).reshape(8, 8) * (200 - 2 * quality) + 50) / 100).clip(1)
    k, n = np.meshgrid(np.arange(8), np.arange(8), indexing="ij")
    dct = np.cos((2 * n + 1) * k * np.pi / 16) * np.where(k == 0, math.sqrt(1 / 8), 0.5)
    rows, columns = codes.shape
    padded = np.pad(np.round(codes * 255), ((0, -rows % 8), (0, -columns % 8)), mode="edge") - 128
    blocks = padded.reshape(padded.shape[0] // 8, 8, padded.shape[1] // 8, 8).transpose(0, 2, 1, 3)
    kept = np.round(dct @ blocks @ dct.T / table) * table
    back = (dct.T @ kept @ dct).transpose(0, 2, 1, 3).reshape(padded.shape) + 128
    return np.round(back).clip(0, 255)[:rows, :columns] / 255


def vignetted(light):
    y, x = np.indices(light.shape)
    r = np.hypot(x - SIZE / 2, y - SIZE / 2) / (SIZE / 2)
    return light / (1 + 0.25 * r * r) ** 2


def unevenly_lit(light):
    y, x = np.indices(light.shape)
    lamp = 0.3 * np.exp(-((x - 180) ** 2 + (y - 520) ** 2) / (2 * 250 ** 2))
    return light * (0.75 + 0.15 * x / SIZE + lamp)


def sharpened(light):
    return light + SHARPEN_AMOUNT * (light - blurred(light))


def with_moire(light):
    """Of a fabric too fine for the pixels: a grating beyond Nyquist, as its samples show it, on what is bright."""
    y, x = np.indices(light.shape)
    return light * (1 + 0.025 * np.cos(2 * np.pi * (0.83 * x + 0.71 * y)) * (light - DARK) / (BRIGHT - DARK))


def with_dust(light):
    random = np.random.default_rng(8)
    y, x = np.indices(light.shape)
    for _ in range(40):
        cx, cy, size, depth = random.uniform(0, SIZE), random.uniform(0, SIZE), random.uniform(1.5, 4), random.uniform(0.1, 0.4)
        light = light * (1 - depth * np.exp(-((x - cx) ** 2 + (y - cy) ** 2) / (2 * size * size)))
    return light


def with_noise(light):
    return light + np.random.default_rng(3).normal(0, (BRIGHT - DARK) / 50, light.shape)


# name: scene, what is done to the light, what is done to the codes, bits
CAUSES = {
    "nothing, 16 bits": ("flat", [], None, 16),
    "8 bits": ("flat", [], None, 8),
    "perspective": ("turned", [], None, 16),
    "vignetting": ("flat", [vignetted], None, 16),
    "uneven light": ("flat", [unevenly_lit], None, 16),
    "sharpening": ("flat", [sharpened], None, 16),
    "moire": ("flat", [with_moire], None, 16),
    "dust": ("flat", [with_dust], None, 16),
    "noise, SNR 50": ("flat", [with_noise], None, 16),
    "JPEG, quality 85": ("flat", [], as_jpeg, 8),
    "all of them": ("turned", [with_moire, unevenly_lit, vignetted, with_dust, with_noise, sharpened], as_jpeg, 8),
}


def run(program, quality=85):
    results = {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def petzval(*words):
            return subprocess.run([str(pathlib.Path(program).resolve()), *map(str, words)], cwd=folder, check=True,
                                  capture_output=True, text=True).stdout

        scenes = {}
        for scene, seen in (("flat", lambda x, y: (x, y)), ("turned", in_perspective)):
            (folder / "squares.txt").write_text(squares(seen))
            petzval("target", "--polygons", "squares.txt", "--size", f"{SIZE}x{SIZE}", "--f-number", F_NUMBER, "--wavelength",
                    1e3 * WAVELENGTH_UM, "--pixel-pitch", PIXEL_UM, "--black", DARK, "--white", BRIGHT, "-o", "scene.npy", "--quiet")
            scenes[scene] = np.load(folder / "scene.npy").reshape(SIZE, SIZE)
        for cause, (scene, changes, codes_of, bits) in CAUSES.items():
            light = scenes[scene]
            for change in changes:
                light = change(light)
            codes = srgb(light)
            name = "photo.png"
            if codes_of and shutil.which("convert"):
                write_png(folder / name, codes, bits)
                name = "photo.jpg"
                subprocess.run(["convert", "photo.png", "-quality", str(quality), name], cwd=folder, check=True)
            else:
                write_png(folder / name, codes_of(codes, quality) if codes_of else codes, bits)
            edges = json.loads(petzval("sfr", name, "--json", "--quiet"))["edges"]
            errors, stated = [], []
            for edge in edges:
                truth = true_mtf50(edge["angle_deg"], sharpened in changes)
                if edge["mtf50_cpp"] is None:
                    continue
                errors.append(100 * (edge["mtf50_cpp"] / truth - 1))
                stated.append(100 * edge["mtf50_deviation_cpp"] / truth)
            size = np.abs(errors)
            results[cause] = {"edges": len(errors), "mean": float(np.mean(errors)), "median_size": float(np.median(size)),
                              "rms": float(np.sqrt(np.mean(size ** 2))), "worst": float(size.max()),
                              "beyond_5_percent": int(np.sum(size > 5)), "stated": float(np.median(stated))}
    return results


if __name__ == "__main__":
    found = run(sys.argv[1], int(sys.argv[sys.argv.index("--quality") + 1]) if "--quality" in sys.argv else 85)
    if "--json" in sys.argv:
        print(json.dumps(found))
    else:
        print("MTF50 in % of the truth; 100 edges\n"
              f"{'cause':<18} {'edges':>5} {'mean':>7} {'median size':>11} {'rms':>7} {'worst':>7} {'> 5 %':>5} {'stated':>7}")
        for cause, r in found.items():
            print(f"{cause:<18} {r['edges']:>5} {r['mean']:>7.2f} {r['median_size']:>11.2f} {r['rms']:>7.2f} {r['worst']:>7.2f} "
                  f"{r['beyond_5_percent']:>5} {r['stated']:>7.2f}")
