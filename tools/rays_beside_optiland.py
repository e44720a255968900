#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Traces the same rays through the same lenses with Petzval and with Optiland, another ray tracer, and tells how far apart
they land: mirrors, folds, tilts, biconics, toroids and freeforms. Fails beyond 1e-9 mm and 1e-12 of a direction.

    pip install optiland
    tools/rays_beside_optiland.py build/release/bin/petzval
"""

import csv
import io
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import numpy as np
from optiland.materials import IdealMaterial
from optiland.optic import Optic
from optiland.rays import RealRays

ROOT = pathlib.Path(__file__).resolve().parent.parent
CLOSE_MM, CLOSE_DIRECTION = 1e-9, 1e-12
GLASS = 1.5168


def hubble():
    return [{"radius_mm": -11040, "conic": -1.0022985, "thickness_mm": -4906.071, "mirror": True},
            {"radius_mm": -1358, "conic": -1.496, "thickness_mm": 6406.2, "mirror": True}], 1000


def mangin():
    return [{"radius_mm": -150, "thickness_mm": 8, "glass": {"index": GLASS}},
            {"radius_mm": -220, "conic": -0.3, "thickness_mm": -8, "mirror": True},
            {"radius_mm": -150, "thickness_mm": -80}], 20


def folded():
    """A lens, a mirror at 45 degrees, and the sensor above it."""
    return [{"radius_mm": 60, "thickness_mm": 5, "glass": {"index": GLASS}},
            {"radius_mm": -200, "thickness_mm": 40},
            {"radius_mm": None, "thickness_mm": -40, "mirror": True, "pose": {"tilt_x_deg": 45}}], 10


def tilted_sphere():
    return [{"radius_mm": 50, "thickness_mm": 6, "glass": {"index": GLASS},
             "pose": {"decentre_x_mm": 0.7, "decentre_y_mm": -1.1, "tilt_x_deg": 6}},
            {"radius_mm": -70, "thickness_mm": 60, "pose": {"tilt_y_deg": 3}}], 8


def shaped(shape, radius_mm, conic):
    return [{"radius_mm": radius_mm, "conic": conic, "thickness_mm": 6, "glass": {"index": GLASS}, "shape": shape},
            {"radius_mm": None, "thickness_mm": 70}], 8


def cylinder():
    """Of biconics the one that both programs mean: Optiland adds two conics, Zemax and Petzval divide by one root."""
    lens, half_width = shaped({"kind": "biconic", "curvature_x_per_mm": 0, "conic_x": 0}, 40, -0.8)
    lens[0]["pose"] = {"decentre_x_mm": 0.5, "decentre_y_mm": 1.5, "tilt_x_deg": 4}
    return lens, half_width


def toroid():
    return shaped({"kind": "toroid", "rotation_curvature_per_mm": 1 / 70, "normalisation_radius_mm": 1,
                   "coefficients_mm": [1e-4, -2e-6, 1e-9]}, 45, -0.5)


def xy_polynomial():
    # x, y, x², xy, y², x³, x²y, xy², y³
    return shaped({"kind": "xy_polynomial", "normalisation_radius_mm": 1,
                   "coefficients_mm": [1e-3, -2e-3, 3e-4, 1e-4, -2e-4, 1e-6, -2e-6, 3e-6, 1e-6]}, 60, -1.5)


def zernike_sag():
    return shaped({"kind": "zernike_sag", "normalisation_radius_mm": 10,
                   "coefficients_mm": [0, 0.01, -0.02, 0.03, 0.01, -0.005, 0.004, 0.003]}, 60, -1.5)


def petzval_lens(surfaces, groups):
    surfaces = [dict(surface) for surface in surfaces]
    surfaces[0]["stop"] = True
    return {"format": "petzval-lens/1", "name": "beside", "aperture": {"stop_semi_diameter_mm": 5000},
            "wavelengths_nm": [550], "surfaces": surfaces, "groups": groups}


def optiland_shape(surface):
    shape = surface.get("shape")
    if not shape:
        return "standard", {}
    unit = shape.get("normalisation_radius_mm", 1)
    a = shape.get("coefficients_mm", [])
    if shape["kind"] == "biconic":
        return "biconic", {"radius_x": np.inf, "radius_y": surface["radius_mm"],
                           "conic_x": shape["conic_x"], "conic_y": surface["conic"]}
    if shape["kind"] == "toroid":
        return "toroidal", {"radius_x": 1 / shape["rotation_curvature_per_mm"], "radius_y": surface["radius_mm"],
                            "conic": surface["conic"], "toroidal_coeffs_poly_y": a}
    if shape["kind"] == "xy_polynomial":
        grid = np.zeros((4, 4))
        i = 0
        for degree in range(1, 4):
            for of_y in range(degree + 1):
                grid[degree - of_y, of_y] = a[i] / unit**degree
                i += 1
        return "polynomial", {"coefficients": grid}
    return "zernike", {"coefficients": a, "norm_radius": unit, "zernike_type": "noll"}


def optiland_lens(surfaces, sensor):
    optic = Optic()
    optic.add_surface(index=0, thickness=np.inf)
    z, medium = 0.0, "air"
    for i, surface in enumerate(surfaces):
        kind, more = optiland_shape(surface)
        pose = surface.get("pose", {})
        if surface.get("mirror"):
            material = "mirror"
        else:
            medium = IdealMaterial(surface["glass"]["index"]) if "glass" in surface else "air"
            material = medium
        arguments = {"index": i + 1, "surface_type": kind, "conic": surface.get("conic", 0), "material": material,
                     "is_stop": i == 0, "x": pose.get("decentre_x_mm", 0), "y": pose.get("decentre_y_mm", 0), "z": z,
                     "rx": math.radians(pose.get("tilt_x_deg", 0)), "ry": math.radians(pose.get("tilt_y_deg", 0)), **more}
        if kind != "biconic" and kind != "toroidal":
            arguments["radius"] = surface["radius_mm"] if surface["radius_mm"] is not None else np.inf
        optic.add_surface(**arguments)
        z += surface["thickness_mm"]
    optic.add_surface(index=len(surfaces) + 1, **(sensor or {"z": z}))
    for each in optic.surface_group.surfaces:
        if hasattr(each.geometry, "tol"):
            each.geometry.tol = 1e-13  # its own 1e-10 leaves more than is asked here
    return optic


def random_rays(half_width, start_z, count=60):
    random.seed(3)
    rays = []
    for _ in range(count):
        l, m = random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01)
        rays.append((random.uniform(-half_width, half_width), random.uniform(-half_width, half_width), start_z,
                     l, m, math.sqrt(1 - l * l - m * m)))
    return rays


def with_petzval(program, lens, rays):
    with tempfile.TemporaryDirectory() as folder:
        lens_file, rays_file = pathlib.Path(folder, "lens.json"), pathlib.Path(folder, "rays.csv")
        lens_file.write_text(json.dumps(lens))
        rays_file.write_text("x_mm,y_mm,z_mm,L,M,N,wavelength_nm\n" +
                             "".join(",".join(map(repr, ray)) + ",550\n" for ray in rays))
        done = subprocess.run([program, "lens", "trace", lens_file, "--rays", rays_file, "--quiet"], text=True,
                              capture_output=True, check=True, env=dict(os.environ, PETZVAL_DATA=str(ROOT / "data")))
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    return np.array([[float(row[key]) if row["status"] == "ok" else math.nan for key in ("x_mm", "y_mm", "L", "M")]
                     for row in rows])


def with_optiland(optic, rays, local):
    columns = np.array(rays).T
    bundle = RealRays(*columns, np.ones(len(rays)), np.full(len(rays), 0.55))
    optic.surface_group.trace(bundle)
    return local(bundle)


def in_lens_space(rays):
    return np.stack([rays.x, rays.y, rays.L, rays.M], axis=1)


def on_sensor_above(rays):
    """Sensor axes after a turn by 90 degrees about x: y' = z, counted from its middle."""
    return np.stack([rays.x, rays.z - 45, rays.L, rays.N], axis=1)


