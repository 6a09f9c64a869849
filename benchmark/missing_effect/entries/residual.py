"""What a rival that fits formulas wants: residuals of the base model, per channel, against the conditions of the runs.

The base model is the generator's own implementation, fitted by least squares under the priors of the job, so no rival suffers from another quadrature. A
channel gets the formula that the rival prefers if it lowers the chi-square by more than its constants cost by the Bayesian information criterion,
and none otherwise. Such an entry names no effect: its verdict is null. Its law is the formula of the channel that gains most.
"""
import pathlib
import re
import sys
import tomllib

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import formula
from answer import CHANNELS, rows
from oracle import Campaign

VARIABLES = ("slip", "wheel_load", "sled_speed")
QUANTITIES = ("drawbar_pull", "torque", "sinkage")


class Base:
    """The campaign, the base fitted to it, and the residuals that it leaves, in noise sds."""

    def __init__(self, folder):
        self.job, self.experiment = (tomllib.loads((folder / name).read_text()) for name in ("job.toml", "experiment.toml"))
        table = rows(folder)
        wheel = self.experiment["wheel"]["w"]
        column = lambda name: np.array([float(row[name]) for row in table])
        runs = {name: column(name) for name in ("slip", "wheel_load_n", "sled_speed_m_s")}
        runs["width_m"] = np.full(len(table), wheel["width_m"])
        runs["rig_radius_m"] = np.full(len(table), wheel["rig_radius_m"])
        fit = np.array([row["use"] == "fit" for row in table])
        self.sds = np.array([self.experiment["noise"][name] for name in CHANNELS])
        self.measured = np.stack([column(name) for name in CHANNELS], axis=1)[fit]
        priors = {"wheel_radius_m": wheel["radius_m"], **{name: prior_of(p) for name, p in self.job["priors"].items()}}
        self.campaign = Campaign({name: x[fit] for name, x in runs.items()}, priors, self.sds)
        _, self.u, self.fitted = self.campaign.fit(self.measured)
        self.held_runs = {name: x[~fit] for name, x in runs.items()}
        self.held = self.campaign.values(np.array([self.u]), [], runs=self.held_runs)[0]
        self.residuals = (self.measured - self.fitted) / self.sds
        self.x = np.stack([runs[name][fit] for name in ("slip", "wheel_load_n", "sled_speed_m_s")], axis=1)
        self.held_x = np.stack([self.held_runs[name] for name in ("slip", "wheel_load_n", "sled_speed_m_s")], axis=1)


def prior_of(prior):
    """A prior of the job as the oracle has it."""
    if not isinstance(prior, dict):
        return float(prior)
    kind = next(name for name in prior if name != "bounds")
    return (kind, *prior[kind], *prior.get("bounds", ()))


def evaluated(text, x):
    """A formula over VARIABLES at rows of conditions; not finite where it is undefined."""
    text, values = formula.constants(text)
    return np.real(formula.function(text, VARIABLES)(dict(zip(VARIABLES, x.T)), values)) + np.zeros(len(x))


def entry(search):
    """An entry from a search, which gets conditions (a row each, scaled to their greatest value), residuals of one channel in sds, and gives a formula over x0, x1, x2."""

    def answered(folder):
        base = Base(folder)
        scale, held = np.abs(base.x).max(axis=0), base.held.copy()
        best, law, failures = 0.0, None, []
        for k, quantity in enumerate(QUANTITIES):
            y = base.residuals[:, k]
            try:
                text = search(base.x / scale, y)
                cost = (len(formula.constants(text)[1]) + 1) * np.log(len(y))
            except Exception as error:  # a rival may fail in any way: the channel then has no formula
                failures.append(f"{quantity}: {type(error).__name__}: {error}")
                continue
            for number, (variable, largest) in enumerate(zip(VARIABLES, map(float, scale))):
                text = re.sub(rf"\bx{number}\b", f"({variable} / {largest!r})", text)
            try:
                change, held_change = evaluated(text, base.x), evaluated(text, base.held_x)
            except (ValueError, SyntaxError, NameError, ZeroDivisionError, TypeError) as error:
                failures.append(f"{quantity}: {text}: {error}")
                continue
            gain = y @ y - np.sum((y - change) ** 2) - cost if np.all(np.isfinite(change)) else -np.inf
            if gain > 0 and np.all(np.isfinite(held_change)):
                held[:, k] += held_change * base.sds[k]
                if gain > best:
                    depends_on = [name for name in VARIABLES if name in text]
                    best, law = gain, {"acts_on": quantity, "depends_on": depends_on, "operation": "plus", "formulas": [f"{float(base.sds[k])!r} * ({text})"]}
        return {"verdict": None, "law": law, "offers_formulas": True, "holdout": held.tolist(), "note": "; ".join(failures)}

    return answered
