"""Opens the exported unit of FOLDER with FMPy and its table with NumPy: python tests/fmu/check.py FOLDER"""

import csv
import json
import pathlib
import struct
import sys
import time

import fmpy
import numpy as np
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu
from scipy.io import netcdf_file

FOLDER = pathlib.Path(sys.argv[1])
UNIT = str(FOLDER / "wheel.fmu")
INPUTS = ["slip", "wheel_load_n", "sled_speed_m_s", "slip_angle_deg"]
OUTPUTS = ["drawbar_pull_n", "torque_n_m", "sinkage_m", "lateral_force_n"]
PREDICTED = json.loads((FOLDER / "predicted.json").read_text())


def bits(value):
    return struct.pack("<d", value)


problems = validate_fmu(UNIT)
assert not problems, problems
description = fmpy.read_model_description(UNIT)
references = {variable.name: variable.valueReference for variable in description.modelVariables}
unzipped = fmpy.extract(UNIT)
unit = FMU3Slave(guid=description.guid, unzipDirectory=unzipped,
                 modelIdentifier=description.coSimulation.modelIdentifier, instanceName="wheel")
unit.instantiate()
unit.enterInitializationMode()
unit.exitInitializationMode()
now = 0.0


def step(condition, draw):
    """The outputs after a step under a condition, at a draw; 0: the mean."""
    global now
    unit.setInt32([references["draw"]], [draw])
    unit.setFloat64([references[name] for name in INPUTS], [condition.get(name, 0.0) for name in INPUTS])
    unit.doStep(currentCommunicationPoint=now, communicationStepSize=0.1)
    now += 0.1
    return dict(zip(OUTPUTS, unit.getFloat64([references[name] for name in OUTPUTS])))


# Each draw has the bits that the workers answered.
with open("examples/hidden-effect/runs.csv") as file:
    runs = {row["run"]: row for row in csv.DictReader(line for line in file if not line.startswith("#"))}
with netcdf_file(FOLDER / "data.nc", mmap=False) as data:
    variables = {name: variable.data.copy() for name, variable in data.variables.items()}
model = variables["posterior_predictive.model"][0]
texts = {name: [bytes(row).decode().strip("\0 ") for row in variables[f"posterior_predictive.{name}"].view("S1")]
         for name in ["run", "channel"]}
compared = 0
for draw in [0, 1, 57, len(model) - 1]:
    for r, name in list(enumerate(texts["run"]))[::5]:
        condition = {key: float(runs[name][key]) for key in INPUTS}
        stepped = step(condition, draw + 1)
        for c, channel in enumerate(texts["channel"]):
            expected = float(model[draw, r, c])
            if not np.isnan(expected):
                assert bits(stepped[channel]) == bits(expected), (name, draw, channel, stepped[channel], expected)
                compared += 1
assert compared > 40, compared

# The mean is that of `coordinator predict`.
for run in PREDICTED["runs"]:
    stepped = step({name: run[name] for name in INPUTS}, 0)
    for quantity in run["quantities"]:
        if quantity["name"] in stepped:
            assert abs(stepped[quantity["name"]] - quantity["mean"]) <= 1e-12 * abs(quantity["mean"]), (run["run"], quantity)

# A condition that the model refuses is said, and the next one is computed; wrong values are refused.
begin = time.perf_counter()
for _ in range(100):
    step({"slip": 0.2, "wheel_load_n": 80.0, "sled_speed_m_s": 0.02}, 1)
elapsed_ms = 10 * (time.perf_counter() - begin)
for refused in [{"slip": 2.0, "wheel_load_n": 80.0, "sled_speed_m_s": 0.02}, {"slip": 0.2, "wheel_load_n": 1e9, "sled_speed_m_s": 0.02}]:
    try:
        step(refused, 1)
    except Exception:
        continue
    raise AssertionError(f"{refused} is not refused")
assert np.isfinite(step({"slip": 0.2, "wheel_load_n": 80.0, "sled_speed_m_s": 0.02}, 1)["drawbar_pull_n"])
unit.terminate()
unit.freeInstance()

# A whole simulation, as other programs make it.
result = fmpy.simulate_fmu(unzipped, stop_time=1.0, step_size=0.1, start_values={"draw": 3, "slip": 0.3})
assert len(result) >= 10 and np.all(np.isfinite(result["drawbar_pull_n"])), result

# The lookup table.
table = np.load(FOLDER / "table.npz")
assert np.allclose(table["slip"], [0.1, 0.3, 0.5]) and table["wheel_load_n"].tolist() == [60.0, 120.0]
pull = table["drawbar_pull_n"]
assert pull.shape == (3, 2)
for k, run in enumerate(PREDICTED["runs"]):
    quantity = next(q for q in run["quantities"] if q["name"] == "drawbar_pull_n")
    assert bits(pull[k, 0]) == bits(quantity["mean"])
    assert [table["drawbar_pull_n_low"][k, 0], table["drawbar_pull_n_high"][k, 0]] == quantity["parameters"]
with open(FOLDER / "table.csv") as file:
    rows = list(csv.DictReader(file))
assert [float(row["drawbar_pull_n"]) for row in rows] == pull.ravel().tolist()
print(f"FMPy {fmpy.__version__}: {compared} values of draws have the bits of the workers, a step of one draw takes {elapsed_ms:.2f} ms")
