"""The digital twin of the INCA 6D: eight elastic cables, eight motors with drums, a platform.

The public names. Each is imported when it is first asked for, so that `inca --help` is quick.
"""

from typing import TYPE_CHECKING

from identification.runtime.lazy import lazy

if TYPE_CHECKING:  # the public names, by what they are for
    # isort: off
    # the robot by its numbers
    from inca_mj.robot.parameters import parameter_set as parameter_set
    from inca_mj.robot.parameters import GRAVITY as GRAVITY
    from inca_mj.robot.geometry import Geometry as Geometry
    from inca_mj.robot.geometry import INCA as INCA
    from inca_mj.robot.geometry import read_geometry as read_geometry
    from inca_mj.kinematics.rotations import rotation as rotation
    from inca_mj.kinematics.rotations import euler as euler
    from inca_mj.kinematics.jacobians import length_jacobian as length_jacobian
    from inca_mj.kinematics.forward import pose_from_lengths as pose_from_lengths
    from inca_mj.robot.law import spring_force as spring_force
    from inca_mj.robot.inputs import make_input as make_input

    # the twin, its runs and its logs
    from inca_mj.twin.twin import Twin as Twin
    from inca_mj.twin.twin import build_twin as build_twin
    from inca_mj.twin.run import Run as Run
    from inca_mj.twin.run import simulate as simulate
    from inca_mj.twin.run import save_run as save_run
    from inca_mj.twin.run import load_run as load_run
    from inca_mj.twin.saved import save_twin as save_twin
    from inca_mj.twin.saved import load_twin as load_twin
    from inca_mj.twin.plain import build_plain as build_plain
    from inca_mj.twin.logs import read_inca_log as read_inca_log
    from inca_mj.twin.logs import run_to_log as run_to_log

    # the twin linearised
    from inca_mj.linear.linearization import linearize as linearize
    from inca_mj.linear.linearization import linearize_along as linearize_along
    from inca_mj.linear.linearization import linearize_grid as linearize_grid
    from inca_mj.linear.linearization import LinearModel as LinearModel
    from inca_mj.linear.linearization import held_at as held_at
    from inca_mj.linear.accuracy import interpolation_errors as interpolation_errors
    from inca_mj.linear.accuracy import InterpolationError as InterpolationError
    from inca_mj.linear.accuracy import run_error as run_error
    from inca_mj.linear.accuracy import RunError as RunError
    from inca_mj.control.environment import load_environment as load_environment
    from inca_mj.control.controller import CONTROL_TIMESTEP as CONTROL_TIMESTEP
    from inca_mj.control.gymnasium_env import load_gymnasium as load_gymnasium
    from inca_mj.control.controller import Controller as Controller
    from inca_mj.control.controller import Gains as Gains
    from inca_mj.control.inverse import Tensions as Tensions
    from inca_mj.control.paths import Point as Point
    from inca_mj.control.paths import Line as Line
    from inca_mj.control.paths import Circle as Circle

    # effects that it may lack
    from inca_mj.effects.catalogue import CATALOGUE as CATALOGUE
    from inca_mj.effects.hooks import DRIVES_EACH as DRIVES_EACH

    # what can be done with it
    from inca_mj.workflows.comparison import compare as compare
    from inca_mj.workflows.comparison import Comparison as Comparison
    from inca_mj.workflows.comparison import compare_twin as compare_twin
    from inca_mj.workflows.pulled import with_force as with_force
    from inca_mj.workflows.identification import identify as identify
    from inca_mj.workflows.identification import Identification as Identification
    from inca_mj.workflows.disturbed import identify_windows as identify_windows
    from inca_mj.workflows.disturbed import identify_innovations as identify_innovations
    from inca_mj.workflows.identification import identify_as_thesis as identify_as_thesis
    from inca_mj.workflows.calibration import calibrate as calibrate
    from inca_mj.workflows.calibration import Calibration as Calibration
    from inca_mj.workflows.spread import Spread as Spread
    from inca_mj.workflows.spread import spread_of as spread_of
    from inca_mj.robot.spread import with_spread as with_spread
    from inca_mj.workflows.discovery import discover as discover
    from inca_mj.workflows.discovery_model import named_twin as named_twin
    from inca_mj.workflows.poses import pose_at_rest as pose_at_rest
    from inca_mj.workflows.poses import RestingPose as RestingPose
    from inca_mj.workflows.poses import log_poses as log_poses
    from inca_mj.workflows.poses import LogPoses as LogPoses
    from inca_mj.workflows.tracking import track as track
    from inca_mj.workflows.tracking import Tracking as Tracking
    from inca_mj.workflows.sensitivity import sensitivity as sensitivity
    from inca_mj.workflows.excitation import excite as excite
    from inca_mj.workflows.excitation import Design as Design
    from inca_mj.workflows.limits import Limits as Limits
    from inca_mj.thesis.trials import trials as trials
    from inca_mj.thesis.trials import TrialResult as TrialResult
    from inca_mj.thesis.trials import monte_carlo as monte_carlo
    from inca_mj.thesis.results import repeat_thesis as repeat_thesis
    from inca_mj.thesis.results import ThesisResults as ThesisResults
    from inca_mj.verification.check import crosscheck as crosscheck
    from inca_mj.verification.check import CrossCheck as CrossCheck

    # what its cables can hold, and where
    from inca_mj.workflows.statics import analyse_statics as analyse_statics
    from inca_mj.workflows.statics import StaticAnalysis as StaticAnalysis
    from inca_mj.statics.robot import static_robot as static_robot
    from inca_mj.statics.tensions import distribute as distribute
    from inca_mj.statics.equilibrium import equilibrium as equilibrium
    from inca_mj.statics.workspace import workspace as workspace
    from inca_mj.statics.workspace import DriveLimits as DriveLimits
    from inca_mj.statics.interference import interference as interference
    from inca_mj.statics.catenary import hang as hang
    from inca_mj.rendering.workspace_picture import workspace_picture as workspace_picture

    # films
    from inca_mj.rendering.film import film as film
    from inca_mj.rendering.film import stills as stills
    from inca_mj.rendering.scene import Scene as Scene
    # isort: on
else:
    __all__, __getattr__, __dir__ = lazy(__name__)
