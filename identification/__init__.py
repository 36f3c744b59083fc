"""Identification of a MuJoCo model from logs of the robot it stands for."""

from identification.errors import DivergenceError as DivergenceError
from identification.errors import GraphicsError as GraphicsError
from identification.errors import InputError as InputError
from identification.log import Log as Log
from identification.log import halves as halves
from identification.metrics import fit_percent as fit_percent
from identification.metrics import loss as loss
from identification.metrics import rms as rms
from identification.parameter import Parameter as Parameter
from identification.parameter import ParameterSet as ParameterSet
from identification.read import read_log as read_log
from identification.write import write_log as write_log
