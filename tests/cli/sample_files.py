# SPDX-License-Identifier: BSD-3-Clause
"""Small right inputs, for tests to use or to spoil."""

import copy
import struct

# A plano-convex singlet with the stop in front. n(N-BK7, 587.56 nm) = 1.51680, so f = 51.68 / 0.51680 = 100.0 mm.
SINGLET = {
    "format": "petzval-lens/1",
    "name": "singlet",
    "source": "made for this test",
    "object_distance_mm": None,
    "aperture": {"f_number": 10.0},
    "fields": {"type": "angle_deg", "values": [0, 5]},
    "wavelengths_nm": [486.13, 587.56, 656.27],
    "reference_wavelength_nm": 587.56,
    "surfaces": [
        {"radius_mm": None, "thickness_mm": 5.0, "stop": True, "semi_diameter_mm": 5.0},
        {"radius_mm": 51.68, "thickness_mm": 4.0, "glass": "SCHOTT:N-BK7", "semi_diameter_mm": 10.0},
        {"radius_mm": None, "thickness_mm": 97.4, "semi_diameter_mm": 10.0},
    ],
}


# A Bayer sensor of 96 x 64 pixels.
SMALL_BAYER = {
    "format": "petzval-sensor/1", "name": "small", "source": "made up", "columns": 96, "rows": 64, "pitch_um": 3.75,
    "channels": [{"name": name, "quantum_efficiency": [{"set": "nikon_d100", "spectrum": name, "scale": 0.5}]}
                 for name in ("red", "green", "blue")],
    "mosaic": [["red", "green"], ["green", "blue"]],
    "gain_modes": [{"name": "base", "full_well_e": 10000, "dn_per_e": 0.4, "read_noise_e": 3}],
    "adc": {"bits": 12, "black_level_dn": 64}, "dsnu_e": 1, "prnu_percent": 1}


def singlet(**changes):
    """The singlet with some of its top-level entries replaced."""
    return {**copy.deepcopy(SINGLET), **changes}


def singlet_with_surface(index, **changes):
    """The singlet with some entries of one surface replaced."""
    lens = singlet()
    lens["surfaces"][index].update(changes)
    return lens


def spectral_exr(columns, rows, wavelengths_nm, value):
    """An uncompressed OpenEXR file of spectral radiance as Fichet et al. (2021) lay it out: a float channel
    "S0.<nm>,000000nm" a wavelength; `value(row, column, band)` fills it. Written from the OpenEXR file layout, without
    OpenEXR."""
    names = sorted(("S0." + f"{nm:.6f}nm".replace(".", ","), band) for band, nm in enumerate(wavelengths_nm))

    def attribute(name, kind, payload):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(payload)) + payload

    channels = b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", 2, 1, 1, 1) for name, _ in names) + b"\0"
    window = struct.pack("<4i", 0, 0, columns - 1, rows - 1)
    header = struct.pack("<II", 20000630, 2)
    header += attribute("channels", "chlist", channels)
    header += attribute("compression", "compression", b"\0")
    header += attribute("dataWindow", "box2i", window)
    header += attribute("displayWindow", "box2i", window)
    header += attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1))
    header += attribute("spectralLayoutVersion", "string", b"1.0")
    header += attribute("emissiveUnits", "string", b"W.m^-2.sr^-1")
    header += b"\0"
    line_bytes = 8 + 4 * columns * len(names)
    first = len(header) + 8 * rows
    body = struct.pack(f"<{rows}Q", *(first + row * line_bytes for row in range(rows)))
    for row in range(rows):
        body += struct.pack("<ii", row, 4 * columns * len(names))
        for _, band in names:
            body += struct.pack(f"<{columns}f", *(value(row, column, band) for column in range(columns)))
    return header + body
