"""The package for asyncio: the same names, with coroutines where requests or programs are waited for.

```python
from grouser import aio

study = await aio.Study.load("http://host:7070", 1)
async for progress in study.watch():
    print(progress.text)
print(await study.missing_effect())
```

Each coroutine does its work in a thread, so an event loop serves others meanwhile. A cancelled coroutine stops waiting; a
request that is on its way ends by itself, and so does :func:`run`'s program, whose results stay in its folder.
"""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import AsyncIterator, Sequence
from pathlib import Path
from typing import Any

from . import _run, _service, _study
from ._calibration import Calibration as SyncCalibration
from ._planned import Plan
from ._progress import OnProgress, Progress, shown
from ._story import MissingEffect, NextRun, Step, Story
from ._study import LOOK_S
from ._table import Table

__all__ = ["Calibration", "Service", "Study", "check", "example", "run"]


class Calibration:
    """As :class:`grouser.Calibration`.

    Attributes:
        sync: the calibration for code that may wait, as for :mod:`grouser.figures`.
    """

    def __init__(self, sync: SyncCalibration) -> None:
        self.sync = sync
        self.id, self.name, self.state, self.effects = sync.id, sync.name, sync.state, sync.effects

    async def posterior(self) -> Table:
        """As :meth:`grouser.Calibration.posterior`."""
        return await asyncio.to_thread(self.sync.posterior)

    async def samples(self, stage: int) -> Table:
        """As :meth:`grouser.Calibration.samples`."""
        return await asyncio.to_thread(self.sync.samples, stage)

    async def comparison(self) -> Table:
        """As :meth:`grouser.Calibration.comparison`."""
        return await asyncio.to_thread(self.sync.comparison)

    async def stages(self) -> Table:
        """As :meth:`grouser.Calibration.stages`."""
        return await asyncio.to_thread(self.sync.stages)

    async def explanations(self) -> Table:
        """As :meth:`grouser.Calibration.explanations`."""
        return await asyncio.to_thread(self.sync.explanations)

    async def diagnostics(self) -> dict[str, Any]:
        """As :meth:`grouser.Calibration.diagnostics`."""
        return await asyncio.to_thread(self.sync.diagnostics)

    async def provenance(self) -> dict[str, Any]:
        """As :meth:`grouser.Calibration.provenance`."""
        return await asyncio.to_thread(self.sync.provenance)

    async def experiment(self) -> dict[str, Any]:
        """As :meth:`grouser.Calibration.experiment`."""
        return await asyncio.to_thread(self.sync.experiment)

    async def inference_data(self, draws: int | None = None, *, predictions: bool = True, prior_draws: int = 1000) -> Any:
        """As :meth:`grouser.Calibration.inference_data`."""
        return await asyncio.to_thread(self.sync.inference_data, draws, predictions=predictions, prior_draws=prior_draws)

    def __repr__(self) -> str:
        return f"aio.{self.sync!r}"


