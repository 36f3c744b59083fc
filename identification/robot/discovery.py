"""The search for what a model lacks: a robot read from its files, or any nominal model."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.discovery.result import Discovery
from identification.effects.effect import Effect
from identification.errors import InputError, refuse_kind
from identification.innovations import discovery as search
from identification.logs.log import Log
from identification.prediction.discovery import discover_records
from identification.report.discovery import verdict as discovery_verdict  # noqa: F401  how the result is shown
from identification.robot.blame import told_of_factors
from identification.robot.file.checks import refuse_horizon
from identification.robot.file.file import refuse_nothing_free
from identification.robot.horizon import with_horizon
from identification.robot.robot import Robot
from identification.robot.second_opinion import ask_torques, with_torques
from identification.robot.suggestions import suggest
from identification.storage.written import Files


def discover(
    model: Robot | NominalModel,
    log: Log | None = None,
    effects: Sequence[Effect] | None = None,
    progress: Callable[[str], None] | None = None,
    options: DiscoveryOptions | None = None,
) -> Discovery:
    """Name what a model lacks to explain a log, and prove it on the part that was not fitted.

    A robot is judged by predictions over a horizon, on the records that confirm or on the second
    half of each log (`identification.prediction`); over a part of a swing where its file gives
    none. So is a nominal model with a horizon. One without is judged by the innovations of a Kalman
    filter along its free run (`identification.innovations`).

    The result is of one kind. `found` itself shows the first sentence of its verdict;
    `discovery_text(found)` tells all of it. Read `found.verdict` first ("named", "unlisted effect",
    "unknown effect" or "nothing missing"), then `found.unexplained`: whether something is left.
    `found.named` has what is missing, `found.rejected` what was tried and not proven, and
    `found.before`, `found.after` and `found.noise_rms` say how far the model was off unseen data.
    `found.report(path)` writes the report, `found.save(folder)` all that the command
    `identification discover` keeps, and `found.to_dict()` returns the numbers.

    Examples:
        from identification import confirm, discover, discovery_text, read_robot

        at = "examples/elbow/"
        robot = read_robot(at + "elbow.toml", at + "first.csv", confirm=[at + "second.csv"])
        found = discover(robot)
        print(found.verdict, found.unexplained)
        for named in found.named:
            print(named.name, named.where, named.confidence, named.parameters)
            print([(rival.name, rival.where, rival.confidence) for rival in named.rivals])
        print(discovery_text(found))
        found.report("elbow.html")
        for record in confirm(robot, found):
            print(record)

    Args:
        model: a robot of `read_robot`, which has its log and its candidates; or a nominal model
            with every candidate effect compiled in, its free parameters and what is known of them.
        log: needed with a nominal model: its part `estimation` (or first half) is fitted, and the
            rest is unseen data for the proof.
        effects: needed with a nominal model: the candidates.
        progress: is told a line per stage.
        options: the judgement constants; the defaults of `DiscoveryOptions` when None.

    Raises:
        InputError: log and effects are given with a robot, or are missing with a nominal model;
            the log is too short, the horizon does not fit into the unseen part, or a free
            parameter has no effect.
        DivergenceError: the nominal model cannot be simulated.
    """
    if not isinstance(model, Robot):
        refuse_kind(model, NominalModel, "discover takes a robot (read_robot) or a NominalModel")
    if isinstance(model, Robot):
        if log is not None or effects is not None:
            raise InputError("a robot has its own log and candidates; leave log and effects out")
        refuse_nothing_free(model.file)
        known, model = len(model.remarks), with_horizon(model)
        if progress is not None:
            for remark in model.remarks[known:]:
                progress(remark)
        fitted = (model.log, *model.others)
        for each in (*fitted, *model.records):
            refuse_horizon(model.file, each, is_whole=bool(model.records))
        torques = ask_torques(model, progress)
        with told_of_factors(model):
            found = discover_records(
                model.nominal_model,
                fitted,
                model.records,
                model.candidates,
                progress,
                options,
                () if isinstance(torques, InputError) else suggest(torques, model),
            )
        return _written(with_torques(found, torques, model), model)
    if log is None or effects is None:
        raise InputError("discover needs a log and candidate effects beside a nominal model")
    refuse_kind(log, Log, "discover takes a Log (read_log) beside a nominal model")
    for effect in effects:
        refuse_kind(effect, Effect, "discover takes effects (candidates(plant, free), or your own)")
    if model.horizon is None:
        return _written(search.discover(model, log, without_states(effects), progress, options))
    return _written(discover_records(model, [log], [], effects, progress, options))


def without_states(effects: Sequence[Effect]) -> tuple[Effect, ...]:
    """Returns the effects without states of joints: effects with these need a horizon.

    A Kalman filter along a free run would have to know how uncertain these states are.
    """
    return tuple(effect for effect in effects if not effect.state)


def _written(found: Discovery, robot: Robot | None = None) -> Discovery:
    """Returns a discovery that knows what it is of, and so which files it has."""
    return replace(found, files_of=partial(_files, robot=robot))


def _files(found: Discovery, robot: Robot | None) -> Files:
    # What draws figures is slow to import.
    from identification.report.discovery.report import DiscoveryFiles
    from identification.robot.results.discovery_files import RobotDiscoveryFiles

    return DiscoveryFiles(found) if robot is None else RobotDiscoveryFiles(found, robot)
