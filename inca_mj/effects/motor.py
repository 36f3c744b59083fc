"""Motors: their frictions, their currents, and the encoders that measure them.

Torques Δτ on the motor [N m], with the smooth sign tanh(β ω):

    stribeck friction          -f_s exp(-|ω/v_s|^n) tanh(β ω)   a peak of friction at low speed
    asymmetric friction        -f_a |tanh(β ω)|                 brakes winding in, helps paying out
    load-dependent friction    -μ R T tanh(β ω)                 bearings rub with the tension
    quadratic friction         -c ω |ω|^(n-1)                   air that the roller stirs
    cogging                    a cos(n φ) + b sin(n φ)          the magnets prefer angles

Currents [A]. Delay, saturation and lag act before the model, in this order: what an amplifier
limits is what its current loop is asked for. Delay and lag have the laws of any robot
(`identification.effects.laws.inputs`). A limit has no size that is zero when it is absent, so that
the size of the saturation is a share of the clipping: 0 is none, 1 is a real limit.

    delay                      i(t) = u(t - τ)                  the current arrives late
    saturation                 i + c (clip(i, ±i_max) - i)      or i_max tanh(i/i_max) where soft
    current lag                τ i̇ = u - i                      the current loop is a filter
    current offset             i + c                            its measurement has another zero
    current crosstalk          i_k + a i_(k-1) + b i_(k+1)      its cable lies beside others

Encoders change what is measured; the robot moves as if they were not there. Their laws are those of
any robot (`identification.effects.laws.sensors`). A jump is looked for as a ramp of a tenth of a
second, so that the outputs change smoothly with its time, and is then fitted as short as it is.

    scale                      (1 + s) φ                        counts a turn are not as taken for
    eccentricity               φ + a cos φ + b sin φ            the disc turns about another centre
    lag                        τ ẋ = φ - x, or φ(t-τ)           read too late, one or all
    jump                       φ + c from t_s on                counts are lost
"""

from math import cos, exp, sin, tanh

from numba import njit

from identification.effects.effect import Effect
from identification.effects.laws import sensors
from identification.effects.laws.inputs import BEFORE
from identification.effects.laws.inputs import DELAY as DELAYED
from identification.effects.laws.inputs import LAG as LAGGED
from identification.effects.sizes import Shape, Size
from inca_mj.effects.change import LASTS, TIMES
from inca_mj.effects.hooks import DRIVES_EACH, ONE_DRIVE, by_law

# Limits to try [A]: dense where a log of the thesis has its currents, then by a factor of 1.4.
GRID = (0.55, 0.65, 0.75, 0.85, 0.95, 1.2, 1.7, 2.4, 3.4, 4.8)
_AMPLIFIER, _ENCODER = "data sheet of the amplifier", "data sheet of the encoder"


@njit
def stribeck_friction(s, p):
    f_s, v_s, n = p
    return -f_s * exp(-(abs(s.omega / v_s) ** n)) * tanh(s.beta * s.omega)


@njit
def asymmetric_friction(s, p):
    return -p[0] * abs(tanh(s.beta * s.omega))


@njit
def load_dependent_friction(s, p):
    return -p[0] * s.R * s.T * tanh(s.beta * s.omega)


@njit
def quadratic_friction(s, p):
    c, n = p
    return -c * s.omega * abs(s.omega) ** (n - 1)


@njit
def cogging(s, p):
    a, b, n = p
    return a * cos(n * s.phi) + b * sin(n * s.phi)


@njit
def current_saturation(s, p):
    c, i_max, soft = p
    limited = i_max * tanh(s.u / i_max) if soft else max(-i_max, min(i_max, s.u))
    return s.u + c * (limited - s.u), 0.0


@njit
def current_offset(s, p):
    return p[0]


@njit
def current_crosstalk(s, p):
    return p[0] * s.i_before + p[1] * s.i_after