class Study:
    """As :class:`grouser.Study`; make one by :meth:`Study.load`, :func:`run` or :meth:`Service.submit`.

    Attributes:
        sync: the study for code that may wait, as for :mod:`grouser.figures`.
    """

    def __init__(self, sync: _study.Study) -> None:
        self.sync = sync

    @classmethod
    async def load(
        cls,
        source: str | os.PathLike[str],
        id: int | None = None,
        *,
        token: str | None = None,
        ca_certificate: str | None = None,
        local_workers: int | None = None,
    ) -> Study:
        """As :meth:`grouser.Study.load`."""
        return cls(
            await asyncio.to_thread(
                _study.Study.load,
                source,
                id,
                token=token,
                ca_certificate=ca_certificate,
                local_workers=local_workers,
            )
        )

    @property
    def id(self) -> int:
        """Its number."""
        return self.sync.id

    @property
    def name(self) -> str:
        """Name of the submitted job."""
        return self.sync.name

    @property
    def state(self) -> str:
        """Its state when it was loaded or last refreshed."""
        return self.sync.state

    @property
    def calibrations(self) -> list[Calibration]:
        """As :attr:`grouser.Study.calibrations`."""
        return [Calibration(calibration) for calibration in self.sync.calibrations]

    @property
    def current(self) -> Calibration:
        """As :attr:`grouser.Study.current`."""
        return Calibration(self.sync.current)

    def calibration(self, id: int) -> Calibration:
        """As :meth:`grouser.Study.calibration`."""
        return Calibration(self.sync.calibration(id))

    def story(self, calibration: int | None = None) -> Story:
        """As :meth:`grouser.Study.story`: it is loaded with the study."""
        return self.sync.story(calibration)

    def ledger(self) -> Table:
        """As :meth:`grouser.Study.ledger`: it is loaded with the study."""
        return self.sync.ledger()

    def flags(self) -> Table:
        """As :meth:`grouser.Study.flags`: they are loaded with the study."""
        return self.sync.flags()

    async def refresh(self) -> Study:
        """As :meth:`grouser.Study.refresh`."""
        await asyncio.to_thread(self.sync.refresh)
        return self

    async def missing_effect(self) -> MissingEffect | None:
        """As :attr:`grouser.Study.missing_effect`."""
        return await asyncio.to_thread(lambda: self.sync.missing_effect)

    async def next_runs(self) -> list[NextRun]:
        """As :meth:`grouser.Study.next_runs`."""
        return await asyncio.to_thread(self.sync.next_runs)

    async def predict(
        self,
        plan: Plan | None = None,
        *,
        sweep: str | None = None,
        wheels: str | os.PathLike[str] | None = None,
        statements: Sequence[str] = (),
        draws: int | None = None,
        calibration: int | None = None,
    ) -> Table:
        """As :meth:`grouser.Study.predict`."""
        return await asyncio.to_thread(
            self.sync.predict,
            plan,
            sweep=sweep,
            wheels=wheels,
            statements=statements,
            draws=draws,
            calibration=calibration,
        )

    async def decide(
        self, file: str | os.PathLike[str], *, draws: int | None = None, calibration: int | None = None
    ) -> dict[str, Any]:
        """As :meth:`grouser.Study.decide`."""
        return await asyncio.to_thread(self.sync.decide, file, draws=draws, calibration=calibration)

    async def stream(
        self,
        recording: str | os.PathLike[str],
        *,
        parameters: Sequence[str] = (),
        wheel: str | None = None,
        calibration: int | None = None,
    ) -> dict[str, Any]:
        """As :meth:`grouser.Study.stream`."""
        return await asyncio.to_thread(
            self.sync.stream, recording, parameters=parameters, wheel=wheel, calibration=calibration
        )

    async def predictions(self) -> Table:
        """As :meth:`grouser.Study.predictions`."""
        return await asyncio.to_thread(self.sync.predictions)

    async def summary(self) -> dict[str, Any]:
        """As :meth:`grouser.Study.summary`."""
        return await asyncio.to_thread(self.sync.summary)

    async def report(self, file: str | os.PathLike[str]) -> Path:
        """As :meth:`grouser.Study.report`."""
        return await asyncio.to_thread(self.sync.report, file)

    async def add(
        self,
        effect: str | MissingEffect | Step | os.PathLike[str],
        *,
        wheel: str | None = None,
        calibration: int | None = None,
        wait: bool = True,
        progress: bool | OnProgress = False,
    ) -> Calibration:
        """As :meth:`grouser.Study.add`; ``progress`` is told in another thread."""
        return Calibration(
            await asyncio.to_thread(
                self.sync.add, effect, wheel=wheel, calibration=calibration, wait=wait, progress=progress
            )
        )

    async def search(
        self, calibration: int | None = None, *, wait: bool = True, progress: bool | OnProgress = False
    ) -> MissingEffect | None:
        """As :meth:`grouser.Study.search`; ``progress`` is told in another thread."""
        return await asyncio.to_thread(self.sync.search, calibration, wait=wait, progress=progress)

    async def add_runs(
        self,
        runs: str | os.PathLike[str],
        *,
        calibration: int | None = None,
        wait: bool = True,
        progress: bool | OnProgress = False,
    ) -> Calibration:
        """As :meth:`grouser.Study.add_runs`; ``progress`` is told in another thread."""
        return Calibration(
            await asyncio.to_thread(self.sync.add_runs, runs, calibration=calibration, wait=wait, progress=progress)
        )

    async def watch(self) -> AsyncIterator[Progress]:
        """As :meth:`grouser.Study.watch`."""
        last: Progress | None = None
        while (progress := await asyncio.to_thread(self.sync._look)) is not None:
            if progress != last:
                yield progress
                last = progress
            await asyncio.sleep(LOOK_S)

    async def wait(self, timeout_s: float | None = None, *, progress: bool | OnProgress = False) -> Study:
        """As :meth:`grouser.Study.wait`; a coroutine that is given up stops waiting."""
        until = None if timeout_s is None else time.monotonic() + timeout_s
        with shown(progress) as tell:
            async for now in self.watch():
                if tell is not None:
                    tell(now)
                if until is not None and time.monotonic() > until:
                    raise TimeoutError(f"study {self.id} is not over after {timeout_s:g} s: {now.text}")
        return self

    def close(self) -> None:
        """As :meth:`grouser.Study.close`."""
        self.sync.close()

    def __repr__(self) -> str:
        return f"aio.{self.sync!r}"


class Service:
    """As :class:`grouser.Service`."""

    def __init__(self, url: str | None = None, *, token: str | None = None, ca_certificate: str | None = None) -> None:
        self.sync = _service.Service(url, token=token, ca_certificate=ca_certificate)

    @property
    def url(self) -> str:
        """Its address."""
        return self.sync.url

    async def submit(self, job: str | os.PathLike[str], *, effects: tuple[str, ...] | list[str] = ()) -> Study:
        """As :meth:`grouser.Service.submit`."""
        return Study(await asyncio.to_thread(self.sync.submit, job, effects=effects))

    async def study(self, id: int) -> Study:
        """As :meth:`grouser.Service.study`."""
        return Study(await asyncio.to_thread(self.sync.study, id))

    async def studies(self, *, archived: bool = False) -> Table:
        """As :meth:`grouser.Service.studies`."""
        return await asyncio.to_thread(self.sync.studies, archived=archived)

    async def effects(self) -> Table:
        """As :meth:`grouser.Service.effects`."""
        return await asyncio.to_thread(self.sync.effects)

    async def workers(self) -> dict[str, dict[str, Any]]:
        """As :meth:`grouser.Service.workers`."""
        return await asyncio.to_thread(self.sync.workers)

    def __repr__(self) -> str:
        return f"aio.{self.sync!r}"


async def run(
    job: str | os.PathLike[str],
    out: str | os.PathLike[str] | None = None,
    *,
    effects: tuple[str, ...] | list[str] = (),
    local_workers: int | None = None,
    progress: bool | OnProgress = False,
) -> Study:
    """As :func:`grouser.run`; ``progress`` is told in another thread."""
    return Study(
        await asyncio.to_thread(_run.run, job, out, effects=effects, local_workers=local_workers, progress=progress)
    )


async def check(job: str | os.PathLike[str]) -> str:
    """As :func:`grouser.check`."""
    return await asyncio.to_thread(_run.check, job)


async def example(name: str, folder: str | os.PathLike[str] | None = None) -> Path:
    """As :func:`grouser.example`."""
    return await asyncio.to_thread(_run.example, name, folder)
