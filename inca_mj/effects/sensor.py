"""Encoders that do not tell the angle of their motor.

    scale           (1 + s) φ               counts a turn are not what they are taken for
    eccentricity    φ + a cos φ + b sin φ   the disc turns about another centre
    lag             φ - τ ω                 read too late, one encoder behind the others or all

They act on what is measured; the robot moves as if they were not there. Their laws are those of any
robot (`identification.effects.sensor_laws`).
"""

from identification.effects import sensor_laws as laws
from identification.effects.effect import Effect, Size
from inca_mj.effects.hooks import DRIVES_EACH

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
    "φ - τ ω",
    (Size("tau", "s", 0.02, 4e-4, about="lag"),),
    places=DRIVES_EACH,
    phrase="encoder: lags",
    reference="data sheet of the encoder",
    hooks={"reading": laws.encoder_lag},
)
SENSORS = (ENCODER_SCALE, ENCODER_ECCENTRICITY, ENCODER_LAG)
