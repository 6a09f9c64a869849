"""Opens the exported files of FOLDER with xarray, ArviZ, DuckDB and pyarrow: python tests/export/check.py FOLDER"""

import csv
import json
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
COMPARISON = json.loads((FOLDER / "calibration.json").read_text())["comparison"]["rows"]
COLUMNS = {"drawbar_pull": "drawbar_pull_n", "torque": "torque_n_m", "sinkage": "sinkage_m"}
# Those that experiment.toml declares.
SDS = xarray.DataArray([1.2, 0.15, 0.0004], dims="channel")


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
    assert np.array_equal(stats["lp"], stats["log_likelihood"] + stats["log_prior"])
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
    # The noise is declared and independent: each density is that of a normal error, and they add up to the draw's log-likelihood.
    pointwise = groups["log_likelihood"]["measurement"]
    places = pointwise["draw"].values
    assert len(set(places)) == len(places) > 100
    errors = (measured - groups["posterior_predictive"]["model"]) / SDS
    of_error = (-0.5 * errors**2 - np.log(SDS) - 0.5 * np.log(2.0 * np.pi)).transpose(*pointwise.dims).values
    assert np.allclose(pointwise, of_error, rtol=1e-12, atol=1e-12), f"{what}: {abs(pointwise.values - of_error).max()}"
    total = pointwise.sum(["run", "channel"]).values.ravel()
    assert np.allclose(total, DRAWS["log_likelihood"][places], rtol=1e-9), f"{what}: {total[:3]}"
    check_predictions(groups["posterior_predictive"], [row["run"] for row in fitted], what)
    check_predictions(groups["predictions"], [row["run"] for row in rows if row["use"] != "fit"], what)
    # The declared noise lies between model and new measurement.
    noise = (predicted - groups["posterior_predictive"]["model"]).std(["chain", "draw", "run"])
    assert np.allclose(noise, SDS.values, rtol=0.05), f"{what}: {noise.values}"


def check_predictions(group, runs, what):
    """The model's values of each run and channel, by their mean over the draws, are those of the table of the calibration."""
    assert [str(run) for run in group["run"].values] == runs, what
    means = group["model"].mean(["chain", "draw"])
    for row in COMPARISON:
        if row["run"] in runs:
            mean = float(means.sel(run=row["run"], channel=COLUMNS[row["channel"]]))
            assert np.isclose(mean, row["predicted"], rtol=1e-9), f"{what}: {row} {mean}"


def same_groups(these, those):
    """Every variable and label, to the bit."""
    for name in GROUPS:
        assert sorted(these[name].variables) == sorted(those[name].variables), name
        for variable in these[name].variables:
            a, b = these[name][variable], those[name][variable]
            assert a.dims == b.dims and a.shape == b.shape, f"{name}.{variable}"
            if a.dtype.kind == "f":
                # NaN, too: compared as the bytes that they are.
                assert np.ascontiguousarray(a.values).tobytes() == np.ascontiguousarray(b.values.astype(float)).tobytes(), f"{name}.{variable}"
            else:
                assert [str(x) for x in a.values.ravel()] == [str(x) for x in b.values.ravel()], f"{name}.{variable}"


def check_blank():
    """A run whose sinkage is blank: only what was measured has a log-likelihood, and leave-one-out needs no NaN."""
    groups = {name: node.to_dataset() for name, node in xarray.open_datatree(FOLDER / "blank.zarr", engine="zarr").children.items()}
    measured, pointwise = groups["observed_data"]["measurement"], groups["log_likelihood"]["measurement"]
    assert int(np.isnan(measured).sum()) == 1 and np.isnan(float(measured.sel(run="r00", channel="sinkage_m")))
    assert pointwise.dims == ("chain", "draw", "observation")
    expected = [f"{run} {channel}" for run in measured["run"].values for channel in measured["channel"].values]
    expected.remove("r00 sinkage_m")
    assert [str(label) for label in pointwise["observation"].values] == expected
    errors = ((measured - groups["posterior_predictive"]["model"]) / SDS).transpose("chain", "draw", "run", "channel").values
    errors = errors.reshape(*errors.shape[:2], -1)
    densities = -0.5 * errors**2 - np.log(np.tile(SDS.values, measured.sizes["run"])) - 0.5 * np.log(2.0 * np.pi)
    densities = densities[:, :, ~np.isnan(errors[0, 0])]
    assert np.allclose(pointwise, densities, rtol=1e-12, atol=1e-12)
    assert np.isfinite(elpd("blank.zarr"))


def check_fit():
    """After a fit the draws are those of a linearised model, and the file says which log-likelihood is whose."""
    groups = {name: node.to_dataset() for name, node in xarray.open_datatree(FOLDER / "fit.zarr", engine="zarr").children.items()}
    of_draw, pointwise = groups["sample_stats"]["log_likelihood"], groups["log_likelihood"]["measurement"]
    assert "linearised model" in of_draw.attrs["long_name"] and "the model itself" in pointwise.attrs["long_name"]
    total = pointwise.sum(["run", "channel"])
    assert not np.allclose(total, of_draw.sel(draw=total["draw"]))


def elpd(file):
    """The leave-one-out score of a file."""
    if arviz.__version__.startswith("0."):
        whole = arviz.InferenceData.from_datatree(xarray.open_datatree(FOLDER / file, engine="zarr"))
        return arviz.loo(whole, var_name="measurement", reff=1.0).elpd_loo
    return arviz.loo(arviz.from_zarr(str(FOLDER / file)), var_name="measurement").elpd


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
zarr, netcdf = {name: node.to_dataset() for name, node in tree.children.items()}, of_classic(FOLDER / "data.nc")
check(zarr, "zarr")
check(netcdf, "netcdf")
same_groups(zarr, netcdf)
check_blank()
check_fit()

if arviz.__version__.startswith("0."):
    data = arviz.InferenceData.from_datatree(tree)
    summary = arviz.summary(data, kind="stats", round_to="none")
else:
    data = arviz.from_zarr(str(FOLDER / "data.zarr"))
    summary = arviz.summary(data, kind="stats", round_to="none")
for name in PARAMETERS:
    assert np.isclose(summary.loc[name, "mean"], DRAWS[name].mean(), rtol=1e-6), f"{name}\n{summary}"
assert np.isfinite(elpd("data.zarr"))

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
