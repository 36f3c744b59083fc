"""The digital twin of the INCA 6D: eight elastic cables, eight motors with drums, a platform.

The public names. Each is imported when it is first asked for, so that `inca --help` is quick.
"""

from typing import TYPE_CHECKING

from identification.lazy import lazy

_PUBLIC = {
    # the robot by its numbers
    "parameter_set": "robot.parameters",
    "GRAVITY": "robot.parameters",
    "Geometry": "robot.geometry",
    "INCA": "robot.geometry",
    "read_geometry": "robot.geometry",
    "rotation": "kinematics.rotations",
    "euler": "kinematics.rotations",
    "length_jacobian": "kinematics.jacobians",
    "pose_from_lengths": "kinematics.forward",
    "spring_force": "robot.law",
    "make_input": "robot.inputs",
    # the twin, its runs and its logs
    "Twin": "twin.twin",
    "build_twin": "twin.twin",
    "Run": "twin.run",
    "simulate": "twin.run",
    "save_run": "twin.run",
    "load_run": "twin.run",
    "save_twin": "twin.saved",
    "load_twin": "twin.saved",
    "build_plain": "twin.plain",
    "read_inca_log": "twin.logs",
    "run_to_log": "twin.logs",
    # the twin linearised
    "linearize": "linear.linearization",
    "linearize_along": "linear.linearization",
    "linearize_grid": "linear.linearization",
    "LinearModel": "linear.linearization",
    "held_at": "linear.linearization",
    "interpolation_errors": "linear.accuracy",
    "InterpolationError": "linear.accuracy",
    "run_error": "linear.accuracy",
    "RunError": "linear.accuracy",
    "load_environment": "control.environment",
    "CONTROL_TIMESTEP": "control.controller",
    "load_gymnasium": "control.gymnasium_env",
    "Controller": "control.controller",
    "Gains": "control.controller",
    "Tensions": "control.inverse",
    "Point": "control.paths",
    "Line": "control.paths",
    "Circle": "control.paths",
    # effects that it may lack
    "CATALOGUE": "effects.catalogue",
    "DRIVES_EACH": "effects.hooks",
    # what can be done with it
    "compare": "workflows.comparison",
    "Comparison": "workflows.comparison",
    "compare_twin": "workflows.comparison",
    "with_force": "workflows.pulled",
    "identify": "workflows.identification",
    "Identification": "workflows.identification",
    "identify_windows": "workflows.disturbed",
    "identify_innovations": "workflows.disturbed",
    "identify_as_thesis": "workflows.identification",
    "calibrate": "workflows.calibration",
    "Calibration": "workflows.calibration",
    "Spread": "workflows.spread",
    "spread_of": "workflows.spread",
    "with_spread": "robot.spread",
    "discover": "workflows.discovery",
    "named_twin": "workflows.discovery_model",
    "pose_at_rest": "workflows.poses",
    "RestingPose": "workflows.poses",
    "log_poses": "workflows.poses",
    "LogPoses": "workflows.poses",
    "track": "workflows.tracking",
    "Tracking": "workflows.tracking",
    "sensitivity": "workflows.sensitivity",
    "excite": "workflows.excitation",
    "Design": "workflows.excitation",
    "Limits": "workflows.limits",
    "trials": "thesis.trials",
    "TrialResult": "thesis.trials",
    "monte_carlo": "thesis.trials",
    "repeat_thesis": "thesis.results",
    "ThesisResults": "thesis.results",
    "crosscheck": "verification.check",
    "CrossCheck": "verification.check",
    # what its cables can hold, and where
    "analyse_statics": "workflows.statics",
    "StaticAnalysis": "workflows.statics",
    "static_robot": "statics.robot",
    "distribute": "statics.tensions",
    "equilibrium": "statics.equilibrium",
    "workspace": "statics.workspace",
    "DriveLimits": "statics.workspace",
    "interference": "statics.interference",
    "hang": "statics.catenary",
    "workspace_picture": "rendering.workspace_picture",
    # films
    "film": "rendering.film",
    "stills": "rendering.film",
    "Scene": "rendering.scene",
}
__all__ = list(_PUBLIC)

