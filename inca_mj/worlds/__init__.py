"""Hidden worlds: logs of a robot with known effects, to test a discovery that does not know them.

The reference's equations with effects of their own, an integrator of their own, and noise; no
physics code is shared with the MuJoCo twin. Names from here are the public ones.
"""

from inca_mj.worlds.cable import CableCreep as CableCreep
from inca_mj.worlds.cable import CableHardening as CableHardening
from inca_mj.worlds.cable import CableWeight as CableWeight
from inca_mj.worlds.catalogue import CATALOGUE as CATALOGUE
from inca_mj.worlds.catalogue import SHAPES as SHAPES
from inca_mj.worlds.catalogue import UNLISTED as UNLISTED
from inca_mj.worlds.catalogue import draw_effect as draw_effect
from inca_mj.worlds.catalogue import effect as effect
from inca_mj.worlds.drum import Backlash as Backlash
from inca_mj.worlds.drum import DrumEccentricity as DrumEccentricity
from inca_mj.worlds.drum import DrumLayering as DrumLayering
from inca_mj.worlds.drum import DrumRadiusMismatch as DrumRadiusMismatch
from inca_mj.worlds.drum import SpringHardening as SpringHardening
from inca_mj.worlds.drum import SpringHysteresis as SpringHysteresis
from inca_mj.worlds.effect import Effect as Effect
from inca_mj.worlds.friction import AsymmetricFriction as AsymmetricFriction
from inca_mj.worlds.friction import FrictionMismatch as FrictionMismatch
from inca_mj.worlds.friction import LoadDependentFriction as LoadDependentFriction
from inca_mj.worlds.friction import PositionDependentFriction as PositionDependentFriction
from inca_mj.worlds.friction import QuadraticFriction as QuadraticFriction
from inca_mj.worlds.friction import StribeckFriction as StribeckFriction
from inca_mj.worlds.motor import Cogging as Cogging
from inca_mj.worlds.motor import CurrentLag as CurrentLag
from inca_mj.worlds.motor import CurrentSaturation as CurrentSaturation
from inca_mj.worlds.motor import Delay as Delay
from inca_mj.worlds.motor import TorqueConstantDrift as TorqueConstantDrift
from inca_mj.worlds.motor import TorqueConstantMismatch as TorqueConstantMismatch
from inca_mj.worlds.motor import TorqueRippleTime as TorqueRippleTime
from inca_mj.worlds.place import AirDrag as AirDrag
from inca_mj.worlds.place import AnchorOffset as AnchorOffset
from inca_mj.worlds.place import ComOffset as ComOffset
from inca_mj.worlds.place import ExternalForce as ExternalForce
from inca_mj.worlds.place import FrameVibration as FrameVibration
from inca_mj.worlds.place import PulleyRadius as PulleyRadius
from inca_mj.worlds.plant import Plant as Plant
from inca_mj.worlds.plant import make_plant as make_plant
from inca_mj.worlds.plant import simulate_world as simulate_world
from inca_mj.worlds.truth import Truth as Truth
from inca_mj.worlds.truth import World as World
from inca_mj.worlds.world import EVERY as EVERY
from inca_mj.worlds.world import VARIED as VARIED
from inca_mj.worlds.world import Setting as Setting
from inca_mj.worlds.world import make_currents as make_currents
from inca_mj.worlds.world import world as world
