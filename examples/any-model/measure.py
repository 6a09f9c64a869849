#!/usr/bin/env python3
"""Writes runs.csv: the wheel of wheel.py at its true parameters, with two flaws of the rig that no model of a wheel knows.

The sled drags 90 N s/m at its speed on the drawbar pull; noise as experiment.toml declares it. The seed makes the file reproducible.
"""
import random

from wheel import wheel

TRUE = {"k_phi": 9.0e5, "n": 0.95, "friction_angle_deg": 31.0, "shear_modulus_m": 0.012, "peak_share": 0.4}
SIZE = {"radius_m": 0.125, "width_m": 0.112}
DRAG_N_S_M = 90.0
NOISE = {"drawbar_pull_n": 1.0, "torque_n_m": 0.12, "sinkage_m": 0.0004}
COLUMNS = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,slip_angle_deg,pass,drawbar_pull_n,torque_n_m,sinkage_m,use"

if __name__ == "__main__":
    random.seed(7)
    rows = ["# Synthetic: measure.py, which names the truth.", COLUMNS]
    for slip in (0.05, 0.15, 0.3, 0.5):
        for load in (60.0, 120.0):
            for speed in (0.01, 0.03, 0.08):
                true = wheel(slip=slip, wheel_load_n=load, **SIZE, **TRUE)
                true["drawbar_pull_n"] -= DRAG_N_S_M * speed
                seen = {channel: value + random.gauss(0.0, NOISE[channel]) for channel, value in true.items()}
                values = ",".join(f"{seen[channel]:.6g}" for channel in NOISE)
                use = "holdout" if (slip, load) == (0.3, 120.0) else "fit"
                rows.append(f"r{len(rows) - 2:02},w,s,{slip},{load},{speed},0,1,{values},{use}")
    with open("runs.csv", "w", encoding="utf-8") as file:
        file.write("\n".join(rows) + "\n")
