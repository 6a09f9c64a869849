#!/usr/bin/env python3
"""A rigid wheel in steady motion after Wong and Reece (1967), https://doi.org/10.1016/0022-4898(67)90105-X.

A program for kind = "command": reads {"runs": [{...}]} from standard input, writes {"runs": [{...}]}. Python's own modules are
enough. server.py serves the same function by UM-Bridge.
"""
import json
import math
import sys

POINTS = 60  # of each of the two zones


def wheel(slip, wheel_load_n, radius_m, width_m, k_phi, n, friction_angle_deg, shear_modulus_m, peak_share):
    """Drawbar pull [N], torque [N m] and sinkage [m] of a driven wheel, slip >= 0; raises ValueError where the soil is too soft.

    Pressure k_phi z^n, mirrored behind the angle of its peak, which lies at the share peak_share + 0.2 slip of the entry angle;
    shear stress p tan(phi) (1 - exp(-j / K)) by Janosi and Hanamoto.
    """
    tan_phi = math.tan(math.radians(friction_angle_deg))

    def forces(entry):
        peak = (peak_share + 0.2 * slip) * entry
        pull = load = torque = 0.0
        for begin, end in ((0.0, peak), (peak, entry)):
            step = (end - begin) / POINTS
            for i in range(POINTS):
                angle = begin + (i + 0.5) * step
                mirror = angle if angle >= peak else entry - angle * (entry - peak) / peak
                pressure = k_phi * (radius_m * (math.cos(mirror) - math.cos(entry))) ** n
                slid = radius_m * (entry - angle - (1 - slip) * (math.sin(entry) - math.sin(angle)))
                shear = pressure * tan_phi * (1 - math.exp(-slid / shear_modulus_m))
                area = radius_m * width_m * step
                load += (pressure * math.cos(angle) + shear * math.sin(angle)) * area
                pull += (shear * math.cos(angle) - pressure * math.sin(angle)) * area
                torque += shear * radius_m * area
        return load, pull, torque

    entry, last, before = 0.7, 0.5, forces(0.5)[0]
    for _ in range(50):  # the load grows as a power of the angle: the secant of logarithms finds it in a few steps
        load, pull, torque = forces(entry)
        if abs(load / wheel_load_n - 1) < 1e-10:
            return {"drawbar_pull_n": pull, "torque_n_m": torque, "sinkage_m": radius_m * (1 - math.cos(entry))}
        power = math.log(load / before) / math.log(entry / last)
        entry, last, before = entry * (wheel_load_n / load) ** (1 / power), entry, load
        if not 0 < entry < math.pi / 2:
            break
    raise ValueError(f"the soil does not carry {wheel_load_n} N")


def answer(run):
    """The channels of one run, or why there are none."""
    try:
        return wheel(**run)
    except ValueError as reason:
        return {"rejected": str(reason)}


if __name__ == "__main__":
    json.dump({"runs": [answer(run) for run in json.load(sys.stdin)["runs"]]}, sys.stdout)
