"""Tables: named columns with units, handed on to pandas, Polars or anything that reads Arrow."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

Column = npt.NDArray[Any]
#: What the rig was set to, with units.
CONDITIONS = {"slip": "1", "wheel_load_n": "N", "sled_speed_m_s": "m/s", "slip_angle_deg": "deg"}


class Table(Mapping[str, Column]):
    """Columns of equal length by name, each a NumPy array.

    Numbers are ``float64`` (nothing stated: NaN), ``int64`` or ``bool``; text is ``object``,
    with ``None`` where nothing is stated.

    Attributes:
        units: the SI unit of each column that has one.
    """

    def __init__(self, columns: Mapping[str, Column], units: Mapping[str, str] | None = None) -> None:
        lengths = {len(column) for column in columns.values()}
        if len(lengths) > 1:
            raise ValueError(f"columns of {sorted(lengths)} rows")
        self._columns = dict(columns)
        self._rows = lengths.pop() if lengths else 0
        self.units = {name: unit for name, unit in (units or {}).items() if name in self._columns}

    @classmethod
    def from_rows(
        cls,
        rows: Sequence[Mapping[str, Any]],
        columns: Sequence[str] | None = None,
        units: Mapping[str, str] | None = None,
    ) -> Table:
        """A table of JSON objects.

        Args:
            rows: the objects.
            columns: the keys that become columns, in this order; by default, those of the first row.
            units: units by column.
        """
        names = list(columns if columns is not None else rows[0] if rows else [])
        return cls({name: _column([row.get(name) for row in rows]) for name in names}, units)

    def __getitem__(self, name: str) -> Column:
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def rows(self) -> int:
        """How many rows there are."""
        return self._rows

    def where(self, **values: str | float | bool) -> Table:
        """The rows in which each named column has the given value."""
        keep = np.ones(self._rows, dtype=bool)
        for name, value in values.items():
            keep &= self._columns[name] == value
        return Table({name: column[keep] for name, column in self._columns.items()}, self.units)

    def to_dicts(self) -> list[dict[str, Any]]:
        """The rows as dictionaries of plain Python values."""
        lists = {name: column.tolist() for name, column in self._columns.items()}
        return [dict(zip(lists, row, strict=True)) for row in zip(*lists.values(), strict=True)]

    def to_arrow(self) -> Any:
        """A ``pyarrow.Table``; the unit of a column is the metadata ``unit`` of its field. Needs ``grouser[arrow]``."""
        import pyarrow

        arrays = [pyarrow.array(column, from_pandas=column.dtype == object) for column in self._columns.values()]
        fields = [
            pyarrow.field(name, array.type, metadata={"unit": self.units[name]} if name in self.units else None)
            for name, array in zip(self._columns, arrays, strict=True)
        ]
        return pyarrow.Table.from_arrays(arrays, schema=pyarrow.schema(fields))

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """The Arrow PyCapsule interface: whatever reads Arrow takes the table as it is."""
        return self.to_arrow().__arrow_c_stream__(requested_schema)

    def to_pandas(self) -> Any:
        """A ``pandas.DataFrame``; ``frame.attrs["units"]`` has the units. Needs ``grouser[pandas]``."""
        frame = self.to_arrow().to_pandas()
        frame.attrs["units"] = dict(self.units)
        return frame

    def to_polars(self) -> Any:
        """A ``polars.DataFrame``. Needs ``grouser[polars]``."""
        import polars

        return polars.from_arrow(self.to_arrow())

    def __repr__(self) -> str:
        return f"Table({self._rows} rows: {', '.join(self._columns)})"

    def _repr_html_(self) -> str:
        from html import escape

        def cell(value: object) -> str:
            text = f"{value:.6g}" if isinstance(value, float) else "" if value is None else str(value)
            return f"<td>{escape(text)}</td>"

        shown = self.to_dicts()[:20]
        unit = {name: f" [{self.units[name]}]" if name in self.units else "" for name in self._columns}
        head = "".join(f"<th>{escape(name + unit[name])}</th>" for name in self._columns)
        body = "".join(f"<tr>{''.join(map(cell, row.values()))}</tr>" for row in shown)
        more = f"<p>{len(shown)} of {self._rows} rows</p>" if len(shown) < self._rows else ""
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


def _column(values: Sequence[Any]) -> Column:
    stated = [value for value in values if value is not None]
    if stated and all(isinstance(value, bool) for value in stated) and len(stated) == len(values):
        return np.array(values, dtype=bool)
    if stated and all(type(value) is int for value in stated) and len(stated) == len(values):
        return np.array(values, dtype=np.int64)
    if all(isinstance(value, (int, float)) for value in stated):
        return np.array([np.nan if value is None else value for value in values], dtype=float)
    column = np.empty(len(values), dtype=object)
    column[:] = [None if value is None else str(value) for value in values]
    return column
