"""Pictures of a study, with Matplotlib. Needs ``grouser[figures]``.

Each function returns a ``matplotlib.figure.Figure``, which a notebook shows as it is, and
``figure.savefig("name.png")`` writes. Axes carry the units of what they show.
"""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from ._table import Table

if TYPE_CHECKING:
    from ._calibration import Calibration
    from ._study import Study

#: How a channel is shown: words, unit, and what an SI value is multiplied by.
CHANNELS = {
    "drawbar_pull": ("drawbar pull", "N", 1.0),
    "torque": ("torque", "N m", 1.0),
    "sinkage": ("sinkage", "mm", 1e3),
    "lateral_force": ("lateral force", "N", 1.0),
}
# Blue and orange of Okabe & Ito (2008), which colour-blind readers tell apart.
FIT, HOLDOUT, GREY = "#0072B2", "#D55E00", "#8c8c8c"


class Picture(Figure):
    """A figure that a notebook shows without ``pyplot``, whose global state would keep every figure alive."""

    def _repr_png_(self) -> bytes:
        written = io.BytesIO()
        self.savefig(written, format="png", dpi=100)
        return written.getvalue()


def _figure(width_in: float, height_in: float) -> Picture:
    return Picture(figsize=(width_in, height_in), layout="constrained")


def _channels(rows: Table) -> list[str]:
    present = set(rows["channel"])
    return [channel for channel in CHANNELS if channel in present]


def comparison(calibration: Calibration) -> Figure:
    """Model against measurement: predicted over measured with 90 % intervals above, residuals in noise sds over slip below.

    A model that explains the measurements to within the noise has its points on the diagonal above, and two thirds of its
    residuals within one noise sd below.
    """
    rows = calibration.comparison()
    channels = _channels(rows)
    figure = _figure(3.6 * len(channels), 5.6)
    axes = figure.subplots(2, len(channels), squeeze=False, height_ratios=[2, 1])
    for column, channel in enumerate(channels):
        words, unit, factor = CHANNELS[channel]
        above, below = axes[:, column]
        own = rows.where(channel=channel)
        ends = factor * np.concatenate([own["measured"], own["predicted"]])
        above.plot(*[[np.nanmin(ends), np.nanmax(ends)]] * 2, color=GREY, linewidth=1, zorder=0)
        for use, color, marker, label in (("fit", FIT, "o", "fitted"), ("holdout", HOLDOUT, "D", "held out")):
            part = own.where(use=use)
            if part.rows == 0:
                continue
            predicted = factor * part["predicted"]
            style = {"color": color, "marker": marker, "markersize": 4, "linestyle": "none", "label": f"{label} runs"}
            reach = np.abs(np.vstack([part["q05"], part["q95"]]) * factor - predicted)
            bars = None if np.isnan(reach).any() else reach
            above.errorbar(factor * part["measured"], predicted, yerr=bars, elinewidth=0.8, **style)
            below.plot(part["slip"], part["residual_sigma"], **style)
        above.set(xlabel=f"measured {words} [{unit}]", ylabel=f"predicted {words} [{unit}]")
        below.axhspan(-1, 1, color=GREY, alpha=0.2, linewidth=0)
        below.axhline(0, color=GREY, linewidth=1)
        below.set(xlabel="slip [1]", ylabel="residual [noise sd]" if column == 0 else None)
    axes[0, 0].legend(frameon=False, fontsize="small")
    figure.suptitle(f"{calibration.name}: model against measurement, 90 % intervals")
    return figure


