"""Where studies are kept: at a service, or in the output folder of a run."""

from __future__ import annotations

import os
import tempfile
import threading
from pathlib import Path
from typing import Any

from . import _program
from ._client import Client
from ._error import GrouserError
from ._progress import OnProgress, of_line
from ._story import EffectFile

Query = str | int | bool | None


class ServicePlace:
    """A service: it computes on its own, and requests return at once."""

    #: Whether a request that makes a study grow returns before the study is over.
    is_remote = True

    def __init__(self, client: Client) -> None:
        self.client = client

    def get(self, path: str, **query: Query) -> Any:
        return self.client.get(path, **query)

    def text(self, path: str, **query: Query) -> str:
        return self.client.text(path, **query)

    def post(self, path: str, body: Any) -> Any:
        return self.client.post(path, body)

    def extend(self, calibration: int, effect: str | EffectFile, wheel: str | None, tell: OnProgress | None) -> None:
        body: dict[str, Any] = {"effect": effect, "wheel": wheel} if wheel else {"effect": effect}
        if isinstance(effect, EffectFile):
            body = {"effect_file": {"name": effect.name, "text": effect.text}}
        self.client.post(f"calibrations/{calibration}/extend", body)

    def discover(self, calibration: int, tell: OnProgress | None) -> None:
        self.client.post(f"calibrations/{calibration}/discovery")

    def add_runs(self, study: int, calibration: int, runs: str, tell: OnProgress | None) -> None:
        self.client.post(f"studies/{study}/runs", {"runs": runs, "calibration": calibration})

    def __str__(self) -> str:
        return self.client.url


class FolderPlace:
    """The folder of a run: read through a service of its own, worked on by the program's verbs."""

    is_remote = False

    def __init__(self, folder: Path, local_workers: int | None = None, token: str | None = None) -> None:
        self.folder = folder
        self.local_workers = local_workers
        # Asked for where the store is that of a service with tokens.
        self.token = token
        self._service: _program.LocalService | None = None
        self._client: Client | None = None
        # Threads, as those of `grouser.aio`, share one service: none starts a second one, and none ends it while another asks.
        self._lock = threading.RLock()

    @property
    def client(self) -> Client:
        with self._lock:
            if self._client is None:
                store = self.folder / "grouser.db"
                if not store.is_file():
                    raise GrouserError(f"{self.folder}: no grouser.db, so no output folder of a run")
                self._service = _program.LocalService(store, read_only=True)
                self._client = Client(self._service.url, self.token)
            return self._client

    def get(self, path: str, **query: Query) -> Any:
        with self._lock:
            return self.client.get(path, **query)

    def text(self, path: str, **query: Query) -> str:
        with self._lock:
            return self.client.text(path, **query)

    def post(self, path: str, body: Any) -> Any:
        with self._lock:
            return self.client.post(path, body)

    def extend(self, calibration: int, effect: str | EffectFile, wheel: str | None, tell: OnProgress | None) -> None:
        if isinstance(effect, str):
            on_wheel = ["--wheel", wheel] if wheel else []
            self._grow(["extend", str(calibration), "--effect", effect, *on_wheel], tell)
            return
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / Path(effect.name).name
            file.write_text(effect.text, encoding="utf-8")
            self._grow(["extend", str(calibration), "--effect-file", str(file)], tell)

    def discover(self, calibration: int, tell: OnProgress | None) -> None:
        self._grow(["discover", str(calibration)], tell)

    def add_runs(self, study: int, calibration: int, runs: str, tell: OnProgress | None) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "runs.csv"
            file.write_text(runs, encoding="utf-8")
            self._grow(["add-runs", str(calibration), str(file)], tell)

    def _grow(self, arguments: list[str], tell: OnProgress | None) -> None:
        self.close()
        try:
            run([*arguments, "--out", os.fspath(self.folder)], self.local_workers, tell)
        finally:
            # Another thread may have read meanwhile: the next request starts a service that sees what is new.
            self.close()

    def close(self) -> None:
        with self._lock:
            if self._service is not None:
                self._service.close()
            self._service = self._client = None

    def __str__(self) -> str:
        return str(self.folder)


Place = ServicePlace | FolderPlace


def run(arguments: list[str], local_workers: int | None, tell: OnProgress | None) -> str:
    """Runs a verb that works in a folder, and returns what it prints.

    Args:
        arguments: verb and options.
        local_workers: threads that simulate; by default, one per core.
        tell: told how far the study has come.
    """

    def on_line(line: str) -> None:
        progress = of_line(line)
        if progress is not None and tell is not None:
            tell(progress)

    workers = [] if local_workers is None else ["--local-workers", str(local_workers)]
    return _program.call([*arguments, *workers], on_line=on_line)


#: The number of entries of a list that are asked for at a time.
PAGE = 1000


def listed(place: Place, path: str, **query: Query) -> list[dict[str, Any]]:
    """A list whose entries have numbers, asked for page by page, so that the service never makes the whole of a long one."""
    entries: list[dict[str, Any]] = []
    while True:
        after = entries[-1]["id"] if entries else None
        page = place.get(path, limit=PAGE, after=after, **query)
        entries += page
        if len(page) < PAGE:
            return entries
