"""A twin in a report: every number of the robot, and where it comes from."""

from __future__ import annotations

from identification.report.page.page import Section, Table
from identification.report.words.values import parameter_words
from inca_mj.twin.twin import Twin


def model_section(robot: Twin) -> Section:
    """Returns the section on every number of the robot and where it comes from."""
    assumed = " These coordinates are assumed." if robot.geometry.assumed else ""
    words = parameter_words(robot.parameters, robot.effects)
    return Section(
        "The model",
        f"Parameter set {robot.parameters.name}. Geometry: {robot.geometry.source}.{assumed}",
        table=Table(
            ("parameter", "value", "unit", "more", "source"),
            tuple(
                (words[p.name], p.value, p.unit, p.about.partition(": ")[2], p.source)
                for p in robot.parameters
            ),
        ),
    )
