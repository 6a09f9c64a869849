"""A study: a line of calibrations on one experiment, each adding an effect, with its ledger of errors."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from ._calibration import Calibration
from ._client import Client
from ._error import CalibrationStopped, GrouserError
from ._place import FolderPlace, Place, ServicePlace, listed
from ._planned import Plan, request, table
from ._progress import OnProgress, Progress, of_status, shown
from ._story import EffectFile, MissingEffect, NextRun, Step, Story, next_run, story
from ._table import CONDITIONS, Table

CHANNEL_UNITS = {"drawbar_pull": "N", "torque": "N m", "sinkage": "m", "lateral_force": "N"}
STOPPED = ("paused", "failed")
OVER = ("finished", "waiting", "cancelled")
LOOK_S = 0.5


class Study:
    """A study as it was when it was loaded or last refreshed.

    Make one by :meth:`Study.load`, :func:`grouser.run` or :meth:`grouser.Service.submit`.

    Attributes:
        id: its number.
    """

    def __init__(self, place: Place, study: int) -> None:
        self._place = place
        self.id = study
        self._overview: dict[str, Any] = {}
        self.refresh()

    @classmethod
    def load(
        cls,
        source: str | os.PathLike[str],
        id: int | None = None,
        *,
        token: str | None = None,
        ca_certificate: str | None = None,
        local_workers: int | None = None,
    ) -> Study:
        """Loads a study.

        Args:
            source: the URL of a service, or the output folder of a run.
            id: the number of the study; may be left out where there is only one.
            token: the token that the service asks for; by default ``GROUSER_TOKEN`` of the environment.
            ca_certificate: a PEM file with the authority of an https service; by default ``GROUSER_CA_CERTIFICATE``, else
                the authorities of this machine.
            local_workers: threads that simulate when a study in a folder grows; by default, one per core.

        Raises:
            GrouserError: there is no such study; the message is the coordinator's.
        """
        place = _place(source, token, ca_certificate, local_workers)
        if id is None:
            studies = [study["id"] for study in listed(place, "studies")]
            if len(studies) != 1:
                raise GrouserError(f"{place}: there are {len(studies)} studies: name one by its id, of {studies}")
            id = studies[0]
        return cls(place, id)

    def refresh(self) -> Study:
        """Asks again, and returns the study itself."""
        self._overview = self._place.get(f"studies/{self.id}")
        return self

    @property
    def name(self) -> str:
        """Name of the submitted job."""
        return str(self._overview["name"])

    @property
    def state(self) -> str:
        """``finished`` where no further step follows, else the state of the first unfinished member."""
        return str(self._overview["state"])

    @property
    def calibrations(self) -> list[Calibration]:
        """The calibrations, oldest first; searches are not among them."""
        return [Calibration(self._place, member) for member in self._overview["members"] if member["searches"] is None]

    @property
    def current(self) -> Calibration:
        """The calibration of the current model: the line of the ledger with the most evidence on the newest measurements.

        Raises:
            GrouserError: none is finished, or none has a posterior.
        """
        current = self._overview["current"]
        if current is None:
            raise GrouserError(f"study {self.id} ({self.state}): no calibration has a posterior yet")
        return self.calibration(current)

    def predictions(self) -> Table:
        """Every run and channel as the models predict it, the content of ``predictions.csv``.

        ``unit`` is the SI unit of ``measured``, ``model`` (the current one), ``corrected`` (that with what it misses in the fitted
        conditions), ``combined`` (all models and the measurements alone) and ``interpolated`` (without a model), and of the
        5 % and 95 % quantiles of a new measurement.
        """
        return Table.from_rows(self._place.get(f"calibrations/{self._lead}/predictions"), units=CONDITIONS)

    def predict(
        self,
        plan: Plan | None = None,
        *,
        sweep: str | None = None,
        wheels: str | os.PathLike[str] | None = None,
        statements: Sequence[str] = (),
        draws: int | None = None,
        calibration: int | None = None,
    ) -> Table:
        """Conditions of one's own: a row for each run and quantity, with 90 % intervals.

        ``parameters`` are those of the model, ``models`` those of all models of the study by their evidence,
        ``measurement`` those of a new measurement by all models, ``corrected`` those of a new measurement by the model and
        what it misses in the fitted conditions. The ``measurement_mean`` of a statement is the probability that a
        new measurement makes it true, its ``mean`` that of the model's parameters alone, its ``models_mean`` that of all
        models; other quantities have no ``measurement_mean``. ``beyond`` says what lies outside the
        fitted range.

        Args:
            plan: a CSV file, or a row for each condition: ``[{"slip": 0.2, "wheel_load_n": 100}]``. What is left out
                follows from the fitted runs.
            sweep: one quantity in evenly spaced values for every row: ``"slip=0:0.8:41"``.
            wheels: a TOML file with tables ``[wheel.NAME]`` of wheels that the experiment does not have.
            statements: comparisons such as ``"drawbar_pull_n > 12"``.
            draws: of each model; by default, up to 199.
            calibration: the calibration that predicts; by default, that of the current model.

        Raises:
            GrouserError: the plan is malformed; the message is the coordinator's.
        """
        by = self.current.id if calibration is None else calibration
        return table(self._place.post(f"calibrations/{by}/predict", request(plan, sweep, wheels, statements, draws)))

    def decide(
        self, file: str | os.PathLike[str], *, draws: int | None = None, calibration: int | None = None
    ) -> dict[str, Any]:
        """Options by their expected losses, what decides, and what one more run is worth (docs/prediction.md).

        Args:
            file: a TOML file with a table ``[decision]``, alone or in a job.
            draws: of each model; by default, up to 199.
            calibration: the calibration that decides; by default, that of the current model.

        Raises:
            GrouserError: the decision is malformed; the message is the coordinator's.
        """
        by = self.current.id if calibration is None else calibration
        body = {"file": Path(file).read_text(encoding="utf-8"), "draws": draws}
        answer: dict[str, Any] = self._place.post(f"calibrations/{by}/decide", body)
        return answer

    def stream(
        self,
        recording: str | os.PathLike[str],
        *,
        parameters: Sequence[str] = (),
        wheel: str | None = None,
        calibration: int | None = None,
    ) -> dict[str, Any]:
        """A recording that is followed: the parameters of the soil after each second, and its changes (docs/prediction.md).

        Args:
            recording: a CSV file with samples at 10 Hz: ``t_s``, ``slip`` and measured channels.
            parameters: those that may vary; by default, those of the soil.
            wheel: the wheel, if the fitted runs have several.
            calibration: the calibration that is taken; by default, that of the current model.

        Raises:
            GrouserError: the recording is malformed; the message is the coordinator's.
        """
        by = self.current.id if calibration is None else calibration
        text = Path(recording).read_text(encoding="utf-8")
        body = {"recording": text, "parameters": list(parameters), "wheel": wheel}
        answer: dict[str, Any] = self._place.post(f"calibrations/{by}/stream", body)
        return answer

    def calibration(self, id: int) -> Calibration:
        """One of the calibrations.

        Args:
            id: its number.
        """
        for calibration in self.calibrations:
            if calibration.id == id:
                return calibration
        raise GrouserError(f"study {self.id} has no calibration {id}, of {[c.id for c in self.calibrations]}")

    def story(self, calibration: int | None = None) -> Story:
        """What is wrong, what is missing, what to do next.

        Args:
            calibration: the calibration that it is about; by default, that of the current model.
        """
        about = self.current.id if calibration is None else self.calibration(calibration).id
        told = next(member["story"] for member in self._overview["members"] if member["id"] == about)
        if told is None:
            raise GrouserError(f"calibration {about} is not finished: it has no story yet")
        return story(told)

    @property
    def missing_effect(self) -> MissingEffect | None:
        """The effect that the study was found to miss; ``None`` where nothing is named.

        What the search of the current model names comes first; else the effect that the study has added last.
        """
        current = self.current.id
        told = next(member["story"] for member in self._overview["members"] if member["id"] == current)["missing"]
        if told["named"]:
            named = told["named"][0]
            found = self._search(current)
            explanation = f"{named['name']}.{named['wheel']}" if named["wheel"] else named["name"]
            factor = _log_bayes_factor(found, explanation)
            probability = _probability(found, explanation)
            return MissingEffect(named["name"], named["wheel"], probability, factor, False, told["text"])
        if told["already_added"]:
            added = told["already_added"][-1]
            # The name of an effect on one wheel of several ends with the wheel.
            name, _, wheel = added["name"].partition(".")
            found = self._search_that_named(added["name"])
            text = told["text"] if found is None else found["text"]
            factor = _log_bayes_factor(found, added["name"])
            return MissingEffect(name, wheel or None, added["probability"], factor, True, text)
        return None

    def _search(self, calibration: int) -> dict[str, Any] | None:
        searched = [member["searches"] for member in self._overview["members"] if member["state"] == "finished"]
        found: dict[str, Any] | None = None
        if calibration in searched:
            found = self._place.get(f"calibrations/{calibration}/discovery")
        return found

    def _search_that_named(self, name: str) -> dict[str, Any] | None:
        for member in reversed(self._overview["members"]):
            if member["searches"] is not None:
                found = self._search(member["searches"])
                if found and found["extension"] and _extension_name(found["extension"]) == name:
                    return found
        return None

    def next_runs(self) -> list[NextRun]:
        """The test runs, at most three, that would tell the open explanations of the current model apart."""
        found = self._search(self.current.id)
        return [] if found is None else [next_run(run) for run in found["next_runs"]]

    def ledger(self) -> Table:
        """The error ledger: a row for each model, base first.

        Errors are root mean squares in SI units (``fit_torque_rmse_n_m``), or in the noise sd of the study
        (``fit_rmse_sigma``); NaN where a channel is not measured.
        """
        rows: list[dict[str, Any]] = []
        units: dict[str, str] = {"log_evidence": "nat", "log_evidence_se": "nat", "wall_s": "s"}
        for line in self._overview["ledger"]:
            keys = ("calibration", "algorithm", "log_evidence", "log_evidence_se", "equilibrated", "evaluations", "wall_s")
            row = {"calibration": line["calibration"], "effects": "+".join(line["effects"]) or "base"}
            row.update({key: line[key] for key in keys})
            for use in ("fit", "holdout"):
                error = line["error"][use] or {}
                for channel, unit in CHANNEL_UNITS.items():
                    name = f"{use}_{channel}_rmse_{unit.lower().replace(' ', '_')}"
                    row[name] = (error.get(channel) or {}).get("rmse")
                    units[name] = unit
                row[f"{use}_rmse_sigma"] = (error.get("all") or {}).get("rmse_fixed_sigma")
                row[f"{use}_coverage90"] = line["coverage90"][use]
            rows.append(row)
        return Table.from_rows(rows, units=units)

    def flags(self) -> Table:
        """What deserves attention: kind, channel, condition, probability if nothing were wrong, and a sentence."""
        return Table.from_rows(self._overview["flags"], ("calibration", "kind", "channel", "against", "p", "text"))

    def summary(self) -> dict[str, Any]:
        """``summary.json`` of the study (docs/results.md)."""
        summary: dict[str, Any] = self._place.get(f"calibrations/{self._lead}/summary")
        return summary

    def report(self, file: str | os.PathLike[str]) -> Path:
        """Writes the report, one self-contained HTML page, and returns its path."""
        path = Path(file)
        path.write_text(self._place.text(f"calibrations/{self._lead}/report"), encoding="utf-8")
        return path

    @property
    def _lead(self) -> int:
        return int(self._overview["current"] or self._overview["calibrations"][0])

    def add(
        self,
        effect: str | MissingEffect | Step | os.PathLike[str],
        *,
        wheel: str | None = None,
        calibration: int | None = None,
        wait: bool = True,
        progress: bool | OnProgress = True,
    ) -> Calibration:
        """Adds a calibration with one more effect to the study, and returns it.

        Args:
            effect: the name of an effect of the catalogue, what :attr:`missing_effect` gives, a step of :meth:`story` that
                adds one, or the path of an effect file.
            wheel: lets the effect act on this wheel alone, of several.
            calibration: the calibration to extend; by default, that of the current model.
            wait: waits until the study is over; in a folder it always does.
            progress: shows how far it is, or is told.

        Raises:
            GrouserError: the effect is unknown or there already; the message is the coordinator's.
        """
        what, on_wheel = _addition(effect)
        base = self.current.id if calibration is None else calibration
        before = {member.id for member in self.calibrations}
        self._grow(lambda tell: self._place.extend(base, what, wheel or on_wheel, tell), wait, progress)
        return next(member for member in self.calibrations if member.id not in before)

    def search(
        self, calibration: int | None = None, *, wait: bool = True, progress: bool | OnProgress = True
    ) -> MissingEffect | None:
        """Searches the model of a calibration for a missing effect, and returns what is named.

        Args:
            calibration: the calibration; by default, that of the current model.
            wait: waits until the search is over; in a folder it always does. Without it, ``None`` is returned.
            progress: shows how far it is, or is told.
        """
        base = self.current.id if calibration is None else calibration
        self._grow(lambda tell: self._place.discover(base, tell), wait, progress)
        return self.missing_effect if wait or not self._place.is_remote else None

    def add_runs(
        self,
        runs: str | os.PathLike[str],
        *,
        calibration: int | None = None,
        wait: bool = True,
        progress: bool | OnProgress = True,
    ) -> Calibration:
        """Adds measurements, calibrates the model against all of them, and returns the new calibration.

        Args:
            runs: a CSV file with the columns of ``runs.csv``.
            calibration: the calibration whose model is taken; by default, that of the current model.
            wait: waits until the study is over; in a folder it always does.
            progress: shows how far it is, or is told.
        """
        base = self.current.id if calibration is None else calibration
        text = Path(runs).read_text(encoding="utf-8")
        before = {member.id for member in self.calibrations}
        self._grow(lambda tell: self._place.add_runs(self.id, base, text, tell), wait, progress)
        return next(member for member in self.calibrations if member.id not in before)

    def _grow(self, request: Callable[[OnProgress | None], None], wait: bool, progress: bool | OnProgress) -> None:
        with shown(progress) as tell:
            request(tell)
        self.refresh()
        if wait and self._place.is_remote:
            self.wait(progress=progress)

    def watch(self) -> Iterator[Progress]:
        """Yields the progress whenever it has changed, until the study is over, waits for a decision, or stops."""
        last: Progress | None = None
        while True:
            progress = self._look()
            if progress is None:
                return
            if progress != last:
                yield progress
                last = progress
            time.sleep(LOOK_S)

    def _look(self) -> Progress | None:
        """Asks again; the progress of what is computed, ``None`` where nothing is and nothing follows.

        Raises:
            CalibrationStopped: a member is paused or failed.
        """
        self.refresh()
        for member in self._overview["members"]:
            if member["state"] in STOPPED:
                reason = member["message"] or "no reason given"
                raise CalibrationStopped(f"{member['name']} is {member['state']}: {reason}", member["state"])
        # A cancelled member ends the study, but others may still be computed.
        going = [m["id"] for m in self._overview["members"] if m["state"] in ("running", "queued")]
        if going:
            return of_status(self._place.get(f"calibrations/{going[0]}"))
        return None if self.state in OVER else Progress(f"{self.name}: next step")

    def wait(self, timeout_s: float | None = None, *, progress: bool | OnProgress = True) -> Study:
        """Waits until the study is over or waits for a decision, and returns the study itself.

        A study with a cancelled calibration is over, too: its ``state`` is ``cancelled``, as is that of the calibration.

        Args:
            timeout_s: longest time to wait [s]; by default, for ever.
            progress: shows how far it is, or is told.

        Raises:
            CalibrationStopped: a calibration is paused or failed; the message says why.
            TimeoutError: the time is up; the study goes on.
        """
        until = None if timeout_s is None else time.monotonic() + timeout_s
        with shown(progress) as tell:
            for now in self.watch():
                if tell is not None:
                    tell(now)
                if until is not None and time.monotonic() > until:
                    raise TimeoutError(f"study {self.id} is not over after {timeout_s:g} s: {now.text}")
        return self

    def close(self) -> None:
        """Ends the service that a folder is read through; a later request starts it again."""
        if isinstance(self._place, FolderPlace):
            self._place.close()

    def __repr__(self) -> str:
        return f"Study({str(self._place)!r}, {self.id}): {self.name}, {self.state}"


def _place(
    source: str | os.PathLike[str], token: str | None, ca_certificate: str | None, local_workers: int | None
) -> Place:
    text = os.fspath(source)
    if text.startswith(("http://", "https://")):
        return ServicePlace(client(text, token, ca_certificate))
    return FolderPlace(Path(text), local_workers, _token(token))


def client(url: str, token: str | None, ca_certificate: str | None) -> Client:
    """A client with what is stated, else with the settings of the environment."""
    return Client(url, _token(token), ca_certificate or os.environ.get("GROUSER_CA_CERTIFICATE"))


def _token(token: str | None) -> str | None:
    token = token or os.environ.get("GROUSER_TOKEN")
    return token and token.strip()


def _addition(effect: str | MissingEffect | Step | os.PathLike[str]) -> tuple[str | EffectFile, str | None]:
    """What is added, and the wheel that alone gets it."""
    match effect:
        case str():
            return effect, None
        case MissingEffect():
            return effect.name, effect.wheel
        case Step():
            what = effect.effect_file or effect.effect
            if what is None or not effect.kind.startswith("add_effect"):
                raise GrouserError(f"the step {effect.text!r} adds no effect")
            return what, effect.wheel
        case _:
            file = Path(effect)
            return EffectFile(file.name, file.read_text(encoding="utf-8")), None


def _extension_name(extension: dict[str, Any]) -> str | None:
    """What a search would add, as explanations are named; ``None`` of an effect file."""
    if "on_wheel" in extension:
        return f"{extension['on_wheel']['effect']}.{extension['on_wheel']['wheel']}"
    return extension.get("effect")


def _log_bayes_factor(found: dict[str, Any] | None, name: str) -> float | None:
    return _of_effect(found, name, "log_bayes_factor")


def _probability(found: dict[str, Any] | None, name: str) -> float | None:
    return _of_effect(found, name, "probability")


def _of_effect(found: dict[str, Any] | None, name: str, key: str) -> float | None:
    for effect in found["effects"] if found else []:
        if effect["name"] == name:
            value: float | None = effect[key]
            return value
    return None
