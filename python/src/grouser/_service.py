"""A service: many studies, many workers, many users."""

from __future__ import annotations

import os
import re
from typing import Any

from . import _program
from ._error import ProgramError
from ._place import ServicePlace, listed
from ._study import Study, client
from ._table import Table

CREATED = re.compile(r"calibration \d+ of study (\d+)")


class Service:
    """A coordinator at a URL.

    Args:
        url: its address; by default ``GROUSER_URL`` of the environment, else port 7070 of this machine.
        token: the token that it asks for; by default ``GROUSER_TOKEN`` of the environment.
        ca_certificate: a PEM file with the authority of an https service; by default ``GROUSER_CA_CERTIFICATE``.
    """

    def __init__(self, url: str | None = None, *, token: str | None = None, ca_certificate: str | None = None) -> None:
        url = url or os.environ.get("GROUSER_URL") or "http://127.0.0.1:7070"
        self._place = ServicePlace(client(url, token, ca_certificate))

    @property
    def url(self) -> str:
        """Its address."""
        return self._place.client.url

    def submit(self, job: str | os.PathLike[str], *, effects: tuple[str, ...] | list[str] = ()) -> Study:
        """Submits a job with its experiment and all files that they name, and returns the study.

        Args:
            job: the path of a ``job.toml``.
            effects: effects of the catalogue that are added to the job.

        Raises:
            GrouserError: a file is malformed; the message names file, line and what was expected.
        """
        place = self._place.client
        environment = {"GROUSER_TOKEN": place.token, "GROUSER_CA_CERTIFICATE": place.ca_certificate}
        added = [word for effect in effects for word in ("--effect", effect)]
        told = _program.call(
            ["submit", os.fspath(job), "--url", place.url, *added],
            environment={name: value for name, value in environment.items() if value},
        )
        created = CREATED.search(told)
        if created is None:
            raise ProgramError(f"submit: no number of a study in {told!r}", 0)
        return self.study(int(created.group(1)))

    def study(self, id: int) -> Study:
        """A study by its number."""
        return Study(self._place, id)

    def studies(self, *, archived: bool = False) -> Table:
        """The studies: number, name, state, model, effects of the current model, verdict in a sentence.

        Args:
            archived: lists those that are archived, too.
        """
        rows = [
            {
                **{key: study[key] for key in ("id", "name", "state", "model_kind")},
                "effects": "+".join(study["effects"]) or "base",
                "verdict": (study["verdict"] or {}).get("text"),
            }
            for study in listed(self._place, "studies", archived=archived)
        ]
        return Table.from_rows(rows, ("id", "name", "state", "model_kind", "effects", "verdict"))

    def effects(self) -> Table:
        """The catalogue of effects: name, what it says, group, origin, source."""
        columns = ("name", "summary", "group", "origin", "source")
        return Table.from_rows(self._place.get("effects"), columns)

    def workers(self) -> dict[str, dict[str, Any]]:
        """The workers heard of lately, by name."""
        workers: dict[str, dict[str, Any]] = self._place.get("workers")
        return workers

    def __repr__(self) -> str:
        return f"Service({self.url!r})"
