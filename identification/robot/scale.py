"""Are angles in radians and positions in metres? Forces tell, whatever else the model lacks.

    η(y) > 1      however light, friction, gravity, payload and springs may be, more is left of the
                  balance of forces than the drives gave

The balance is that of `identification.robot.balance`, where masses may be off by a factor of four,
and with springs, which the model may lack too. A smaller motion needs less force for its masses,
and all else that it needs is free in the balance. So only a motion that is too large for the forces
has η > 1: where inertia needs all of them, a model that is more than eight times too heavy would be
needed for as much. Such a log is refused where another unit leaves far less. A motion that is
rougher than its noise (the steps of an encoder) has false accelerations: ψ is made wider too, and
the smallest η counts. No model is simulated, so that a payload that it lacks bars nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import chain

import mujoco
import numpy as np

from identification.logs.double_readings import turned_units
from identification.logs.factor_readings import factor_readings
from identification.logs.log import Log
from identification.logs.readings import EXPLAINED, NEARER, Reading, unit_readings
from identification.quantities import held
from identification.robot.balance import Freedom, unbalanced_share
from identification.robot.model_units import UNITS

FREEDOM = Freedom(has_springs=True)
WIDER = (1, 2, 4)  # times ψ; a fourfold one has 32 times less noise in its accelerations
DIGITS = 6  # of a change; a factor of 1000 and the unit mrad are the same one
NEEDED = 1.0  # η of a motion that the drives cannot have made


def rescaled(
    model: mujoco.MjModel,
    log: Log,
    column: Mapping[str, str],
    signs: bool = True,
    alone: bool = True,
) -> tuple[Reading, str] | None:
    """Returns the unit in which the forces of the drives explain a motion that they else cannot.

    A unit with a sign that is turned counts where it leaves less than a fifth of the unit alone.

    Args:
        model: with the log's actuators and sensors.
        log: as it is read.
        column: what an output or input is called in the log's file.
        signs: whether a sign may be turned besides.
        alone: whether one column of several of a kind may be in another unit.

    Returns:
        Of the units that explain it the one that changes least, if none leaves a fifth of it, and
        in words what it explains; None where the motion can be as it is read.
    """
    own = _least_share(model, log)
    if own is None or own.max() <= NEEDED:
        return None
    found: list[tuple[Reading, np.ndarray]] = []
    every = np.ones(len(own), bool)
    both = turned_units(log, every, column) if signs else ()
    factors = factor_readings(log, every, column)
    for reading in chain(factors, unit_readings(log, every, column, alone=alone), both):
        left = unbalanced_share(model, reading.log, FREEDOM)
        if left is None or left.max() > EXPLAINED or left.sum() > NEARER * own.sum():
            continue
        found.append((reading, left))
    if not found:
        return None
    least = min(left.sum() for _, left in found)
    near = [(r, left) for r, left in found if NEARER * left.sum() <= least]
    # Rounded, so that of two readings that are the same the first one counts.
    reading, left = min(near, key=lambda each: round(_change(each[0].log, log), DIGITS))
    times = held(float(np.sqrt(own.max())))
    return reading, (
        f"needs forces {times} times those of the drives for this motion, whatever"
        f" payload and friction it has, and explains {100 * (1 - left.max()):.0f} % of them"
        f" {reading.said}; {reading.cure} (where the outputs are right, the inputs are in a larger"
        " unit: write that of the inputs)"
    )


def wanted_units(model: mujoco.MjModel, log: Log) -> dict[str, str]:
    """Returns SI units of the inputs that drives compare with their joint's own motion, by name.

    Args:
        model: with the log's actuators.
        log: its inputs are the actuators, in order.
    """
    found = {}
    for i, name in enumerate(log.input_names):
        gain, bias = float(model.actuator_gainprm[i, 0]), model.actuator_biasprm[i]
        is_joint = model.actuator_trntype[i] == int(mujoco.mjtTrn.mjTRN_JOINT)
        is_affine = model.actuator_biastype[i] == int(mujoco.mjtBias.mjBIAS_AFFINE)
        if not (is_joint and is_affine and gain > 0):
            continue
        kind = int(model.jnt_type[model.actuator_trnid[i, 0]])
        place = (int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE))
        if kind in place and -gain in (bias[1], bias[2]):
            found[name] = UNITS["qpos" if bias[1] == -gain else "qvel"][place.index(kind)]
    return found


def _change(other: Log, log: Log) -> float:
    """Returns how far another reading is from a log: Σ |ln factor| over its columns."""
    pairs = (other.outputs, log.outputs), (other.inputs, log.inputs)
    sizes = [[np.abs(x).max(axis=0) for x in pair] for pair in pairs]
    return sum(float(np.abs(np.log(a[b > 0] / b[b > 0])).sum()) for a, b in sizes)


def _least_share(model: mujoco.MjModel, log: Log) -> np.ndarray | None:
    """Returns η of each output (ny,), of the ψ that leaves least; None where it cannot be had."""
    best: np.ndarray | None = None
    for wider in WIDER:
        left = unbalanced_share(model, log, replace(FREEDOM, wider=wider))
        if left is None:
            return best
        if best is None or left.max() < best.max():
            best = left
        if best.max() <= NEEDED:
            return best
    return best
