"""A calibration as the groups that ArviZ reads."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from ._prediction import CHANNELS, NoPredictionError, predict
from ._prior import UnstatedPriorError, check_moments, draw
from ._table import CONDITIONS, Table

Values = npt.NDArray[np.float64]
#: Largest difference of a log-likelihood from the calibration's own that counts as rounding, over max(1, |value|).
ROUNDING = 1e-6
HEAD = ("log_likelihood", "log_prior")


class Calibrated(Protocol):
    """What inference data are made from: a calibration, which imports this module."""

    id: int
    name: str

    def posterior(self) -> Table: ...
    def stages(self) -> Table: ...
    def comparison(self) -> Table: ...
    def provenance(self) -> dict[str, Any]: ...
    def experiment(self) -> dict[str, Any]: ...
    def _prior_moments(self) -> dict[str, tuple[float, float]]: ...


def build(calibration: Calibrated, draws: int | None, predictions: bool, prior_draws: int) -> Any:
    """The groups of :meth:`Calibration.inference_data`."""
    posterior = calibration.posterior()
    if posterior.rows == 0:
        raise ValueError(f"calibration {calibration.id} is a point estimate: it has no posterior")
    kept = _equally_spaced(posterior.rows, draws)
    names = [name for name in posterior if name not in HEAD]
    thetas = np.column_stack([posterior[name][kept] for name in names])
    comparison = calibration.comparison()
    fitted = comparison.where(use="fit")
    provenance = calibration.provenance()
    seed = int(provenance["seed"])
    attributes = {
        "inference_library": "grouser",
        "calibration": calibration.id,
        "name": calibration.name,
        "model": provenance["model"],
        "model_version": provenance["model_version"] or "",
        "algorithm": provenance["algorithm"],
    }
    groups = {
        "posterior": _draws({name: posterior[name][kept] for name in names}, posterior.units, attributes),
        "sample_stats": _sample_stats(posterior, kept, calibration.stages(), attributes),
        "observed_data": _by_run(fitted, "measured", attributes),
        "constant_data": _conditions(fitted, attributes),
    }
    try:
        prior = draw(provenance, names, prior_draws, seed)
        check_moments(prior, calibration._prior_moments())
        groups["prior"] = _draws(prior, posterior.units, attributes)
    except UnstatedPriorError as error:
        _left_out("prior", error)
    if predictions:
        try:
            runs, model = predict(provenance, calibration.experiment(), names, thetas)
            sds = _noise_sds(fitted, names, thetas)
            likelihood, predicted = _scored(fitted, runs, model, sds, seed)
            _check(likelihood, posterior["log_likelihood"][kept])
            units = {CHANNELS[channel]: unit for channel, unit in zip(fitted["channel"], fitted["unit"], strict=True)}
            groups["log_likelihood"] = _predicted(fitted, likelihood, dict.fromkeys(units, "nat"), attributes)
            groups["posterior_predictive"] = _predicted(fitted, predicted, units, attributes)
        except NoPredictionError as error:
            _left_out("posterior_predictive and log_likelihood", error)
    return _container(groups)


def _container(groups: Mapping[str, Any]) -> Any:
    import arviz

    # ArviZ 1.x answers to the name InferenceData, too, but with another class.
    if arviz.__version__.startswith("0."):
        return arviz.InferenceData(**groups)
    import xarray

    return xarray.DataTree.from_dict(dict(groups))


def _left_out(what: str, why: Exception) -> None:
    warnings.warn(f"{what} left out: {why}", UserWarning, stacklevel=4)


def _equally_spaced(count: int, most: int | None) -> npt.NDArray[np.intp]:
    if most is None or most >= count:
        return np.arange(count)
    if most < 1:
        raise ValueError(f"draws {most} must be at least 1")
    return np.arange(most) * count // most


def _draws(columns: Mapping[str, Values], units: Mapping[str, str], attributes: Mapping[str, Any]) -> Any:
    """One chain of draws of each variable."""
    import xarray

    count = len(next(iter(columns.values())))
    variables = {
        name: (("chain", "draw"), values[np.newaxis], {"units": units[name]} if name in units else {})
        for name, values in columns.items()
    }
    return xarray.Dataset(variables, {"chain": [0], "draw": np.arange(count)}, dict(attributes))


def _sample_stats(posterior: Table, kept: npt.NDArray[np.intp], stages: Table, attributes: Mapping[str, Any]) -> Any:
    """Log-densities by draw, and what the sampler did by stage."""
    likelihood, prior = (posterior[name][kept] for name in HEAD)
    densities = {"lp": likelihood + prior, "log_likelihood": likelihood, "log_prior": prior}
    group = _draws(densities, dict.fromkeys(densities, "nat"), attributes)
    if stages.rows == 0:
        return group
    columns = [name for name in stages if name != "stage"]
    return group.assign_coords(stage=stages["stage"]).assign({name: ("stage", stages[name]) for name in columns})


def _dimension(rows: Table, channel: str) -> tuple[str, Table]:
    """The dimension of a channel's runs: ``run``, or one of its own where it was not measured in all of them."""
    own = rows.where(channel=channel)
    everywhere = own.rows == len(set(rows["run"]))
    return ("run" if everywhere else f"run_{channel}"), own