def ledger(study: Study) -> Figure:
    """The ledger of errors: root mean square errors of each model in noise sds, on fitted and on held-out runs.

    A correct model scores about 1, the dashed line.
    """
    table = study.ledger()
    if table.rows == 0:
        raise ValueError(f"study {study.id} has no line in its ledger yet")
    labels = [str(effects).replace("+", "\n+ ") for effects in table["effects"]]
    figure = _figure(max(5.0, 1.2 + 1.5 * table.rows), 3.8)
    axes = figure.subplots()
    for offset, (use, color, label) in zip(
        (-0.2, 0.2), (("fit", FIT, "fitted runs"), ("holdout", HOLDOUT, "held-out runs")), strict=True
    ):
        errors = table[f"{use}_rmse_sigma"]
        if np.isnan(errors).all():
            continue
        bars = axes.bar(np.arange(table.rows) + offset, errors, 0.38, color=color, label=label)
        plain = {"facecolor": "white", "edgecolor": "none", "pad": 1}
        axes.bar_label(bars, [f"{error:.2g}" for error in errors], padding=2, fontsize="small", bbox=plain)
    axes.axhline(1, color="black", linewidth=1, linestyle="--", zorder=0)
    axes.set_xticks(np.arange(table.rows), labels)
    axes.margins(y=0.12)
    axes.set(ylabel="root mean square error [noise sd]")
    axes.legend(frameon=False)
    figure.suptitle(f"{study.name}: ledger of errors")
    return figure


def posterior(calibration: Calibration, parameters: list[str] | None = None) -> Figure:
    """The posterior in pairs: draws of each pair of parameters, and each parameter's marginal on the diagonal.

    Args:
        calibration: the calibration.
        parameters: the parameters that are shown; by default, all.
    """
    draws = calibration.posterior()
    names = parameters or [name for name in draws if name not in ("log_likelihood", "log_prior")]
    size = len(names)
    figure = _figure(1.9 * size + 0.6, 1.9 * size + 0.6)
    axes = figure.subplots(size, size, squeeze=False)
    values = [draws[name] for name in names]
    labels = [_label(name, draws.units.get(name, "")) for name in names]
    for row in range(size):
        for column in range(size):
            place = axes[row, column]
            if column > row:
                place.set_axis_off()
                continue
            if column == row:
                place.hist(values[row], bins=30, color=FIT, alpha=0.8)
                place.set_yticks([])
            else:
                place.plot(values[column], values[row], ".", color=FIT, markersize=2, alpha=0.4)
            place.tick_params(labelsize="small", rotation=30)
            place.set_xlabel(labels[column] if row == size - 1 else "", fontsize="small")
            place.set_ylabel(labels[row] if column == 0 and row > 0 else "", fontsize="small")
            place.label_outer()
    figure.suptitle(f"{calibration.name}: {draws.rows} draws of the posterior")
    return figure


def _label(name: str, unit: str) -> str:
    # An effect's parameter has a long name: its effect stands on a line of its own.
    words = "\n".join(name.split(".", 1))
    return words if unit in ("", "1") else f"{words} [{unit}]"


def explanations(calibration: Calibration, most: int = 10) -> Figure:
    """What the search weighed: log Bayes factors over the searched model, each with its probability P.

    Args:
        calibration: the calibration whose model was searched.
        most: most explanations that are shown, the likeliest first.
    """
    table = calibration.explanations()
    factors = table["log_bayes_factor"]
    # Among explanations without probability, the one with more evidence comes first.
    order = sorted(range(table.rows), key=lambda i: (-table["probability"][i], -np.nan_to_num(factors[i], nan=-np.inf)))
    order = [i for i in order if not np.isnan(factors[i])][:most][::-1]
    figure = _figure(7.5, 1.2 + 0.32 * len(order))
    axes = figure.subplots()
    named = [bool(table["in_credible_set"][i]) for i in order]
    bars = axes.barh(
        [str(table["name"][i]) for i in order], factors[order], color=[FIT if is_named else GREY for is_named in named]
    )
    axes.bar_label(bars, [_probability(table["probability"][i]) for i in order], padding=4, fontsize="small")
    axes.axvline(0, color="black", linewidth=1)
    axes.margins(x=0.18)
    axes.set(xlabel="log Bayes factor over the searched model [nat]")
    figure.suptitle(f"{calibration.name}: explanations of its misfit; blue: in the credible set")
    return figure


def _probability(value: float) -> str:
    if value > 0.999:
        return "P > 0.999"
    return "P < 0.001" if value < 0.001 else f"P {value:.3f}"
