# SPDX-License-Identifier: BSD-3-Clause
"""One page: curves as SVG, tables and pictures, in one HTML file."""


class Page:
    """Curves as SVG in one HTML file."""
    COLOURS = ("#1b6ca8", "#c0392b", "#2e8b57", "#8e5aa8", "#b8860b", "#555555")

    def __init__(self, folder):
        self.folder, self.parts, self.lines = folder, [], []

    def summary(self, *cells):
        """Quantity, ours, published simulation, telephone as measured, difference: a line of the table on top."""
        self.lines.append(cells)

    @staticmethod
    def rows(columns, rows):
        lines = ["<tr>" + "".join(f"<th>{each}</th>" for each in columns) + "</tr>"]
        lines += ["<tr>" + "".join(f"<td>{each}</td>" for each in row) + "</tr>" for row in rows]
        return f"<table>{''.join(lines)}</table>"

    def table(self, title, columns, rows, note=""):
        self.parts.append(f"<h2>{title}</h2>{self.rows(columns, rows)}<p>{note}</p>")

    def plot(self, title, axis, curves, note=""):
        xs = [x for curve in curves.values() for x, _ in curve]
        ys = [y for curve in curves.values() for _, y in curve]
        low, high, top, bottom = min(xs), max(xs), max(max(ys), 1e-9), min(0, min(ys))

        def at(x, y):
            return f"{50 + 420 * (x - low) / (high - low):.1f},{20 + 220 * (top - y) / (top - bottom):.1f}"
        lines = [f'<text x="260" y="275" text-anchor="middle">{axis}</text>',
                 '<path d="M50 20V240H470" fill="none" stroke="#888"/>']
        for share in (0, 0.5, 1):
            x, y = low + share * (high - low), bottom + share * (top - bottom)
            lines.append(f'<text x="{50 + 420 * share}" y="256" text-anchor="middle">{x:.3g}</text>')
            lines.append(f'<text x="45" y="{244 - 220 * share}" text-anchor="end">{y:.3g}</text>')
        for k, (name, curve) in enumerate(curves.items()):
            colour = self.COLOURS[k % len(self.COLOURS)]
            points = " ".join(at(*point) for point in curve)
            dash = ' stroke-dasharray="5 3"' if k % 2 else ""
            lines.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.6"{dash}/>')
            lines.append(f'<text x="490" y="{32 + 18 * k}" fill="{colour}">{name}</text>')
        self.parts.append(f'<h2>{title}</h2><svg viewBox="0 0 720 285" width="720" font-size="12" font-family="sans-serif">'
                          + "".join(lines) + f"</svg><p>{note}</p>")

    def picture(self, name, note):
        self.parts.append(f'<figure><img src="{name}" width="400"><figcaption>{note}</figcaption></figure>')

    def write(self):
        style = ("body{font-family:sans-serif;max-width:60em;margin:auto;padding:1em}td,th{padding:.2em .8em;text-align:right;border-bottom:1px solid #ddd}"
                 "td:first-child,th:first-child{text-align:left}table{border-collapse:collapse;font-size:90%}figure{display:inline-block;margin:.5em}")
        top = self.rows(["", "ours", "published simulation", "telephone, measured", "difference"], self.lines)
        (self.folder / "index.html").write_text(
            f'<!doctype html><meta charset="utf-8"><title>The telephone of 2022</title><style>{style}</style><h1>The telephone of 2022</h1>'
            f'<p>A telephone\'s camera, its lens known by its ray transfer alone, beside what Lyu, Goossens, Wandell and Farrell published in 2022.</p>{top}'
            + "\n".join(self.parts))


class NoPage:
    folder = None

    def plot(self, *_):
        pass

    def summary(self, *_):
        pass
