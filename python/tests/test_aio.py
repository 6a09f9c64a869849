"""The names of asyncio are those of the package, and threads share a folder."""

from __future__ import annotations

import asyncio
import inspect
import shutil
from pathlib import Path
from typing import Any

import pytest

import grouser
from grouser import aio

from .conftest import Asked

#: What waits for requests or programs; errors and records are the same objects for both.
WAITING = ("Calibration", "Service", "Study", "check", "example", "run")
CLASSES = ("Calibration", "Service", "Study")


def public(owner: type) -> dict[str, Any]:
    return {name: member for name, member in vars(owner).items() if not name.startswith("_")}


def parameters(function: Any) -> list[str]:
    return [name for name in inspect.signature(function).parameters if name not in ("self", "cls")]


def test_every_name_that_waits_has_its_coroutine() -> None:
    others = {name for name in grouser.__all__ if not hasattr(aio, name)}
    assert set(aio.__all__) == set(WAITING)
    # Errors and records ask nobody.
    for name in others - set(WAITING):
        value = getattr(grouser, name)
        assert issubclass(value, Exception) or hasattr(value, "__dataclass_fields__") or value is grouser.Table, name
    for name in ("check", "example", "run"):
        assert inspect.iscoroutinefunction(getattr(aio, name))
        assert parameters(getattr(aio, name)) == parameters(getattr(grouser, name)), name


@pytest.mark.parametrize("owner", CLASSES)
def test_members_and_their_parameters_are_the_same(owner: str) -> None:
    sync, other = public(getattr(grouser, owner)), public(getattr(aio, owner))
    # An attribute of each object there is a property here.
    assert set(sync) - {"id"} == set(other) - {"id"}
    for name, member in sync.items():
        if inspect.isfunction(member) and inspect.isfunction(other[name]):
            assert parameters(member) == parameters(other[name]), f"{owner}.{name}"


def test_many_reads_of_a_folder_at_once_share_one_service(folder: Path) -> None:
    async def read() -> None:
        study = await aio.Study.load(folder)
        for _ in range(3):
            # None is there any more: all of these ask for one at the same time.
            study.close()
            told = await asyncio.gather(*(study.current.posterior() for _ in range(8)), study.summary(), study.next_runs())
            assert [table.rows for table in told[:8]] == [1000] * 8
        study.close()

    asyncio.run(read())


def test_a_folder_that_grows_is_read_meanwhile(asked: Asked, tmp_path: Path) -> None:
    own = tmp_path / "out"
    shutil.copytree(asked.folder, own)

    async def grow() -> None:
        study = await aio.Study.load(own)
        base = study.calibrations[0]

        async def read() -> int:
            return sum([(await base.posterior()).rows for _ in range(20)])

        extended, rows = await asyncio.gather(study.add("slip_sinkage", calibration=base.id), read())
        assert extended.state == "finished" and rows == 20 * 200
        study.close()

    asyncio.run(grow())
