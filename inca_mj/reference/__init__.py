"""The INCA 6D as the thesis writes it: 36 states, body axes, Euler angles. The twin's oracle.

It shares parameters and geometry with the MuJoCo twin, and no physics code. Names from here are
the public ones.
"""

from inca_mj.reference.equations import derivative as derivative
from inca_mj.reference.integrate import ReferenceRun as ReferenceRun
from inca_mj.reference.integrate import simulate_reference as simulate_reference
from inca_mj.reference.numbers import Rest as Rest
from inca_mj.reference.numbers import pack as pack
from inca_mj.reference.numbers import rest as rest
from inca_mj.reference.numbers import rotation_matrix as rotation_matrix
