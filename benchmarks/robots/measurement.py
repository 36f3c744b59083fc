"""One measured robot: fit, discovery, confirmation, and the models of others, as a JSON object."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from identification import InputError, JointPlant, read_robot
from identification.discovery.result import Discovery
from identification.prediction.discovery import discover_records
from identification.report.discovery.json import discovery_to_json
from identification.report.discovery.report import discovery_text
from identification.robot.robot import Robot
from identification.sweep.work import commit
from robots.measured_robot import MeasuredRobot, Outcome
from robots.unseen import compare, errors_of, on_changed
from robots.written import write_model

NOMINAL, FINAL, BEGUN = "nominal, fitted", "with what is named", "as begun"


def discovered(robot: MeasuredRobot, say: Callable[[str], None]) -> tuple[Robot, Discovery, float]:
    """The compiled robot, what a discovery on its records found, and the seconds it took.

    Raises:
        InputError: the files, the records or the values with which the fit begins are refused.
        DivergenceError: the nominal model cannot be simulated.
    """
    begun = time.perf_counter()
    with TemporaryDirectory() as folder:
        path = write_model(robot, Path(folder))
        compiled = read_robot(path, list(robot.fit), list(robot.confirm))
        found = discover_records(
            compiled.nominal_model, robot.fit, robot.confirm, compiled.candidates, say
        )
    return compiled, found, time.perf_counter() - begun


def measure(robot: MeasuredRobot, say: Callable[[str], None]) -> dict[str, Any]:
    """Everything that the page tells of a robot.

    Raises:
        DivergenceError: the nominal model cannot be simulated.
    """
    record: dict[str, Any] = {
        "robot": robot.name, "title": robot.title, "source": robot.source, **when(),
        "horizon": robot.horizon, "fit": [log.name for log in robot.fit],
        "confirm": [log.name for log in robot.confirm], "expected": list(robot.expected),
        "unit": robot.unit or robot.fit[0].output_unit,
    }  # fmt: skip
    begun = time.perf_counter()
    try:
        compiled, found, seconds = discovered(robot, say)
    except InputError as error:
        return {**record, "refused": str(error), "seconds": time.perf_counter() - begun}
    say(discovery_text(found))
    known = {p.name: p.value for p in robot.published}
    record |= {"discovery": discovery_to_json(found), "seconds": seconds, **_busy(), "published": [
        vars(p) for p in robot.published
    ]}  # fmt: skip
    record["scores"] = [
        {"name": s.candidate.effect.name, "where": s.candidate.where, "fall": s.fall}
        for s in found.scores[:5]
    ]
    record["sizes"] = _sizes(compiled, found, known)
    fitted = {NOMINAL: found.nominal.values}
    fitted |= {FINAL: found.final.values} if found.named else {}
    own = _own_values(compiled.plant, record["discovery"])
    return plain({**record, **_beside(robot, compiled.plant, fitted, own)})


def measure_again(robot: MeasuredRobot, record: dict[str, Any]) -> dict[str, Any]:
    """A record with all that needs no discovery made anew: errors, models of others, evidence.

    Raises:
        InputError: the files are refused.
        DivergenceError: a model cannot be simulated.
    """
    if "refused" in record:
        return record
    with TemporaryDirectory() as folder:
        path = write_model(robot, Path(folder))
        compiled = read_robot(path, list(robot.fit), list(robot.confirm))
    kept = record["discovery"]
    fitted = {NOMINAL: _shared(kept["nominal"])}
    if kept["effects"]:
        fitted[FINAL] = _shared(kept["final"])
    own, published = _own_values(compiled.plant, kept), [vars(p) for p in robot.published]
    found = _beside(robot, compiled.plant, fitted, own)
    return plain({**record, "published": published, **found})


def _shared(values: dict[str, Any]) -> dict[str, float]:
    """The fitted values that hold for all records, of a discovery's JSON."""
    return {n: v["value"] for n, v in values.items() if not n.endswith("]")}


def _busy() -> dict[str, float]:
    """How many processes ran in the last minute, and how many can at a time."""
    return {"load": os.getloadavg()[0], "cores": os.cpu_count() or 1}


def _own_values(plant: JointPlant, found: dict[str, Any]) -> dict[str, dict[str, float]]:
    """By record and name what each record has for itself with what is named, as a shift of a clock.

    Of a record that confirms it is the mean of what its halves tell: one number of a whole record.
    """
    effects, out = {e.name: e for e in plant.effects}, {}
    for named in found["effects"]:
        for said, parameter in named["parameters"].items():
            size, _, record = said.removesuffix("]").partition(" [")
            if record:
                name = effects[named["name"]].parameter(size, named["where"])
                out.setdefault(record, {})[name] = parameter["value"]
    return out


def _beside(
    robot: MeasuredRobot,
    plant: JointPlant,
    fitted: dict[str, dict[str, float]],
    own: dict[str, dict[str, float]],
) -> dict[str, Any]:
    """Errors of the fitted models and of those of others on unseen records; other evidence."""
    models = {
        name: errors_of(plant, values, own if name == FINAL else {})
        for name, values in fitted.items()
    }
    last = [*models.values()][-1]
    every = {NOMINAL: models[NOMINAL], BEGUN: errors_of(plant, {}), **models,
             **{m.name: m.errors for m in robot.models}}  # fmt: skip
    found: dict[str, Any] = {
        "unseen": compare(every, robot.confirm, robot.horizon),
        "published_models": {m.name: m.source for m in robot.models},
        "apart": [on_changed(robot, each, plant, fitted) for each in robot.apart],
    }
    if robot.evidence:
        values = [*fitted.values()][-1]
        outcome = Outcome(values=values, nominal=models[NOMINAL], final=last)
        found["evidence"] = robot.evidence(outcome)
    return found


def _sizes(compiled: Robot, found: Discovery, published: dict[str, float]) -> dict[str, Any]:
    """Values of the nominal and of the final model by name, beside what others published."""
    own = compiled.plant.parameters
    sizes, every = {}, own.values()
    shared = [n for n in published if n in every and n not in found.final.values]
    for name in (*found.final.values, *shared):
        sizes[name] = {
            "nominal": found.nominal.values.get(name),
            "nominal_std": found.nominal.std.get(name), "final": found.final.values.get(name),
            "final_std": found.final.std.get(name), "published": published.get(name),
            "unit": own[name].unit if name in every else "",
        }  # fmt: skip
    return sizes


def when() -> dict[str, str]:
    """Date and version of what was run."""
    today = datetime.now(UTC).date().isoformat()
    return {"date": today, "version": version("inca-mj"), "commit": commit()}


def plain(record: Any) -> Any:
    """The record as JSON has it, numbers that are not finite as null."""
    return json.loads(json.dumps(record, default=float), parse_constant=lambda _: None)
