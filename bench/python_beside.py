# SPDX-License-Identifier: BSD-3-Clause
"""Petzval beside Optiland and batoid (both on PyPI) on the same lens: rays through it, and one diffraction PSF. Best of
several runs. What each calls a PSF differs: Petzval sums plane waves of real rays, Optiland and batoid transform the
wavefront over the pupil by an FFT."""

import timeit
import warnings

import numpy as np

import petzval as pz

warnings.simplefilter("ignore")
WAVELENGTH_NM, FIELD_DEG, SAMPLES = 587.5618, 10.0, 128
lens = pz.Lens("double-gauss")
first = lens.first_order(WAVELENGTH_NM)


def show(program, what, call, repeat=5):
    call()
    print(f"{program:<10} {what:<32} {min(timeit.repeat(call, number=1, repeat=repeat)) * 1e3:>10.2f} ms")


def bundle(count=316):
    """count² rays across the entrance pupil, at the field."""
    half = 0.5 * first.entrance_pupil.diameter_mm * 0.7
    x, y = np.meshgrid(np.linspace(-half, half, count), np.linspace(-half, half, count))
    slope = np.tan(np.radians(FIELD_DEG))
    start = first.entrance_pupil.position_mm + 20
    points = np.stack([x.ravel(), y.ravel() - slope * start, np.full(x.size, -20.0)], 1)
    return points, np.tile([0, np.sin(np.radians(FIELD_DEG)), np.cos(np.radians(FIELD_DEG))], (x.size, 1))


points, directions = bundle()
show("Petzval", f"{len(points)} rays", lambda: lens.trace(points, directions, WAVELENGTH_NM, ignore_apertures=True))
show("Petzval", "PSF", lambda: lens.psf([FIELD_DEG], wavelengths_nm=[WAVELENGTH_NM], size=SAMPLES, spacing_um=1, threads=1))


def in_batoid():
    import batoid
    items, z, medium = [], 0.0, batoid.ConstMedium(1.0)
    for surface in lens.surfaces:
        behind = batoid.ConstMedium(surface.glass.index(WAVELENGTH_NM))
        shape = batoid.Plane() if surface.curvature_per_mm == 0 else batoid.Sphere(surface.radius_mm * 1e-3)
        items.append(batoid.RefractiveInterface(shape, name=str(len(items)), inMedium=medium, outMedium=behind,
                                                coordSys=batoid.CoordSys(origin=[0, 0, z * 1e-3])))
        z, medium = z + surface.thickness_mm, behind
    items.append(batoid.Detector(batoid.Plane(), name="sensor", coordSys=batoid.CoordSys(origin=[0, 0, z * 1e-3])))
    return batoid, batoid.CompoundOptic(items, name="lens", inMedium=batoid.ConstMedium(1.0), outMedium=batoid.ConstMedium(1.0),
                                        backDist=0.1, sphereRadius=abs(first.exit_pupil.position_mm) * 1e-3, pupilSize=first.entrance_pupil.diameter_mm * 1e-3,
                                        stopSurface=batoid.Interface(batoid.Plane(), coordSys=batoid.CoordSys(
                                            origin=[0, 0, first.entrance_pupil.position_mm * 1e-3])))


try:
    batoid, optic = in_batoid()
    metres = np.ascontiguousarray(points.T * 1e-3)
    cosines = np.ascontiguousarray(directions.T)

    def trace_in_batoid():
        rays = batoid.RayVector(*metres, *cosines, t=0.0, wavelength=WAVELENGTH_NM * 1e-9)
        return optic.trace(rays)
    ours = lens.trace(points, directions, WAVELENGTH_NM, ignore_apertures=True)
    theirs = trace_in_batoid()
    arrived = ~(np.isnan(ours.points_mm[:, 1]) | np.isnan(theirs.y))
    print(f"rays differ by at most {np.abs(ours.points_mm[arrived, 1] - theirs.y[arrived] * 1e3).max():.1e} mm, {arrived.sum()} of them")
    show("batoid", f"{len(points)} rays", trace_in_batoid)
    show("batoid", "PSF", lambda: batoid.fftPSF(optic, 0, np.radians(FIELD_DEG), WAVELENGTH_NM * 1e-9, nx=SAMPLES, pad_factor=2))
except Exception as error:
    print("batoid:", error)


def in_optiland():
    from optiland import optic
    from optiland.materials import IdealMaterial
    other = optic.Optic()
    other.add_surface(index=0, thickness=np.inf)
    for number, surface in enumerate(lens.surfaces, 1):
        other.add_surface(index=number, radius=surface.radius_mm, thickness=surface.thickness_mm, is_stop=surface.stop,
                          material=IdealMaterial(surface.glass.index(WAVELENGTH_NM)))
    other.add_surface(index=len(lens.surfaces) + 1)
    other.set_aperture(aperture_type="EPD", value=first.entrance_pupil.diameter_mm)
    other.set_field_type(field_type="angle")
    other.add_field(y=0)
    other.add_field(y=FIELD_DEG)
    other.add_wavelength(value=WAVELENGTH_NM * 1e-3, is_primary=True)
    return other


try:
    from optiland.psf import FFTPSF
    other = in_optiland()
    show("Optiland", "about 100,000 rays", lambda: other.trace(Hx=0, Hy=1, wavelength=WAVELENGTH_NM * 1e-3, num_rays=357,
                                                               distribution="uniform"))
    show("Optiland", "PSF", lambda: FFTPSF(other, field=(0, 1), wavelength=WAVELENGTH_NM * 1e-3, num_rays=SAMPLES,
                                           grid_size=2 * SAMPLES))
except Exception as error:
    print("Optiland:", error)
