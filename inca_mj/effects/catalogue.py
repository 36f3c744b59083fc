"""All candidate effects: those with a law of their own, then those by rule, then the sensors'."""

from identification.effects.effect import Effect
from inca_mj.effects.cable import CABLE_CREEP, CABLE_HARDENING, CABLE_WEIGHT
from inca_mj.effects.change import DRIFTS, JUMPS, MISMATCHES
from inca_mj.effects.drum import (
    BACKLASH,
    DRUM_ECCENTRICITY,
    DRUM_LAYERING,
    SPRING_HARDENING,
    SPRING_HYSTERESIS,
)
from inca_mj.effects.friction import (
    ASYMMETRIC_FRICTION,
    LOAD_DEPENDENT_FRICTION,
    QUADRATIC_FRICTION,
    STRIBECK_FRICTION,
)
from inca_mj.effects.motor import (
    COGGING,
    CURRENT_CROSSTALK,
    CURRENT_LAG,
    CURRENT_OFFSET,
    CURRENT_SATURATION,
    DELAY,
)
from inca_mj.effects.place import (
    AIR_DRAG,
    ANCHOR_OFFSET,
    COM_OFFSET,
    EXTERNAL_FORCE,
    PULL,
    PULLEY_RADIUS,
)
from inca_mj.effects.sensor import SENSORS

CATALOGUE: tuple[Effect, ...] = (
    STRIBECK_FRICTION,
    ASYMMETRIC_FRICTION,
    LOAD_DEPENDENT_FRICTION,
    QUADRATIC_FRICTION,
    COGGING,
    DELAY,  # what acts on the currents, in the order in which they pass it
    CURRENT_SATURATION,
    CURRENT_LAG,
    CURRENT_OFFSET,
    CURRENT_CROSSTALK,
    DRUM_ECCENTRICITY,
    DRUM_LAYERING,
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
    *MISMATCHES,
    *DRIFTS,
    *JUMPS,
    *SENSORS,
)

# What a saved twin or run may have: the candidates, and what only a simulation is given.
EVERY: tuple[Effect, ...] = (*CATALOGUE, PULL)
