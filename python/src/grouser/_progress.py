"""How far a study has come, shown in a notebook or on a terminal."""

from __future__ import annotations

import html
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

# What `coordinator run` writes where it has no terminal: `31 %, about 6 s left: sand, stage 3 of about 10`.
# Where a search is among the parts, the share is that of the present part:
# `31 % of this search, further rounds may follow: sand, search for a missing effect`.
LINE = re.compile(r"^\s*(\d+) %(?: of this \w+)?(?:, [^:]*)?: ")


@dataclass(frozen=True)
class Progress:
    """Where a study stands."""

    text: str
    #: Share that is done, from 0 to 1, of the study or, where a search is among its parts, of the present calibration or
    #: search; ``None`` where it cannot be told.
    share: float | None = None


OnProgress = Callable[[Progress], None]


def of_line(line: str) -> Progress | None:
    """The progress that a line of the program tells; ``None`` of other lines."""
    match = LINE.match(line)
    if match is None:
        return None
    return Progress(line.strip(), int(match.group(1)) / 100)


def of_status(status: Mapping[str, Any]) -> Progress:
    """The progress of a calibration as ``GET /v1/calibrations/ID`` tells it."""
    live = status.get("progress")
    name = status["name"].removesuffix(" (discovery)")
    if not live:
        return Progress(f"{name}: {status['state']}")
    left = live.get("remaining_s")
    about = f", about {left:.0f} s left" if left is not None else ""
    return Progress(f"{name}: {_phase(live['position'])}, {live['evaluations']} evaluations{about}")


def _phase(position: Mapping[str, Any]) -> str:
    match position["kind"]:
        case "sampler":
            return f"stage {position['stage']}, tempering exponent {position['tempering_exponent']:.2g}"
        case "fit":
            return f"fit, step {position['steps']}"
        case "evolution":
            return f"generation {position['generations']}"
        case _:
            return "search for a missing effect"


class Display:
    """Shows progress in place: in Jupyter, else on a terminal, else nowhere."""

    def __init__(self) -> None:
        self._handle: Any = None
        self._width = 0
        self._in_notebook = _in_notebook()

    def __call__(self, progress: Progress) -> None:
        if self._in_notebook:
            self._show(_html(progress))
        elif sys.stderr.isatty():
            text = progress.text[:100]
            sys.stderr.write("\r" + text.ljust(self._width))
            sys.stderr.flush()
            self._width = len(text)

    def close(self) -> None:
        """Takes the last text away."""
        if self._handle is not None:
            self._show("")
        elif self._width:
            sys.stderr.write("\r" + " " * self._width + "\r")
            sys.stderr.flush()

    def _show(self, text: str) -> None:
        from IPython.display import HTML, display

        if self._handle is None:
            self._handle = display(HTML(text), display_id=True)
        else:
            self._handle.update(HTML(text))


@contextmanager
def shown(progress: bool | OnProgress) -> Iterator[OnProgress | None]:
    """Where progress is told to: a display that is taken away at the end, a function of the caller, or nowhere."""
    if progress is True:
        display = Display()
        try:
            yield display
        finally:
            display.close()
    else:
        yield progress if callable(progress) else None


def _in_notebook() -> bool:
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return type(shell).__name__ == "ZMQInteractiveShell"


def _html(progress: Progress) -> str:
    bar = "" if progress.share is None else f'<progress value="{progress.share:.2f}" max="1"></progress> '
    return f"<div>{bar}{html.escape(progress.text)}</div>"
