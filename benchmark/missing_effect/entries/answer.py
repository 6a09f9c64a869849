"""What an entry writes, and how it is started: `ENTRY.py FOLDER ANSWER.json`. README.md says what the fields mean."""
import csv
import json
import os
import pathlib
import sys

for library in ("OMP", "OPENBLAS", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")
CHANNELS = ("drawbar_pull_n", "torque_n_m", "sinkage_m")
EMPTY = {"verdict": None, "named": [], "class": [], "probabilities": None, "classes": [], "law": None, "laws": [],
         "offers_formulas": False, "faults": [], "holdout": None, "note": ""}


def rows(folder):
    """The rows of runs.csv."""
    with (pathlib.Path(folder) / "runs.csv").open() as file:
        return list(csv.DictReader(file))


def main(entry):
    folder, target = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    target.write_text(json.dumps({**EMPTY, **entry(folder)}))
