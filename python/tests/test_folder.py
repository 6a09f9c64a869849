"""A study in a folder: run, read, grown."""

from __future__ import annotations

import csv
import json
import shutil
from pathlib import Path

import numpy as np
import pytest

import grouser

from .conftest import EXAMPLE, Asked, changed_example


def test_a_run_names_the_missing_effect_and_its_error_falls(study: grouser.Study) -> None:
    missing = study.missing_effect
    assert missing is not None
    assert str(missing) == "janosi_hanamoto" and missing.is_added
    assert missing.probability is not None and missing.probability > 0.999
    assert missing.log_bayes_factor_nats is not None and missing.log_bayes_factor_nats > 1000
    base, extended = study.ledger()["holdout_rmse_sigma"]
    assert base > 5 and extended < 1.2
    assert study.ledger().units["fit_torque_rmse_n_m"] == "N m"


def test_the_story_tells_what_the_model_got_wrong(study: grouser.Study) -> None:
    first = study.story(study.calibrations[0].id)
    assert first.verdict == "named" and not first.channels[0].is_within_noise
    now = study.story()
    assert now.verdict == "nothing_detectable" and all(channel.is_within_noise for channel in now.channels)
    assert str(now).startswith("wrong:") and "\nnext:" in str(now)
    assert "janosi_hanamoto" in now._repr_html_()


