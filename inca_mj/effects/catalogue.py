"""All candidate effects, in the order of the design: drives, cables, platform."""

from inca_mj.effects.air_drag import AIR_DRAG
from inca_mj.effects.anchor_offset import ANCHOR_OFFSET
from inca_mj.effects.asymmetric_friction import ASYMMETRIC_FRICTION
from inca_mj.effects.backlash import BACKLASH
from inca_mj.effects.cable_creep import CABLE_CREEP
from inca_mj.effects.cable_hardening import CABLE_HARDENING
from inca_mj.effects.cable_weight import CABLE_WEIGHT
from inca_mj.effects.cogging import COGGING
from inca_mj.effects.com_offset import COM_OFFSET
from inca_mj.effects.current_lag import CURRENT_LAG
from inca_mj.effects.current_saturation import CURRENT_SATURATION
from inca_mj.effects.delay import DELAY
from inca_mj.effects.drum_eccentricity import DRUM_ECCENTRICITY
from inca_mj.effects.drum_layering import DRUM_LAYERING
from inca_mj.effects.drum_radius_mismatch import DRUM_RADIUS_MISMATCH
from inca_mj.effects.external_force import EXTERNAL_FORCE
from inca_mj.effects.friction_mismatch import FRICTION_MISMATCH
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.load_dependent_friction import LOAD_DEPENDENT_FRICTION
from inca_mj.effects.pulley_radius import PULLEY_RADIUS
from inca_mj.effects.quadratic_friction import QUADRATIC_FRICTION
from inca_mj.effects.spring_hardening import SPRING_HARDENING
from inca_mj.effects.spring_hysteresis import SPRING_HYSTERESIS
from inca_mj.effects.stribeck_friction import STRIBECK_FRICTION
from inca_mj.effects.torque_constant_drift import TORQUE_CONSTANT_DRIFT
from inca_mj.effects.torque_constant_mismatch import TORQUE_CONSTANT_MISMATCH

CATALOGUE: tuple[DriveEffect, ...] = (
    STRIBECK_FRICTION,
    ASYMMETRIC_FRICTION,
    LOAD_DEPENDENT_FRICTION,
    QUADRATIC_FRICTION,
    FRICTION_MISMATCH,
    COGGING,
    CURRENT_LAG,
    DELAY,
    CURRENT_SATURATION,
    TORQUE_CONSTANT_DRIFT,
    TORQUE_CONSTANT_MISMATCH,
    DRUM_ECCENTRICITY,
    DRUM_LAYERING,
    DRUM_RADIUS_MISMATCH,
    BACKLASH,
    SPRING_HARDENING,
    SPRING_HYSTERESIS,
    CABLE_HARDENING,
    CABLE_CREEP,
    PULLEY_RADIUS,
    CABLE_WEIGHT,
    ANCHOR_OFFSET,
    COM_OFFSET,
    EXTERNAL_FORCE,
    AIR_DRAG,
)
