# SPDX-License-Identifier: BSD-3-Clause
"""The telephone's lens: illumination, line spreads and MTF beside its design, its measurements and the published simulation."""
import json
import math
import subprocess
from pathlib import Path

PITCH_MM = 0.0014  # IMX363
FILM_MM = 0.465 - 0.464135918  # behind the input plane, as the authors set it
# The authors tried films 0.465136 mm behind the last surface and on in steps of 0.2/9 mm; these are the ones taken.
THEIR_FILM_MM = {0.5: 0.001 + 0.2 / 9, 0.3: 0.001 + 5 * 0.2 / 9}
LENGTH_MM = 6.771  # from the front plane to the input plane

ILLUMINATION = {0.5: 0.952, 1: 0.840, 1.5: 0.711, 2: 0.586, 2.5: 0.472, 3: 0.387, 3.5: 0.302}

# Focus [m], edge [m], field height [mm]: frequency [1/mm] -> (measured, published simulation).
EDGES = {
    (0.5, 0.5, 0.8): {25: (0.919, 0.955), 50: (0.777, 0.835), 75: (0.609, 0.658), 100: (0.451, 0.466),
                      125: (0.335, 0.292), 150: (0.226, 0.144), 175: (0.148, 0.065), 200: (0.103, 0.064)},
    (0.5, 0.3, 0.7): {25: (0.744, 0.818), 50: (0.394, 0.433), 75: (0.131, 0.100), 100: (0.062, 0.089)},
    (0.3, 0.3, 0.7): {25: (0.826, 0.911), 50: (0.618, 0.695), 75: (0.441, 0.430), 100: (0.250, 0.202),
                      125: (0.138, 0.095), 150: (0.090, 0.078)},
    (0.3, 0.5, 0.8): {25: (0.671, 0.744), 50: (0.203, 0.267), 75: (0.025, 0.042)},
}


class Telephone:
    def __init__(self, folder, petzval):
        self.lens = str(folder / "pixel4a-rearcamera-ellipse-raytransfer.json")
        self.petzval = petzval

    def run(self, *words):
        return subprocess.run([self.petzval, *map(str, words), "--quiet"], check=True, capture_output=True, text=True).stdout

    def ask(self, command, *options):
        return json.loads(self.run("lens", command, self.lens, "--json", *options))

    def at_heights(self, command, heights, *options):
        return self.ask(command, "--field-type", "real_image_height_mm", "--fields", ",".join(f"{h:g}" for h in heights),
                        *options)["rows"]

    def illumination(self, heights):
        rows = self.at_heights("illumination", heights, "--set", f"surfaces[1].thickness_mm={FILM_MM}")
        return [row["relative_illumination"] for row in rows]

    def chief_ray_angles(self, heights):
        return [row["chief_ray_angle_deg"] for row in self.at_heights("chief-ray-angle", heights)]

    def mtf(self, heights, frequencies, *options):
        """(tangential, sagittal) by height and frequency: of the rays alone with --geometric, else of waves."""
        rows = self.at_heights("mtf", heights, "--frequencies", ",".join(f"{f:g}" for f in frequencies), *options)
        return {(row["field"], row["frequency_cpmm"]): (row["tangential"], row["sagittal"]) for row in rows}

    def edge_mtf(self, edge_m, height, film_mm, frequencies, *how):
        """Of an edge between tangential and sagittal, with pixels and the green channel demosaiced bilinearly."""
        ours = self.mtf([height], frequencies, "--set", f"object_distance_mm={1000 * edge_m - film_mm - LENGTH_MM:.6f}",
                        "--set", f"surfaces[1].thickness_mm={film_mm:.9f}", *how)
        return {f: abs(sum(ours[height, f])) / 2 * pixel(f) * green(f) for f in frequencies}


def pixel(frequency):
    x = math.pi * frequency * PITCH_MM
    return math.sin(x) / x


def green(frequency):
    """Half of the pixels are green, the others the mean of their four neighbours, across an upright edge."""
    return 0.75 + 0.25 * math.cos(2 * math.pi * frequency * PITCH_MM)


FINE = [2.5 * k for k in range(1, 161)]  # cycles/mm


def spread(at, contrast):
    """Line spread of an even one, per um at places [um]: the cosine transform of its MTF, in a window of cosine shape that leaves
    nothing beyond 400 per mm, so that it does not ring."""
    return [(x, 0.0025 * (1 + 2 * sum(contrast(f) * math.cos(math.pi * f / 800) ** 2 * math.cos(2 * math.pi * f * x / 1000)
                                      for f in FINE))) for x in at]


def words_of(path):
    for line in path.read_text(encoding="latin-1").splitlines():
        yield line, line.split()


def zemax_illumination(path):
    return [(float(words[0]), float(words[1])) for _, words in words_of(path)
            if len(words) == 3 and words[0][0].isdigit() and all("." in word for word in words)]


