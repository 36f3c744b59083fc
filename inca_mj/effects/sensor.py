"""Encoders that do not tell the angle of their motor.

    scale           (1 + s) φ               counts a turn are not what they are taken for
    eccentricity    φ + a cos φ + b sin φ   the disc turns about another centre
    lag             τ ẋ = φ - x, or φ(t-τ)  read too late, one encoder behind the others or all
    jump            φ + c from t_s on       counts are lost

They act on what is measured; the robot moves as if they were not there. Their laws are those of any
robot (`identification.effects.sensor_laws`). A jump is looked for as a ramp of a tenth of a second,
so that the outputs change smoothly with its time, and is then fitted as short as it is.
"""

from identification.effects import sensor_laws as laws
from identification.effects.effect import Effect, Shape, Size
from identification.effects.sensor_catalogue import KIND
from inca_mj.effects.change import LASTS, TIMES
from inca_mj.effects.hooks import DRIVES_EACH, ONE_DRIVE

ENCODER_SCALE = Effect(
    "encoder_scale",
    "(1 + s) φ",
    (Size("s", "", 0.05, 1e-3, about="relative excess of the reading"),),
    places=DRIVES_EACH,
    phrase="encoder: scale",
    reference="data sheet of the encoder",
    hooks={"reading": laws.encoder_scale},
)
ENCODER_ECCENTRICITY = Effect(
    "encoder_eccentricity",
    "φ + a cos φ + b sin φ",
    (
        Size("a", "rad", 0.02, 4e-4, about="cosine part of the error"),
        Size("b", "rad", 0.02, 4e-4, about="sine part of the error"),
    ),
    places=DRIVES_EACH,
    phrase="encoder: its disc is off centre",
    reference="data sheet of the encoder",
    hooks={"reading": laws.encoder_eccentricity},
)
ENCODER_LAG = Effect(
    "encoder_lag",
    "φ through a first-order lag τ, or φ(t - τ)",
    (Size("tau", "s", 0.02, 4e-4, sign=1, about="lag, or delay"),),
    (KIND,),
    places=DRIVES_EACH,
    phrase="encoder: lags",
    reference="data sheet of the encoder",
    hooks={"reading": laws.encoder_lag},
)
ENCODER_JUMP = Effect(
    "encoder_jump",
    "φ + c from t_s on",
    (Size("c", "rad", 0.5, 1e-3, about="what the reading jumps by"),),
    (
        Shape("t_s", "s", TIMES, 0.1, 600.0, about="time of the jump in the record", step=LASTS),
        Shape("w", "s", (LASTS,), 1e-3, 1.0, about="how long the jump takes"),
    ),
    places=ONE_DRIVE,
    phrase="encoder: its reading jumps",
    reference="data sheet of the encoder",
    hooks={"reading": laws.encoder_jump},
)
SENSORS = (ENCODER_SCALE, ENCODER_ECCENTRICITY, ENCODER_LAG, ENCODER_JUMP)
