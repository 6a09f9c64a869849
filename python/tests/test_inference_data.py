"""Posteriors for ArviZ 0.x and 1.x."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import grouser

from .conftest import changed_example

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    az = pytest.importorskip("arviz")

CHANNELS = {"drawbar_pull_n", "torque_n_m", "sinkage_m"}


@pytest.fixture(scope="module")
def data(study: grouser.Study) -> Any:
    return study.current.inference_data(draws=200)


def test_every_group_has_its_dimensions_and_units(data: Any) -> None:
    assert dict(data["posterior"].sizes) == {"chain": 1, "draw": 200}
    assert dict(data["posterior_predictive"].sizes) == {"chain": 1, "draw": 200, "run": 24}
    assert dict(data["log_likelihood"].sizes) == {"chain": 1, "draw": 200, "run": 24}
    assert dict(data["prior"].sizes) == {"chain": 1, "draw": 1000}
    for group in ("observed_data", "posterior_predictive", "log_likelihood"):
        assert set(data[group].data_vars) == CHANNELS
    assert data["observed_data"]["torque_n_m"].attrs["units"] == "N m"
    conditions = data["constant_data"]
    assert conditions["wheel_load_n"].attrs["units"] == "N" and set(conditions["wheel_load_n"].values) == {60.0, 120.0}
    np.testing.assert_allclose(conditions["drawbar_pull_n_sd"].values, 1.2)
    stages = data["sample_stats"]["tempering_exponent"]
    assert stages.dims == ("stage",) and stages.values[-1] == 1.0 and (np.diff(stages.values) > 0).all()


def test_log_likelihoods_of_the_measurements_add_up_to_those_of_the_draws(data: Any) -> None:
    terms = data["log_likelihood"]
    total = sum(terms[channel].sum("run") for channel in CHANNELS)
    np.testing.assert_allclose(total.values, data["sample_stats"]["log_likelihood"].values, rtol=1e-9)


def test_each_log_likelihood_is_that_of_the_coordinator_s_export(study: grouser.Study) -> None:
    current = study.current
    exported = current._get("inference-data")
    group = next(group for group in exported["groups"] if group["name"] == "log_likelihood")
    labels = {label["name"]: next(iter(label["values"].values())) for label in group["coords"]}
    [variable] = group["data_vars"]
    values = np.array(variable["values"]["real"]).reshape(variable["shape"])[0]
    # The coordinator keeps predictions of some draws; those of all are computed here.
    places = labels["draw"]
    assert values.shape == (len(places), 24, 3) and len(set(places)) > 150
    whole = current.inference_data(prior_draws=1)
    for name, own in whole["posterior"].data_vars.items():
        np.testing.assert_array_equal(own.values[0], current.posterior()[str(name)])
    for place, channel in enumerate(labels["channel"]):
        terms = whole["log_likelihood"][channel]
        assert list(terms["run"].values) == labels["run"]
        np.testing.assert_allclose(terms.values[0][places], values[:, :, place], rtol=1e-9, atol=1e-9)


def test_predictions_scatter_about_the_measurements_as_the_noise_says(data: Any) -> None:
    for channel in CHANNELS:
        predicted = data["posterior_predictive"][channel]
        noise = data["constant_data"][f"{channel}_sd"]
        residual = (data["observed_data"][channel] - predicted.mean(("chain", "draw"))) / noise
        assert np.sqrt((residual**2).mean()) < 1.5
        assert 0.9 < float((predicted.std(("chain", "draw")) / noise).mean()) < 1.3


def test_draws_of_the_prior_have_the_moments_that_the_coordinator_states(study: grouser.Study) -> None:
    current = study.current
    drawn = current.inference_data(predictions=False, prior_draws=20_000)["prior"]
    stated = study._overview["ledger"][-1]["parameters"]
    assert set(drawn.data_vars) == set(stated)
    for name, moments in stated.items():
        values = drawn[name].values.ravel()
        assert abs(values.mean() - moments["prior_mean"]) < 5 * moments["prior_sd"] / np.sqrt(values.size)
        assert abs(values.std() / moments["prior_sd"] - 1) < 0.1


def test_arviz_reads_it(data: Any, tmp_path: Path) -> None:
    summary = az.summary(data)
    assert 29 < float(summary.loc["friction_angle_deg", "mean"]) < 31
    loo = az.loo(data, var_name="torque_n_m")
    # Its name is elpd_loo in 0.x.
    elpd = loo["elpd_loo"] if az.__version__.startswith("0.") else loo.elpd
    assert 0 < float(elpd) < 40
    file = tmp_path / "data.zarr"
    if not az.__version__.startswith("0."):
        data.to_zarr(file)
        assert az.from_zarr(file)["posterior"].sizes["draw"] == 200


def test_what_cannot_be_made_exactly_is_left_out_with_the_reason(tmp_path: Path) -> None:
    few = {'"auto"': '"off"', "seed = 1": "seed = 1\nparticles = 50\n[likelihood]\ndiscrepancy = 1.0\n"}
    unknown = {"torque_n_m = 0.15": 'torque_n_m = "unknown"'}
    job = changed_example(tmp_path, {"job.toml": few, "experiment.toml": unknown})
    study = grouser.run(job, tmp_path / "out", progress=False)
    with pytest.warns(UserWarning) as told:
        data = study.current.inference_data(draws=10)
    reasons = " ".join(str(warning.message) for warning in told)
    assert "prior left out" in reasons and "noise.torque_n_m" in reasons
    assert "log_likelihood left out: the errors are not independent and normal" in reasons
    assert "posterior" in data and "observed_data" in data and "log_likelihood" not in data
    study.close()


def test_an_inferred_noise_and_a_blank_cell_enter_as_they_should(tmp_path: Path) -> None:
    few = {'"auto"': '"off"', "seed = 1": "seed = 1\nparticles = 50"}
    few["[sampler]"] = '"noise.torque_n_m" = { half_normal = 2.0 }\n[sampler]'
    unknown = {"torque_n_m = 0.15": 'torque_n_m = "unknown"'}
    blank = {",0.0053032389,": ",,"}
    job = changed_example(tmp_path, {"job.toml": few, "experiment.toml": unknown, "runs.csv": blank})
    study = grouser.run(job, tmp_path / "out", progress=False)
    data = study.current.inference_data(draws=10)
    terms = data["log_likelihood"]
    # A channel that one run lacks has runs of its own.
    assert terms["sinkage_m"].dims == ("chain", "draw", "run_sinkage") and terms.sizes["run_sinkage"] == 23
    total = sum(terms[channel].sum(terms[channel].dims[2]) for channel in CHANNELS)
    np.testing.assert_allclose(total.values, data["sample_stats"]["log_likelihood"].values, rtol=1e-9)
    study.close()