OF_MOTORS = (
    by_law(stribeck_friction, "torque", "-f_s exp(-|ω/v_s|^n) tanh(β ω)",
           (Size("f_s", "N m", 0.02, 1e-3, sign=1, about="height of the peak, but for tanh(βω)"),),
           (Shape("v_s", "rad/s", (0.3, 0.6, 1.2, 2.4, 5.0), 0.05, 20.0,
                  about="rate at which it has fallen to 1/e"),
            Shape("n", "", (1.0, 2.0), 0.5, 3.0, free=False, about="the power")),
           phrase="friction: Stribeck peak",
           reference="Armstrong-Hélouvry, Dupont, Canudas de Wit 1994"),
    by_law(asymmetric_friction, "torque", "-f_a |tanh(β ω)|",
           (Size("f_a", "N m", 0.003, 2e-4,
                 about="friction winding in, less the mean of both ways"),),
           phrase="friction: more in one direction", reference="Janot, Gautier, Brunot 2019"),
    by_law(load_dependent_friction, "torque", "-μ R T tanh(β ω)",
           (Size("mu", "", 0.1, 1e-4, sign=1, about="friction per load torque"),),
           phrase="friction: grows with the tension",
           reference="Torres-Charry, Gómez-Mendoza 2022"),
    by_law(quadratic_friction, "torque", "-c ω |ω|, or another power of |ω|",
           (Size("c", "N m s²/rad²", 1e-5, 2e-8, sign=1, about="friction per power of speed"),),
           (Shape("n", "", (1.5, 2.0, 3.0), 1.2, 4.0, free=False, about="the power"),),
           phrase="friction: grows with the square of the speed",
           reference="Olsson, Åström, Canudas de Wit, Gäfvert, Lischinsky 1998"),
    by_law(cogging, "torque", "a cos(n φ) + b sin(n φ)",
           (Size("a", "N m", 0.02, 1e-4, about="cosine part of the torque"),
            Size("b", "N m", 0.02, 1e-4, about="sine part of the torque")),
           (Shape("n", "", tuple(map(float, range(1, 25))), 1.0, 400.0, free=False,
                  about="harmonic"),),
           phrase="motor: cogging torque", reference="Holtz, Springob 1996"),
    # What acts on the currents, in the order in which they pass it. Probes of delay and lag reach
    # to the largest ones: the outputs follow them only nearly in proportion.
    Effect("delay", "pure delay of the input",
           (Size("tau", "s", 0.02, 5e-4, sign=1, about="delay"),), (BEFORE,), places=DRIVES_EACH,
           phrase="motor: current comes late", reference="Åström, Hägglund 2006",
           probes=(1.0, 40**0.5, 40.0), hooks=DELAYED),
    by_law(current_saturation, "input", "i clipped at ±i_max, or i_max tanh(i/i_max)",
           (Size("c", "", 1.0, 0.02, sign=1, present=1.0,
                 about="share of the clipping, 1 when there is a limit"),),
           (Shape("i_max", "A", GRID, 0.05, 20.0, about="the limit"),
            Shape("soft", "", (0.0, 1.0), 0.0, 1.0, free=False, usual=0.0,
                  about="1: it bends, does not clip",
                  words=("it clips", "it bends and does not clip"))),
           phrase="motor: current clipped", reference=_AMPLIFIER),
    Effect("current_lag", "first-order lag τ of the current loop",
           (Size("tau", "s", 0.01, 5e-4, sign=1, about="time constant"),), (BEFORE,),
           places=DRIVES_EACH, phrase="motor: current lags", reference="Krishnan 2010",
           probes=(1.0, 20**0.5, 20.0), hooks=LAGGED),
    by_law(current_offset, "current", "i + c on one drive",
           (Size("c", "A", 0.1, 1e-3, about="what the motor gets beyond the logged current"),),
           places=ONE_DRIVE, phrase="current: its measurement has an offset",
           reference=_AMPLIFIER),
    by_law(current_crosstalk, "current", "i_k + a i_(k-1) + b i_(k+1)",
           (Size("a", "", 0.1, 2e-3, about="share of the current of the drive before it"),
            Size("b", "", 0.1, 2e-3, about="share of the current of the drive behind it")),
           phrase="current: its measurement has some of those beside it", reference=_AMPLIFIER),
)  # fmt: skip
OF_ENCODERS = (
    by_law(sensors.encoder_scale, "reading", "(1 + s) φ",
           (Size("s", "", 0.05, 1e-3, about="relative excess of the reading"),),
           phrase="encoder: scale", reference=_ENCODER),
    by_law(sensors.encoder_eccentricity, "reading", "φ + a cos φ + b sin φ",
           (Size("a", "rad", 0.02, 4e-4, about="cosine part of the error"),
            Size("b", "rad", 0.02, 4e-4, about="sine part of the error")),
           phrase="encoder: its disc is off centre", reference=_ENCODER),
    by_law(sensors.encoder_lag, "reading", "φ through a first-order lag τ, or φ(t - τ)",
           (Size("tau", "s", 0.02, 4e-4, sign=1, about="lag, or delay"),), (sensors.KIND,),
           phrase="encoder: lags", reference=_ENCODER),
    by_law(sensors.encoder_jump, "reading", "φ + c from t_s on",
           (Size("c", "rad", 0.5, 1e-3, about="what the reading jumps by"),),
           (Shape("t_s", "s", TIMES, 0.1, 600.0, about="time of the jump in the record",
                  step=LASTS),
            Shape("w", "s", (LASTS,), 1e-3, 1.0, about="how long the jump takes")),
           places=ONE_DRIVE, phrase="encoder: its reading jumps", reference=_ENCODER),
)  # fmt: skip
