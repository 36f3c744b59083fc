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
    "GraphicsError": "errors",
    # logs
    "Log": "logs.log",
    "halves": "logs.log",
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
    "State": "model.rollout",
    "Coordinates": "model.coordinates",
    "coordinates": "model.coordinates",
    "sensitivity": "model.sensitivity",
    # what a model may lack
    "Effect": "effects.effect",
    "Size": "effects.effect",
    "Shape": "effects.effect",
    "Candidate": "effects.effect",
    "Axis": "effects.axes",
    "axes": "effects.axes",
    "joint_effects": "effects.catalogue",
    "drives": "effects.inputs",
    "input_effects": "effects.inputs",
    "JointPlant": "effects.jointed",
    "joint_plant": "effects.joint_plant",
    "candidates": "effects.joint_plant",
    "read_model": "effects.rows",
    "places": "effects.effect",
    # linear models
    "LinearSystem": "linear.system",
    "OperatingPoints": "linear.operating_points",
    "at_rest": "linear.operating_points",
    "along_log": "linear.operating_points",
    "operating_points": "robot.linearization",
    "linearize": "linear.linearization",
    "minimal": "linear.modes",
    "Minimal": "linear.modes",
    "modes": "linear.modes",
    "Mode": "linear.modes",
    "save_system": "linear.export",
    "load_system": "linear.export",
    "GriddedSystem": "linear.gridded",
    "gridded": "linear.gridded",
    "load_grid": "linear.gridded",
    # values from a log
    "estimate": "estimation.estimation",
    "Estimate": "estimation.estimation",
    "Options": "estimation.search",
    "estimate_from": "estimation.multistart",
    "Starts": "estimation.multistart",
    "assess": "estimation.fit",
    "Fit": "estimation.fit",
    "profile": "estimation.profiles",
    "Profile": "estimation.profiles",
    "estimate_windows": "windows.window_estimate",
    "WindowEstimate": "windows.window_estimate",
    "joined": "windows.window_error",
    "estimate_innovations": "kalman.estimate",
    "InnovationsFit": "kalman.estimate",
    # how good a model is
    "fit_percent": "estimation.metrics",
    "rms": "estimation.metrics",
    "loss": "estimation.metrics",
    "window_error": "windows.window_error",
    "residual_tests": "estimation.residuals",
    "ResidualTests": "estimation.residuals",
    # what an experiment can say
    "Experiment": "estimation.experiment",
    "information": "estimation.experiment",
    "Information": "estimation.information",
    "determinable": "estimation.information",
    # the search for what is missing
    "NominalModel": "discovery.nominal_model",
    "Discovery": "discovery.result",
    "DiscoveryOptions": "discovery.options",
    "read_options": "discovery.options",
    "Finding": "discovery.findings.finding",
    "FindingKind": "discovery.findings.finding",
    "collect_final_values": "discovery.result",
    # words and figures
    "fit_verdict": "report.fit_verdict",
    "fit_to_json": "report.fit_json",
    "discovery_text": "report.discovery_report",
    "discovery_to_json": "report.discovery_json",
    "describe_rejected": "report.effect_words",
    "describe_finding": "report.finding_words",
    "compare_figure": "report.figures",
    "windows_figure": "report.figures",
    "save_png": "report.style",
}
__all__ = list(_PUBLIC)

