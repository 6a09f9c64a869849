"""Pictures of a study."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import grouser

pytest.importorskip("matplotlib")
from grouser import figures


def words(figure: Any) -> str:
    from matplotlib.text import Text

    return "\n".join(text.get_text() for text in figure.findobj(Text))


def test_each_figure_states_its_units_and_is_written(study: grouser.Study, tmp_path: Path) -> None:
    base, extended = study.calibrations
    drawn = {
        "comparison": (figures.comparison(extended), "measured sinkage [mm]"),
        "ledger": (figures.ledger(study), "root mean square error [noise sd]"),
        "posterior": (figures.posterior(extended), "friction_angle_deg [deg]"),
        "explanations": (figures.explanations(base), "P > 0.999"),
    }
    for name, (figure, expected) in drawn.items():
        assert expected in words(figure), name
        figure.savefig(tmp_path / f"{name}.png", dpi=50)
        assert len((tmp_path / f"{name}.png").read_bytes()) > 5_000
    # What a notebook shows.
    assert drawn["ledger"][0]._repr_png_().startswith(b"\x89PNG")


def test_as_many_explanations_are_shown_as_are_asked_for(study: grouser.Study) -> None:
    axes = figures.explanations(study.calibrations[0], most=3).axes[0]
    names = [label.get_text() for label in axes.get_yticklabels()]
    assert len(names) == 3 and names[-1] == "janosi_hanamoto"
