"""What can go wrong, with the message of the coordinator."""

from __future__ import annotations


class GrouserError(Exception):
    """A request that was refused, or a program that ended early; the text is the coordinator's message."""


class ServiceError(GrouserError):
    """A service answered with an error.

    Attributes:
        kind: one of the closed list of types in docs/service.md, as in ``"not_found"``; ``"unreachable"`` without an answer.
        status: the HTTP status; 0 without an answer.
    """

    def __init__(self, message: str, kind: str, status: int) -> None:
        super().__init__(message)
        self.kind = kind
        self.status = status


class ProgramError(GrouserError):
    """The program ``coordinator`` ended with an error.

    Attributes:
        exit_status: the program's exit status; negative where a signal ended it.
    """

    def __init__(self, message: str, exit_status: int) -> None:
        super().__init__(message)
        self.exit_status = exit_status


class CalibrationStopped(GrouserError):
    """A calibration that was waited for is paused or failed.

    Attributes:
        state: ``"paused"`` or ``"failed"``.
    """

    def __init__(self, message: str, state: str) -> None:
        super().__init__(message)
        self.state = state
