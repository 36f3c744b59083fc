"""The fit of a robot to one log of a folder, and how well it predicts a record that confirms."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from identification.sweep.estimates import ESTIMATES, estimate_findings
from identification.sweep.method import Column, Method, Seed
from identification.sweep.words import file_setting

SPREAD_WORDS = ("none", "usual")
SPREAD = "how much the parts of one robot may differ: none, usual, or a TOML file"


@dataclass(frozen=True, kw_only=True)
class OnLog:
    """Settings for work on a log; every field says what it is in its metadata."""

    robot: Path = file_setting("robot file (TOML)")
    log: Path = file_setting("log that is fitted")
    confirm: Path | None = file_setting(
        "record that confirms; without it, the rest of the log", None
    )
    spread: str = file_setting(SPREAD, "usual", words=SPREAD_WORDS)

    def read(self) -> Any:
        """Reads the robot with its log.

        Raises:
            InputError: as `identification.read_robot`.
        """
        from identification.robot.reading import read_robot

        confirm = [] if self.confirm is None else [self.confirm]
        return read_robot(self.robot, [self.log], confirm, [], self.spread)


def fit_log(settings: OnLog, seed: Seed) -> dict[str, Any]:
    """Fit; nothing is left to chance, so the seed is not used."""
    from identification.robot.confirmation import confirm
    from identification.robot.fitting import fit

    robot = settings.read()
    found = fit(robot)
    unseen = confirm(robot, found)
    values = found.values
    return {
        "names": [*values], "estimated": [*map(float, values.values())],
        "std": [*found.std.values()], "true": [float("nan")] * len(values),
        "converged": bool(found.converged), "worse": bool(found.is_worse),
        "before": float(unseen[0].before) if unseen else None,
        "after": float(unseen[0].after) if unseen else None,
        "unit": unseen[0].unit if unseen else "",
    }  # fmt: skip


FIT_LOG = Method(
    about="fits the free parameters of a robot to a log",
    settings=OnLog,
    columns={
        **ESTIMATES,
        "converged": Column(bool, "whether the search ended by itself"),
        "worse": Column(bool, "whether unseen data are predicted worse than by the robot's file"),
        "before": Column(
            float, "rms on unseen data with the values of the file [unit of the outputs]"
        ),
        "after": Column(float, "rms on unseen data with the fitted values [unit of the outputs]"),
        "unit": Column(str, "unit of the outputs"),
    },
    run=fit_log,
    summary=estimate_findings,
)