def _measured(rows: Table) -> list[str]:
    return [channel for channel in CHANNELS if channel in set(rows["channel"])]


def _by_run(rows: Table, column: str, attributes: Mapping[str, Any]) -> Any:
    import xarray

    variables, coordinates = {}, {}
    for channel in _measured(rows):
        dimension, own = _dimension(rows, channel)
        variables[CHANNELS[channel]] = (dimension, own[column], {"units": str(own["unit"][0])})
        coordinates[dimension] = own["run"].astype(str)
    return xarray.Dataset(variables, coordinates, dict(attributes))


def _conditions(rows: Table, attributes: Mapping[str, Any]) -> Any:
    """What the rig was set to in each fitted run, and the noise sd of each measurement."""
    import xarray

    _, first = np.unique(rows["run"].astype(str), return_index=True)
    first.sort()
    runs = rows["run"][first].astype(str)
    variables: dict[str, Any] = {"wheel": ("run", rows["wheel"][first].astype(str))}
    for name, unit in CONDITIONS.items():
        variables[name] = ("run", rows[name][first], {"units": unit})
    group = xarray.Dataset(variables, {"run": runs}, dict(attributes))
    noise = _by_run(rows, "noise_sd", {}).rename({name: f"{name}_sd" for name in map(CHANNELS.get, _measured(rows))})
    return group.merge(noise)


def _noise_sds(rows: Table, names: Sequence[str], thetas: Values) -> dict[str, Values]:
    """The noise sd of each channel, by draw and run: inferred, or as the comparison states it."""
    sds = {}
    for channel in _measured(rows):
        stated = rows.where(channel=channel)["noise_sd"]
        inferred = f"noise.{CHANNELS[channel]}"
        if inferred in names:
            sds[channel] = np.repeat(thetas[:, [names.index(inferred)]], len(stated), axis=1)
        else:
            sds[channel] = np.repeat(stated[np.newaxis], len(thetas), axis=0)
    return sds


def _scored(
    rows: Table, runs: Sequence[str], model: Mapping[str, Values], sds: Mapping[str, Values], seed: int
) -> tuple[dict[str, Values], dict[str, Values]]:
    """By channel the log-likelihood of each measurement, and a new measurement drawn for each, by draw and run."""
    generator = np.random.default_rng(seed)
    likelihood, predicted = {}, {}
    for channel in _measured(rows):
        own = rows.where(channel=channel)
        places = [runs.index(run) for run in own["run"]]
        value, sd = model[channel][:, places], sds[channel]
        residual = (own["measured"] - value) / sd
        likelihood[channel] = -0.5 * residual**2 - np.log(sd) - 0.5 * math.log(2.0 * math.pi)
        predicted[channel] = value + sd * generator.standard_normal(value.shape)
    return likelihood, predicted


def _check(likelihood: Mapping[str, Values], own: Values) -> None:
    """Whether the terms add up to the log-likelihoods of the calibration itself, which its other error models would not."""
    total = np.sum([terms.sum(axis=1) for terms in likelihood.values()], axis=0)
    difference = float(np.max(np.abs(total - own) / np.maximum(1.0, np.abs(own))))
    if not difference < ROUNDING:
        raise NoPredictionError(
            f"the errors are not independent and normal: by {difference:.2g}, not the calibration's log-likelihood"
        )


def _predicted(rows: Table, values: Mapping[str, Values], units: Mapping[str, str], attributes: Mapping[str, Any]) -> Any:
    import xarray

    variables: dict[str, Any] = {}
    coordinates: dict[str, Any] = {"chain": [0]}
    for channel, array in values.items():
        dimension, own = _dimension(rows, channel)
        name = CHANNELS[channel]
        variables[name] = (("chain", "draw", dimension), array[np.newaxis], {"units": units[name]})
        coordinates |= {"draw": np.arange(len(array)), dimension: own["run"].astype(str)}
    return xarray.Dataset(variables, coordinates, dict(attributes))