def test_tables_are_the_files_of_the_folder_to_the_bit(study: grouser.Study, folder: Path) -> None:
    with (folder / "posterior.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    posterior = study.current.posterior()
    assert list(posterior) == list(rows[0]) and posterior.rows == len(rows)
    for name, column in posterior.items():
        np.testing.assert_array_equal(column, [float(row[name]) for row in rows])
    with (folder / "predictions.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    predictions = study.predictions()
    assert list(predictions) == list(rows[0]) and predictions.rows == len(rows)
    for name in ("measured", "model", "combined", "combined_q95", "interpolated"):
        np.testing.assert_array_equal(predictions[name], [float(row[name] or "nan") for row in rows])
    assert study.summary() == json.loads((folder / "summary.json").read_text(encoding="utf-8"))


def test_conditions_of_ones_own_are_predicted_with_their_probabilities(study: grouser.Study, tmp_path: Path) -> None:
    plan = [{"slip": slip, "wheel_load_n": 100, "sled_speed_m_s": 0.02} for slip in (0.1, 0.4)]
    predicted = study.predict(plan, statements=["drawbar_pull_n > 12"])
    pull = predicted.where(quantity="drawbar_pull_n")
    assert pull.rows == 2 and pull["mean"][0] < 12 < pull["mean"][1]
    assert np.all(pull["measurement_q05"] < pull["parameters_q05"])
    chance = predicted.where(quantity="drawbar_pull_n > 12")["measurement_mean"]
    assert chance[0] < 0.05 and chance[1] > 0.95
    # The probability by the models has its own column, and quantities have none of a measurement.
    row = predicted.where(quantity="drawbar_pull_n > 12")
    assert np.all((row["models_mean"] >= 0) & (row["models_mean"] <= 1)) and np.all(np.isnan(pull["measurement_mean"]))
    file = tmp_path / "decision.toml"
    climb = '[[decision.options]]\nname = "climb"\ncondition = { slope_deg = 6 }\n'
    stay = '[[decision.options]]\nname = "stay"\nloss = "900"\n'
    file.write_text(f'[decision]\nloss = "energy_j_m"\n{climb}{stay}', encoding="utf-8")
    assert study.decide(file)["best"] == "climb"
    recording = tmp_path / "recording.csv"
    rows = "".join(f"{i / 10},0.2,{20 + i % 3},{4 + 0.1 * (i % 4)}\n" for i in range(60))
    recording.write_text(f"t_s,slip,drawbar_pull_n,torque_n_m\n{rows}", encoding="utf-8")
    followed = study.stream(recording, parameters=["friction_angle_deg"])
    assert [time["t_s"] for time in followed["times"]] == [0.9, 1.9, 2.9, 3.9, 4.9, 5.9]
    assert followed["times"][0]["parameters"][0]["name"] == "friction_angle_deg"


def test_a_population_has_the_units_that_the_service_states(study: grouser.Study) -> None:
    population = study.current.samples(1)
    assert population.units["wheel_radius_m"] == "m" and population.units["friction_angle_deg"] == "deg"
    assert population.units == {name: unit for name, unit in study.current.posterior().units.items() if name in population}


def test_the_report_is_written(study: grouser.Study, tmp_path: Path) -> None:
    report = study.report(tmp_path / "report.html")
    assert "janosi_hanamoto" in report.read_text(encoding="utf-8")


def test_the_same_run_again_gives_the_same_study(study: grouser.Study, folder: Path) -> None:
    told: list[grouser.Progress] = []
    again = grouser.run(EXAMPLE / "job.toml", folder, progress=told.append)
    assert again.ledger()["log_evidence"].tolist() == study.ledger()["log_evidence"].tolist()
    assert not told, "nothing is left to compute"
    again.close()


def test_a_study_that_asks_grows_by_the_effect_that_is_missing(asked: Asked, tmp_path: Path) -> None:
    told = asked.told
    shutil.copytree(asked.folder, tmp_path / "out")
    study = grouser.Study.load(tmp_path / "out")
    shares = [progress.share for progress in told if "of this search" in progress.text]
    assert shares and shares == sorted(shares) and 0 <= shares[0] <= shares[-1] <= 1
    assert any("of this calibration" in progress.text for progress in told)
    missing = study.missing_effect
    assert missing is not None and not missing.is_added
    with pytest.raises(grouser.GrouserError, match=r'unknown effect "janosi_hanamotto".*janosi_hanamoto'):
        study.add("janosi_hanamotto", progress=False)
    step = study.story().steps[0]
    assert step.kind == "add_effect" and step.effect == missing.name
    extended = study.add(step, progress=False)
    assert extended.effects == ("janosi_hanamoto",)
    assert study.current.id == extended.id and study.missing_effect is not None and study.missing_effect.is_added
    assert study.ledger()["holdout_rmse_sigma"][1] < 1.2
    assert study.search(progress=False) == study.missing_effect
    study.close()


def test_a_run_that_is_interrupted_goes_on_with_the_same_bits(asked: Asked, tmp_path: Path) -> None:
    def interrupt(progress: grouser.Progress) -> None:
        if progress.share is not None and progress.share > 0.1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        grouser.run(asked.job, tmp_path, progress=interrupt)
    assert not (tmp_path / "posterior.csv").exists()
    grouser.run(asked.job, tmp_path, progress=False).close()
    assert (tmp_path / "posterior.csv").read_bytes() == (asked.folder / "posterior.csv").read_bytes()


def test_measurements_are_added_to_a_study(asked: Asked, tmp_path: Path) -> None:
    shutil.copytree(asked.folder, tmp_path / "out")
    lines = [line for line in (EXAMPLE / "runs.csv").read_text(encoding="utf-8").splitlines() if line[0] != "#"]
    (tmp_path / "more.csv").write_text(f"{lines[0]}\n{lines[1].replace('r00', 'extra')}\n", encoding="utf-8")
    study = grouser.Study.load(tmp_path / "out")
    more = study.add_runs(tmp_path / "more.csv", progress=False)
    assert "extra" in more.comparison()["run"]
    study.close()


def test_a_malformed_file_is_named_with_its_line(tmp_path: Path) -> None:
    changed_example(tmp_path, {"job.toml": {"friction_angle_deg": "friction_angel_deg"}})
    with pytest.raises(grouser.ProgramError, match=r"job\.toml.*friction_angel_deg") as raised:
        grouser.run(tmp_path, tmp_path / "out", progress=False)
    assert raised.value.exit_status == 1
    with pytest.raises(grouser.ProgramError, match="friction_angel_deg"):
        grouser.check(tmp_path)


def test_an_example_is_written_as_it_is_carried(tmp_path: Path) -> None:
    job = grouser.example("hidden-effect", tmp_path / "new")
    for file in ("job.toml", "experiment.toml", "runs.csv"):
        assert (job.parent / file).read_bytes() == (EXAMPLE / file).read_bytes()
    with pytest.raises(grouser.ServiceError, match='there is no example "hiden-effect"'):
        grouser.example("hiden-effect", tmp_path / "other")
    with pytest.raises(FileExistsError):
        grouser.example("hidden-effect", tmp_path / "new")


def test_a_check_says_what_a_job_costs() -> None:
    assert "evaluations" in grouser.check(EXAMPLE)


def test_a_folder_without_a_store_is_refused(tmp_path: Path) -> None:
    with pytest.raises(grouser.GrouserError, match=r"no grouser\.db"):
        grouser.Study.load(tmp_path)
    (tmp_path / "grouser.db").write_bytes(b"no store" * 1000)
    with pytest.raises(grouser.ProgramError, match=r"grouser\.db"):
        grouser.Study.load(tmp_path)


def test_a_study_or_calibration_that_is_not_there_is_named(study: grouser.Study, folder: Path) -> None:
    with pytest.raises(grouser.ServiceError, match="7") as raised:
        grouser.Study.load(folder, 7)
    assert (raised.value.kind, raised.value.status) == ("not_found", 404)
    with pytest.raises(grouser.GrouserError, match=r"no calibration 2, of \[1, 3\]"):
        study.calibration(2)
