# SPDX-License-Identifier: BSD-3-Clause
"""A lens in closed form, written as ISET's files and as Petzval's own, without Petzval: numbers are laid out here
from the descriptions of the formats, each in its own frame.

The lens: 8 mm, f/2.5, object at infinity, 4 % barrel distortion at the edge, an illumination that falls as a parabola,
and a lopsided spot: a Gaussian head on the chief ray and a wider tail that grows with the height and leans to one side.
Its centre of gravity lies 0.8 % of the height beyond the chief ray.
"""

import math
import struct
import zlib

import h5py
import numpy as np

EFL, F_NUMBER = 8.0, 2.5
HEIGHTS = np.linspace(0, 2.4, 13)  # paraxial [mm]
WAVES = np.array([500.0, 600.0])
SPACING_UM, SIZE = 1.0, 128
OFFSET = 0.008  # of the centre of gravity, per height
LEAN = 0.5  # of the tail: s per t
G_AXIS = math.pi / (1 + 4 * F_NUMBER ** 2)


def real_height(paraxial, nm):
    return paraxial * (1 - 0.04 * (paraxial / 2.4) ** 2) * (1 + 1e-3 * (nm - 500) / 100)


def relative_illumination(real):
    """Of a uniform wall, as lens design programs print it."""
    return 1 - 0.06 * real ** 2


def g_source(real):
    """What gives that wall: the light of height h is centred on (1 + OFFSET) h, and each ring keeps its flux."""
    return G_AXIS * relative_illumination((1 + OFFSET) * real) * (1 + OFFSET) ** 2


def light(s_um, t_um, real):
    """The spot [per sample] at (s, t): t away from the axis, s a quarter turn clockwise from it in the picture."""
    t_tail = 2 * OFFSET * real * 1000  # half of the light is in the tail
    head = np.exp(-(s_um ** 2 + t_um ** 2) / (2 * 2.0 ** 2)) / 2.0 ** 2
    width = 2.0 + real
    tail = np.exp(-((s_um - LEAN * t_tail) ** 2 + (t_um - t_tail) ** 2) / (2 * width ** 2)) / width ** 2
    return SPACING_UM ** 2 * (head + tail) / (4 * math.pi)


