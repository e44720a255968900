# SPDX-License-Identifier: BSD-3-Clause
"""The telephone's sensor: conversion gain, noise against level, and a colour chart under three lights.

The figures of the IMX363 are those that Lyu et al. (2022) set for the telephone at ISO 55, in volts; ISETCam's model of the
sensor (sensorIMX363, MIT) says what a volt is: 0.44875 mV a step up to 1023, and 6000 electrons in that swing.
"""
import json
import math

from .files import npy, spectra_of, write_npy

SWING_MV, FULL_WELL_E, BLACK_DN, WHITE_DN = 1023 * 0.44875, 6000, 64, 1023
MV_PER_E, MV_PER_DN = SWING_MV / FULL_WELL_E, SWING_MV / (WHITE_DN + 1 - BLACK_DN)
DN_PER_E = MV_PER_E / MV_PER_DN
DSNU_MV, DARK_MV_PER_S, READ_MV, PRNU_PERCENT = 0.38, 0.021, 0.2256, 0.544
GAIN_MEASURED_WITHIN = 0.018  # the authors' photon transfer on the telephone, against the gain above
LEVELS_DN = (2, 10, 40, 120, 250, 450, 650, 850)
LIGHTS = ("A", "D65", "F11")


def description(name, columns, rows, sensitivities):
    """A sensor file of Petzval. sensitivities: by channel, a list as in `quantum_efficiency`."""
    return {"format": "petzval-sensor/1", "name": name, "source": "Lyu et al. (2022) and ISETCam's sensorIMX363 (MIT)",
            "columns": columns, "rows": rows, "pitch_um": 1.4,
            "channels": [{"name": channel, "quantum_efficiency": spectra} for channel, spectra in sensitivities.items()],
            "mosaic": [["red", "green"], ["green", "blue"]],
            "gain_modes": [{"name": "base", "full_well_e": FULL_WELL_E, "dn_per_e": DN_PER_E, "read_noise_e": READ_MV / MV_PER_E}],
            "adc": {"bits": 10, "black_level_dn": BLACK_DN, "white_level_dn": WHITE_DN},
            "dark": {"current_e_per_s": DARK_MV_PER_S / MV_PER_E, "temperature_c": 25, "doubling_c": 7},
            "dsnu_e": DSNU_MV / MV_PER_E, "prnu_percent": PRNU_PERCENT}


def calibrated(folder):
    """Sensitivities as the authors' calibration left them."""
    return {name: [{"wavelengths_nm": [nm for nm, _ in curve], "values": [value for _, value in curve]}]
            for name, curve in spectra_of(folder / "sensor_qe.csv").items()}


def write_sensor(path, *what):
    path.write_text(json.dumps(description(*what)))
    return path


def gain(phone, sensor, page):
    """What a photon transfer of exposures finds again."""
    found = json.loads(phone.run("measure", "sensor", sensor, "--json"))
    rows = [("conversion gain [DN/e]", found["dn_per_e"], DN_PER_E), ("dark noise [e]", found["dark_noise_e"], READ_MV / MV_PER_E),
            ("DSNU [e]", found["dsnu_e"], DSNU_MV / MV_PER_E), ("PRNU [%]", found["prnu_percent"], PRNU_PERCENT)]
    print("the sensor by a photon transfer (EMVA 1288)     ours  published simulation  difference")
    for name, ours, set_to in rows:
        print(f"  {name:40} {ours:10.4f}  {set_to:10.4f}  {100 * (ours / set_to - 1):+.2f} %")
    print(f"  the authors' photon transfer on the telephone: gain within {100 * GAIN_MEASURED_WITHIN:.1f} % of {DN_PER_E:.4f} DN/e")
    table = [[name, f"{ours:.4f}", f"{set_to:.4f}", f"{100 * (ours / set_to - 1):+.2f} %", "not in the data"] for name, ours, set_to in rows]
    table[0][4] = f"within {100 * GAIN_MEASURED_WITHIN:.1f} % of the simulation's: {DN_PER_E * (1 - GAIN_MEASURED_WITHIN):.4f} to {DN_PER_E * (1 + GAIN_MEASURED_WITHIN):.4f}"
    for row in table:
        page.summary(row[0], row[1], row[2], row[4], f"{row[3]} from the simulation's")
    page.table("Conversion gain and noise", ["", "ours, by a photon transfer", "published simulation", "difference", "telephone, measured"], table,
               f"{MV_PER_E * 1000:.2f} µV an electron. Dark noise is that of the readings; below 0.4 DN the steps of the converter hide it.")


def published_noise_dn(mean_dn):
    """Standard deviation [DN] over pixels of a uniform surface, by the published figures: no part of Petzval."""
    electrons = mean_dn / DN_PER_E
    fixed = (DSNU_MV / MV_PER_E) ** 2 + (PRNU_PERCENT / 100 * electrons) ** 2
    return math.sqrt(DN_PER_E**2 * ((READ_MV / MV_PER_E) ** 2 + electrons + fixed) + 1 / 12)


def mean_and_deviation(values):
    mean = sum(values) / len(values)
    return mean, math.sqrt(sum((value - mean) ** 2 for value in values) / (len(values) - 1))


