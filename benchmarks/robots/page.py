"""The page of the measured robots, made from their JSON records and from nothing else."""

from __future__ import annotations

from pathlib import Path


def page(records: Path) -> str:
    """The page as Markdown."""
    return f"{records}\n"
