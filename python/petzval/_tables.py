# SPDX-License-Identifier: BSD-3-Clause
"""Tables of numbers with units, as analyses give them."""

from collections.abc import Mapping
from dataclasses import dataclass
from html import escape

from ._display import Svg


class Table(Mapping):
    """Columns by name: numbers are NumPy arrays, text is a list. `units` has the unit of each column."""

    def __init__(self, columns, units, heading="", text=""):
        self._columns, self.units, self.heading, self._text = columns, units, heading, text

    def __getitem__(self, name):
        return self._columns[name]

    def __iter__(self):
        return iter(self._columns)

    def __len__(self):
        return len(self._columns)

    @property
    def rows(self):
        """A dict for each row."""
        return [dict(zip(self._columns, row)) for row in zip(*self._columns.values())]

    def to_xarray(self):
        """As xarray.Dataset along `row`, units as attributes."""
        from . import _xarray
        return _xarray.table(self)

    def __repr__(self):
        return self._text.rstrip("\n") or f"<Table {', '.join(self._columns)}>"

    def _repr_html_(self):
        def heading(name):
            unit = self.units.get(name)
            return f"<th>{escape(name)}{f' [{escape(unit)}]' if unit else ''}</th>"

        def cell(value):
            return f"<td>{value:.6g}</td>" if isinstance(value, float) else f"<td>{escape(str(value))}</td>"

        rows = "".join(f"<tr>{''.join(map(cell, row.values()))}</tr>" for row in self.rows)
        return (f"<table><caption>{escape(self.heading)}</caption><tr>{''.join(map(heading, self._columns))}</tr>"
                f"{rows}</table>")


class Analysis(Mapping):
    """What an analysis found: the columns of its rows, `tables` (all of them by name), `facts`, `remarks`, and with
    plots=True a `plot`."""

    def __init__(self, name, lens, field_type, reference_wavelength_nm, tables, facts, remarks, svg):
        self.name, self.lens, self.field_type = name, lens, field_type
        self.reference_wavelength_nm = reference_wavelength_nm
        self.tables, self.facts, self.remarks = tables, facts, remarks
        self.plot = Svg(svg) if svg else None

    @property
    def _rows(self):
        return self.tables["rows"]

    def __getitem__(self, column):
        return self._rows[column]

    def __iter__(self):
        return iter(self._rows)

    def __len__(self):
        return len(self._rows)

    @property
    def units(self):
        """The unit of each column."""
        return self._rows.units

    @property
    def rows(self):
        """A dict for each row."""
        return self._rows.rows

    def to_xarray(self):
        """As xarray.Dataset along `row`, units as attributes."""
        dataset = self._rows.to_xarray()
        dataset.attrs.update(analysis=self.name, lens=self.lens, field_type=self.field_type,
                             reference_wavelength_nm=self.reference_wavelength_nm)
        return dataset

    def __repr__(self):
        return f"{self.lens}: {self._rows.heading}\n{self._rows!r}"

    def _repr_html_(self):
        return (self.plot or "") + "".join(table._repr_html_() for table in self.tables.values())


@dataclass
class TracedRays:
    """Rays at the image surface; numbers of those that did not arrive are NaN."""

    status: list  # "ok", "missed", "vignetted", "tir"
    points_mm: object  # array (ray, 3)
    directions: object  # array (ray, 3)
    opl_mm: object  # array (ray), optical path


@dataclass
class Events:
    """What an event camera tells, in the order of time."""

    t_s: object  # array (event) of float64
    column: object  # array (event) of int32
    row: object  # array (event) of int32
    brighter: object  # array (event) of uint8: 1, or 0 for darker

    def __len__(self):
        return len(self.t_s)

    def save(self, path):
        """Writes lines of time [s], column, row and 1 (brighter) or 0, as `petzval shoot --events` does."""
        with open(path, "w", encoding="ascii") as file:
            for event in zip(self.t_s.tolist(), self.column.tolist(), self.row.tolist(), self.brighter.tolist()):
                file.write("%.9f %d %d %d\n" % event)

    def to_xarray(self):
        """As xarray.Dataset along `event`, units as attributes."""
        from . import _xarray
        return _xarray.events(self)

    def __repr__(self):
        return f"<Events: {len(self)}>"
