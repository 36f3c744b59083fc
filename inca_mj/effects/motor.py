"""Motors and their currents.

    cogging                    Δτ = a cos(n φ) + b sin(n φ)     the rotor's magnets prefer angles
    delay                      i(t) = u(t - τ)                  the current arrives late
    saturation                 i clipped at ±i_max, or i_max tanh(i/i_max)
    current lag                τ i̇ = u - i                      the current loop is a filter
    current offset             i + c                            its measurement has another zero
    current crosstalk          i_k + a i_(k-1) + b i_(k+1)      its cable lies beside others

Delay, saturation and lag act on the currents before they reach the model, in this order: what an
amplifier limits is what its current loop is asked for. Delay and lag have the laws of any robot
(`identification.effects.input_laws`). A limit has no size that is zero when it is absent, so that
the size of the saturation is a share of the clipping: 0 is none, 1 is a real limit.
"""

from math import cos, sin, tanh

from numba import njit

from identification.effects.effect import BEFORE, Effect, Shape, Size
from identification.effects.input_laws import DELAY as DELAYED
from identification.effects.input_laws import LAG as LAGGED
from inca_mj.effects.hooks import DRIVES_EACH, ONE_DRIVE

# Limits to try [A]: dense where a log of the thesis has its currents, then by a factor of 1.4.
GRID = (0.55, 0.65, 0.75, 0.85, 0.95, 1.2, 1.7, 2.4, 3.4, 4.8)


@njit
def cogging(s, p):  # type: ignore[no-untyped-def]
    """Δτ = a cos(n φ) + b sin(n φ) [N m]."""
    a, b, n = p
    return a * cos(n * s.phi) + b * sin(n * s.phi)


@njit
def current_saturation(s, p):  # type: ignore[no-untyped-def]
    """i + c (clip(i, ±i_max) - i), or with i_max tanh(i/i_max) where soft [A], and no moment."""
    c, i_max, soft = p
    limited = i_max * tanh(s.u / i_max) if soft else max(-i_max, min(i_max, s.u))
    return s.u + c * (limited - s.u), 0.0


@njit
def current_offset(s, p):  # type: ignore[no-untyped-def]
    """Δi = c [A]."""
    return p[0]


@njit
def current_crosstalk(s, p):  # type: ignore[no-untyped-def]
    """Δi_k = a i_(k-1) + b i_(k+1) [A]."""
    return p[0] * s.i_before + p[1] * s.i_after


COGGING = Effect(
    "cogging",
    "a cos(n φ) + b sin(n φ)",
    (
        Size("a", "N m", 0.02, 1e-4, about="cosine part of the torque"),
        Size("b", "N m", 0.02, 1e-4, about="sine part of the torque"),
    ),
    (Shape("n", "", tuple(map(float, range(1, 25))), 1.0, 400.0, free=False, about="harmonic"),),
    places=DRIVES_EACH,
    phrase="motor: cogging torque",
    reference="Holtz, Springob 1996",
    hooks={"torque": cogging},
)
CURRENT_LAG = Effect(
    "current_lag",
    "first-order lag τ of the current loop",
    (Size("tau", "s", 0.01, 5e-4, sign=1, about="time constant"),),
    (BEFORE,),
    places=DRIVES_EACH,
    phrase="motor: current lags",
    reference="Krishnan 2010",
    probes=(1.0, 20**0.5, 20.0),  # to the largest: the outputs follow it only nearly
    hooks=LAGGED,
)
DELAY = Effect(
    "delay",
    "pure delay of the input",
    (Size("tau", "s", 0.02, 5e-4, sign=1, about="delay"),),
    (BEFORE,),
    places=DRIVES_EACH,
    phrase="motor: current comes late",
    reference="Åström, Hägglund 2006",
    probes=(1.0, 40**0.5, 40.0),  # to the largest: the outputs follow it only nearly
    hooks=DELAYED,
)
CURRENT_SATURATION = Effect(
    "current_saturation",
    "i clipped at ±i_max, or i_max tanh(i/i_max)",
    (
        Size("c", "", 1.0, 0.02, sign=1, present=1.0,
             about="share of the clipping, 1 when there is a limit"),
    ),
    (
        Shape("i_max", "A", GRID, 0.05, 20.0, about="the limit"),
        Shape("soft", "", (0.0, 1.0), 0.0, 1.0, free=False, usual=0.0,
              about="1: it bends, does not clip"),
    ),
    places=DRIVES_EACH,
    phrase="motor: current clipped",
    reference="data sheet of the amplifier",
    hooks={"input": current_saturation},
)  # fmt: skip
CURRENT_OFFSET = Effect(
    "current_offset",
    "i + c on one drive",
    (Size("c", "A", 0.1, 1e-3, about="what the motor gets beyond the logged current"),),
    places=ONE_DRIVE,
    phrase="current: its measurement has an offset",
    reference="data sheet of the amplifier",
    hooks={"current": current_offset},
)
CURRENT_CROSSTALK = Effect(
    "current_crosstalk",
    "i_k + a i_(k-1) + b i_(k+1)",
    (
        Size("a", "", 0.1, 2e-3, about="share of the current of the drive before it"),
        Size("b", "", 0.1, 2e-3, about="share of the current of the drive behind it"),
    ),
    places=DRIVES_EACH,
    phrase="current: its measurement has some of those beside it",
    reference="data sheet of the amplifier",
    hooks={"current": current_crosstalk},
)
