"""Tables and how they are handed on; words of progress; priors."""

from __future__ import annotations

import numpy as np
import pytest

import grouser
from grouser import _prior, _progress, _story


@pytest.fixture
def table() -> grouser.Table:
    rows = [
        {"run": "a", "load_n": 60, "pull_n": 1.5, "is_fitted": True, "note": None},
        {"run": "b", "load_n": 120, "pull_n": None, "is_fitted": False, "note": None},
    ]
    return grouser.Table.from_rows(rows, units={"load_n": "N", "pull_n": "N", "absent": "m"})


def test_columns_have_the_types_of_their_values(table: grouser.Table) -> None:
    kinds = {name: column.dtype.kind for name, column in table.items()}
    assert kinds == {"run": "O", "load_n": "i", "pull_n": "f", "is_fitted": "b", "note": "f"}
    assert table.rows == 2 and np.isnan(table["pull_n"][1]) and table.units == {"load_n": "N", "pull_n": "N"}
    assert table.where(run="b")["load_n"].tolist() == [120]
    assert table.to_dicts()[0]["run"] == "a"
    assert "load_n [N]" in table._repr_html_()
    assert grouser.Table.from_rows([], ["a", "b"]).rows == 0


def test_arrow_carries_values_and_units(table: grouser.Table) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    arrow = table.to_arrow()
    assert arrow.schema.field("load_n").metadata == {b"unit": b"N"}
    assert pyarrow.table(table).column("run").to_pylist() == ["a", "b"]
    polars = pytest.importorskip("polars")
    assert table.to_polars()["load_n"].sum() == 180
    assert polars.DataFrame(table.to_arrow()).shape == (2, 5)
    pytest.importorskip("pandas")
    frame = table.to_pandas()
    assert frame["pull_n"].isna().tolist() == [False, True] and frame.attrs["units"]["pull_n"] == "N"


def test_a_next_run_keeps_its_units() -> None:
    told = {"slip": 0.4, "wheel_load_n": 60, "sled_speed_m_s": 0.02, "separates": ["a", "b"], "information_nats": 0.3}
    assert _story.next_run(told) == grouser.NextRun(0.4, 60.0, 0.02, ("a", "b"), 0.3)


def test_progress_is_read_from_the_lines_of_the_program() -> None:
    told = _progress.of_line("31 %, about 6 s left: sand, stage 3 of about 10")
    assert told == grouser.Progress("31 %, about 6 s left: sand, stage 3 of about 10", 0.31)
    assert _progress.of_line(" 6 %: sand, stage 1") == grouser.Progress("6 %: sand, stage 1", 0.06)
    part = "31 % of this search, further rounds may follow: sand, search for a missing effect (combines effects)"
    assert _progress.of_line(part) == grouser.Progress(part, 0.31)
    assert _progress.of_line("2 local workers simulated 38.7 % of 3.8 s") is None


@pytest.mark.parametrize(
    ("position", "words"),
    [
        (
            {"kind": "sampler", "stage": 5, "tempering_exponent": 0.0123, "step": 1, "acceptance": None},
            "stage 5, tempering exponent 0.012",
        ),
        ({"kind": "fit", "steps": 4}, "fit, step 4"),
        ({"kind": "evolution", "generations": 7}, "generation 7"),
        ({"kind": "search", "rounds": 2}, "search for a missing effect"),
    ],
)
def test_progress_says_where_each_kind_of_algorithm_is(position: dict[str, object], words: str) -> None:
    live = {"algorithm": "any", "position": position, "evaluations": 2300, "remaining_s": 12.0}
    told = _progress.of_status({"name": "sand", "state": "running", "progress": live})
    assert told.text == f"sand: {words}, 2300 evaluations, about 12 s left"


@pytest.mark.parametrize(
    ("prior", "low", "median", "high"),
    [
        ({"uniform": [4.0, 5.6]}, 4.0, 4.8, 5.6),
        ({"uniform": [4.0, 5.6], "bounds": [5.0, 9.0]}, 5.0, 5.3, 5.6),
        ({"loguniform": [1.0, 100.0]}, 1.0, 10.0, 100.0),
        ({"normal": [30.0, 1.5]}, 20.0, 30.0, 40.0),
        # Half of the tail beyond 3 sds lies beyond 3.2053 sds: 1 - Phi(3.2053) = 0.5 (1 - Phi(3)).
        ({"normal": [0.0, 1.0], "bounds": [3.0, 9.0]}, 3.0, 3.2053, 9.0),
        ({"normal": [0.0, 1.0], "bounds": [-9.0, -3.0]}, -9.0, -3.2053, -3.0),
        ({"lognormal": [0.008, 2.5]}, 0.0, 0.008, 1.0),
        ({"half_normal": 2.0}, 0.0, 2.0 * 0.67449, 20.0),
    ],
)
def test_draws_of_a_prior_keep_its_bounds_and_median(
    prior: dict[str, object], low: float, median: float, high: float
) -> None:
    levels = (np.arange(2001) + 0.5) / 2001
    drawn = _prior._draw(prior, levels)
    assert low <= drawn.min() and drawn.max() <= high
    assert abs(np.median(drawn) - median) < 2e-3 * max(1.0, abs(median))


def test_a_prior_that_the_coordinator_cuts_at_physical_bounds_is_refused() -> None:
    levels = np.linspace(0.0005, 0.9995, 1000)
    drawn = {"friction_angle_deg": _prior._draw({"normal": [30.0, 40.0]}, levels)}
    with pytest.raises(_prior.UnstatedPriorError, match="friction_angle_deg is cut"):
        _prior.check_moments(drawn, {"friction_angle_deg": (39.48, 23.35)})
    _prior.check_moments(drawn, {"friction_angle_deg": (30.0, 40.0)})


def test_an_unknown_prior_is_refused() -> None:
    with pytest.raises(_prior.UnstatedPriorError, match="beta"):
        _prior._draw({"beta": [1.0, 2.0]}, np.array([0.5]))
