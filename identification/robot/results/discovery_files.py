"""The files of a discovery on a robot of a file: also robot.toml, and how each record confirms."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from identification.report.discovery.json import discovery_to_json
from identification.report.discovery.missing_place import find_place
from identification.report.discovery.named_words import set_words
from identification.report.discovery.own_stub import own_stub
from identification.report.discovery.report import DiscoveryFiles
from identification.report.discovery.straight_curves import force_ranges
from identification.report.page.page import Section
from identification.robot.reading import doubtful
from identification.robot.results.mjcf import write_mjcf
from identification.robot.results.record_error import (
    Repetition,
    Rest,
    find_repetitions,
    find_rests,
)
from identification.robot.results.unexplained import Unexplained, find_unexplained
from identification.robot.results.write import write_robot
from identification.robot.robot import Robot
from identification.storage.files import write_text

STUB = "own_effect.py"
OWN = "A law of your own"
BENT = "Something without a name is missing from this model, and bends the values that were fitted."
OWN_TEXT = (
    "The largest force is missing on {place}. The file below, which is kept beside this page as"
    f" {STUB}, has an effect there. Write the law that you suspect into it and run it: the search"
    " then compares it with all known ones."
)


@dataclass(frozen=True)
class RobotDiscoveryFiles(DiscoveryFiles):
    """The files of a discovery on a robot of a file."""

    robot: Robot

    @cached_property
    def record(self) -> dict[str, Any]:
        """The discovery as plain values, with what the robot's records say."""
        record = discovery_to_json(self.found)
        weak: tuple[Rest | Repetition, ...] = (*find_rests(self.robot), *self._repeated)
        return record | {
            "located": [*record["located"], *map(str, self._unexplained), *map(str, weak)],
            "findings": [
                *record["findings"],
                *(u.finding for u in self._unexplained),
                *(r.finding for r in weak),
            ],
            "remarks": list(self.robot.remarks),
        }

    @cached_property
    def sentences(self) -> Sequence[str]:
        """The sentences behind the verdict."""
        behind = (*self._unexplained, *self._repeated)
        return [*doubtful(self.robot), *map(str, behind)]

    def keep(self, folder: Path, place: Path) -> dict[str, Any]:
        """Write robot.toml and model.xml: the robot with what was found, read from `place`."""
        found = self.found
        named = {n for each in found.named for n in (*each.candidate.sizes, *each.candidate.fixed)}
        kept = {*found.nominal.values, *named}
        values = {n: v for n, v in found.final.values.items() if n in kept}
        own = found.final.own_values
        if stub := self._stub(place):
            write_text(folder / STUB, stub)
        path, std = folder / "robot.toml", found.final.told_std
        said = [*map(set_words, found.named), BENT if found.verdict == "unknown effect" else ""]
        remark = "; ".join(filter(None, said))
        write_robot(self.robot, values, path, place, remark, own_values=own, std=std)
        # MJCF has a place for a limit of a force that does not fall with the speed
        limits, beside = dict[str, float](), dict(values)
        for each in found.named:
            if ranges := force_ranges(each, found.final):
                limits |= ranges
                for name in (*each.candidate.sizes, *each.candidate.fixed):
                    beside.pop(name, None)
        write_mjcf(self.robot, beside, folder / "model.xml", place, remark, limits)
        return {}

    @cached_property
    def sections(self) -> list[Section]:
        """The sections of the report; where something has no name, the last one is what to try."""
        sections = super().sections
        at, stub = find_place(self.found), self._stub()
        if at is None or not stub:
            return sections
        said = OWN_TEXT.format(place=f"joint {at.joint}, {at.range}: {at.size}")
        return [*sections, Section(OWN, said, code=stub)]

    def _stub(self, folder: Path | None = None) -> str:
        """Returns an effect of the user's own where a force is missing; "" where none is known.

        Paths in it begin in the folder in which the file will lie, if given.
        """
        at = find_place(self.found)
        if at is None:
            return ""
        robot, *logs = (
            str(path) if folder is None else os.path.relpath(path, folder)
            for path in (self.robot.file.path, *self.robot.paths)
        )
        fitted = 1 + len(self.robot.others)
        return own_stub(at, robot, logs[:fitted], logs[fitted:])

    @cached_property
    def _unexplained(self) -> Sequence[Unexplained]:
        return find_unexplained(self.robot, self.found)

    @cached_property
    def _repeated(self) -> Sequence[Repetition]:
        return find_repetitions(self.robot)
