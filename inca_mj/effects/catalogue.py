"""All candidate effects: those with a law of their own, then those by rule, then the encoders'."""

from identification.effects.effect import Effect
from inca_mj.effects.cable import OF_CABLES
from inca_mj.effects.change import DRIFTS, JUMPS, MISMATCHES
from inca_mj.effects.motor import OF_ENCODERS, OF_MOTORS
from inca_mj.effects.platform import OF_PLATFORM, PULL

# The order is part of the contract: the sum of the effects, and the key of their law, follow it.
CATALOGUE: tuple[Effect, ...] = (
    *OF_MOTORS, *OF_CABLES, *OF_PLATFORM, *MISMATCHES, *DRIFTS, *JUMPS, *OF_ENCODERS,
)  # fmt: skip

# What a saved twin or run may have: the candidates, and what only a simulation is given.
EVERY: tuple[Effect, ...] = (*CATALOGUE, PULL)