def zemax_by_height(path, columns, key, values):
    height, curves = None, {}
    for line, words in words_of(path):
        if line.startswith("Field:"):
            height = float(words[1])
        elif height is not None and len(words) == columns and words[0].lstrip("-")[0].isdigit():
            curves[height, float(words[key])] = tuple(float(words[k]) for k in values)
    return curves


def interpolated(table, positions, at):
    step = positions[1] - positions[0]
    below = min(int(at / step), len(table) - 2)
    return table[below] + (table[below + 1] - table[below]) * (at / step - below)


def light_of_ellipse(file, height):
    """What a point of the input plane sees through the file's ellipse [sr], by a sum over it: no part of Petzval."""
    bands = file["polynomials"]
    what = (bands[0] if isinstance(bands, list) else bands)["passnopass"]
    a, b, c = (interpolated(what[key], what["positions"], height) for key in ("radiiX", "radiiY", "centersY"))
    distance, total, rings = what["intersectPlaneDistance"], 0.0, 100
    for i in range(rings):
        for k in range(rings):
            r, angle = (i + 0.5) / rings, 2 * math.pi * (k + 0.5) / rings
            x, y = a * r * math.cos(angle), c + b * r * math.sin(angle) - height
            total += r * distance**2 / (x * x + y * y + distance**2) ** 2
    return total * a * b * 2 * math.pi / rings**2


def illumination(phone, folder, page):
    rows = zemax_illumination(folder / "RI.txt")
    heights = [height for height, _ in rows]
    file = json.loads(Path(phone.lens).read_text())
    ours, axis = phone.illumination(heights), light_of_ellipse(file, 0)
    own = [light_of_ellipse(file, height) / axis for height in heights]
    print("relative illumination    height [mm]  ours    file's ellipses  design")
    for k in range(0, len(rows), 4):
        print(f"                         {heights[k]:11.3f}  {ours[k]:.4f}  {own[k]:15.4f}  {rows[k][1]:.4f}")
    print(f"  ours from the file's ellipses: {max(abs(a - b) for a, b in zip(ours, own)):.4f} at most; "
          f"these from the design: {max(abs(a - row[1]) for a, row in zip(own, rows)):.4f}")
    # A sensor whose pixels take cos^k of the light at a chief-ray angle; k by least squares in the logarithm.
    places = list(ILLUMINATION)
    cosines = [math.cos(math.radians(angle)) for angle in phone.chief_ray_angles(places)]
    design = [min(rows, key=lambda row: abs(row[0] - place))[1] for place in places]
    kept = [ILLUMINATION[place] / d for place, d in zip(places, design)]
    power = sum(math.log(c) * math.log(s) for c, s in zip(cosines, kept)) / sum(math.log(c) ** 2 for c in cosines)
    with_sensor = [d * c**power for d, c in zip(design, cosines)]
    print(f"  measured: the sensor keeps cos^{power:.2f} of the chief-ray angle (microlens, in a sensor's description)")
    print("                         height [mm]  angle  measured  design  with the sensor")
    for place, c, d, w in zip(places, cosines, design, with_sensor):
        print(f"                         {place:11.2f}  {math.degrees(math.acos(c)):5.1f}  {ILLUMINATION[place]:8.3f}  {d:.3f}   {w:.3f}")
    before = max(abs(d - ILLUMINATION[p]) for d, p in zip(design, places))
    after = max(abs(w - ILLUMINATION[p]) for w, p in zip(with_sensor, places))
    print(f"  largest difference from the telephone: {before:.3f} by the design, {after:.3f} with the sensor")
    at_edge = places.index(3.5)
    page.summary("relative illumination at 3.5 mm, by the design", f"{design[at_edge]:.3f}", "not in the data", f"{ILLUMINATION[3.5]:.3f}",
                 f"{design[at_edge] - ILLUMINATION[3.5]:+.3f}")
    page.summary("the same with the sensor's angles", f"{with_sensor[at_edge]:.3f}", "not in the data", f"{ILLUMINATION[3.5]:.3f}",
                 f"{with_sensor[at_edge] - ILLUMINATION[3.5]:+.3f}")
    page.plot("Relative illumination", "height on the film [mm]", {
        "ours": list(zip(heights, ours)), "design program": rows, "telephone, measured": list(ILLUMINATION.items()),
        "design with the sensor's angles": list(zip(places, with_sensor))},
        f"Ours is within {max(abs(a - b) for a, b in zip(ours, own)):.4f} of a sum over the file's own ellipses, which differ "
        f"from the design by {max(abs(a - r[1]) for a, r in zip(own, rows)):.4f}.")


