"""Grouser: calibrates wheel-soil contact models and finds the physics that they are missing.

Layout:
    run, check, example: calibrations on this machine.
    Service: a coordinator at a URL: submit jobs, list studies.
    Study: a line of calibrations: its story, its missing effect, its error ledger; how it grows.
    Calibration: posterior, model against measurement, explanations; its data for ArviZ.
    Table: columns with units, for pandas, Polars and Arrow.
    grouser.figures: pictures, with Matplotlib.
    grouser.aio: the same for asyncio.

All quantities are in SI units, and each name carries its unit, except slip and model parameters, whose units stand in the
tables' ``units``.
"""

from ._calibration import Calibration
from ._error import CalibrationStopped, GrouserError, ProgramError, ServiceError
from ._progress import Progress
from ._run import check, example, run
from ._service import Service
from ._story import ChannelError, EffectFile, MissingEffect, NextRun, Step, Story
from ._study import Study
from ._table import Table

__all__ = [
    "Calibration",
    "CalibrationStopped",
    "ChannelError",
    "EffectFile",
    "GrouserError",
    "MissingEffect",
    "NextRun",
    "ProgramError",
    "Progress",
    "Service",
    "ServiceError",
    "Step",
    "Story",
    "Study",
    "Table",
    "check",
    "example",
    "run",
]
