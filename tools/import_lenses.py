#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Re-encodes published lens prescriptions as native lens files.

    tools/import_lenses.py FOLDER -o data/lenses

FOLDER holds zmx/, pbrt/ and json/ with the files that PRESCRIPTIONS names (see data/lenses/README.md for where they
come from). The readers here are small and independent of the C++ ones, so that a test can hold the two against each
other. The same input gives the same bytes.
"""
import argparse
import json
import math
import pathlib
import struct

F_D_C_NM = [486.1327, 587.5618, 656.2725]
D_NM = 587.5618

# RXGLASS, the catalogue that the file names, is not to be had; with these CDGM glasses focal length, magnification
# and entrance pupil agree with the figures in the file itself to all its digits.
EDMUND_GLASSES = {"LAK10C": "CDGM:H-LAK10", "LAF1C": "CDGM:H-LAF1", "ZF7C": "CDGM:ZF7", "ZK9C": "CDGM:H-ZK9A",
                  "LAK1C": "CDGM:H-LAK1"}
# SSK4, SK1 and F15 are no longer made and no catalogue of today has them: nd and Vd as SCHOTT's old catalogue gave
# them (glass codes 618551, 610567, 606378).
PATENT_GLASSES = {"SSK4": {"nd": 1.61765, "vd": 55.14}, "SK1": {"nd": 1.61025, "vd": 56.71},
                  "F15": {"nd": 1.60565, "vd": 37.83}, "SK16": "HIKARI:SK16"}

SMITH = "W. J. Smith, Modern Lens Design, {}; by way of the CS348B assignment and pbrt-v4-scenes. Indices for one " \
        "wavelength; image surface at the paraxial focus"
ISETRTF = "{}; by way of isetrtf and ISETCam (MIT). Indices for one wavelength; image surface at the paraxial focus"


def angles(*values):
    return {"type": "angle_deg", "values": [float(v) for v in values]}


# name: (kind of file, path, name of the lens, source, what else is set)
PRESCRIPTIONS = {
    "edmund-54852": (
        "zmx", "zmx/EO54852.ZMX", "6 mm f/1.8 micro video lens, Edmund Optics 54-852",
        "Edmund Optics R54-852, the lens of Maeda, Catrysse & Wandell 2005, who used the prescription with the vendor's "
        "approval; file EO54852.ZMX of ISETCam (MIT). CDGM glasses stand for those of the catalogue RXGLASS",
        {"glasses": EDMUND_GLASSES}),
    "us-2532751": (
        "zmx", "zmx/US02532751-1.zmx", "Double Gauss with an aspheric front, US patent 2,532,751",
        "US patent 2,532,751, lens exchange file US02532751-1",
        {"glasses": PATENT_GLASSES}),
    "us-5831776": (
        "zmx", "zmx/US05831776-1.zmx", "Projection lens for 248 nm lithography, US patent 5,831,776",
        "US patent 5,831,776, lens exchange file US05831776-1",
        {"glasses": {"SILICA": "MISC:SILICA"}}),
    "dgauss-50mm": (
        "dat", "pbrt/dgauss.50mm.dat", "Double Gauss 50 mm f/2, 22 degrees half field",
        SMITH.format("p. 312: US patent 2,673,491 (Tronnier)"), {"fields": angles(0, 7, 15, 22)}),
    "wide-22mm": (
        "dat", "pbrt/wide.22mm.dat", "Wide-angle lens 22 mm, 38 degrees half field",
        SMITH.format("p. 360: Nakamura"), {"fields": angles(0, 13, 26, 38)}),
    "telephoto-250mm": (
        "dat", "pbrt/telephoto.250mm.dat", "Super-achromatic telephoto lens 250 mm f/5.6",
        SMITH.format("p. 175: Sigler"), {"fields": angles(0, 2, 3.5, 5)}),
    "fisheye-10mm": (
        "dat", "pbrt/fisheye.10mm.dat", "Fisheye lens 10 mm f/4, 78 degrees half field",
        SMITH.format("p. 164: Muller"), {"fields": angles(0, 30, 55, 75)}),
    "cooke-triplet": (
        "project", "json/cooke_triplet_f5.json", "Cooke triplet 50 mm f/5, 20 degrees half field",
        "The vendor sample \"Cooke 40 degree field\", by way of Optiland (MIT)", {}),
    "double-gauss": (
        "project", "json/double_gauss_f5.json", "Double Gauss 100 mm f/5, 14 degrees half field",
        "The vendor sample \"Double Gauss 28 degree field\" at f/5, by way of Optiland (MIT)", {}),
    "tessar": (
        "iset", "json/tessar-zemax.json", "Tessar", ISETRTF.format("A vendor sample"),
        {"fields": angles(0, 5, 10, 14)}),
    "inverse-telephoto": (
        "iset", "json/inversetelephoto-zemax.json", "Inverse telephoto lens",
        ISETRTF.format("A vendor sample"), {"fields": angles(0, 10, 20, 30)}),
    "petzval-lens": (
        "iset", "json/petzval-zemax.json", "Petzval lens with field flattener", ISETRTF.format("A vendor sample"),
        {"fields": angles(0, 2, 4, 6)}),
    "dgauss-12.5mm": (
        "iset", "json/dgauss.22deg.12.5mm.json", "Double Gauss 12.5 mm, 22 degrees half field",
        ISETRTF.format("W. J. Smith, Modern Lens Design, p. 312, scaled"), {"fields": angles(0, 7, 15, 22)}),
}


def read_text(path):
    raw = path.read_bytes()
    return raw.decode("utf-16" if raw[:2] == b"\xff\xfe" else "latin-1")


def radius_of(printed_curvature):
    """The shortest radius whose curvature has all the printed digits: 2.115506663846E-001 is that of 4.727."""
    curvature = float(printed_curvature)
    if curvature == 0:
        return None
    digits = min(sum(c.isdigit() for c in printed_curvature.upper().split("E")[0].lstrip("-0.")), 16)
    radii = (float(f"{1 / curvature:.{n}g}") for n in range(1, 18))
    return next(r for r in radii if f"{1 / r:.{digits - 1}e}" == f"{curvature:.{digits - 1}e}")


def read_zmx(path, glasses):
    """The few keywords that the files in PRESCRIPTIONS use."""
    header, surfaces = {}, []
    for line in read_text(path).splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "SURF":
            surfaces.append({"PARM": {}})
        elif surfaces and not line.startswith(" "):
            break
        elif not surfaces:
            header.setdefault(words[0], []).append(words[1:])
        elif words[0] == "PARM":
            surfaces[-1]["PARM"][int(words[1])] = float(words[2])
        else:
            surfaces[-1][words[0]] = words[1:]
    assert header["UNIT"][0][0] == "MM"
    kind, telecentric, field_count, wavelength_count = [int(w) for w in header["FTYP"][0][:4]]
    # 0.5875618 um is 587.5618 nm, not the double nearest to the product of the doubles.
    wavelengths = [round(float(words[1]) * 1e3, 6) for words in header["WAVM"]][:wavelength_count]
    stop = next(s for s in surfaces if "STOP" in s)
    lens = {
        "object_distance_mm": None if surfaces[0]["DISZ"][0] == "INFINITY" else float(surfaces[0]["DISZ"][0]),
        "aperture": zmx_aperture(header, stop),
        "fields": {"type": ["angle_deg", "object_height_mm", "paraxial_image_height_mm", "real_image_height_mm"][kind],
                   "values": [float(word) for word in header["YFLN"][0][:field_count]]},
        "wavelengths_nm": wavelengths,
        "reference_wavelength_nm": wavelengths[int(header["PWAV"][0][0]) - 1],
        "surfaces": [zmx_surface(surface, glasses) for surface in surfaces[1:-1]],
    }
    return lens


def zmx_aperture(header, stop):
    if "FNUM" in header:
        value, flag = header["FNUM"][0]
        return {"working_f_number" if flag == "1" else "f_number": float(value)}
    if "OBNA" in header:
        assert header["OBNA"][0][1] == "0"
        return {"object_na": float(header["OBNA"][0][0])}
    assert "FLOA" in header
    return {"stop_semi_diameter_mm": float(stop["DIAM"][0])}


def zmx_surface(surface, glasses):
    assert surface["TYPE"][0] in ("STANDARD", "EVENASPH")
    aperture = surface.get("CLAP") or surface.get("FLAP")
    if aperture:
        semi_diameter = float(aperture[1])
    else:
        semi_diameter = float(surface["DIAM"][0]) if surface["DIAM"][1] == "1" else None
    even = surface["TYPE"][0] == "EVENASPH"
    return {
        "radius_mm": radius_of(surface["CURV"][0]), "thickness_mm": float(surface["DISZ"][0]),
        "glass": glasses[surface["GLAS"][0]] if "GLAS" in surface else None, "stop": "STOP" in surface,
        "semi_diameter_mm": semi_diameter, "conic": float(surface["CONI"][0]) if "CONI" in surface else 0.0,
        "asphere": {str(2 * i): value for i, value in sorted(surface["PARM"].items()) if even and value != 0},
    }


def rows_to_lens(rows, fields):
    """rows: (radius, thickness, index behind, semi-diameter), radius 0 at the stop."""
    surfaces = []
    for radius, thickness, index, semi_diameter in rows:
        stop = radius == 0
        surfaces.append({"radius_mm": None if stop else radius, "thickness_mm": thickness,
                         "glass": None if index in (0, 1) else {"index": index}, "stop": stop,
                         "semi_diameter_mm": semi_diameter})
    assert surfaces[-1]["thickness_mm"] == 0
    surfaces[-1]["thickness_mm"] = paraxial_focus(rows)
    stop = next(s for s in surfaces if s["stop"])
    return {"object_distance_mm": None, "aperture": {"stop_semi_diameter_mm": stop["semi_diameter_mm"]},
            "fields": fields, "wavelengths_nm": F_D_C_NM, "reference_wavelength_nm": D_NM, "surfaces": surfaces}


def paraxial_focus(rows):
    y, u, n = 1.0, 0.0, 1.0
    for i, (radius, thickness, index, _) in enumerate(rows):
        after = index or 1.0
        if radius:
            u = (n * u - y * (after - n) / radius) / after
        n = after
        if i + 1 < len(rows):
            y += thickness * u
    return -y / u


def read_dat(path, fields):
    rows = []
    for line in read_text(path).splitlines():
        words = line.split("#")[0].split()
        if words:
            radius, thickness, index, diameter = [float(word) for word in words]
            rows.append((radius, thickness, index, diameter / 2))
    return rows_to_lens(rows, fields)


def shortest_float32(value):
    """1.669999957084656 was 1.67 before somebody kept it in 32 bits."""
    single = struct.pack("f", value)
    if not math.isclose(struct.unpack("f", single)[0], value, rel_tol=1e-15):  # the 16 digits of the file
        return value
    return next(float(text) for text in (f"{value:.{digits}g}" for digits in range(1, 18))
                if struct.pack("f", float(text)) == single)


def read_iset(path, fields):
    data = json.loads(read_text(path))
    rows = [tuple(shortest_float32(float(surface[key])) for key in ("radius", "thickness", "ior", "semi_aperture"))
            for surface in data["surfaces"]]
    return rows_to_lens(rows, fields)


def project_glass(surface):
    """"SK16 (hikari)" is HIKARI:SK16; a test holds the catalogue's indices against those listed here."""
    if surface["material"] == "AIR":
        return None
    name, catalogue = surface["material"].rstrip(")").split(" (")
    return f"{catalogue.upper()}:{name}"