if TYPE_CHECKING:  # the same list, for type checkers and editors
    from identification.discovery.findings.finding import Finding as Finding
    from identification.discovery.findings.finding import FindingKind as FindingKind
    from identification.discovery.nominal_model import NominalModel as NominalModel
    from identification.discovery.options import DiscoveryOptions as DiscoveryOptions
    from identification.discovery.options import read_options as read_options
    from identification.discovery.result import Discovery as Discovery
    from identification.discovery.result import collect_final_values as collect_final_values
    from identification.effects.axes import Axis as Axis
    from identification.effects.axes import axes as axes
    from identification.effects.catalogue import joint_effects as joint_effects
    from identification.effects.effect import Candidate as Candidate
    from identification.effects.effect import Effect as Effect
    from identification.effects.effect import Shape as Shape
    from identification.effects.effect import Size as Size
    from identification.effects.effect import places as places
    from identification.effects.inputs import drives as drives
    from identification.effects.inputs import input_effects as input_effects
    from identification.effects.joint_plant import candidates as candidates
    from identification.effects.joint_plant import joint_plant as joint_plant
    from identification.effects.jointed import JointPlant as JointPlant
    from identification.effects.rows import read_model as read_model
    from identification.errors import DivergenceError as DivergenceError
    from identification.errors import GraphicsError as GraphicsError
    from identification.errors import InputError as InputError
    from identification.estimation.estimation import Estimate as Estimate
    from identification.estimation.estimation import estimate as estimate
    from identification.estimation.experiment import Experiment as Experiment
    from identification.estimation.experiment import information as information
    from identification.estimation.fit import Fit as Fit
    from identification.estimation.fit import assess as assess
    from identification.estimation.information import Information as Information
    from identification.estimation.information import determinable as determinable
    from identification.estimation.metrics import fit_percent as fit_percent
    from identification.estimation.metrics import loss as loss
    from identification.estimation.metrics import rms as rms
    from identification.estimation.multistart import Starts as Starts
    from identification.estimation.multistart import estimate_from as estimate_from
    from identification.estimation.profiles import Profile as Profile
    from identification.estimation.profiles import profile as profile
    from identification.estimation.residuals import ResidualTests as ResidualTests
    from identification.estimation.residuals import residual_tests as residual_tests
    from identification.estimation.search import Options as Options
    from identification.inspection.inspected import Inspection as Inspection
    from identification.inspection.inspected import inspect_log as inspect_log
    from identification.kalman.estimate import InnovationsFit as InnovationsFit
    from identification.kalman.estimate import estimate_innovations as estimate_innovations
    from identification.linear.export import load_system as load_system
    from identification.linear.export import save_system as save_system
    from identification.linear.gridded import GriddedSystem as GriddedSystem
    from identification.linear.gridded import gridded as gridded
    from identification.linear.gridded import load_grid as load_grid
    from identification.linear.linearization import linearize as linearize
    from identification.linear.modes import Minimal as Minimal
    from identification.linear.modes import Mode as Mode
    from identification.linear.modes import minimal as minimal
    from identification.linear.modes import modes as modes
    from identification.linear.operating_points import OperatingPoints as OperatingPoints
    from identification.linear.operating_points import along_log as along_log
    from identification.linear.operating_points import at_rest as at_rest
    from identification.linear.system import LinearSystem as LinearSystem
    from identification.logs.csv_files import write_log as write_log
    from identification.logs.decimation import decimate as decimate
    from identification.logs.log import Log as Log
    from identification.logs.log import halves as halves
    from identification.logs.noise import noise_floor as noise_floor
    from identification.logs.read import read_log as read_log
    from identification.logs.resampling import on_a_grid as on_a_grid
    from identification.model.coordinates import Coordinates as Coordinates
    from identification.model.coordinates import coordinates as coordinates
    from identification.model.parameter import Parameter as Parameter
    from identification.model.parameter import ParameterSet as ParameterSet
    from identification.model.plant import ModelPlant as ModelPlant
    from identification.model.predictor import Predictor as Predictor
    from identification.model.protocol import Plant as Plant
    from identification.model.rollout import State as State
    from identification.model.sensitivity import sensitivity as sensitivity
    from identification.report.discovery_json import discovery_to_json as discovery_to_json
    from identification.report.discovery_report import discovery_text as discovery_text
    from identification.report.effect_words import describe_rejected as describe_rejected
    from identification.report.figures import compare_figure as compare_figure
    from identification.report.figures import windows_figure as windows_figure
    from identification.report.finding_words import describe_finding as describe_finding
    from identification.report.fit_json import fit_to_json as fit_to_json
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
    from identification.windows.window_error import joined as joined
    from identification.windows.window_error import window_error as window_error
    from identification.windows.window_estimate import WindowEstimate as WindowEstimate
    from identification.windows.window_estimate import estimate_windows as estimate_windows
else:
    __getattr__, __dir__ = lazy(__name__, _PUBLIC)
