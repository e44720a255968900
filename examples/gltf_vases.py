#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes vases.gltf: three vases of clay, brass and glass on a board, lit by a window.

python3 examples/gltf_vases.py vases.gltf
petzval render vases.gltf --lens dgauss-50mm --focus 0.9m --size 240x180 -o vases.png
"""

import array
import base64
import json
import math
import struct
import sys
import zlib

gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [],
        "accessors": [], "bufferViews": [], "buffers": [{}], "images": [], "textures": [], "extensionsUsed": []}
data = bytearray()


def view(numbers):
    data.extend(bytes(-len(data) % 4))
    gltf["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(numbers)})
    data.extend(numbers)
    return len(gltf["bufferViews"]) - 1


def accessor(values, kind, width, component=5126):
    flat = [v for row in values for v in row] if width > 1 else values
    gltf["accessors"].append({"bufferView": view(array.array("f" if component == 5126 else "I", flat).tobytes()),
                              "componentType": component, "count": len(values), "type": kind})
    return len(gltf["accessors"]) - 1


def material(**what):
    gltf["materials"].append(what)
    return len(gltf["materials"]) - 1


def place(positions, normals, uvs, triangles, material, **where):
    attributes = {"POSITION": accessor(positions, "VEC3", 3), "NORMAL": accessor(normals, "VEC3", 3),
                  "TEXCOORD_0": accessor(uvs, "VEC2", 2)}
    gltf["meshes"].append({"primitives": [{"attributes": attributes, "indices": accessor(triangles, "SCALAR", 1, 5125),
                                           "material": material}]})
    gltf["nodes"].append({"mesh": len(gltf["meshes"]) - 1, **where})


def turned(profile, material, sides=64, **where):
    """A surface of revolution about y; `profile` lists radius and height."""
    positions, normals, uvs, triangles = [], [], [], []
    for i, (r, y) in enumerate(profile):
        (r0, y0), (r1, y1) = profile[max(i - 1, 0)], profile[min(i + 1, len(profile) - 1)]
        out, up = y1 - y0, r0 - r1
        norm = math.hypot(out, up)
        for j in range(sides + 1):
            a = 2 * math.pi * j / sides
            positions.append((r * math.cos(a), y, -r * math.sin(a)))
            normals.append((out / norm * math.cos(a), up / norm, -out / norm * math.sin(a)))
            uvs.append((j / sides, 1 - i / (len(profile) - 1)))
    for i in range(len(profile) - 1):
        for j in range(sides):
            a = i * (sides + 1) + j
            triangles += [a, a + 1, a + sides + 2, a, a + sides + 2, a + sides + 1]
    place(positions, normals, uvs, triangles, material, **where)


def square(material, **where):
    place([(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)], [(0, 1, 0)] * 4, [(0, 1), (1, 1), (1, 0), (0, 0)],
          [0, 1, 2, 0, 2, 3], material, **where)


def texture(width, height, colour):
    """A PNG of colour(x, y), three bytes."""
    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))
    rows = b"".join(b"\0" + b"".join(bytes(colour(x, y)) for x in range(width)) for y in range(height))
    png = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
           + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
    gltf["images"].append({"bufferView": view(png), "mimeType": "image/png"})
    gltf["textures"].append({"source": len(gltf["images"]) - 1})
    return {"index": len(gltf["textures"]) - 1}


def vase(height, waist):
    steps = [i / 40 for i in range(41)]
    return [(0.001, 0)] + [(0.055 * (1 + 0.5 * math.sin(2.6 * math.pi * t - 0.4)) * (1 - waist * t), height * t) for t in steps]


def glaze(x, y):
    if y % 32 < 6:
        return (40, 70, 130)
    return (236, 224, 200) if (x // 16 + y // 32) % 2 else (188, 92, 60)


def planks(x, y):
    tone = 120 + 18 * (x // 32 * 7 % 5) + int(8 * math.sin(y / 3 + x // 32))
    return (30, 22, 16) if x % 32 == 0 else (tone, tone * 7 // 10, tone * 9 // 20)


clay = material(pbrMetallicRoughness={"metallicFactor": 0, "roughnessFactor": 0.35, "baseColorTexture": texture(256, 256, glaze)})
brass = material(pbrMetallicRoughness={"metallicFactor": 1, "roughnessFactor": 0.3, "baseColorFactor": [0.9, 0.7, 0.3, 1]})
glass = material(pbrMetallicRoughness={"metallicFactor": 0, "roughnessFactor": 0},
                 extensions={"KHR_materials_transmission": {"transmissionFactor": 1},
                             "KHR_materials_volume": {"thicknessFactor": 0.05}, "KHR_materials_ior": {"ior": 1.52}})
board = material(pbrMetallicRoughness={"metallicFactor": 0, "roughnessFactor": 0.5, "baseColorTexture": texture(256, 64, planks)})
window = material(emissiveFactor=[1, 0.97, 0.9], extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 3000}})
wall = material(pbrMetallicRoughness={"metallicFactor": 0, "roughnessFactor": 1, "baseColorFactor": [0.6, 0.65, 0.6, 1]})

turned(vase(0.22, 0.2), clay, translation=[-0.13, 0, 0])
turned(vase(0.17, 0.1), brass, translation=[0.02, 0, 0.1])
turned(vase(0.2, 0.3), glass, translation=[0.15, 0, -0.02])
square(board, scale=[0.8, 1, 0.8])
square(wall, translation=[0, 0, -0.6], rotation=[math.sqrt(0.5), 0, 0, math.sqrt(0.5)], scale=[2, 1, 2])
square(window, translation=[-0.9, 0.7, 0.5], rotation=[0.259, 0, -0.837, 0.483], scale=[0.3, 1, 0.3])
gltf["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.5, "aspectRatio": 4 / 3, "znear": 0.01}}]
gltf["nodes"].append({"camera": 0, "translation": [0, 0.28, 0.95], "rotation": [math.sin(-0.1), 0, 0, math.cos(-0.1)]})
gltf["extensionsUsed"] = ["KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_transmission", "KHR_materials_volume"]
gltf["scenes"][0]["nodes"] = list(range(len(gltf["nodes"])))
gltf["buffers"] = [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]
with open(sys.argv[1], "w", encoding="utf-8") as file:
    json.dump(gltf, file)
