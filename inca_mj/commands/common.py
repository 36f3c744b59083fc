"""Shared parts of the commands on INCA: the robot by its options, graphics, and saved runs."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import tyro

import inca_mj as inca
from identification.commands.common import assignments
from identification.errors import GraphicsError, InputError

if TYPE_CHECKING:
    from identification import Log
    from identification.effects.effect import Effect
    from identification.model.parameter import ParameterSet


@dataclass(frozen=True)
class Values:
    """A robot: a parameter set, some values of your own, a geometry of your own."""

    set: Literal["trial", "simulation"] = "trial"
    """Parameter set: the thesis' Table 3.2 (trial) or Table 2.1 (simulation)."""
    param: Annotated[tuple[str, ...], tyro.conf.arg(metavar="NAME=VALUE")] = ()
    """Values of your own in SI units, such as m=0.2 lambda=26000."""
    geometry: Annotated[Path | None, tyro.conf.arg(metavar="PATH")] = None
    """TOML file with exit points and connectors; the built-in ones are assumed."""

    def parameters(self) -> ParameterSet:
        """Returns the parameter set with the values replaced."""
        return inca.parameter_set(self.set, assignments(self.param, "--param"))

    def place(self) -> inca.Geometry:
        """Returns the geometry."""
        return inca.INCA if self.geometry is None else inca.read_geometry(self.geometry)


Trust = Annotated[
    tuple[tuple[Literal["sensors", "units", "wiring"], ...], ...],
    tyro.conf.UseAppendAction,
    tyro.conf.arg(metavar="WORD"),
]  # checks of a log that the user overrules, words of `inca_mj.twin.logs.JUDGED`


@dataclass(frozen=True)
class Robot(Values):
    """A robot to be simulated."""

    step: float = 1e-3
    """Largest step of the integrator [s]; stiff cables and light motors need a smaller one."""

    def check(self) -> None:
        """Refuse what describes no robot, before anything heavy is imported."""
        from inca_mj.robot.parameters import refuse_step

        self.parameters()
        self.place()
        refuse_step(self.step)

    def twin(self, sampling_time: float, effects: Sequence[Effect] = ()) -> inca.Twin:
        """Returns the robot, with a step that divides the sampling time [s]."""
        from inca_mj.workflows.comparison import timestep_for

        step = timestep_for(sampling_time, self.step)
        return inca.build_twin(self.parameters(), self.place(), timestep=step, effects=effects)


@dataclass(frozen=True)
class SavedRobot(Robot):
    """A robot to be simulated, or one that was saved."""

    model: Annotated[Path | None, tyro.conf.arg(metavar="DIR")] = None
    """Folder of a twin that inca discover or inca calibrate saved; it has values of its own."""

    def check(self) -> None:
        """Refuses what describes no robot, and options that do not go with a saved robot."""
        from inca_mj.robot.parameters import refuse_step

        if self.model is None:
            return super().check()
        if self.param or self.geometry is not None or self.set != "trial":
            raise InputError(
                "--model is a whole robot; leave out --set, --param and --geometry, or change"
                " values in Python: load_twin(path).with_values({...})"
            )
        own = self.model if self.model.suffix in (".xml", ".json") else self.model / "effects.json"
        if not own.exists():
            raise InputError(f"no {own}; inca discover --out DIR writes one")
        return refuse_step(self.step)

    def twin(self, sampling_time: float, effects: Sequence[Effect] = ()) -> inca.Twin:
        """Returns the robot; a saved one has effects of its own."""
        from inca_mj.twin.twin import rebuild
        from inca_mj.workflows.comparison import timestep_for

        saved = self.saved()
        if saved is None:
            return super().twin(sampling_time, effects)
        return rebuild(saved, timestep=timestep_for(sampling_time, self.step))

    def saved(self) -> inca.Twin | None:
        """Returns the twin that was saved; None where no folder is given."""
        if self.model is None:
            return None
        self.check()
        return inca.load_twin(self.model)


def read_logs(paths: Iterable[Path], trust: Sequence[str]) -> list[Log]:
    """Returns logs of INCA; `trust` names checks that the user overrules."""
    return [inca.read_inca_log(path, trust) for path in paths]


def keep_run(run: inca.Run, notes: str, out: Path) -> None:
    """Write the log, the run and the model of a simulation into a folder."""
    from identification import write_log

    write_log(inca.run_to_log(run, notes=notes), out / "log.csv")
    inca.save_run(run, out / "run.npz")
    run.twin.save(out / "model.xml")


def cannot_draw() -> str:
    """Settle the OpenGL backend before MuJoCo is imported: "" or why nothing can be drawn."""
    from inca_mj.rendering.graphics import choose_backend

    try:
        choose_backend()
    except GraphicsError as error:
        do_not_draw()
        return str(error)
    return ""


def do_not_draw() -> None:
    """Import MuJoCo without OpenGL, for commands that do not draw: a bad MUJOCO_GL breaks it."""
    before = os.environ.get("MUJOCO_GL")
    os.environ["MUJOCO_GL"] = "disable"
    try:
        import mujoco  # noqa: F401
    finally:
        if before is None:
            del os.environ["MUJOCO_GL"]
        else:
            os.environ["MUJOCO_GL"] = before
