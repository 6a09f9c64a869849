"""A study at a service, for code that waits and for asyncio."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import cast

import pytest

import grouser
from grouser import aio
from grouser._place import ServicePlace, listed

from .conftest import Served, changed_example


@pytest.fixture(scope="module")
def service(served: Served) -> grouser.Service:
    return grouser.Service(served.url, token=served.token)


def test_a_submitted_study_has_the_bits_of_a_run_and_grows(service: grouser.Service, served: Served, tmp_path: Path) -> None:
    few = {"seed = 1": "seed = 1\nparticles = 100", '"auto"': '"off"'}
    job = changed_example(tmp_path, {"job.toml": few})
    study = service.submit(job)
    seen = [progress.text for progress in study.watch()]
    assert any("evaluations" in text for text in seen)
    local = grouser.run(job, tmp_path / "out", progress=False)
    here, there = study.current.posterior(), local.current.posterior()
    assert here.rows == there.rows == 100 and all((here[name] == there[name]).all() for name in there)
    local.close()
    assert study.missing_effect is None
    extended = study.add("janosi_hanamoto", progress=False)
    assert extended.state == "finished" and study.current.id == extended.id
    again = grouser.Study.load(served.url, study.id, token=served.token)
    assert again.ledger()["effects"].tolist() == ["base", "janosi_hanamoto"]
    assert service.studies().where(id=study.id)["effects"].tolist() == ["janosi_hanamoto"]
    # An effect file is another guess in the same ledger.
    weaker = """name = "weaker_when_slow"
summary = "the shear stress is weaker where the rim slides slowly"
source = "a guess"
shear = "tau * (1 - a * exp(-v_t / v_a))"

[parameters.a]
unit = "1"
neutral = 0.0
prior = { uniform = [0.0, 1.0] }

[parameters.v_a]
unit = "m/s"
prior = { lognormal = [0.01, 3.0] }
"""
    (tmp_path / "weaker_when_slow.toml").write_text(weaker, encoding="utf-8")
    base = study.calibrations[0].id
    guess = study.add(tmp_path / "weaker_when_slow.toml", calibration=base, progress=False)
    assert guess.effects == ("weaker_when_slow",) and study.current.id == extended.id
    assert study.search(wait=False) is None
    assert study.wait(progress=False).state == "finished"
    assert study.current.explanations()["name"][0] == "none"


def test_the_coordinator_s_message_is_the_error_s(service: grouser.Service, served: Served) -> None:
    with pytest.raises(grouser.ServiceError, match="token") as raised:
        grouser.Service(served.url, token="wrong").studies()
    assert (raised.value.kind, raised.value.status) == ("unauthorized", 401)
    with pytest.raises(grouser.ServiceError, match=r"no answer from http://127\.0\.0\.1:9") as raised:
        grouser.Service("http://127.0.0.1:9").studies()
    assert raised.value.kind == "unreachable"
    with pytest.raises(ValueError, match="not an http or https URL"):
        grouser.Service("coordinator:7070")
    assert "janosi_hanamoto" in service.effects()["name"]


@pytest.fixture(scope="module")
def long_job(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A job that is not over when it is cancelled."""
    place = tmp_path_factory.mktemp("long")
    return changed_example(place, {"job.toml": {"seed = 1": "seed = 1\nparticles = 50000"}})


def cancel(study: grouser.Study) -> None:
    """Cancels the last member."""
    study._place.client.post(f"calibrations/{study._overview['members'][-1]['id']}/cancel")


def test_waiting_ends_when_the_time_is_up_or_the_calibration_is_paused(service: grouser.Service, long_job: Path) -> None:
    study = service.submit(long_job)
    with pytest.raises(TimeoutError, match="not over after 0 s"):
        study.wait(0.0, progress=False)
    study._place.client.post(f"calibrations/{study.calibrations[0].id}/pause")
    with pytest.raises(grouser.CalibrationStopped, match="paused") as raised:
        study.wait(progress=False)
    assert raised.value.state == "paused"
    cancel(study)


def test_a_cancelled_calibration_is_an_outcome(service: grouser.Service, long_job: Path, tmp_path: Path) -> None:
    study = service.submit(long_job)
    cancel(study)
    assert study.wait(progress=False).state == "cancelled"
    assert [calibration.state for calibration in study.calibrations] == ["cancelled"]
    assert list(study.watch()) == []
    # Beside a finished one it takes nothing from that. So many particles are not over before it is cancelled.
    alone = {"seed = 1": "seed = 1\nparticles = 1000", '"auto"': '"off"'}
    grown = service.submit(changed_example(tmp_path, {"job.toml": alone})).wait(progress=False)
    later = grown.add("janosi_hanamoto", wait=False)
    cancel(grown)
    assert grown.wait(progress=False).calibration(later.id).state == "cancelled"
    assert grown.calibrations[0].state == "finished" and grown.current.posterior().rows == 1000


def test_coroutines_do_the_same_beside_other_work(served: Served, folder: Path, long_job: Path) -> None:
    async def both() -> None:
        service = aio.Service(served.url, token=served.token)
        # Two studies at a time: one at the service, one in a folder.
        submitted, local = await asyncio.gather(service.submit(long_job), aio.Study.load(folder))
        missing, posterior = await asyncio.gather(local.missing_effect(), local.current.posterior())
        assert missing is not None and missing.name == "janosi_hanamoto" and posterior.rows == 1000
        with pytest.raises(grouser.GrouserError, match="unknown effect"):
            await local.add("no_such_effect")
        local.close()
        seen: list[str] = []
        async for progress in submitted.watch():
            seen.append(progress.text)
            if "evaluations" in progress.text:
                await asyncio.to_thread(cancel, submitted.sync)
        assert any("evaluations" in text for text in seen) and submitted.state == "cancelled"
        # A coroutine that is given up stops waiting.
        longer = await service.submit(long_job)
        with pytest.raises(asyncio.TimeoutError):
            await asyncio.wait_for(longer.wait(), 0.1)
        await asyncio.to_thread(cancel, longer.sync)

    asyncio.run(both())


def test_a_long_list_is_asked_for_page_by_page(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("grouser._place.PAGE", 2)
    entries = [{"id": number} for number in (1, 3, 4, 7)]
    asked: list[int | None] = []

    class Place:
        def get(self, path: str, *, limit: int, after: int | None, archived: bool) -> list[dict[str, int]]:
            asked.append(after)
            return [entry for entry in entries if after is None or entry["id"] > after][:limit]

    place = cast(ServicePlace, Place())
    assert listed(place, "studies", archived=True) == entries and asked == [None, 3, 7]
