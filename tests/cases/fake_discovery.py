"""Discoveries that nobody made: a second of a real robot, what is said of it written by hand."""

from dataclasses import replace
from functools import cache

import numpy as np

from identification import Predictor, fit_percent
from identification.discovery.missing_forces import MissingForce
from identification.discovery.result import (
    Detectable,
    Discovery,
    Gap,
    Named,
    Proof,
    Retuned,
    Rival,
    Tried,
)
from identification.discovery.scoring.scores import Score
from identification.effects.effect import Candidate
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Noise
from identification.kalman.point import Point
from identification.kalman.refit import Refit
from identification.model.coordinates import coordinates
from inca_mj.effects.friction import FRICTION_MISMATCH, STRIBECK_FRICTION
from inca_mj.effects.motor import DELAY
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import Twin, build_twin

EFFECTS = (STRIBECK_FRICTION, FRICTION_MISMATCH, DELAY)
SIZES = {"stribeck_friction.f_s": 0.00412345678901234, "stribeck_friction.v_s": 1.9 / 1.01}
BASE = ("b_v", "x")
NOISE = 5e-4
RETUNED = Retuned("m", 40.0, 0.0)

STRIBECK = Candidate(STRIBECK_FRICTION, "all drives", {"v_s": 2.4, "n": 2.0})
MISMATCH = Candidate(FRICTION_MISMATCH, "drive 3", {})
LATE = Candidate(DELAY, "all drives", {})
REJECTED = Tried(LATE, {"tau": (2.5e-4, 1e-4, "s")}, 4.0, Proof(-1.2, -0.7, 0.0, -0.002, 0.0))


@cache
def robot() -> Twin:
    return build_twin(effects=EFFECTS)


@cache
def truth() -> Twin:
    return robot().with_values({**SIZES, "b_v": 2.3e-4, "x": 0.01 / 3})


@cache
def log():
    run = simulate(truth(), make_input("prbs", 1.0))
    clean = run_to_log(run, "second")
    noise = NOISE * np.random.default_rng(1).standard_normal(clean.outputs.shape)
    units = {name: clean.units[name] for name in (*clean.input_names, *clean.output_names)}
    return replace(clean, outputs=clean.outputs + noise, extras={}, units=units)


def fit(values: dict[str, float]) -> Refit:
    names = (*BASE, *(n for n in values if n not in BASE))
    predictor = Predictor(robot(), log(), names)
    space = coordinates(robot().parameters, names, np.array([values[n] for n in names]))
    q = space.encode(np.array([values[n] for n in names]))
    shape = log().outputs.shape
    at = Point(predictor, space, q, np.zeros(shape), np.zeros((*shape, len(q))), None)
    return Refit(at, _level(), np.full(len(q), 0.02), q, np.zeros(len(q)), 3)


def found(verdict="named", *, one_of=False, unexplained=False, several=False) -> Discovery:
    """A discovery of the Stribeck peak that is in the log; or of nothing."""
    nominal = fit({"b_v": 2.4e-4, "x": 0.003})
    is_named = verdict == "named"
    final = fit({"b_v": 2.3e-4, "x": 0.01 / 3, **SIZES}) if is_named else nominal
    named = (_stribeck(one_of),) if is_named else ()
    if several:
        named += (
            Named(MISMATCH, {"delta": (0.2, 0.03, "")}, 0.8, (), False, 31.0, _proof(), RETUNED),
        )
    before, after = (
        f.point.predictor.predict(f.point.space.decode(f.point.q))[0] for f in (nominal, final)
    )
    scores = tuple(
        Score(c, np.array([s]), np.array([s / 9]), g, 1e-9, 1e-6, 0.5, _level())
        for c, s, g in ((STRIBECK, 0.004, 900.0), (MISMATCH, 0.2, 70.0), (LATE, 3e-4, -1.0))
    )
    return Discovery(
        log(), verdict, named, unexplained, NOISE, 0.0, _gap(before), _gap(after), nominal, final,
        before, after, scores, scores[1:],
        (Detectable(STRIBECK, "f_s", 2e-4, "N m"), Detectable(LATE, "tau", np.inf, "s")),
        ("The error grows at low speed.",), ("The error is largest at drive 3.",) * unexplained,
        () if verdict == "nothing missing" else (_pushed(),),
        {"fit": 1.5, "score": 2.0},
        rejected=(REJECTED,) if is_named else (),
    )  # fmt: skip


def _pushed() -> MissingForce:
    names = tuple(f"roller_{k}" for k in range(1, 9))
    force = 1e-3 * np.random.default_rng(5).standard_normal((50, 8))
    return MissingForce("the actuated joints", names, ("N m",) * 8, force, 812.0, 0.93)


def _stribeck(one_of: bool) -> Named:
    parameters = {
        "f_s": (SIZES["stribeck_friction.f_s"], 2.1e-4, "N m"),
        "v_s": (SIZES["stribeck_friction.v_s"], 0.1, "rad/s"),
    }
    rival = Rival(MISMATCH, 0.36 if one_of else 0.02, 0.97)
    return Named(
        STRIBECK,
        parameters,
        0.61 if one_of else 0.97,
        (rival,),
        one_of,
        900.0,
        _proof(),
        RETUNED,
    )


def _proof() -> Proof:
    return Proof(450.0, 12.0, 0.98, 0.97, 0.98)


def _level() -> NoiseLevel:
    return NoiseLevel(Noise(0.0, 0.1), NOISE, 0.0)


def _gap(predicted: np.ndarray) -> Gap:
    y, p = log().outputs[50:], predicted[50:]
    return Gap(float(np.sqrt(np.mean((y - p) ** 2))), fit_percent(y, p))