def write_native(path):
    """The HDF5 layout of docs/FILE_FORMATS.md, without the checksum."""
    shape = (len(HEIGHTS), len(WAVES))
    real = np.array([[real_height(h, nm) for nm in WAVES] for h in HEIGHTS])
    axis = (np.arange(SIZE) - SIZE // 2) * SPACING_UM
    t, s = np.meshgrid(axis, axis, indexing="ij")
    psf = np.array([[light(s, t, r) for r in row] for row in real])
    psf /= psf.sum(axis=(2, 3), keepdims=True)
    with h5py.File(path, "w") as file:
        file.attrs.update(format="petzval-optics/1", lens_name="closed form", lens_json="", provenance="test",
                          object_distance_mm=math.inf, vertex_to_sensor_mm=0.0)
        first = file.create_group("first_order").attrs
        first.update(wavelength_nm=550.0, efl_mm=EFL, f_number=F_NUMBER, working_f_number=F_NUMBER, magnification=0.0)
        file["object_field"] = np.degrees(np.arctan(HEIGHTS / EFL))
        file["wavelength"] = WAVES
        file["real_image_height"] = real
        file["g_source"] = g_source(real)
        file["g_sensor"] = G_AXIS * relative_illumination(real)
        file["psf"] = psf.astype("f4")
        file["psf_size"] = np.full(shape, SIZE)
        file["psf_spacing"] = np.full(shape, SPACING_UM)
        file["psf_captured"] = np.ones(shape)


# MATLAB, level 5: a tag of type and size, then data padded to eight bytes (up to four bytes share eight with their tag);
# the first index runs fastest.

def _element(kind, data):
    return struct.pack("<II", kind, len(data)) + data + b"\0" * (-len(data) % 8)


def _matrix(array_class, shape, name, content):
    flags = _element(6, struct.pack("<II", array_class, 0))
    sizes = _element(5, struct.pack(f"<{len(shape)}i", *shape))
    return _element(14, flags + sizes + _element(1, name.encode()) + content)


def matlab(value, name=""):
    """A dictionary as a struct, a text, a number or an array as MATLAB stores it."""
    if isinstance(value, dict):
        names = b"".join(key.encode().ljust(32, b"\0") for key in value)
        fields = b"".join(matlab(inner) for inner in value.values())
        return _matrix(2, (1, 1), name, struct.pack("<HHi", 5, 4, 32) + _element(1, names) + fields)
    if isinstance(value, str):
        return _matrix(4, (1, len(value)), name, _element(4, value.encode("utf-16-le")))
    array = np.atleast_2d(np.asarray(value, dtype="<f8"))
    return _matrix(6, array.shape, name, _element(9, array.tobytes(order="F")))


def write_mat(path, name, value, packed=True):
    variable = matlab(value, name)
    if packed:
        deflated = zlib.compress(variable)
        variable = struct.pack("<II", 15, len(deflated)) + deflated
    path.write_bytes(b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H", 0x0100) + b"IM" + variable)


def ray_trace(turned=False):
    """ISET's structure. ISET turns psf.function from the direction of its columns to the azimuth of a place, its zero in
    row and column SIZE/2 counted from 1. `turned`: as rtImportData leaves PSFs of Zemax, standing on end."""
    real = np.array([[real_height(h, nm) for nm in WAVES] for h in HEIGHTS])
    function = np.empty((SIZE, SIZE, len(HEIGHTS), len(WAVES)))
    zero = SIZE // 2 - 1
    rows, columns = np.meshgrid(np.arange(SIZE) - zero, np.arange(SIZE) - zero, indexing="ij")
    for i, _ in enumerate(HEIGHTS):
        for j, _ in enumerate(WAVES):
            # Away is to the right; a quarter turn clockwise from it is down.
            t, s = columns * SPACING_UM, rows * SPACING_UM
            if turned:  # away is up; a quarter turn clockwise from it is to the right
                t, s = -rows * SPACING_UM, columns * SPACING_UM
            function[:, :, i, j] = light(s, t, real[i, j])
    curve = {"fieldHeight": HEIGHTS[:, None], "wavelength": WAVES[:, None]}
    return {"program": "Zemax", "lensFile": "closed form", "referenceWavelength": 550.0, "objectDistance": math.inf,
            "mag": 0.0, "fNumber": F_NUMBER, "effectiveFocalLength": EFL, "effectiveFNumber": F_NUMBER,
            "fov": 2 * math.degrees(math.atan(2.4 / EFL)),
            "geometry": {"function": real, **curve},
            "relIllum": {"function": relative_illumination(real), **curve},
            "psf": {"function": function, **curve, "sampleSpacing": [SPACING_UM / 1000] * 2}}


def listing(field, wave, header="Values are relative intensity."):
    """A Huygens PSF as Zemax lists it: columns along x', rows from +y' down, the field at -y' as ISET's macros put it."""
    real = real_height(HEIGHTS[field], WAVES[wave])
    x, y = np.meshgrid((np.arange(SIZE) - SIZE // 2) * SPACING_UM, (SIZE // 2 - np.arange(SIZE)) * SPACING_UM)
    # At -y' away is -y' (down); clockwise from it -x'.
    values = light(-x, -y, real)
    values *= 0.486 / values.max()
    head = ["Listing of Huygens PSF Data", "", "File : C:\\ZEMAX\\CLOSED.ZMX", "Title: closed form", "", "HUYGENS PSF",
            f"{WAVES[wave] / 1000:.4f} \u00b5m at {-real:.2f} deg.", f"Data spacing is {SPACING_UM:.2f} \u00b5m.",
            f"Data area is {SIZE * SPACING_UM:.2f} by {SIZE * SPACING_UM:.2f} \u00b5m.", "Strehl ratio: 0.486",
            "Pupil grid size: 32 by 32", f"Image grid size: {SIZE} by {SIZE}",
            f"Center point is: {SIZE // 2 + 1}, {SIZE // 2 + 1}",
            f"Center coordinates: 0.00000000E+000, {-real:.8E}", header, ""]
    return "\r\n".join(head + ["\t".join(f"{v:.6E}" for v in row) for row in values] + [""])


def write_zemax(folder, header="Values are relative intensity.", encoding="latin-1", old_names=False):
    """ISETPARMS.TXT, DI, RI and the listings, as ISET's macros leave them."""
    folder.mkdir(exist_ok=True)
    (folder / "ISETPARMS.TXT").write_text("\r\n".join([
        "%   C:\\PROGRAM FILES\\ZEMAX\\LENSES\\CLOSED.ZMX", "lensFile='CLOSED.ZMX';     %Lens file name",
        f"psfSize={SIZE};                 % PSF ROW AND COL SIZE", f"psfSpacing={SPACING_UM / 1000:.7f};   % IN MM",
        "wave=500:100:600;            % WAVELENGTH SAMPLES (NM)", f"imgHeightNum={len(HEIGHTS)};   % Number",
        f"imgHeightMax={HEIGHTS[-1]:.7f};      % (MM)", "objDist=10000000000.000;   % OBJECT DISTANCE (MM)",
        "mag=0.000000;", "baseLensFileName='C:\\Program Files\\ZEMAX\\ISET\\CLOSED'", "refWave=550.000;",
        f"fov={math.degrees(math.atan(2.4 / EFL)):.6f};", f"efl={EFL:.6f};", f"fnumber_eff={F_NUMBER:.6f};",
        f"fnumber={F_NUMBER:.6f};", ""]))
    real = [[real_height(h, nm) for nm in WAVES] for h in HEIGHTS]
    curves = {"DI": real, "RI": [[relative_illumination(r) for r in row] for row in real]}
    for name, rows in curves.items():
        text = "\n".join(" ".join(f"{v:.9E}" for v in row) for row in rows) + "\n"
        (folder / f"CLOSED_{name}_.dat").write_text(text)
    for i in range(len(HEIGHTS)):
        for j in range(len(WAVES)):
            name = f"CLOSED_PSF_{i + 1}_{j + 1}.dat" if old_names else f"CLOSED_2D_PSF_Fld{i + 1}_Wave{j + 1}.dat"
            (folder / name).write_bytes(listing(i, j, header).encode(encoding))


# Reading what was exported.

def read_mat(path):
    """(name, value) of the one variable of a packed file; structs are dictionaries, arrays are in MATLAB's shape."""
    data = path.read_bytes()
    assert data[:6] == b"MATLAB" and data[124:128] == b"\0\1IM"
    kind, size = struct.unpack_from("<II", data, 128)
    assert kind == 15 and 136 + size == len(data)
    return _read_matrix(zlib.decompress(data[136:])[8:])


def _read_element(data, at):
    """(type, content, where the next one begins)."""
    kind, size = struct.unpack_from("<II", data, at)
    if kind >> 16:  # small
        return kind & 0xffff, data[at + 4:at + 4 + (kind >> 16)], at + 8
    return kind, data[at + 8:at + 8 + size], at + 8 + size + (-size % 8 if kind != 14 else 0)


def _read_matrix(data):
    _, flags, at = _read_element(data, 0)
    _, shape, at = _read_element(data, at)
    shape = struct.unpack(f"<{len(shape) // 4}i", shape)
    _, name, at = _read_element(data, at)
    array_class = flags[0]
    if array_class == 2:
        _, width, at = _read_element(data, at)
        _, names, at = _read_element(data, at)
        width = struct.unpack("<i", width)[0]
        value = {}
        for start in range(0, len(names), width):
            _, field, at = _read_element(data, at)
            value[names[start:start + width].split(b"\0")[0].decode()] = _read_matrix(field)[1]
        return name.decode(), value
    kind, content, _ = _read_element(data, at)
    if array_class == 4:
        return name.decode(), content.decode("utf-16-le" if kind in (4, 17) else "utf-8")
    numbers = np.frombuffer(content, {1: "<i1", 2: "<u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 9: "<f8"}[kind])
    return name.decode(), numbers.astype("f8").reshape(shape, order="F")
