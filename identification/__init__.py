"""Identification of a MuJoCo model from logs of the robot it stands for.

The public names. Each is imported when it is first asked for, so that reading a log needs no
simulator and a bad graphics setting cannot stop it.
"""

from typing import TYPE_CHECKING

from identification.runtime.lazy import lazy

if TYPE_CHECKING:  # the public names, by what they are for
    # isort: off
    # errors, each one sentence
    from identification.errors import InputError as InputError
    from identification.errors import DivergenceError as DivergenceError

    # logs
    from identification.logs.log import Log as Log
    from identification.logs.read import read_log as read_log
    from identification.logs.formats.csv_files import write_log as write_log
    from identification.logs.stamps.decimation import decimate as decimate
    from identification.logs.stamps.resampling import on_a_grid as on_a_grid
    from identification.logs.noise import noise_floor as noise_floor
    from identification.inspection.inspected import inspect_log as inspect_log
    from identification.inspection.inspected import Inspection as Inspection

    # a robot of a TOML file
    from identification.robot.reading import read_robot as read_robot
    from identification.robot.robot import Robot as Robot
    from identification.robot.fitting import fit as fit
    from identification.robot.results.results import RobotFit as RobotFit
    from identification.robot.torques import fit_torques as fit_torques
    from identification.robot.results.results import TorqueFit as TorqueFit
    from identification.robot.discovery import discover as discover
    from identification.robot.results.confirmation import confirm as confirm
    from identification.robot.results.record_error import Confirmation as Confirmation
    from identification.robot.results.write import write_robot as write_robot
    from identification.robot.experiment import design_experiment as design_experiment
    from identification.robot.results.results import NextExperiment as NextExperiment

    # results that were saved
    from identification.storage.saved import load as load
    from identification.storage.saved import SavedDiscovery as SavedDiscovery
    from identification.storage.saved import SavedFit as SavedFit

    # models and their parameters
    from identification.model.parameter import Parameter as Parameter
    from identification.model.parameter import ParameterSet as ParameterSet
    from identification.model.plant import ModelPlant as ModelPlant
    from identification.model.protocol import Plant as Plant
    from identification.model.predictor import Predictor as Predictor

    # what a model may lack
    from identification.effects.effect import Effect as Effect
    from identification.effects.sizes import Size as Size
    from identification.effects.sizes import Shape as Shape
    from identification.effects.effect import Candidate as Candidate
    from identification.effects.axes import Axis as Axis
    from identification.effects.axes import axes as axes
    from identification.effects.catalogue import joint_effects as joint_effects
    from identification.effects.plant.jointed import JointPlant as JointPlant
    from identification.effects.plant.joint_plant import joint_plant as joint_plant
    from identification.effects.plant.joint_plant import candidates as candidates
    from identification.effects.effect import places as places

    # linear models
    from identification.linear.system import LinearSystem as LinearSystem
    from identification.linear.operating_points import OperatingPoints as OperatingPoints
    from identification.linear.operating_points import at_rest as at_rest
    from identification.robot.linearization import operating_points as operating_points
    from identification.linear.linearization import linearize as linearize
    from identification.linear.modes import minimal as minimal
    from identification.linear.modes import modes as modes
    from identification.linear.modes import Mode as Mode
    from identification.linear.export import save_system as save_system
    from identification.linear.export import load_system as load_system
    from identification.linear.gridded import GriddedSystem as GriddedSystem
    from identification.linear.gridded import load_grid as load_grid

    # values from a log
    from identification.estimation.estimation import estimate as estimate
    from identification.estimation.search import Options as Options
    from identification.estimation.fit import assess as assess
    from identification.estimation.fit import Fit as Fit
    from identification.windows.window_estimate import estimate_windows as estimate_windows
    from identification.windows.window_estimate import WindowEstimate as WindowEstimate

    # how good a model is
    from identification.estimation.metrics import fit_percent as fit_percent
    from identification.estimation.metrics import rms as rms
    from identification.windows.window_error import window_error as window_error

    # the search for what is missing
    from identification.discovery.nominal_model import NominalModel as NominalModel
    from identification.discovery.result import Discovery as Discovery
    from identification.discovery.options import DiscoveryOptions as DiscoveryOptions
    from identification.discovery.findings.finding import Finding as Finding

    # words and figures
    from identification.report.fit.verdict import fit_verdict as fit_verdict
    from identification.report.discovery.report import discovery_text as discovery_text
    from identification.report.page.figures import compare_figure as compare_figure
    from identification.report.page.figures import windows_figure as windows_figure
    from identification.report.page.style import save_png as save_png
    # isort: on
else:
    __all__, __getattr__, __dir__ = lazy(__name__)
