"""What a calibrated model predicts of every run, draw by draw: forward runs by the program."""

from __future__ import annotations

import csv
import os
import tempfile
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _program, _toml
from ._error import ProgramError

Values = npt.NDArray[np.float64]
#: Channels by name, with the column of ``runs.csv``.
CHANNELS = {
    "drawbar_pull": "drawbar_pull_n",
    "torque": "torque_n_m",
    "sinkage": "sinkage_m",
    "lateral_force": "lateral_force_n",
}


class NoPredictionError(Exception):
    """The model's predictions cannot be made here; the text says why."""


def predict(
    provenance: Mapping[str, Any], experiment: Mapping[str, Any], parameters: Sequence[str], draws: Values
) -> tuple[list[str], dict[str, Values]]:
    """Names of the runs, and of each channel the model's values in SI units, by draw and run.

    Args:
        provenance: ``job`` and ``effects`` of the calibration.
        experiment: ``toml`` and ``files`` of the experiment.
        parameters: names of the columns of ``draws``.
        draws: a row for each draw.

    Raises:
        NoPredictionError: the model is another one than ``quasi_static``, or rejects a draw.
    """
    job = _toml.parse(provenance["job"])
    kind = job["model"].get("kind")
    if kind != "quasi_static":
        raise NoPredictionError(f"a forward run of {kind} for each draw takes too long")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        experiment_file = folder / "experiment.toml"
        _write(folder, "experiment.toml", experiment["toml"])
        for file, text in experiment["files"].items():
            _write(folder, file, text)
        model = folder / "grouser-job.toml"
        model.write_text(provenance["job"], encoding="utf-8")
        own = len(job["model"].get("effects", []))
        for file, effect in zip(job["model"].get("effect_files", []), provenance["effects"][own:], strict=False):
            _write(folder, file, effect["text"])
        fixed = {k: float(v) for k, v in job.get("priors", {}).items() if isinstance(v, (int, float))}

        def simulate(number: int) -> list[dict[str, str]]:
            # What belongs to the likelihood alone is no parameter of the model.
            free = {k: float(v) for k, v in zip(parameters, draws[number], strict=True)}
            values = {k: v for k, v in {**fixed, **free}.items() if not k.startswith(("noise.", "bevameter."))}
            theta, out = folder / f"theta-{number}.toml", folder / f"out-{number}.csv"
            theta.write_text("".join(f'"{k}" = {v!r}\n' for k, v in values.items()), encoding="utf-8")
            command = ["worker", "simulate", str(experiment_file), "--model", str(model)]
            _program.call([*command, "--parameters", str(theta), "--out", str(out)], {"RUST_LOG": "error"})
            with out.open(encoding="utf-8", newline="") as file:
                return list(csv.DictReader(file))

        try:
            with ThreadPoolExecutor(os.cpu_count()) as pool:
                tables = list(pool.map(simulate, range(len(draws))))
        except ProgramError as error:
            raise NoPredictionError(str(error)) from error
    runs = [row["run"] for row in tables[0]] if tables else []
    # A channel without stated noise is blank.
    columns = {
        channel: np.array([[float(row[column] or "nan") for row in table] for table in tables])
        for channel, column in CHANNELS.items()
    }
    return runs, columns


def _write(folder: Path, name: str, text: str) -> None:
    path = (folder / name).resolve()
    if not path.is_relative_to(folder.resolve()):
        raise NoPredictionError(f"the file {name} lies outside the folder of its experiment")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
