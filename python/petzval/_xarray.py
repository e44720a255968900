# SPDX-License-Identifier: BSD-3-Clause
"""Results as xarray's, which is imported when one is asked for."""

import numpy
import xarray


def _axis(dimension, values, units):
    return dimension, numpy.asarray(values), {"units": units}


def _pixels(count, pitch_mm):
    return (numpy.arange(count) + 0.5 - count / 2) * pitch_mm


def light(image):
    pitch_mm = image.pitch_um * 1e-3
    return xarray.DataArray(
        image.values, dims=("y", "x", "wavelength"), name="irradiance",
        coords={"wavelength": _axis("wavelength", image.wavelengths_nm, "nm"),
                "y": _axis("y", -_pixels(image.rows, pitch_mm), "mm"),
                "x": _axis("x", _pixels(image.columns, pitch_mm), "mm")},
        attrs={"units": "W m-2 nm-1", "pitch_um": image.pitch_um, "pixel_aperture": image.pixel_aperture,
               "provenance": image.provenance})


def scene(scene):
    step = 2 * numpy.tan(numpy.radians(scene.horizontal_angle_deg / 2)) / scene.columns
    return xarray.DataArray(
        scene.radiance, dims=("y", "x", "wavelength"), name="radiance",
        coords={"wavelength": _axis("wavelength", scene.wavelengths_nm, "nm"),
                "y": _axis("y", -_pixels(scene.rows, step), "1"), "x": _axis("x", _pixels(scene.columns, step), "1")},
        attrs={"units": "W m-2 sr-1 nm-1", "scene": scene.name})


def picture(picture):
    channels = ["red", "green", "blue"] if picture.shape[2] == 3 else range(picture.shape[2])
    return xarray.DataArray(picture.values, dims=("y", "x", "channel"), name="picture",
                            coords={"channel": list(channels)}, attrs={"space": picture.space, "transfer": "linear"})


def psfs(stack):
    field_units = "deg" if stack.field_type == "angle_deg" else "mm"
    by_point = ("field", "wavelength")
    return xarray.Dataset(
        {"psf": ((*by_point, "y", "x"), stack.values, {"units": "1", "long_name": "share of the light in a cell"}),
         "captured": (by_point, stack.captured, {"units": "1"}),
         "image_height": (by_point, stack.image_height_mm, {"units": "mm"})},
        coords={"field": ("field", stack.fields, {"units": field_units, "type": stack.field_type}),
                "wavelength": _axis("wavelength", stack.wavelengths_nm, "nm"),
                "y": ("y", stack.y_um, {"units": "µm", "long_name": "tangential, away from the axis"}),
                "x": ("x", stack.x_um, {"units": "µm", "long_name": "sagittal"})},
        attrs={"spacing_um": stack.spacing_um})


def table(table):
    return xarray.Dataset({name: ("row", numpy.asarray(column), {"units": table.units.get(name, "")})
                           for name, column in table.items()}, attrs={"heading": table.heading})


def events(events):
    return xarray.Dataset({"t": ("event", events.t_s, {"units": "s"}),
                           "column": ("event", events.column, {"units": "pixel"}),
                           "row": ("event", events.row, {"units": "pixel"}),
                           "brighter": ("event", events.brighter, {"units": "1"})})
