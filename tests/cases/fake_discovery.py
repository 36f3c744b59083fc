"""Discoveries that nobody made: a second of a real robot, what is said of it written by hand."""

from dataclasses import replace
from functools import cache, partial

import numpy as np
from effect_cases import BY_NAME

from identification import Predictor, fit_percent
from identification.discovery.effect_results import (
    Detectable,
    Gap,
    Hidden,
    NamedEffect,
    Proof,
    RejectedEffect,
    Retuned,
    Rival,
    Unlogged,
)
from identification.discovery.findings.evidence import WorstInterval, WorstOutput
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.free_run import FreeRun
from identification.discovery.missing_forces import MissingForce
from identification.discovery.options import DiscoveryOptions
from identification.discovery.result import Discovery
from identification.effects.effect import Candidate
from identification.estimation.priors import Priors
from identification.innovations.recovery import recover_force
from identification.innovations.scoring.scores import Score
from identification.kalman.linear import linearise
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Noise
from identification.kalman.point import Point
from identification.kalman.refit import Refit
from identification.model.coordinates import coordinates
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import Twin, build_twin
from inca_mj.workflows.discovery_files import TwinDiscoveryFiles

EFFECTS = tuple(BY_NAME[name] for name in ("stribeck_friction", "friction_mismatch", "delay"))
SIZES = {"stribeck_friction.f_s": 0.00412345678901234, "stribeck_friction.v_s": 1.9 / 1.01}
BASE = ("b_v", "x")
NOISE = 5e-4
RETUNED = Retuned("m", 40.0, 0.0)

STRIBECK = Candidate(EFFECTS[0], "all drives", {"v_s": 2.4, "n": 2.0})
MISMATCH = Candidate(EFFECTS[1], "drive 3", {})
LATE = Candidate(EFFECTS[2], "all drives", {})
WORSE = Proof(gain=-1.2, t=-0.7, chance=0.75, blocks=20, share=0.0, fall=-0.002, above=0.0)
REJECTED = RejectedEffect(LATE, {"tau": (2.5e-4, 1e-4, "s")}, 4.0, WORSE)
SLOW = Finding(FindingKind.WORST_INTERVAL, WorstInterval(0.2, 0.3, 0.4))
DRIVE_3 = Finding(FindingKind.WORST_OUTPUT, WorstOutput("angle_3", "rad", 2e-3, 0.5, 4.0))


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
    return _fit(tuple(values.items()))


@cache
def _fit(items: tuple[tuple[str, float], ...]) -> Refit:
    values = dict(items)
    names = (*BASE, *(n for n in values if n not in BASE))
    predictor = Predictor(robot(), log(), names)
    space = coordinates(robot().parameters, names, np.array([values[n] for n in names]))
    q = space.encode(np.array([values[n] for n in names]))
    shape, p = log().outputs.shape, len(q)
    e, J = np.zeros(shape), np.zeros((*shape, p))
    linear = linearise(predictor, space.decode(q))
    point = Point(predictor=predictor, space=space, q=q, e=e, J=J, linear=linear)
    std, prior = np.full(p, 0.02), np.zeros(p)
    return Refit(point=point, level=_level(), std=std, priors=Priors(space, q, prior), steps=3)


class ByHand(FreeRun):
    """What a discovery computes when it is asked for is written by hand too."""

    def located(self, forces):
        return (SLOW,)

    def missing_forces(self):
        return (_pushed(),)


@cache
def found(verdict="named", *, one_of=False, unexplained=False, several=False) -> Discovery:
    """A discovery of the Stribeck peak that is in the log; or of nothing."""
    nominal = fit({"b_v": 2.4e-4, "x": 0.003})
    is_named = verdict == "named"
    final = fit({"b_v": 2.3e-4, "x": 0.01 / 3, **SIZES}) if is_named else nominal
    named = (_stribeck(one_of),) if is_named else ()
    if several:
        named += (_mismatch(),)
    before, after = (
        f.point.predictor.predict(f.point.space.decode(f.point.q))[0] for f in (nominal, final)
    )
    scores = tuple(
        score_of(c, s, g)
        for c, s, g in ((STRIBECK, 0.004, 900.0), (MISMATCH, 0.2, 70.0), (LATE, 3e-4, -1.0))
    )
    gap = _gap(before)
    if verdict == "nothing missing":  # what is left is then noise
        gap = replace(gap, rms=1.1 * NOISE)
    run = ByHand(log(), nominal, final, log().outputs - before, log().outputs - after)
    return Discovery(
        records=run.records, options=DiscoveryOptions(), verdict=verdict, named=named,
        rejected=(REJECTED,) if is_named else (), unexplained=unexplained, share=0.98,
        unit="rad", noise_rms=NOISE, disturbance_rms=0.0, input_error=0.0, at_bound=(),
        unlogged=Unlogged(0.01, "A", 0.1, True), before=gap, after=_gap(after),
        errors=run.errors, nominal=nominal, final=final, run=run,
        recover=partial(recover_force, final), scores=scores, remaining=scores[1:],
        scored_by="gain",
        hidden=(Hidden(MISMATCH, {"delta": (0.002, 0.006, "")}, 0.3, 4.0),),
        detectable=(Detectable(STRIBECK, "f_s", 2e-4, "N m"), Detectable(LATE, "tau", np.inf, "s")),
        findings=(DRIVE_3,) * unexplained, seconds={"fit": 1.5, "score": 2.0}, took=3.5,
        files_of=TwinDiscoveryFiles,
    )  # fmt: skip


def score_of(candidate: Candidate, size: float, gain: float) -> Score:
    return Score(
        candidate=candidate, size=np.array([size]), std=np.array([size / 9]), gain=gain,
        p_value=1e-6, identifiable=0.5, level=_level(),
    )  # fmt: skip


def _pushed() -> MissingForce:
    names, units = tuple(f"motor_{k}" for k in range(1, 9)), ("N m",) * 8
    force = 1e-3 * np.random.default_rng(5).standard_normal((50, 8))
    where = "the actuated joints"
    return MissingForce(where=where, names=names, units=units, force=force, gain=812.0, share=0.93)


def _mismatch() -> NamedEffect:
    return NamedEffect(
        candidate=MISMATCH, parameters={"delta": (0.2, 0.03, "")}, confidence=0.8, rivals=(),
        compared=0, one_of=False, bic_gain=31.0, proof=_proof(), retuned=RETUNED,
    )  # fmt: skip


def _stribeck(one_of: bool) -> NamedEffect:
    parameters = {
        "f_s": (SIZES["stribeck_friction.f_s"], 2.1e-4, "N m"),
        "v_s": (SIZES["stribeck_friction.v_s"], 0.1, "rad/s"),
    }
    rival = Rival(MISMATCH, 0.36 if one_of else 0.02, 0.97)
    return NamedEffect(
        candidate=STRIBECK, parameters=parameters, confidence=0.61 if one_of else 0.97,
        rivals=(rival,), compared=1, one_of=one_of, bic_gain=900.0, proof=_proof(), retuned=RETUNED,
    )  # fmt: skip


def _proof() -> Proof:
    return Proof(gain=450.0, t=12.0, chance=2**-20, blocks=20, share=0.98, fall=0.97, above=0.98)


def _level() -> NoiseLevel:
    return NoiseLevel(Noise(0.0, 0.1), NOISE, 0.0)


def _gap(predicted: np.ndarray) -> Gap:
    y, p = log().outputs[50:], predicted[50:]
    return Gap(float(np.sqrt(np.mean((y - p) ** 2))), fit_percent(y, p))