def read_project(path):
    data = json.loads(read_text(path))
    assert data["field_type"] == "object_angle_y_deg" and data["object"] == "infinity"
    kind = {"EPD": "entrance_pupil_diameter_mm", "image_fno_paraxial": "f_number"}[data["aperture"]["type"]]
    wavelengths = [round(um * 1e3, 6) for um in data["wavelengths_um"]]
    surfaces = []
    for number, surface in enumerate(data["surfaces"], start=1):
        assert not surface["poly"] and not surface["conic"]
        surfaces.append({"radius_mm": surface["radius"], "thickness_mm": float(surface["thickness"]),
                         "glass": project_glass(surface), "stop": number == data["stop_surface"],
                         "semi_diameter_mm": surface["semi_aperture"] and float(surface["semi_aperture"])})
    return {"object_distance_mm": None, "aperture": {kind: data["aperture"]["value"]},
            "fields": angles(*data["fields"]), "wavelengths_nm": wavelengths,
            "reference_wavelength_nm": wavelengths[data["primary"]], "surfaces": surfaces}


def native_text(name, source, lens):
    """Pretty-printed, one surface a line; entries that say nothing are left out."""
    def one_line(value):
        return json.dumps(value, ensure_ascii=False)

    lines = [f'  "{key}": {one_line(value)},' for key, value in
             [("format", "petzval-lens/1"), ("name", name), ("source", source)]
             + [(key, lens[key]) for key in lens if key != "surfaces"]]
    surfaces = []
    for surface in lens["surfaces"]:
        kept = {key: value for key, value in surface.items()
                if key in ("radius_mm", "thickness_mm") or value not in (None, False, 0.0, {})}
        assert all(math.isfinite(v) for v in kept.values() if isinstance(v, float))
        surfaces.append("    " + one_line(kept))
    return "{\n" + "\n".join(lines) + '\n  "surfaces": [\n' + ",\n".join(surfaces) + "\n  ]\n}\n"


def read_prescription(kind, path, options):
    if kind == "zmx":
        return read_zmx(path, options["glasses"])
    if kind == "project":
        return read_project(path)
    return {"dat": read_dat, "iset": read_iset}[kind](path, options["fields"])


def main():
    parser = argparse.ArgumentParser(description="Re-encode published lens prescriptions as native lens files.")
    parser.add_argument("folder", type=pathlib.Path, help="with zmx/, pbrt/ and json/")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="folder to write to")
    arguments = parser.parse_args()
    for stem, (kind, path, name, source, options) in PRESCRIPTIONS.items():
        lens = read_prescription(kind, arguments.folder / path, options)
        (arguments.output / f"{stem}.json").write_text(native_text(name, source, lens), encoding="utf-8")


if __name__ == "__main__":
    main()
