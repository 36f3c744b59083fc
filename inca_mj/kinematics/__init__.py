"""Kinematics of the INCA 6D (thesis section 2.2): cables of a pose, rates, and the pose back.

The public names; `docs/kinematics.md` shows their use. The pose from motor angles needs the
pretension of the robot as well: `inca_mj.pose_at_rest` and `inca_mj.log_poses`."""

from typing import TYPE_CHECKING

from identification.runtime.lazy import lazy

if TYPE_CHECKING:  # the public names
    # isort: off
    from inca_mj.kinematics.rotations import body_rate_matrix as body_rate_matrix
    from inca_mj.kinematics.rotations import euler as euler
    from inca_mj.kinematics.rotations import euler_of as euler_of
    from inca_mj.kinematics.rotations import euler_rate_matrix as euler_rate_matrix
    from inca_mj.kinematics.rotations import pose_rate_matrix as pose_rate_matrix
    from inca_mj.kinematics.rotations import quaternion as quaternion
    from inca_mj.kinematics.rotations import rotation as rotation
    from inca_mj.kinematics.cables import Pulleys as Pulleys
    from inca_mj.kinematics.cables import Cables as Cables
    from inca_mj.kinematics.cables import inverse as inverse
    from inca_mj.kinematics.jacobians import CableRates as CableRates
    from inca_mj.kinematics.jacobians import rates as rates
    from inca_mj.kinematics.jacobians import CableAccelerations as CableAccelerations
    from inca_mj.kinematics.jacobians import accelerations as accelerations
    from inca_mj.kinematics.jacobians import condition as condition
    from inca_mj.kinematics.jacobians import jacobian as jacobian
    from inca_mj.kinematics.jacobians import jacobian_rate as jacobian_rate
    from inca_mj.kinematics.jacobians import length_jacobian as length_jacobian
    from inca_mj.kinematics.jacobians import rank as rank
    from inca_mj.kinematics.forward import ForwardPose as ForwardPose
    from inca_mj.kinematics.forward import pose_from_lengths as pose_from_lengths
    # isort: on
else:
    __all__, __getattr__, __dir__ = lazy(__name__)
