"""Two models of one robot that share no physics code must agree: the twin and the reference ODE.

They share the parameters and the geometry only. What is compared: accelerations at random
states (`derivatives`), and trajectories at several steps of the twin (`trajectories`). Names
from here are the public ones.
"""

from inca_mj.verification.check import CrossCheck as CrossCheck
from inca_mj.verification.check import crosscheck as crosscheck
from inca_mj.verification.derivatives import DerivativeErrors as DerivativeErrors
from inca_mj.verification.derivatives import compare_derivatives as compare_derivatives
from inca_mj.verification.trajectories import CASES as CASES
