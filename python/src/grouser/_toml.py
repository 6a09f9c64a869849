"""TOML of jobs, experiments and effects."""

from __future__ import annotations

import sys
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


def parse(text: str) -> dict[str, Any]:
    """The table of a file's text."""
    table: dict[str, Any] = tomllib.loads(text)
    return table
