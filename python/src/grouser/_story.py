"""What a study says in words: what is wrong, what is missing, what to do next."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class ChannelError:
    """The error of a channel: on held-out runs where it is measured there, else on fitted runs."""

    channel: str
    #: ``"fit"`` or ``"holdout"``.
    use: str
    #: Root mean square of measured minus predicted, in ``unit``.
    rmse: float
    #: SI unit.
    unit: str
    #: The error in noise sds; ``None`` where no noise is known.
    noise_sds: float | None
    #: Where the model fails and in which direction; ``None`` where no pattern stands out.
    place: str | None
    #: Whether noise alone explains the error; false where it cannot be judged.
    is_within_noise: bool
    #: Whether the error can be judged; not where the noise is inferred together with the misfit.
    is_judged: bool


@dataclass(frozen=True)
class NextRun:
    """A test run that would tell explanations apart."""

    slip: float
    wheel_load_n: float
    sled_speed_m_s: float
    #: The explanations that it distinguishes.
    separates: tuple[str, ...]
    #: Expected information on them beyond that of the runs before it in the list [nats].
    information_nats: float


@dataclass(frozen=True)
class EffectFile:
    """The file of an effect that the library lacks, as a search wrote it."""

    name: str
    text: str


@dataclass(frozen=True)
class Step:
    """A step to take; :meth:`grouser.Study.add` takes one that adds an effect."""

    #: ``"add_effect"``, ``"add_effect_file"``, ``"discover"``, ``"widen_prior"``, ``"make_runs"``,
    #: ``"measure_other"``, ``"state_in_experiment"`` or ``"predict"``.
    kind: str
    #: What to do, in a sentence.
    text: str
    #: Where the result is stated, with the keys of the files; ``None`` where nothing is stated.
    detail: str | None
    #: Arguments of the program ``coordinator``; ``None`` of what no command does.
    command: str | None
    #: The effect to add, or that the runs would tell apart.
    effect: str | None
    #: The wheel that alone has the effect; ``None`` where all have.
    wheel: str | None
    #: The effect file to add.
    effect_file: EffectFile | None
    runs: tuple[NextRun, ...]


@dataclass(frozen=True)
class MissingEffect:
    """An effect that a model was found to miss.

    ``str()`` of it is its name.
    """

    name: str
    #: The wheel that alone has it; ``None`` where all have.
    wheel: str | None
    #: Probability of the explanation given the data, the priors and the library; ``None`` where no search named it.
    probability: float | None
    #: Logarithm of its Bayes factor over the model without it [nats]; ``None`` where no search named it.
    log_bayes_factor_nats: float | None
    #: Whether the study has added it already.
    is_added: bool
    #: The finding in a sentence.
    text: str

    def __str__(self) -> str:
        return self.name if self.wheel is None else f"{self.name} on wheel {self.wheel}"


@dataclass(frozen=True)
class Story:
    """What a calibration gets wrong, what it is missing, what to do next; ``str()`` of it is the three sentences."""

    #: The calibration it is about.
    calibration: int
    #: What the model gets wrong, in a sentence.
    wrong: str
    #: The errors by channel, the worst first.
    channels: tuple[ChannelError, ...]
    #: What is missing, in a sentence.
    missing: str
    #: ``"named"``, ``"class"``, ``"not_in_library"``, ``"undecided"``, ``"nothing_detectable"``; ``None`` without a search.
    verdict: str | None
    #: Probability of what is named; of nothing missing where nothing is named.
    probability: float | None
    #: What to do next, in a sentence.
    next: str
    #: The steps, the first one first.
    steps: tuple[Step, ...]

    def __str__(self) -> str:
        return f"wrong:   {self.wrong}\nmissing: {self.missing}\nnext:    {self.next}"

    def _repr_html_(self) -> str:
        from html import escape

        parts = [("Wrong", self.wrong), ("Missing", self.missing), ("Next", self.next)]
        return "<dl>" + "".join(f"<dt><b>{name}</b></dt><dd>{escape(text)}</dd>" for name, text in parts) + "</dl>"


def next_run(run: Mapping[str, Any]) -> NextRun:
    """A run of ``next_runs``."""
    return NextRun(
        slip=float(run["slip"]),
        wheel_load_n=float(run["wheel_load_n"]),
        sled_speed_m_s=float(run["sled_speed_m_s"]),
        separates=tuple(run["separates"]),
        information_nats=float(run["information_nats"]),
    )


def story(told: Mapping[str, Any]) -> Story:
    """A story as ``GET /v1/studies/ID`` tells it."""
    keys = ("channel", "use", "rmse", "unit", "noise_sds", "place", "is_within_noise", "is_judged")
    channels = [ChannelError(**{key: channel.get(key) for key in keys}) for channel in told["wrong"]["channels"]]
    steps = [
        Step(
            kind=step["kind"],
            text=step["text"],
            detail=step.get("detail"),
            command=step.get("command"),
            effect=step.get("effect"),
            wheel=step.get("wheel"),
            effect_file=EffectFile(**step["effect_file"]) if step.get("effect_file") else None,
            runs=tuple(next_run(run) for run in step["runs"]),
        )
        for step in told["next"]["steps"]
    ]
    return Story(
        calibration=int(told["calibration"]),
        wrong=told["wrong"]["text"],
        channels=tuple(channels),
        missing=told["missing"]["text"],
        verdict=told["missing"].get("verdict"),
        probability=told["missing"].get("probability"),
        next=told["next"]["text"],
        steps=tuple(steps),
    )
