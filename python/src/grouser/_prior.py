"""Draws from the priors that a job and its effect files state."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from statistics import NormalDist
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _toml

Draws = npt.NDArray[np.float64]
NORMAL = NormalDist()
#: A level of 0 would be the quantile at minus infinity.
SMALLEST = float(np.finfo(float).tiny)


class UnstatedPriorError(Exception):
    """A prior is stated nowhere, or in a form that has no draws here."""


def draw(provenance: Mapping[str, Any], parameters: Sequence[str], count: int, seed: int) -> dict[str, Draws]:
    """Independent draws of each parameter, in SI units.

    Args:
        provenance: ``job`` and ``effects`` as ``GET /v1/calibrations/ID/provenance`` gives them.
        parameters: the free parameters.
        count: how many draws.
        seed: of the draws, which depend on nothing else.

    Raises:
        UnstatedPriorError: names the parameter.
    """
    job = _toml.parse(provenance["job"])
    stated = job.get("priors", {})
    if "posterior" in stated:
        raise UnstatedPriorError("the prior is the posterior of another calibration, which the job names as a file")
    stated = {**_of_effects(provenance["effects"]), **job.get("discovery", {}).get("priors", {}), **stated}
    generator = np.random.default_rng(seed)
    drawn = {}
    for parameter in parameters:
        # An effect on one wheel of several has the prior of its file.
        prior = stated.get(parameter, stated.get(parameter.rpartition(".")[0]))
        if not isinstance(prior, dict):
            raise UnstatedPriorError(f"neither the job nor a file of an effect states the prior of {parameter}")
        drawn[parameter] = _draw(prior, generator.uniform(SMALLEST, 1.0, count))
    return drawn


def check_moments(drawn: Mapping[str, Draws], stated: Mapping[str, tuple[float, float]]) -> None:
    """Compares draws with the mean and the sd that the coordinator states: physical bounds that the job does not state cut a prior.

    Raises:
        UnstatedPriorError: names the parameter.
    """
    for name, values in drawn.items():
        if name not in stated:
            continue
        mean, sd = stated[name]
        error = sd / math.sqrt(len(values))
        if abs(float(values.mean()) - mean) > 6 * error or not 0.7 < float(values.std()) / sd < 1.4:
            raise UnstatedPriorError(f"the prior of {name} is cut by physical bounds that its job does not state")


def _of_effects(effects: Sequence[Mapping[str, str]]) -> dict[str, Any]:
    files = [_toml.parse(effect["text"]) for effect in effects]
    return {
        f"{file['name']}.{name}": parameter.get("prior")
        for file in files
        for name, parameter in file.get("parameters", {}).items()
    }


def _draw(prior: Mapping[str, Any], uniform: Draws) -> Draws:
    """A prior's quantiles at levels in (0, 1), of what its bounds leave."""
    lower, upper = prior.get("bounds", (-math.inf, math.inf))
    kinds = [key for key in prior if key != "bounds"]
    kind = kinds[0] if len(kinds) == 1 else ""
    stated: Any = prior.get(kind)
    match kind, stated:
        case "uniform", [a, b]:
            low, high = max(a, lower), min(b, upper)
            return np.asarray(low + (high - low) * uniform)
        case "loguniform", [a, b]:
            low, high = math.log(max(a, lower)), math.log(min(b, upper))
            return np.exp(low + (high - low) * uniform)
        case "normal", [mean, sd]:
            return np.asarray(mean + sd * _normal(uniform, (lower - mean) / sd, (upper - mean) / sd))
        case "lognormal", [median, factor]:
            sd = math.log(factor)
            low, high = (math.log(b / median) / sd if b > 0 else -math.inf for b in (lower, upper))
            return np.asarray(median * np.exp(sd * _normal(uniform, low, high)))
        case "half_normal", scale:
            return np.asarray(scale * _normal(uniform, max(lower, 0.0) / scale, upper / scale))
    raise UnstatedPriorError(f"a prior of the form {dict(prior)} has no draws here")


def _normal(levels: Draws, lower: float, upper: float) -> Draws:
    """Standard normal quantiles between two bounds."""
    # From the tail that is nearer, where the cumulative probability has its digits.
    sign = -1.0 if lower > 0.0 else 1.0
    low, high = sorted((sign * lower, sign * upper))
    start, end = (0.5 * math.erfc(-bound / math.sqrt(2.0)) for bound in (low, high))
    quantiles = [NORMAL.inv_cdf(level) for level in start + (end - start) * levels]
    # A quantile next to a bound may be rounded beyond it.
    return sign * np.clip(quantiles, low, high)
