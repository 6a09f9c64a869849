"""Opens the exported files of FOLDER with xarray, ArviZ, DuckDB and pyarrow: python tests/export/check.py FOLDER"""

import csv
import pathlib
import sys

import arviz
import duckdb
import numpy as np
import pyarrow.ipc
import xarray

FOLDER = pathlib.Path(sys.argv[1])
GROUPS = ["posterior", "sample_stats", "prior", "log_likelihood", "posterior_predictive", "observed_data", "constant_data",
          "predictions", "predictions_constant_data"]

with open(FOLDER / "posterior.csv") as file:
    NAMES, *ROWS = csv.reader(file)
DRAWS = {name: np.array([float(row[k]) for row in ROWS]) for k, name in enumerate(NAMES)}
PARAMETERS = NAMES[2:]
assert len(ROWS) > 100 and len(PARAMETERS) > 2


def same(values, name):
    """To the bit, as posterior.csv has them."""
    values = np.asarray(values, dtype=float).ravel()
    assert np.array_equal(values, DRAWS[name]), f"{name}: {values[:3]} is not {DRAWS[name][:3]}"


def check(groups, what):
    """Groups by name, each as a dataset."""
    assert sorted(groups) == sorted(GROUPS), f"{what}: {sorted(groups)}"
    posterior, stats = groups["posterior"], groups["sample_stats"]
    assert sorted(posterior.data_vars) == sorted(PARAMETERS)
    for name in PARAMETERS:
        assert posterior[name].dims == ("chain", "draw")
        same(posterior[name], name)
    same(stats["log_likelihood"], "log_likelihood")
    same(stats["log_prior"], "log_prior")
    assert np.allclose(stats["lp"], stats["log_likelihood"] + stats["log_prior"])
    assert float(stats["tempering_exponent"][-1]) == 1.0
    measured, predicted = groups["observed_data"]["measurement"], groups["posterior_predictive"]["measurement"]
    assert measured.dims == ("run", "channel") and predicted.dims == ("chain", "draw", "run", "channel")
    assert [str(name) for name in measured["channel"].values] == ["drawbar_pull_n", "torque_n_m", "sinkage_m"]
    assert [str(name) for name in measured["run"].values][:2] == ["r00", "r01"]
    with open("examples/hidden-effect/runs.csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    fitted = [row for row in rows if row["use"] == "fit"]
    assert np.array_equal(measured.sel(channel="torque_n_m"), [float(row["torque_n_m"]) for row in fitted])
    assert len(groups["predictions"]["run"]) == len(rows) - len(fitted)
    slips = groups["constant_data"]["slip"]
    assert np.array_equal(slips, [float(row["slip"]) for row in fitted])
    assert {str(unit) for unit in groups["constant_data"]["unit"].values} == {"N", "N m", "m"}
    # The noise is declared and independent: the densities of the measurements add up to the log-likelihood of the draw.
    pointwise = groups["log_likelihood"]["measurement"]
    places = pointwise["draw"].values
    assert len(set(places)) == len(places) > 100
    total = pointwise.sum(["run", "channel"]).values.ravel()
    assert np.allclose(total, DRAWS["log_likelihood"][places], rtol=1e-9), f"{what}: {total[:3]}"
    # The declared noise lies between model and new measurement.
    noise = (predicted - groups["posterior_predictive"]["model"]).std(["chain", "draw", "run"])
    assert np.allclose(noise, [1.2, 0.15, 0.0004], rtol=0.05), f"{what}: {noise.values}"


def of_classic(file):
    """The groups of a NetCDF file, whose names begin with their group's."""
    whole = xarray.open_dataset(file, engine="scipy")
    parts = {}
    for name in GROUPS:
        own = [variable for variable in whole.variables if variable.startswith(f"{name}.")]
        part = whole[own]
        parts[name] = part.rename({old: old[len(name) + 1:] for old in [*part.variables, *part.dims] if old.startswith(f"{name}.")})
    assert whole.attrs["created_by"].startswith("grouser ")
    return parts


tree = xarray.open_datatree(FOLDER / "data.zarr", engine="zarr")
assert tree.attrs["created_by"].startswith("grouser ") and float(tree.attrs["log_evidence"]) < 0
check({name: node.to_dataset() for name, node in tree.children.items()}, "zarr")
check(of_classic(FOLDER / "data.nc"), "netcdf")

if arviz.__version__.startswith("0."):
    data = arviz.InferenceData.from_datatree(tree)
    summary = arviz.summary(data, kind="stats", round_to="none")
else:
    data = arviz.from_zarr(str(FOLDER / "data.zarr"))
    summary = arviz.summary(data, kind="stats", round_to="none")
for name in PARAMETERS:
    assert np.isclose(summary.loc[name, "mean"], DRAWS[name].mean(), rtol=1e-6), f"{name}\n{summary}"
assert np.isfinite(arviz.loo(data, var_name="measurement").elpd if arviz.__version__.startswith("1.") else
                   arviz.loo(data, var_name="measurement", reff=1.0).elpd_loo)

database = duckdb.connect()
table = database.execute(f"select * from '{FOLDER}/draws.parquet' order by chain, draw").fetchnumpy()
assert list(table) == ["chain", "draw", *NAMES]
arrow = pyarrow.ipc.open_file(FOLDER / "draws.arrow").read_all()
assert arrow.column_names == ["chain", "draw", *NAMES]
units = {field.name: field.metadata[b"unit"] for field in arrow.schema if field.metadata}
assert units["wheel_radius_m"] == b"m"
for name in NAMES:
    same(table[name], name)
    same(arrow[name].to_numpy(), name)
mean = database.execute(f"select avg(n) from '{FOLDER}/draws.parquet'").fetchone()[0]
assert np.isclose(mean, DRAWS["n"].mean())

print(f"xarray {xarray.__version__}, ArviZ {arviz.__version__}, DuckDB {duckdb.__version__}, pyarrow {pyarrow.__version__}: "
      f"{len(ROWS)} draws of {len(PARAMETERS)} parameters are those of posterior.csv")
