"""inca statics: what the cables can hold, how stiffly, where, and what their mass costs."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Literal

import tyro

import inca_mj as inca
from identification.commands.common import Output, conclude, draw_report, note, table
from inca_mj.commands.common import Values, cannot_draw, do_not_draw


@dataclass(frozen=True, kw_only=True)
class Statics:
    """Tensions, rest, stiffness, modes, workspace, near cables and the mass of cables at a pose.

    Examples:
        inca statics --workspace feasible --out out/statics
        inca statics --pose 0.3 0.2 1.2 0 0 0.1 --force-on-handle 0 0 -2
    """

    pose: Annotated[
        tuple[float, float, float, float, float, float] | None,
        tyro.conf.arg(metavar="X Y Z ROLL PITCH YAW"),
    ] = None
    """x y z [m] roll pitch yaw [rad]; the start pose when it is not given."""
    workspace: Literal["none", "closure", "feasible", "static"] = "none"
    """Workspace at the orientation of the pose."""
    log: Annotated[Path | None, tyro.conf.arg(metavar="LOG")] = None
    """Log along which cables may come near to each other."""
    force_on_handle: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Force on the platform beside its weight, in the frame of the room [N]."""
    torque_on_handle: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Torque on the platform, in the frame of the room [N m]."""
    current: tuple[float, float] = (-2.0, 2.0)
    """Smallest and largest current of a motor [A]."""
    taut: float = 0.5
    """Every cable keeps at least this tension [N]."""
    force: float = 1.0
    """Of the feasible workspace: any force up to this must be held [N]."""
    torque: float = 0.02
    """Of the feasible workspace: any torque up to this must be held [N m]."""
    cells: int = 24
    """Cells of the workspace along the longest edge of the frame."""
    rho: Annotated[tuple[float, ...], tyro.conf.arg(metavar="KG/M")] = (3e-4, 1e-3, 3e-3)
    """Masses of the cables per length to look at [kg/m]."""
    seed: int = 0
    """Seed of the random points that measure the volume."""
    robot: Values = Values()
    output: Output = Output()

    def run(self) -> int:
        """Analyse, say, keep."""
        draws = self.output.out is not None and self.workspace != "none"
        blind = cannot_draw() if draws else ""  # before MuJoCo is imported
        if not draws:
            do_not_draw()
        import numpy as np

        from inca_mj.report.statics import statics_json, statics_verdict

        found = inca.analyse_statics(
            self.robot.parameters(),
            self.robot.place(),
            None if self.pose is None else np.array(self.pose),
            load=np.array([*self.force_on_handle, *self.torque_on_handle]),
            limits=inca.DriveLimits(
                current=self.current, taut=self.taut, force=self.force, torque=self.torque
            ),
            kind=None if self.workspace == "none" else self.workspace,
            cells=self.cells,
            log=None if self.log is None else inca.read_inca_log(self.log),
            rho=self.rho,
            seed=self.seed,
        )
        if blind:
            note(f"no picture of the workspace: {blind}")
        text = "\n".join([summary(found), *statics_verdict(found)])
        draw_all = partial(draw, self, found, draws and not blind)
        conclude(self, statics_json(found), text, draw=draw_all)
        return 0


def summary(found: inca.StaticAnalysis) -> str:
    """Returns tensions and currents of the cables at the pose."""
    held = found.held
    columns = zip(held.low, held.high, held.within, held.current, strict=True)
    rows = [
        (str(k), f"{low:.2f}", f"{high:.2f}", f"{T:.3f}", f"{i:z.3f}")
        for k, (low, high, T, i) in enumerate(columns, 1)
    ]
    return table(("cable", "low [N]", "high [N]", "tension [N]", "current [A]"), rows)


def draw(command: Statics, found: inca.StaticAnalysis, picture: bool, out: Path) -> None:
    """Write the figures, the picture of the workspace, and the report into a folder."""
    from inca_mj.report.statics import statics_sections, statics_verdict

    draw_report(out, "Statics of the robot", statics_verdict(found), statics_sections(found))
    if picture and found.workspace is not None and found.workspace.inside.any():
        inca.workspace_picture(
            found.workspace, out / "workspace.png", command.robot.parameters(),
            command.robot.place(), pose=found.pose, tension=found.held.within,
        )  # fmt: skip