def main():
    program = sys.argv[1]
    worst = 0
    for make in (hubble, mangin, folded, tilted_sphere, cylinder, toroid, xy_polynomial, zernike_sag):
        surfaces, half_width = make()
        groups, sensor, local, start_z = [], None, in_lens_space, -20.0
        if make is folded:
            surfaces_after = len(surfaces)
            groups = []
            sensor = {"x": 0, "y": 40, "z": 45, "rx": math.radians(90)}
            local = on_sensor_above
        lens = petzval_lens(surfaces, groups)
        if make is folded:
            # The mirror's vertex stands at z = 45, the sensor 40 mm above it, turned by 90 degrees.
            lens["sensor_pose"] = {"decentre_y_mm": 40, "shift_z_mm": 40, "tilt_x_deg": 90}
        if make is hubble:
            start_z = -6000.0
        rays = random_rays(half_width, start_z)
        ours = with_petzval(program, lens, rays)
        theirs = with_optiland(optiland_lens(surfaces, sensor), rays, local)
        reached = ~np.isnan(ours).any(axis=1)
        apart = np.abs(ours - theirs)[reached]
        mm, direction = apart[:, :2].max(), apart[:, 2:].max()
        print(f"{make.__name__:14} {reached.sum():3} of {len(rays)} rays: {mm:.1e} mm, direction {direction:.1e}", flush=True)
        if not (reached.all() and mm < CLOSE_MM and direction < CLOSE_DIRECTION):
            worst = 1
    sys.exit(worst)


if __name__ == "__main__":
    main()
