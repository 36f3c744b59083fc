"""inca kinematics POSE|LOG: the cables of a pose, or the pose along a log."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

import inca_mj as inca
from identification.commands.common import Output, assignments, conclude, draw_report, table
from identification.errors import InputError
from inca_mj.commands.common import Values, do_not_draw

if TYPE_CHECKING:
    import numpy as np


@dataclass(frozen=True, kw_only=True)
class Kinematics:
    """Cables of a pose (lengths, directions, Jacobian), or the pose along a log with its std.

    Examples:
        inca kinematics 0.1 0 1.4 0 0.2 0
        inca kinematics examples/log.csv --std R=1e-4 x=0.002 --out out/kinematics
    """

    what: Annotated[tuple[str, ...], tyro.conf.Positional, tyro.conf.arg(metavar="POSE|LOG")]
    """A pose, six numbers x y z [m] roll pitch yaw [rad], or one log of currents and angles."""
    pulley: float = 0.0
    """Of a pose: radius of a swivelling pulley at each exit point [m]; 0: straight cables."""
    noise: Annotated[float | None, tyro.conf.arg(metavar="RAD")] = None
    """Of a log: std of each angle [rad]; seen in the log when not given."""
    std: Annotated[tuple[str, ...], tyro.conf.arg(metavar="NAME=STD")] = ()
    """Of a log: how well parameters are known, such as R=1e-4 x=0.002; exact when not given."""
    robot: Values = Values()
    output: Output = Output()

    def run(self) -> int:
        """Compute, say, keep."""
        do_not_draw()
        pose = self._pose()
        if pose is None:
            self._along()
        else:
            self._at(pose)
        return 0

    def _pose(self) -> np.ndarray | None:
        """Returns the six numbers of a pose, or None where a log is named."""
        import numpy as np

        if not self.what:
            raise InputError(
                "no pose and no log is given; write inca kinematics X Y Z ROLL PITCH YAW [m, rad],"
                " such as inca kinematics 0 0 1.43 0 0 0, or inca kinematics LOG"
            )
        if len(self.what) == 1 and Path(self.what[0]).suffix in (".csv", ".mat"):
            return None
        try:
            pose = np.array([float(x) for x in self.what])
        except ValueError:
            pose = np.empty(0)
        if pose.shape != (6,) or not np.isfinite(pose).all():
            raise InputError(
                f"{' '.join(self.what)!r} is neither a pose nor a log; give six numbers x y z [m]"
                " roll pitch yaw [rad], such as 0 0 1.43 0 0 0, or one log (.csv, .mat)"
            )
        return pose

    def _at(self, pose: np.ndarray) -> None:
        from inca_mj.kinematics.cables import Pulleys, inverse
        from inca_mj.kinematics.jacobians import jacobian
        from inca_mj.report.poses import cables_json, cables_rows, cables_section, cables_verdict
        from inca_mj.robot.spread import displaced

        if self.noise is not None or self.std:
            raise InputError("--noise and --std are for a log; a pose has no noise: leave them out")
        place = displaced(self.robot.place(), self.robot.parameters().values())
        cables = inverse(pose, place, Pulleys(self.pulley) if self.pulley else None)
        lines = cables_verdict(cables, place)
        names = ("cable", "∂/∂x", "∂/∂y", "∂/∂z", "∂/∂ω_x [m]", "∂/∂ω_y [m]", "∂/∂ω_z [m]")
        rows = [(str(k), *(f"{x:+z.4f}" for x in row)) for k, row in enumerate(jacobian(cables), 1)]
        slopes = "Jacobian of the lengths by twist, along O:\n" + table(names, rows)
        text = "\n".join([table(*cables_rows(cables)), slopes, *lines])
        conclude(
            self, cables_json(pose, cables), text,
            draw=lambda out: draw_report(
                out, "A pose and its cables", lines, [cables_section(pose, cables, place)]
            ),
        )  # fmt: skip

    def _along(self) -> None:
        from inca_mj.report.poses import poses_json, poses_section, poses_verdict, write_poses

        if self.pulley:
            raise InputError("--pulley is for a pose; a log is read with straight cables: leave it")
        log = inca.read_inca_log(Path(self.what[0]))
        found = inca.log_poses(
            log, self.robot.parameters(), self.robot.place(), encoder=self.noise,
            std=assignments(self.std, "--std"), progress=self.output.tell,
        )  # fmt: skip
        verdict, title = poses_verdict(found), f"{found.log.name}: where the platform was"
        conclude(
            self, poses_json(found), "\n".join([log_text(found), *verdict]),
            keep=lambda out: write_poses(found, out / "poses.csv"),
            draw=lambda out: draw_report(out, title, verdict, [poses_section(found)]),
        )  # fmt: skip


def log_text(found: inca.LogPoses) -> str:
    """Returns some of the poses as a text table."""
    import numpy as np

    from inca_mj.twin.logs import POSE

    some = np.unique(np.linspace(0, len(found.log) - 1, 11).round().astype(int))
    rows = [(f"{found.log.time[k]:.2f}", *(f"{x:z.4f}" for x in found.pose[k])) for k in some]
    return table(("time [s]", *(f"{n} [{'m' if n in 'xyz' else 'rad'}]" for n in POSE)), rows)
