"""Identification of a MuJoCo model from logs of the robot it stands for.

The public names. Each is imported when it is first asked for, so that reading a log needs no
simulator and a bad graphics setting cannot stop it.
"""

from typing import TYPE_CHECKING

from identification.lazy import lazy

_PUBLIC = {
    # errors, each one sentence
    "InputError": "errors",
    "DivergenceError": "errors",
    # logs
    "Log": "logs.log",
    "read_log": "logs.read",
    "write_log": "logs.csv_files",
    "decimate": "logs.decimation",
    "on_a_grid": "logs.resampling",
    "noise_floor": "logs.noise",
    "inspect_log": "inspection.inspected",
    "Inspection": "inspection.inspected",
    # a robot of a TOML file
    "read_robot": "robot.reading",
    "Robot": "robot.robot",
    "fit": "robot.fitting",
    "RobotFit": "robot.robot_fit",
    "discover": "robot.discovery",
    "confirm": "robot.confirmation",
    "Confirmation": "robot.record_error",
    "write_robot": "robot.write",
    # results that were saved
    "load": "saved",
    "SavedDiscovery": "saved",
    "SavedFit": "saved",
    # models and their parameters
    "Parameter": "model.parameter",
    "ParameterSet": "model.parameter",
    "ModelPlant": "model.plant",
    "Plant": "model.protocol",
    "Predictor": "model.predictor",
    # what a model may lack
    "Effect": "effects.effect",
    "Size": "effects.effect",
    "Shape": "effects.effect",
    "Candidate": "effects.effect",
    "Axis": "effects.axes",
    "axes": "effects.axes",
    "joint_effects": "effects.catalogue",
    "JointPlant": "effects.jointed",
    "joint_plant": "effects.joint_plant",
    "candidates": "effects.joint_plant",
    "places": "effects.effect",
    # linear models
    "LinearSystem": "linear.system",
    "OperatingPoints": "linear.operating_points",
    "at_rest": "linear.operating_points",
    "operating_points": "robot.linearization",
    "linearize": "linear.linearization",
    "minimal": "linear.modes",
    "modes": "linear.modes",
    "Mode": "linear.modes",
    "save_system": "linear.export",
    "load_system": "linear.export",
    "GriddedSystem": "linear.gridded",
    "load_grid": "linear.gridded",
    # values from a log
    "estimate": "estimation.estimation",
    "Options": "estimation.search",
    "assess": "estimation.fit",
    "Fit": "estimation.fit",
    "estimate_windows": "windows.window_estimate",
    "WindowEstimate": "windows.window_estimate",
    # how good a model is
    "fit_percent": "estimation.metrics",
    "rms": "estimation.metrics",
    "window_error": "windows.window_error",
    # the search for what is missing
    "NominalModel": "discovery.nominal_model",
    "Discovery": "discovery.result",
    "DiscoveryOptions": "discovery.options",
    "Finding": "discovery.findings.finding",
    # words and figures
    "fit_verdict": "report.fit_verdict",
    "discovery_text": "report.discovery_report",
    "compare_figure": "report.figures",
    "windows_figure": "report.figures",
    "save_png": "report.style",
}
__all__ = list(_PUBLIC)

if TYPE_CHECKING:  # the same list, for type checkers and editors
    from identification.discovery.findings.finding import Finding as Finding
    from identification.discovery.nominal_model import NominalModel as NominalModel
    from identification.discovery.options import DiscoveryOptions as DiscoveryOptions
    from identification.discovery.result import Discovery as Discovery
    from identification.effects.axes import Axis as Axis
    from identification.effects.axes import axes as axes
    from identification.effects.catalogue import joint_effects as joint_effects
    from identification.effects.effect import Candidate as Candidate
    from identification.effects.effect import Effect as Effect
    from identification.effects.effect import Shape as Shape
    from identification.effects.effect import Size as Size
    from identification.effects.effect import places as places
    from identification.effects.joint_plant import candidates as candidates
    from identification.effects.joint_plant import joint_plant as joint_plant
    from identification.effects.jointed import JointPlant as JointPlant
    from identification.errors import DivergenceError as DivergenceError
    from identification.errors import InputError as InputError
    from identification.estimation.estimation import estimate as estimate
    from identification.estimation.fit import Fit as Fit
    from identification.estimation.fit import assess as assess
    from identification.estimation.metrics import fit_percent as fit_percent
    from identification.estimation.metrics import rms as rms
    from identification.estimation.search import Options as Options
    from identification.inspection.inspected import Inspection as Inspection
    from identification.inspection.inspected import inspect_log as inspect_log
    from identification.linear.export import load_system as load_system
    from identification.linear.export import save_system as save_system
    from identification.linear.gridded import GriddedSystem as GriddedSystem
    from identification.linear.gridded import load_grid as load_grid
    from identification.linear.linearization import linearize as linearize
    from identification.linear.modes import Mode as Mode
    from identification.linear.modes import minimal as minimal
    from identification.linear.modes import modes as modes
    from identification.linear.operating_points import OperatingPoints as OperatingPoints
    from identification.linear.operating_points import at_rest as at_rest
    from identification.linear.system import LinearSystem as LinearSystem
    from identification.logs.csv_files import write_log as write_log
    from identification.logs.decimation import decimate as decimate
    from identification.logs.log import Log as Log
    from identification.logs.noise import noise_floor as noise_floor
    from identification.logs.read import read_log as read_log
    from identification.logs.resampling import on_a_grid as on_a_grid
    from identification.model.parameter import Parameter as Parameter
    from identification.model.parameter import ParameterSet as ParameterSet
    from identification.model.plant import ModelPlant as ModelPlant
    from identification.model.predictor import Predictor as Predictor
    from identification.model.protocol import Plant as Plant
    from identification.report.discovery_report import discovery_text as discovery_text
    from identification.report.figures import compare_figure as compare_figure
    from identification.report.figures import windows_figure as windows_figure
    from identification.report.fit_verdict import fit_verdict as fit_verdict
    from identification.report.style import save_png as save_png
    from identification.robot.confirmation import confirm as confirm
    from identification.robot.discovery import discover as discover
    from identification.robot.fitting import fit as fit
    from identification.robot.linearization import operating_points as operating_points
    from identification.robot.reading import read_robot as read_robot
    from identification.robot.record_error import Confirmation as Confirmation
    from identification.robot.robot import Robot as Robot
    from identification.robot.robot_fit import RobotFit as RobotFit
    from identification.robot.write import write_robot as write_robot
    from identification.saved import SavedDiscovery as SavedDiscovery
    from identification.saved import SavedFit as SavedFit
    from identification.saved import load as load
    from identification.windows.window_error import window_error as window_error
    from identification.windows.window_estimate import WindowEstimate as WindowEstimate
    from identification.windows.window_estimate import estimate_windows as estimate_windows
else:
    __getattr__, __dir__ = lazy(__name__, _PUBLIC)
