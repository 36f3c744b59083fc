"""Hidden worlds: logs of a robot with known effects, to test a discovery that does not know them.

The reference's equations with effects of their own, an integrator of their own, and noise; no
physics code is shared with the MuJoCo twin. Names from here are the public ones.
"""

from inca_mj.studies.worlds.cable import HiddenCableCreep as HiddenCableCreep
from inca_mj.studies.worlds.cable import HiddenCableHardening as HiddenCableHardening
from inca_mj.studies.worlds.cable import HiddenCableWeight as HiddenCableWeight
from inca_mj.studies.worlds.catalogue import ALL_EFFECTS as ALL_EFFECTS
from inca_mj.studies.worlds.catalogue import CHANGES as CHANGES
from inca_mj.studies.worlds.catalogue import FAULTS as FAULTS
from inca_mj.studies.worlds.catalogue import HIDDEN_EFFECTS as HIDDEN_EFFECTS
from inca_mj.studies.worlds.catalogue import SHAPES as SHAPES
from inca_mj.studies.worlds.catalogue import UNLISTED as UNLISTED
from inca_mj.studies.worlds.catalogue import draw_effect as draw_effect
from inca_mj.studies.worlds.catalogue import effect as effect
from inca_mj.studies.worlds.change import HiddenCableElasticityDrift as HiddenCableElasticityDrift
from inca_mj.studies.worlds.change import HiddenCableElasticityJump as HiddenCableElasticityJump
from inca_mj.studies.worlds.change import HiddenDrumSpringDrift as HiddenDrumSpringDrift
from inca_mj.studies.worlds.change import HiddenDrumSpringJump as HiddenDrumSpringJump
from inca_mj.studies.worlds.change import HiddenFrictionDrift as HiddenFrictionDrift
from inca_mj.studies.worlds.change import HiddenFrictionJump as HiddenFrictionJump
from inca_mj.studies.worlds.change import HiddenTorqueConstantJump as HiddenTorqueConstantJump
from inca_mj.studies.worlds.change import HiddenViscousFrictionDrift as HiddenViscousFrictionDrift
from inca_mj.studies.worlds.change import HiddenViscousFrictionJump as HiddenViscousFrictionJump
from inca_mj.studies.worlds.drum import HiddenBacklash as HiddenBacklash
from inca_mj.studies.worlds.drum import HiddenDrumEccentricity as HiddenDrumEccentricity
from inca_mj.studies.worlds.drum import HiddenDrumLayering as HiddenDrumLayering
from inca_mj.studies.worlds.drum import HiddenDrumRadiusMismatch as HiddenDrumRadiusMismatch
from inca_mj.studies.worlds.drum import HiddenSpringHardening as HiddenSpringHardening
from inca_mj.studies.worlds.drum import HiddenSpringHysteresis as HiddenSpringHysteresis
from inca_mj.studies.worlds.effect import HiddenEffect as HiddenEffect
from inca_mj.studies.worlds.friction import HiddenAsymmetricFriction as HiddenAsymmetricFriction
from inca_mj.studies.worlds.friction import HiddenFrictionMismatch as HiddenFrictionMismatch
from inca_mj.studies.worlds.friction import (
    HiddenLoadDependentFriction as HiddenLoadDependentFriction,
)
from inca_mj.studies.worlds.friction import (
    HiddenPositionDependentFriction as HiddenPositionDependentFriction,
)
from inca_mj.studies.worlds.friction import HiddenQuadraticFriction as HiddenQuadraticFriction
from inca_mj.studies.worlds.friction import HiddenStribeckFriction as HiddenStribeckFriction
from inca_mj.studies.worlds.motor import HiddenCogging as HiddenCogging
from inca_mj.studies.worlds.motor import HiddenCurrentLag as HiddenCurrentLag
from inca_mj.studies.worlds.motor import HiddenCurrentSaturation as HiddenCurrentSaturation
from inca_mj.studies.worlds.motor import HiddenDelay as HiddenDelay
from inca_mj.studies.worlds.motor import HiddenTorqueConstantDrift as HiddenTorqueConstantDrift
from inca_mj.studies.worlds.motor import (
    HiddenTorqueConstantMismatch as HiddenTorqueConstantMismatch,
)
from inca_mj.studies.worlds.motor import HiddenTorqueRippleTime as HiddenTorqueRippleTime
from inca_mj.studies.worlds.place import HiddenAirDrag as HiddenAirDrag
from inca_mj.studies.worlds.place import HiddenAnchorOffset as HiddenAnchorOffset
from inca_mj.studies.worlds.place import HiddenComOffset as HiddenComOffset
from inca_mj.studies.worlds.place import HiddenExternalForce as HiddenExternalForce
from inca_mj.studies.worlds.place import HiddenFrameVibration as HiddenFrameVibration
from inca_mj.studies.worlds.place import HiddenPulleyRadius as HiddenPulleyRadius
from inca_mj.studies.worlds.plant import HiddenPlant as HiddenPlant
from inca_mj.studies.worlds.plant import make_plant as make_plant
from inca_mj.studies.worlds.plant import simulate_world as simulate_world
from inca_mj.studies.worlds.sensor import HiddenEncoderEccentricity as HiddenEncoderEccentricity
from inca_mj.studies.worlds.sensor import HiddenEncoderJump as HiddenEncoderJump
from inca_mj.studies.worlds.sensor import HiddenEncoderLag as HiddenEncoderLag
from inca_mj.studies.worlds.sensor import HiddenEncoderScale as HiddenEncoderScale
from inca_mj.studies.worlds.setting import EVERY as EVERY
from inca_mj.studies.worlds.setting import VARIED as VARIED
from inca_mj.studies.worlds.setting import HiddenSetting as HiddenSetting
from inca_mj.studies.worlds.setting import make_currents as make_currents
from inca_mj.studies.worlds.tolerances import AS_BUILT as AS_BUILT
from inca_mj.studies.worlds.tolerances import EXACT as EXACT
from inca_mj.studies.worlds.tolerances import Tolerances as Tolerances
from inca_mj.studies.worlds.truth import HiddenTruth as HiddenTruth
from inca_mj.studies.worlds.truth import HiddenWorld as HiddenWorld
from inca_mj.studies.worlds.world import records as records
from inca_mj.studies.worlds.world import world as world
