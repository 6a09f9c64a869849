"""Errors of the rig: what they do to the truth, to what the files state, and to what was recorded.

`accepted` are the names of a library under which an error of the rig is stated rightly, `law:QUANTITY` a law of a quantity; where there is none, no name and no law is right.
"""
import numpy as np

from bench import RADIUS_M, noise_sds, simulate
from catalogue import FAULT_EFFECTS

FAULTS = ("drift_of_pull", "drift_of_soil", "exchanged_sensors", "scaled_sinkage", "scaled_torque", "scaled_pull", "wrong_radius", "wrong_width",
          "wrong_rig_radius", "saturated_pull", "exchanged_rows", "sessions")


def applied(truth, turn):
    """The truth with the fault of this turn."""
    rng, fault = truth["rng"], FAULTS[turn % len(FAULTS)]
    sign, runs, soil, states_order = rng.choice([-1, 1]), truth["runs"], dict(truth["soil"]), turn % 2 == 0
    truth["fault"], hooks = {"name": fault}, []
    if fault == "drift_of_pull":
        change = float(sign * rng.uniform(4, 8) * truth["sds"][0])
        hooks = [(FAULT_EFFECTS["drift_drawbar_pull_zero"], {"change_n": change})]
        truth["fault"]["change_n"], truth["accepted"] = change, ["drift_drawbar_pull_zero"] if states_order else []
    elif fault == "drift_of_soil":
        change = float(sign * rng.uniform(0.2, 0.4))
        hooks = [(FAULT_EFFECTS["drift_stiffness"], {"ln_change": change})]
        truth["fault"]["ln_change"], truth["accepted"] = change, ["drift_stiffness"] if states_order else []
    elif fault in ("wrong_radius", "wrong_width", "wrong_rig_radius"):
        share = float(1 + sign * (0.1 if fault == "wrong_width" else 0.05))
        truth["fault"]["true_over_stated"] = share
        truth["accepted"] = [{"wrong_radius": "wheel_radius_error", "wrong_width": "wheel_width_error", "wrong_rig_radius": "slip_radius_error"}[fault]]
        if fault == "wrong_radius":
            soil["wheel_radius_m"], truth["fixed"] = RADIUS_M * share, ("wheel_radius_m",)
            truth["priors"] = {**truth["priors"], "wheel_radius_m": RADIUS_M}
        elif fault == "wrong_width":
            runs = {**runs, "width_m": runs["width_m"] * share}
        else:
            runs = {**runs, "rig_radius_m": runs["rig_radius_m"] * share}
    elif fault == "scaled_sinkage":
        truth["fault"]["scale"] = float(rng.uniform(1.15, 1.4) ** sign)
    elif fault in ("scaled_torque", "scaled_pull"):
        truth["fault"]["scale"] = float(rng.uniform(1.1, 1.3) ** sign)
        truth["accepted"] = ["torque_gain" if fault == "scaled_torque" else "drawbar_pull_gain"]
    truth["soil"] = soil
    values, truth["state"] = simulate(runs, soil, hooks)
    column = {"scaled_sinkage": 2, "scaled_torque": 1, "scaled_pull": 0}.get(fault)
    if column is not None:
        values[:, column] *= truth["fault"]["scale"]
    count = truth["count"]
    if fault == "saturated_pull":
        limit_n = float(values[:count, 0].max() * rng.uniform(0.6, 0.8))
        truth["fault"]["most_n"], truth["accepted"] = limit_n, ["law:drawbar_pull"]
        values[:, 0] = np.minimum(values[:, 0], limit_n)
    if fault == "sessions":
        block = np.floor((truth["runs"]["order"][:count] + 0.5) * 3.999).astype(int)
        offsets = rng.standard_normal(4) * 4 * truth["sds"][0]
        truth["fault"]["offsets_n"] = offsets.round(4).tolist()
        values[:count, 0] += offsets[block]
    truth["values"], truth["sds"] = values, noise_sds(values[:count])
    return truth


def recorded(truth, measured):
    """What the table says, with columns or rows exchanged."""
    fault, measured = truth["fault"]["name"], measured.copy()
    if fault == "exchanged_sensors":
        measured[:, [0, 1]] = measured[:, [1, 0]]
        truth["sds"] = truth["sds"][[1, 0, 2]]
        truth["values"] = truth["values"][:, [1, 0, 2]]
    if fault == "exchanged_rows":
        first = int(np.argmin(truth["runs"]["slip"][: truth["count"]] + truth["runs"]["wheel_load_n"][: truth["count"]] / 1e3))
        last = int(np.argmax(truth["runs"]["slip"][: truth["count"]]))
        measured[[first, last]] = measured[[last, first]]
        truth["fault"]["rows"] = [first, last]
    return measured
