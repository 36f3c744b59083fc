"""The effects of sensors: what a reading differs by from what a perfect sensor would say.

    y' = y + Σ_e reading_e(s, p_e)                        s: the `Reading` state of a sensor

They act on the predicted outputs, after the simulation: the robot moves as if they were not there.
Between two samples at t_0 and t_1 = t_0 + h the joint is at

    q(t_0 + u h) = (1 + 2u)(1 - u)² q_0 + u (1 - u)² h v_0 + u² (3 - 2u) q_1 - u² (1 - u) h v_1

which is the cubic with the positions and rates of both (Hermite). A first-order lag of it,
τ ẋ = q - x, is over that interval

    x(t) = p(t) + (x(t_0) - p(t_0)) e^(-(t - t_0)/τ),    p = q - τ q' + τ² q'' - τ³ q'''
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Sequence
from functools import cache
from math import exp
from typing import Any

from numba import types

from identification.native.cache import compile_once
from identification.native.compose import total
from identification.native.element import Element, Hook, Term, refuse_unfit_functions
from identification.native.memory import internal, load_double, store_double

# What an effect sees of a sensor at a sample.
#   y: what a perfect sensor would say [rad, m, rad/s or m/s]
#   q, v: position [rad or m] and rate [rad/s or m/s] of the joint that it measures
#   time: of the record [s]
#   k: number of the sample; signals: address of y, q, v and time of all samples, which
#   `position_at` reads; samples: their number
Reading: Any = namedtuple("Reading", "y q v time k signals samples")

SENSOR = Element(
    "sensor",
    Reading,
    (Hook("reading", ("what is added to the reading, in its unit",)),),
    integers=("k", "signals", "samples"),
)

FORGOTTEN = 25.0  # time constants after which a lag has forgotten: e^-25 is 1e-11
_SIGNATURE = types.void(types.int64, types.int64, types.int64)


@internal
def position_at(s, time):
    """Returns the joint's position at a time of the record; beyond its ends it moves steadily."""
    q, v, t = [s.signals + 8 * s.samples * i for i in (1, 2, 3)]
    k = s.k
    while k > 0 and time < load_double(t + 8 * k):
        k -= 1
    while k + 1 < s.samples and time >= load_double(t + 8 * (k + 1)):
        k += 1
    t_0, q_0, v_0 = load_double(t + 8 * k), load_double(q + 8 * k), load_double(v + 8 * k)
    if k + 1 == s.samples or time < t_0:
        return q_0 + v_0 * (time - t_0)
    h, q_1 = load_double(t + 8 * (k + 1)) - t_0, load_double(q + 8 * (k + 1))
    v_1, u = load_double(v + 8 * (k + 1)), (time - t_0) / h
    here = (1 + 2 * u) * (1 - u) ** 2 * q_0 + u * (1 - u) ** 2 * h * v_0
    return here + u**2 * (3 - 2 * u) * q_1 - u**2 * (1 - u) * h * v_1


@internal
def lagged_position(s, tau):
    """Returns the joint's position after a first-order lag; before the record it moved steadily."""
    q, v, t = [s.signals + 8 * s.samples * i for i in (1, 2, 3)]
    k, now = s.k, load_double(t + 8 * s.k)
    while k > 0 and now - load_double(t + 8 * k) < FORGOTTEN * tau:
        k -= 1
    x = load_double(q + 8 * k) - tau * load_double(v + 8 * k)
    while k < s.k:
        h = load_double(t + 8 * (k + 1)) - load_double(t + 8 * k)
        q_0, q_1 = load_double(q + 8 * k), load_double(q + 8 * (k + 1))
        v_0, v_1 = load_double(v + 8 * k), load_double(v + 8 * (k + 1))
        mean = (q_1 - q_0) / h
        a_0, a_1 = (6 * mean - 4 * v_0 - 2 * v_1) / h, (2 * v_0 + 4 * v_1 - 6 * mean) / h
        jerk = (a_1 - a_0) / h
        begin = q_0 - tau * (v_0 - tau * (a_0 - tau * jerk))
        end = q_1 - tau * (v_1 - tau * (a_1 - tau * jerk))
        x = end + (x - begin) * exp(-h / tau)
        k += 1
    return x


@cache
def sensor_filter(terms: Sequence[Term]) -> Any:
    """Returns the compiled effects of a sensor.

    Returns:
        (signals, samples, row): a ctypes function. `signals` is the address of an array of shape
        (5, samples): y, q, v, time, and y', which is written. `row` is the address of the effects'
        parameters.
    """
    reading = total(SENSOR, terms, "reading")

    def sensor(signals, samples, row):
        q, v, time, out = [signals + 8 * samples * i for i in (1, 2, 3, 4)]
        for k in range(samples):
            y = load_double(signals + 8 * k)
            s = Reading(
                y=y,
                q=load_double(q + 8 * k),
                v=load_double(v + 8 * k),
                time=load_double(time + 8 * k),
                k=k,
                signals=signals,
                samples=samples,
            )
            store_double(out + 8 * k, y + reading(s, row, 0))

    try:
        return compile_once(sensor, _SIGNATURE)
    except Exception:
        refuse_unfit_functions(SENSOR, terms)
        raise
