"""The digital twin of the INCA 6D: eight elastic cables, eight motors with drums, a handle.

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
    "rotation": "robot.kinematics",
    "euler": "robot.kinematics",
    "length_jacobian": "robot.kinematics",
    "pose_from_lengths": "robot.kinematics",
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
    "load_environment": "twin.control",
    "CONTROL_TIMESTEP": "twin.control",
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
    "identify_as_thesis": "workflows.procedure",
    "calibrate": "workflows.calibration",
    "Calibration": "workflows.calibration",
    "Spread": "workflows.spread",
    "spread_of": "workflows.spread",
    "with_spread": "robot.spread",
    "discover": "workflows.discovery",
    "named_twin": "workflows.discovery_model",
    "sensitivity": "workflows.sensitivity",
    "excite": "workflows.excitation",
    "Design": "workflows.excitation",
    "Limits": "workflows.limits",
    "trials": "workflows.trials",
    "TrialResult": "workflows.trials",
    "monte_carlo": "workflows.trials",
    "repeat_thesis": "workflows.thesis_results",
    "ThesisResults": "workflows.thesis_results",
    "crosscheck": "verification.check",
    "CrossCheck": "verification.result",
    # films
    "film": "rendering.film",
    "stills": "rendering.film",
    "Scene": "rendering.scene",
}
__all__ = list(_PUBLIC)

if TYPE_CHECKING:  # the same list, for type checkers and editors
    from inca_mj.effects.catalogue import CATALOGUE as CATALOGUE
    from inca_mj.effects.hooks import DRIVES_EACH as DRIVES_EACH
    from inca_mj.rendering.film import film as film
    from inca_mj.rendering.film import stills as stills
    from inca_mj.rendering.scene import Scene as Scene
    from inca_mj.robot.geometry import INCA as INCA
    from inca_mj.robot.geometry import Geometry as Geometry
    from inca_mj.robot.geometry import read_geometry as read_geometry
    from inca_mj.robot.inputs import make_input as make_input
    from inca_mj.robot.kinematics import euler as euler
    from inca_mj.robot.kinematics import length_jacobian as length_jacobian
    from inca_mj.robot.kinematics import pose_from_lengths as pose_from_lengths
    from inca_mj.robot.kinematics import rotation as rotation
    from inca_mj.robot.law import spring_force as spring_force
    from inca_mj.robot.parameters import GRAVITY as GRAVITY
    from inca_mj.robot.parameters import parameter_set as parameter_set
    from inca_mj.robot.spread import with_spread as with_spread
    from inca_mj.twin.control import CONTROL_TIMESTEP as CONTROL_TIMESTEP
    from inca_mj.twin.control import load_environment as load_environment
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
    from inca_mj.verification.check import crosscheck as crosscheck
    from inca_mj.verification.result import CrossCheck as CrossCheck
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
    from inca_mj.workflows.limits import Limits as Limits
    from inca_mj.workflows.procedure import identify_as_thesis as identify_as_thesis
    from inca_mj.workflows.pulled import with_force as with_force
    from inca_mj.workflows.sensitivity import sensitivity as sensitivity
    from inca_mj.workflows.spread import Spread as Spread
    from inca_mj.workflows.spread import spread_of as spread_of
    from inca_mj.workflows.thesis_results import ThesisResults as ThesisResults
    from inca_mj.workflows.thesis_results import repeat_thesis as repeat_thesis
    from inca_mj.workflows.trials import TrialResult as TrialResult
    from inca_mj.workflows.trials import monte_carlo as monte_carlo
    from inca_mj.workflows.trials import trials as trials
else:
    __getattr__, __dir__ = lazy(__name__, _PUBLIC)
