"""A study in a folder, and a service, for all tests."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

import grouser
from grouser import _program

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "hidden-effect"

# The settings of whoever runs the tests are not theirs.
for variable in [name for name in os.environ if name.startswith("GROUSER_")]:
    del os.environ[variable]


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The output folder of the example."""
    out = tmp_path_factory.mktemp("hidden-effect")
    grouser.run(EXAMPLE, out, progress=False).close()
    return out


@pytest.fixture(scope="session")
def study(folder: Path) -> Iterator[grouser.Study]:
    """The study of the example, read from its folder."""
    loaded = grouser.Study.load(folder)
    yield loaded
    loaded.close()


def changed_example(place: Path, changes: dict[str, dict[str, str]]) -> Path:
    """A copy of the example with some texts replaced, by file; returns its job."""
    for file in ("job.toml", "experiment.toml", "runs.csv"):
        text = (EXAMPLE / file).read_text(encoding="utf-8")
        for old, new in changes.get(file, {}).items():
            assert old in text, f"{file} has no {old}"
            text = text.replace(old, new)
        (place / file).write_text(text, encoding="utf-8")
    return place / "job.toml"


@dataclass(frozen=True)
class Asked:
    """The example as a job that leaves the decision to the user, with few particles: run in a folder."""

    job: Path
    folder: Path
    told: list[grouser.Progress]


@pytest.fixture(scope="session")
def asked(tmp_path_factory: pytest.TempPathFactory) -> Asked:
    place = tmp_path_factory.mktemp("asking")
    changes = {"job.toml": {'apply = "auto"': 'apply = "ask"', "seed = 1": "seed = 1\nparticles = 200"}}
    job = changed_example(place, changes)
    told: list[grouser.Progress] = []
    grouser.run(job, place / "out", progress=told.append).close()
    return Asked(job, place / "out", told)


class Served:
    """A service with local workers, and a token that it asks for."""

    def __init__(self, folder: Path) -> None:
        store = f"sqlite://{folder / 'grouser.db'}"
        self.token = _program.call(["token", "add", "tests", "--role", "submit", "--store", store]).strip()
        command = [str(_program.find()), "serve", "--listen", "127.0.0.1:0", "--local-workers", "2", "--store", store]
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        self.url = f"http://{_program._address(self.process)}"


@pytest.fixture(scope="session")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A service of its own."""
    service = Served(tmp_path_factory.mktemp("service"))
    yield service
    _program._stop(service.process)
