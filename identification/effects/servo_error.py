"""The error of a joint's position servo along a log, and its integral.

    e = u/γ - q,    z = ∫ e dt                 u: setpoint, γ: gear of the actuator, q: as measured
    u_k = a u_(k-1) + (1 - a) c_(k-1)          of an actuator that filters its command c,
    a = e^(-h/T)                               T: its time constant, h: sampling time

An integral part knows z. What was wound up before the log is not known: a window begins at z of the
log, and is free about it by how far z moves there, and by what holds `SOON` of the largest force.
"""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from identification.logs.log import Log
from identification.model.predictor import output_columns
from identification.model.tied import is_filtered, servo_kind

SOON = 0.1  # [s]: an integral part wound up for so long at the largest error was there before


def position_servo(model: mujoco.MjModel, drives: Sequence[int]) -> tuple[str, float, float]:
    """Returns the one position servo among a joint's actuators, its gear and its stiffness there.

    Returns "", 1 and 0 where there is none, and where there are several.
    """
    gains = model.actuator_gear[:, 0] ** 2 * model.actuator_gainprm[:, 0]
    servos = [i for i in drives if servo_kind(model, i) == "position" and gains[i] > 0]
    if len(servos) != 1:
        return "", 1.0, 0.0
    i = servos[0]
    return model.actuator(i).name, float(model.actuator_gear[i, 0]), float(gains[i])


def commands_of(model: mujoco.MjModel, i: int, inputs: np.ndarray, h: float) -> np.ndarray:
    """Returns u, that by which an actuator acts, at the samples of a log, shape (N,).

    Args:
        model: with the actuator.
        i: its row.
        inputs: of the log, shape (N, nu).
        h: its sampling time [s].
    """
    c = inputs[:, int(model.actuator_ctrladr[i])]
    if not is_filtered(model, i):
        return c
    from scipy.signal import lfilter  # slow to import

    a = float(np.exp(-h / max(float(model.actuator_dynprm[i, 0]), 1e-9 * h)))
    u, _ = lfilter([0.0, 1 - a], [1.0, -a], c, zi=[c[0]])
    return np.asarray(u)


def errors_of(model: mujoco.MjModel, servo: int, log: Log) -> np.ndarray | None:
    """Returns e of a servo at the samples of a log, shape (N,); None where q is not measured."""
    at = int(model.jnt_qposadr[int(model.actuator_trnid[servo, 0])])
    measured = {row: k for k, (field, row) in enumerate(output_columns(model, log.output_names))
                if field == "qpos"}  # fmt: skip
    if at not in measured:
        return None
    u = commands_of(model, servo, log.inputs, log.sampling_time)
    q = log.outputs[:, measured[at]]
    return np.asarray(u / float(model.actuator_gear[servo, 0]) - q)


def sum_where(
    model: mujoco.MjModel, servo: str, force: float, log: Log, starts: np.ndarray
) -> tuple[np.ndarray, float]:
    """Returns z where windows begin, shape (W,), and how far off it may be [rad s or m s].

    Args:
        model: with the log's sensors and inputs.
        servo: a position servo.
        force: its largest [N m or N].
        log: the record.
        starts: first samples of the windows, shape (W,).
    """
    i = int(model.actuator(servo).id)
    far, e = SOON * force / position_servo(model, [i])[2], errors_of(model, i, log)
    if e is None:
        return np.zeros(len(starts)), far
    z = np.concatenate([[0.0], np.cumsum(e[:-1])]) * log.sampling_time
    return z[starts], far + float(np.std(z))