def noise(phone, sensor, page, size=200):
    """Uniform light in steps of exposure; the green pixels of one picture, as the authors measured theirs."""
    light = page.folder / "flat.npy"
    write_npy(light, size, size, 1.0)

    def green(seconds):
        raw = page.folder / "flat-raw.npy"
        phone.run("sense", light, "--wavelengths", "550", "--sensor", sensor, "--exposure", f"{seconds:.9g}", "-o", raw)
        rows = npy(raw)
        return mean_and_deviation([rows[r][c][0] - BLACK_DN for r in range(size) for c in range(1 - r % 2, size, 2)])

    short_s = 1e-3
    dn_per_s = green(short_s)[0] / short_s
    print("noise of green pixels     level [DN]    ours  by the published figures  difference")
    ours, theirs = [], []
    for level in LEVELS_DN:
        mean, deviation = green(level / dn_per_s)
        ours.append((mean, deviation)), theirs.append((mean, published_noise_dn(mean)))
        print(f"                          {mean:10.1f}  {deviation:6.3f}  {theirs[-1][1]:24.3f}  {100 * (deviation / theirs[-1][1] - 1):+9.2f} %")
    worst = max(abs(a[1] / b[1] - 1) for a, b in zip(ours, theirs))
    page.summary(f"noise at {ours[-1][0]:.0f} DN [DN]", f"{ours[-1][1]:.2f}", f"{theirs[-1][1]:.2f} by its figures", "not in the data",
                 f"{100 * worst:.1f} % at most of eight levels")
    page.plot("Noise against level, green", "mean above black [DN]", {
        "ours, DN": ours, "published figures, DN": theirs},
        f"Ours: {size} × {size} pixels of uniform light at each level. The published simulation's figures in closed form (read noise, photons, PRNU, "
        f"DSNU, steps of the converter). They differ by {100 * worst:.1f} % at most; half the pixels of one picture tell a deviation to 0.5 %. "
        "The measured points of figure 8 are not in the data.")


def chart_values(phone, folder, sensor, light):
    """Of each patch of the ColorChecker: raw red, green and blue [DN], and ΔE2000 when developed."""
    name = f"chart-{sensor.stem}-{light}"
    exr, dng, raw, shot = (folder / f"{name}{ending}" for ending in (".exr", ".dng", ".npy", ".png"))
    phone.run("image", "colorchecker", "--lens", phone.lens, "--focus", "0.5m", "--illuminant", light, "--sensor", sensor, "--method", "none",
              "--wavelengths", "400:10:700", "-o", exr)
    phone.run("sense", exr, "--sensor", sensor, "--illuminant", light, "-o", raw, "-o", dng)
    phone.run("develop", dng, "-o", shot)
    found = json.loads(phone.run("measure", "colour", shot, "--light", light, "--json"))
    rows = npy(raw)
    half = 4
    patches = []
    for patch in found["rows"]:
        r, c = int(patch["y_px"]) // 2 * 2, int(patch["x_px"]) // 2 * 2
        sums = [[], [], []]
        for y in range(r - half, r + half):
            for x in range(c - half, c + half):
                sums[y % 2 + x % 2].append(rows[y][x][0] - BLACK_DN)
        patches.append((patch["patch"], [sum(each) / len(each) for each in sums]))
    return patches, found["mean_delta_e_2000"], shot


def colour(phone, folder, page, size=(400, 300)):
    """The chart through the lens under three lights, by the calibrated sensitivities and by those of the bundled sensor."""
    assumed = {channel: [{"set": "ar0132at", "spectrum": channel, "scale": 0.75}, {"set": "ir_cut", "spectrum": "transmittance"}]
               for channel in ("red", "green", "blue")}
    sensors = {"calibrated": write_sensor(page.folder / "calibrated.json", "calibrated", *size, calibrated(folder)),
               "bundled": write_sensor(page.folder / "bundled.json", "bundled imx363", *size, assumed)}
    print("colour chart              light  R/G, B/G of white: calibrated   bundled      colours apart   DE2000: calibrated  bundled")
    for light in LIGHTS:
        seen = {name: chart_values(phone, page.folder, sensor, light) for name, sensor in sensors.items()}
        ratios = {name: {patch: (r / g, b / g) for patch, (r, g, b) in values} for name, (values, _, _) in seen.items()}
        white = {name: each["white"] for name, each in ratios.items()}
        # White set to white in each: what is left is the shape of the sensitivities.
        apart = sum(abs(math.log(ratios["calibrated"][patch][k] / white["calibrated"][k] * white["bundled"][k] / ratios["bundled"][patch][k]))
                    for patch in ratios["calibrated"] for k in (0, 1)) / 2 / len(ratios["calibrated"])
        print(f"                          {light:5}  {white['calibrated'][0]:.3f} {white['calibrated'][1]:.3f}"
              f"{white['bundled'][0]:22.3f} {white['bundled'][1]:.3f} {100 * apart:14.1f} %   {seen['calibrated'][1]:18.2f} {seen['bundled'][1]:8.2f}")
        page.table(f"Colour chart under {light}", ["patch", "red [DN]", "green [DN]", "blue [DN]"],
                   [[patch, *(f"{value:.1f}" for value in values)] for patch, values in seen["calibrated"][0]],
                   f"Mean ΔE2000 when developed: {seen['calibrated'][1]:.2f} with the calibrated sensitivities, {seen['bundled'][1]:.2f} with those of the bundled imx363. "
                   f"R/G and B/G, white set to white, differ between the two by {100 * apart:.1f} % in the mean.")
        page.summary(f"colour chart under {light}, R/G and B/G of white", "{:.3f}, {:.3f}".format(*white["calibrated"]), "not in the data",
                     "not in the data", f"{100 * apart:.1f} % in the mean from the bundled imx363")
        page.picture(seen["calibrated"][2].name, f"The chart under {light}, developed.")
    print("  the telephone's own values of the chart are not in the data; its sensitivities are what they were fitted to")
