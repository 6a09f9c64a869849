"""Calibrations on this machine, without a service."""

from __future__ import annotations

import os
import tempfile
import urllib.parse
from pathlib import Path

from . import _place, _program
from ._client import Client
from ._progress import OnProgress, shown
from ._study import Study


def run(
    job: str | os.PathLike[str],
    out: str | os.PathLike[str] | None = None,
    *,
    effects: tuple[str, ...] | list[str] = (),
    local_workers: int | None = None,
    progress: bool | OnProgress = True,
) -> Study:
    """Calibrates a job on this machine until its study is over, and returns the study.

    Stopped by an interrupt of the kernel or by power, the same call goes on where it stopped and ends with the same bits.

    Args:
        job: the path of a ``job.toml``, or of the folder that it lies in.
        out: folder of the results; by default ``out/NAME`` below the working directory, named after the job.
        effects: effects of the catalogue that are added to the job.
        local_workers: threads that simulate; by default, one per core.
        progress: shows how far it is, or is told.

    Raises:
        GrouserError: a file is malformed, or the folder holds another job; the message is the coordinator's.
    """
    file = job_file(job)
    folder = Path(out) if out is not None else Path("out") / _name(file, effects)
    added = [word for effect in effects for word in ("--effect", effect)]
    with shown(progress) as tell:
        _place.run(["run", str(file), "--out", str(folder), *added], local_workers, tell)
    return Study.load(folder, local_workers=local_workers)


def check(job: str | os.PathLike[str]) -> str:
    """Validates a job with all files that it names, and returns what it is expected to cost, in words.

    Args:
        job: the path of a ``job.toml``, or of the folder that it lies in.

    Raises:
        GrouserError: a file is malformed; the message names file, line and what was expected.
    """
    return _program.call(["check", str(job_file(job))])


def example(name: str, folder: str | os.PathLike[str] | None = None) -> Path:
    """Writes an example that the program carries, and returns the path of its job.

    Args:
        name: as in ``"hidden-effect"``.
        folder: a new folder for its files; by default, ``NAME`` below the working directory.

    Raises:
        GrouserError: there is no such example; the message is the coordinator's.
    """
    with tempfile.TemporaryDirectory() as place:
        service = _program.LocalService(Path(place) / "grouser.db", read_only=False)
        try:
            files = Client(service.url).get(f"examples/{urllib.parse.quote(name, safe='')}")
        finally:
            service.close()
    path = Path(name if folder is None else folder)
    path.mkdir(parents=True)
    named = {file["name"]: file["text"] for file in (files["job"], files["experiment"])}
    for file, text in {**named, **files["files"]}.items():
        (path / Path(file).name).write_text(text, encoding="utf-8")
    return path / str(files["job"]["name"])


def job_file(job: str | os.PathLike[str]) -> Path:
    """The job file that is meant."""
    path = Path(job)
    return path / "job.toml" if path.is_dir() else path


def _name(file: Path, effects: tuple[str, ...] | list[str]) -> str:
    """The name that `coordinator run` gives its folder."""
    name = file.resolve().parent.name if file.name == "job.toml" else file.stem
    return "+".join([name, *effects])