def geometric_mtf(phone, folder, page):
    design = zemax_by_height(folder / "GeometricMTF.txt", 3, 0, (1, 2))
    heights, frequencies = sorted({height for height, _ in design}), list(range(25, 201, 25))
    best = None
    # The exit distance of the design's film is not in the file: the one at which the axis agrees best.
    for film_um in range(0, 10):
        option = ["--geometric", "--set", f"surfaces[1].thickness_mm={film_um / 1000 + 1e-9}"]
        axis = phone.mtf([0], frequencies, *option)
        worst = max(abs(axis[0, f][0] - design[0, f][0]) for f in frequencies)
        if best is None or worst < best[0]:
            best = worst, film_um, option
    ours = phone.mtf(heights, frequencies, *best[2])
    print(f"geometric MTF to 200/mm, film {best[1]} um behind the input plane: largest difference from the design's")
    for height in heights:
        off = [max(abs(ours[height, f][k] - design[height, f][k]) for f in frequencies) for k in (0, 1)]
        print(f"                         {height:11.3f}  tangential {off[0]:.3f}  sagittal {off[1]:.3f}")
    # The line spread of the axis, which is even: the cosine transform of the MTF.
    axis = phone.mtf([0], FINE, *best[2])
    lsp = zemax_by_height(folder / "GeometricLSP.txt", 5, 0, (1,))
    at = sorted(x for height, x in lsp if height == 0)
    theirs = [lsp[0, x][0] for x in at]
    contrast = {f: sum(t * math.cos(2 * math.pi * f * x / 1000) for x, t in zip(at, theirs)) / sum(theirs) for f in FINE}

    page.plot("Line spread on the axis, to 400 cycles/mm", "place [um]", {
        "ours": spread(at, lambda f: axis[0, f][0]), "design program": spread(at, contrast.get)},
        "Per µm. The data hold the design's line spread on the axis alone; none off it, none at the two depths, and none that was measured.")
    page.plot("Geometric MTF, tangential", "cycles/mm", {
        f"{'ours' if who is ours else 'design'}, {height:g} mm": [(f, who[height, f][0]) for f in frequencies]
        for height in (heights[0], heights[2], heights[4]) for who in (ours, design)},
        "The file's polynomials of the fourth degree hold the axis, and off it other aberrations than the design's.")
    edge_of_symmetry(json.loads(Path(phone.lens).read_text()))


def edge_of_symmetry(file):
    """By how much the file's polynomials break what every round lens has: on the axis, x by dx is y by dy."""
    bands = file["polynomials"]
    slope = {}
    for each in (bands[0] if isinstance(bands, list) else bands)["poly"]:
        for powers in zip(each["termr"], each["termdx"], each["termdy"], each["coeff"]):
            slope[(each["outputname"], *powers[:3])] = powers[3]
    off = slope["outdx", 0, 1, 0] - slope["outdy", 0, 0, 1]
    power, sine = abs(slope["outdy", 1, 0, 0]), 0.1467
    print(f"  the file itself: on the axis directions by dx and by dy differ, as much as {1000 * abs(off) * sine / power:.2f} um "
          "on the film at the rim of the pupil, where a round lens has 0")


def edges(phone, page):
    print("MTF of slanted edges: mean absolute difference of curves, pixels and bilinear green included")
    for focus_m in (0.5, 0.3):
        which = [key for key in EDGES if key[0] == focus_m]

        def differences(film_mm, column, *how):
            result = []
            for key in which:
                ours = phone.edge_mtf(key[1], key[2], film_mm, EDGES[key], *how)
                result.append(sum(abs(ours[f] - EDGES[key][f][column]) for f in ours) / len(ours))
            return result

        near = round(1000 * THEIR_FILM_MM[focus_m])
        films = [um / 1000 for um in range(near - 1, near + 8)]
        # One number a focus setting: the film at which the worse of its two edges is best.
        rays = min((max(d), film, d) for film in films for d in [differences(film, 1, "--geometric")])
        waves = min((max(d), film, d) for film in films for d in [differences(film, 0)])
        there = differences(THEIR_FILM_MM[focus_m], 1, "--geometric")
        for k, key in enumerate(which):
            published = sum(abs(s - m) for m, s in EDGES[key].values()) / len(EDGES[key])
            print(f"  focus {key[0]} m, edge {key[1]} m  rays from the published simulation: {there[k]:.3f} on its film, "
                  f"{rays[2][k]:.3f} {1000 * (rays[1] - THEIR_FILM_MM[focus_m]):+.1f} um from it; "
                  f"from the telephone: waves {waves[2][k]:.3f} (film {1000 * waves[1]:.0f} um), published {published:.3f}")
            page.plot(f"Slanted edge at {key[1]} m, focus at {key[0]} m", "cycles/mm", {
                "ours, waves": list(phone.edge_mtf(key[1], key[2], waves[1], EDGES[key]).items()),
                "ours, rays": list(phone.edge_mtf(key[1], key[2], rays[1], EDGES[key], "--geometric").items()),
                "telephone, measured": [(f, m) for f, (m, _) in EDGES[key].items()],
                "published simulation": [(f, s) for f, (_, s) in EDGES[key].items()]},
                f"Mean difference from the telephone: ours {waves[2][k]:.3f}, published {published:.3f}.")
            page.summary(f"MTF, focus {key[0]} m, edge {key[1]} m, mean difference from the telephone", f"{waves[2][k]:.3f}", f"{published:.3f}",
                         "0", f"{waves[2][k] - published:+.3f} from the simulation's")
