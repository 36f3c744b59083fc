"""An effect of your own: one compiled function, one record; then ask whether a log needs it.

    Δτ = -c |φ| tanh(β ω)      the cable rubs on what is wound already

Run it: python examples/own_effect.py
"""

from dataclasses import replace
from math import tanh

import numpy as np
from numba import njit

from identification import Effect, Size, discovery_text
from inca_mj import (
    CATALOGUE,
    DRIVES_EACH,
    DriveEffect,
    build_twin,
    discover,
    make_input,
    run_to_log,
    simulate,
)


@njit
def torque(s, p):
    """Torque on a motor [N m]: s is what is known of its drive, p the effect's parameters."""
    return -p[0] * abs(s.phi) * tanh(s.beta * s.omega)


WINDING_FRICTION = DriveEffect(
    Effect(
        "winding_friction",
        law="-c |φ| tanh(β ω)",
        sizes=(Size("c", "N m/rad", largest=2e-3, probe=1e-4, sign=1, about="growth per radian"),),
        places=DRIVES_EACH,  # on all drives alike, or on one
        phrase="friction: grows with what is wound",
    ),
    torque=torque,
)


def robot_with_it(c=5e-4):
    """A twin of which the law has the effect; its parameters are called after it."""
    return build_twin(effects=[WINDING_FRICTION]).with_values({"winding_friction.c": c})


def log_with_it(seconds=10.0, c=5e-4, noise=5e-4):
    """A log of that robot under the thesis' input, with noise on its encoders [rad]."""
    clean = run_to_log(simulate(robot_with_it(c), make_input("prbs", seconds)), "own effect")
    errors = noise * np.random.default_rng(0).standard_normal(clean.outputs.shape)
    seen = (*clean.input_names, *clean.output_names)
    units = {name: clean.units[name] for name in seen}
    return replace(clean, outputs=clean.outputs + errors, extras={}, units=units)


def find(log, effects=(*CATALOGUE, WINDING_FRICTION)):
    """What the nominal model lacks of a log, the own effect among the candidates."""
    return discover(log, effects=effects)


if __name__ == "__main__":
    print(discovery_text(find(log_with_it())))
