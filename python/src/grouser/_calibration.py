"""A calibration: one Bayesian update of one model, and what came out."""

from __future__ import annotations

from typing import Any

from ._place import Place
from ._table import CONDITIONS, Table

COMPARISON = (
    "run", "use", "wheel", "slip", "wheel_load_n", "sled_speed_m_s", "slip_angle_deg", "channel", "unit",
    "measured", "predicted", "q05", "q95", "noise_sd", "residual_sigma", "error_sd",
    "corrected", "corrected_q05", "corrected_q95", "interpolated",
)  # fmt: skip


class Calibration:
    """A calibration of a study.

    Attributes:
        id: its number.
        name: its name.
        state: its state when the study was loaded or refreshed.
        effects: effects of its model beyond those of the submitted job, ``EFFECT.WHEEL`` on one wheel of several.
    """

    def __init__(self, place: Place, member: dict[str, Any]) -> None:
        self._place = place
        self.id = int(member["id"])
        self.name = str(member["name"])
        self.state = str(member["state"])
        self.effects: tuple[str, ...] = tuple(member["effects"])

    def _get(self, what: str, **query: int) -> Any:
        return self._place.get(f"calibrations/{self.id}/{what}", **query)

    def posterior(self) -> Table:
        """The equally weighted draws: ``log_likelihood``, ``log_prior`` and the free parameters."""
        answer = self._get("posterior")
        columns = answer["columns"]
        return Table.from_rows([dict(zip(columns, row, strict=True)) for row in answer["rows"]], columns, self._units())

    def samples(self, stage: int) -> Table:
        """The population at the end of a stage, counted from 1: ``log_likelihood``, ``log_prior`` and the parameters."""
        answer = self._get("samples", stage=stage)
        names = ["log_likelihood", "log_prior", *answer["parameters"]]
        rows = [[s["log_likelihood"], s["log_prior"], *s["theta"]] for s in answer["samples"]]
        units = dict(zip(answer["parameters"], answer["units"], strict=True))
        return Table.from_rows([dict(zip(names, row, strict=True)) for row in rows], names, units)

    def _units(self) -> dict[str, str]:
        return {parameter["name"]: parameter["unit"] for parameter in self._get("diagnostics")["parameters"]}

    def _prior_moments(self) -> dict[str, tuple[float, float]]:
        """Mean and standard deviation of each parameter's prior, as the coordinator states them."""
        study = self._place.get(f"calibrations/{self.id}")["study"]
        lines = [line for line in self._place.get(f"studies/{study}")["ledger"] if line["calibration"] == self.id]
        stated = {name: moments for line in lines for name, moments in line["parameters"].items()}
        return {name: (moments["prior_mean"], moments["prior_sd"]) for name, moments in stated.items()}

    def comparison(self) -> Table:
        """Model against measurement: a row for each run and measured channel.

        ``unit`` is the SI unit of ``measured``, ``predicted`` (posterior mean), ``q05`` and ``q95`` (of a new measurement),
        ``noise_sd`` and ``error_sd``, the sd of all errors that the calibration assumes or infers (noise, scatter of the
        soil, discrepancy); ``residual_sigma`` is measured minus predicted in noise sds.
        """
        return Table.from_rows(self._get("comparison")["rows"], COMPARISON, CONDITIONS)

    def stages(self) -> Table:
        """The stages of the sampler: tempering exponent, acceptance, drift, steps, evaluations."""
        return Table.from_rows(self._get("stages"))

    def explanations(self) -> Table:
        """What the search of this model weighed, likeliest first: each effect, its probability, its log Bayes factor [nats].

        ``none`` is the model as it is; ``not_in_library``, where it was searched, a law outside the library.

        Raises:
            GrouserError: this model was not searched, or the search is not finished.
        """
        columns = (
            "name",
            "probability",
            "log_bayes_factor",
            "class",
            "in_credible_set",
            "prior_sds",
            "strength_prior",
            "method",
        )
        effects = sorted(self._get("discovery")["effects"], key=lambda effect: -effect["probability"])
        return Table.from_rows(effects, columns, {"log_bayes_factor": "nat"})

    def diagnostics(self) -> dict[str, Any]:
        """How far the result can be trusted, and where the model fails (docs/results.md)."""
        diagnostics: dict[str, Any] = self._get("diagnostics")
        return diagnostics

    def provenance(self) -> dict[str, Any]:
        """How it came about: the job and the effect files as they were, versions, and what it reached in sentences."""
        provenance: dict[str, Any] = self._get("provenance")
        return provenance

    def experiment(self) -> dict[str, Any]:
        """The experiment: ``toml``, the text of ``experiment.toml``, and ``files``, the texts of what it names."""
        number = self._place.get(f"calibrations/{self.id}")["experiment"]
        experiment: dict[str, Any] = self._place.get(f"experiments/{number}")
        return experiment

    def inference_data(self, draws: int | None = None, *, predictions: bool = True, prior_draws: int = 1000) -> Any:
        """The posterior for ArviZ: ``arviz.InferenceData`` with ArviZ 0.x, ``xarray.DataTree`` with 1.x.

        Groups: ``posterior``, ``sample_stats``, ``prior``, ``observed_data``, ``constant_data``, and, of models of the kind
        ``quasi_static`` with independent normal noise, ``posterior_predictive`` and ``log_likelihood``. A group that cannot
        be made exactly is left out with a ``UserWarning`` that says why. There is one chain: the draws are equally weighted
        and have no order in time, so ``r_hat`` does not apply; :meth:`diagnostics` has the checks of the sampler.

        Args:
            draws: most draws, equally spaced ones of the posterior; by default, all.
            predictions: makes ``posterior_predictive`` and ``log_likelihood``, by a forward run for each draw.
            prior_draws: draws of ``prior``.
        """
        from ._inference_data import build

        return build(self, draws, predictions, prior_draws)

    def __repr__(self) -> str:
        return f"Calibration {self.id}: {self.name}, {self.state}"
