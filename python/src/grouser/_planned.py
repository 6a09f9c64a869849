"""Predictions of conditions of one's own: the request, and the answer as a table."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ._table import CONDITIONS, Table

#: A plan: a CSV file, or a row for each condition by the names of its columns.
Plan = str | os.PathLike[str] | Sequence[Mapping[str, Any]]


def request(
    plan: Plan | None,
    sweep: str | None,
    wheels: str | os.PathLike[str] | None,
    statements: Sequence[str],
    draws: int | None,
) -> dict[str, Any]:
    """The body of the request."""
    return {
        "plan": None if plan is None else _text(plan),
        "sweep": sweep,
        "wheels": None if wheels is None else Path(wheels).read_text(encoding="utf-8"),
        "statements": list(statements),
        "draws": draws,
    }


def _text(plan: Plan) -> str:
    if isinstance(plan, str | os.PathLike):
        return Path(plan).read_text(encoding="utf-8")
    names = list(dict.fromkeys(name for row in plan for name in row))
    file = io.StringIO()
    writer = csv.DictWriter(file, names, lineterminator="\n")
    writer.writeheader()
    writer.writerows(plan)
    return file.getvalue()


def table(answer: Mapping[str, Any]) -> Table:
    """A row for each run and quantity, then one for each run and statement, whose means are its probabilities."""
    rows = [row for run in answer["runs"] for row in _rows(run)]
    return Table.from_rows(rows, units=CONDITIONS)


def _rows(run: Mapping[str, Any]) -> list[dict[str, Any]]:
    condition = {name: run[name] for name in ("run", "wheel", *CONDITIONS, "slope_deg")}
    condition["beyond"] = "; ".join(run["beyond"])
    rows = []
    for quantity in run["quantities"]:
        row = {**condition, "quantity": quantity["name"], "unit": quantity["unit"], "mean": quantity["mean"]}
        row["models_mean"], row["corrected"] = quantity["models_mean"], quantity["corrected"]
        row["measurement_mean"] = None
        for name, key in (
            ("parameters", "parameters"),
            ("models", "models"),
            ("measurement", "models_measurement"),
            ("corrected", "corrected_measurement"),
        ):
            row[f"{name}_q05"], row[f"{name}_q95"] = quantity[key] or (None, None)
        rows.append(row)
    for statement in run["statements"]:
        row = dict.fromkeys(rows[0]) if rows else {}
        row.update({**condition, "quantity": statement["statement"], "unit": "1"})
        row["mean"], row["models_mean"] = statement["parameters"], statement["models"]
        # A measurement makes the statement true with this probability, over all models.
        row["measurement_mean"] = statement["measurement"]
        rows.append(row)
    return rows