if TYPE_CHECKING:  # the same list, for type checkers and editors
    from inca_mj.control.controller import CONTROL_TIMESTEP as CONTROL_TIMESTEP
    from inca_mj.control.controller import Controller as Controller
    from inca_mj.control.controller import Gains as Gains
    from inca_mj.control.environment import load_environment as load_environment
    from inca_mj.control.gymnasium_env import load_gymnasium as load_gymnasium
    from inca_mj.control.inverse import Tensions as Tensions
    from inca_mj.control.paths import Circle as Circle
    from inca_mj.control.paths import Line as Line
    from inca_mj.control.paths import Point as Point
    from inca_mj.effects.catalogue import CATALOGUE as CATALOGUE
    from inca_mj.effects.hooks import DRIVES_EACH as DRIVES_EACH
    from inca_mj.kinematics.forward import pose_from_lengths as pose_from_lengths
    from inca_mj.kinematics.jacobians import length_jacobian as length_jacobian
    from inca_mj.kinematics.rotations import euler as euler
    from inca_mj.kinematics.rotations import rotation as rotation
    from inca_mj.linear.accuracy import InterpolationError as InterpolationError
    from inca_mj.linear.accuracy import RunError as RunError
    from inca_mj.linear.accuracy import interpolation_errors as interpolation_errors
    from inca_mj.linear.accuracy import run_error as run_error
    from inca_mj.linear.linearization import LinearModel as LinearModel
    from inca_mj.linear.linearization import held_at as held_at
    from inca_mj.linear.linearization import linearize as linearize
    from inca_mj.linear.linearization import linearize_along as linearize_along
    from inca_mj.linear.linearization import linearize_grid as linearize_grid
    from inca_mj.rendering.film import film as film
    from inca_mj.rendering.film import stills as stills
    from inca_mj.rendering.scene import Scene as Scene
    from inca_mj.rendering.workspace_picture import workspace_picture as workspace_picture
    from inca_mj.robot.geometry import INCA as INCA
    from inca_mj.robot.geometry import Geometry as Geometry
    from inca_mj.robot.geometry import read_geometry as read_geometry
    from inca_mj.robot.inputs import make_input as make_input
    from inca_mj.robot.law import spring_force as spring_force
    from inca_mj.robot.parameters import GRAVITY as GRAVITY
    from inca_mj.robot.parameters import parameter_set as parameter_set
    from inca_mj.robot.spread import with_spread as with_spread
    from inca_mj.statics.catenary import hang as hang
    from inca_mj.statics.equilibrium import equilibrium as equilibrium
    from inca_mj.statics.interference import interference as interference
    from inca_mj.statics.robot import static_robot as static_robot
    from inca_mj.statics.tensions import distribute as distribute
    from inca_mj.statics.workspace import DriveLimits as DriveLimits
    from inca_mj.statics.workspace import workspace as workspace
    from inca_mj.thesis.results import ThesisResults as ThesisResults
    from inca_mj.thesis.results import repeat_thesis as repeat_thesis
    from inca_mj.thesis.trials import TrialResult as TrialResult
    from inca_mj.thesis.trials import monte_carlo as monte_carlo
    from inca_mj.thesis.trials import trials as trials
    from inca_mj.twin.logs import read_inca_log as read_inca_log
    from inca_mj.twin.logs import run_to_log as run_to_log
    from inca_mj.twin.plain import build_plain as build_plain
    from inca_mj.twin.run import Run as Run
    from inca_mj.twin.run import load_run as load_run
    from inca_mj.twin.run import save_run as save_run
    from inca_mj.twin.run import simulate as simulate
    from inca_mj.twin.saved import load_twin as load_twin
    from inca_mj.twin.saved import save_twin as save_twin
    from inca_mj.twin.twin import Twin as Twin
    from inca_mj.twin.twin import build_twin as build_twin
    from inca_mj.verification.check import CrossCheck as CrossCheck
    from inca_mj.verification.check import crosscheck as crosscheck
    from inca_mj.workflows.calibration import Calibration as Calibration
    from inca_mj.workflows.calibration import calibrate as calibrate
    from inca_mj.workflows.comparison import Comparison as Comparison
    from inca_mj.workflows.comparison import compare as compare
    from inca_mj.workflows.comparison import compare_twin as compare_twin
    from inca_mj.workflows.discovery import discover as discover
    from inca_mj.workflows.discovery_model import named_twin as named_twin
    from inca_mj.workflows.disturbed import identify_innovations as identify_innovations
    from inca_mj.workflows.disturbed import identify_windows as identify_windows
    from inca_mj.workflows.excitation import Design as Design
    from inca_mj.workflows.excitation import excite as excite
    from inca_mj.workflows.identification import Identification as Identification
    from inca_mj.workflows.identification import identify as identify
    from inca_mj.workflows.identification import identify_as_thesis as identify_as_thesis
    from inca_mj.workflows.limits import Limits as Limits
    from inca_mj.workflows.poses import LogPoses as LogPoses
    from inca_mj.workflows.poses import RestingPose as RestingPose
    from inca_mj.workflows.poses import log_poses as log_poses
    from inca_mj.workflows.poses import pose_at_rest as pose_at_rest
    from inca_mj.workflows.pulled import with_force as with_force
    from inca_mj.workflows.sensitivity import sensitivity as sensitivity
    from inca_mj.workflows.spread import Spread as Spread
    from inca_mj.workflows.spread import spread_of as spread_of
    from inca_mj.workflows.statics import StaticAnalysis as StaticAnalysis
    from inca_mj.workflows.statics import analyse_statics as analyse_statics
    from inca_mj.workflows.tracking import Tracking as Tracking
    from inca_mj.workflows.tracking import track as track
else:
    __getattr__, __dir__ = lazy(__name__, _PUBLIC)
