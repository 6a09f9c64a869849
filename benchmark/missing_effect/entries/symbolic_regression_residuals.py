#!/usr/bin/env python3
"""The crate symbolic_regression (Rust port of SymbolicRegression.jl) on the residuals of the base model, by the program in symbolic_regression/.

`cargo build --release` there, or $SYMBOLIC_REGRESSION names the program. Of the Pareto front the formula is taken that PySR calls best.
"""
import os
import pathlib
import subprocess

import numpy as np
import residual
from answer import main

PROGRAM = pathlib.Path(__file__).resolve().parent / "symbolic_regression/target/release/symbolic_regression_front"


def search(x, y):
    table = "".join(",".join(repr(float(value)) for value in row) + "\n" for row in np.column_stack([y, x]))
    ended = subprocess.run([os.environ.get("SYMBOLIC_REGRESSION", PROGRAM)], input=table, capture_output=True, text=True, check=True)
    front = [line.split(",", 2) for line in ended.stdout.splitlines()]
    complexity, loss, text = zip(*[(int(c), max(float(l), 1e-12), t) for c, l, t in front])
    # PySR: the best gain of the log error per node among those with an error within 1.5 of the least.
    gains = [0.0] + [np.log(loss[k - 1] / loss[k]) / max(complexity[k] - complexity[k - 1], 1) for k in range(1, len(loss))]
    allowed = [k for k in range(len(loss)) if loss[k] <= 1.5 * min(loss)]
    return text[max(allowed, key=lambda k: gains[k])].replace("^", "**")


if __name__ == "__main__":
    main(residual.entry(search))
