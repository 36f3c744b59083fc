"""What smooth forces explain is measured in the units of what laws took away."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from arm_cases import LOG, text

from identification.discovery.nominal_model import NominalModel
from identification.effects.effect import Candidate
from identification.effects.plant.joint_plant import candidates, joint_plant
from identification.model.parameter import Parameter
from identification.model.predictor import Predictor
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.prediction.judging.extension import with_effect
from identification.prediction.scoring.first_fit import begin
from identification.prediction.scoring.scores import window_scores
from identification.prediction.verdict.yardstick import measure
from identification.windows.point import linearised
from identification.windows.problem import with_scale
from identification.windows.records import as_records

HORIZON, NOISE = 0.2, 3e-4
FREE = Parameter(
    name="d", value=0.05, unit="N m s/rad", where="joint/elbow.damping", lower=0.0, upper=1.0
)
TRUTH = {"coulomb_friction.f_c@elbow": 0.3, "hardening.k_3@shoulder": 0.6}


@cache
def plant():
    return joint_plant(text(0.002, "implicitfast"), (FREE,), LOG)


def record(seed, truth=TRUTH, samples=300):
    rng = np.random.default_rng(seed)
    u = np.repeat(rng.uniform(-1, 1, (samples // 20, 2)) * (4.0, 1.5), 20, axis=0)
    log = replace(LOG, time=0.01 * np.arange(samples), inputs=u, outputs=np.zeros((samples, 2)))
    y = Predictor(plant(), log, tuple(truth)).predict(np.array([[*truth.values()]]))[0]
    return replace(log, outputs=y + NOISE * rng.standard_normal(y.shape), name=f"record {seed}")


def fitted(truth):
    roles = as_records([record(1, truth), record(2, truth)], [record(3, truth)])
    return roles, fit_nominal(NominalModel(plant(), ("d",), np.array([0.5]), HORIZON), roles)


@cache
def rubbed():
    """The model with the friction of the elbow, and without what is left at the shoulder."""
    roles, nominal = fitted(TRUTH)
    law = next(e for e in candidates(plant(), ("d",)) if e.name == "coulomb_friction")
    (best,) = window_scores(nominal.fit, [Candidate(law, "joint elbow", {})])
    confirm = [r for r in roles if r.role == "confirm"]
    return with_effect(nominal, begin(nominal, [best]), HORIZON, confirm)


def test_a_fit_in_other_units_is_the_linearisation_in_these_units():
    fit, scale = rubbed().fit, rubbed().scale * (0.3, 2.0)
    seen = fit.weighed(scale)
    slow = linearised(with_scale(fit.problem, scale), fit.q, fit.moves, 1e-4)
    for a, b in zip(seen.tangents, slow.tangents, strict=True):
        for mine, theirs in zip(a.projected, b.projected, strict=True):
            np.testing.assert_allclose(mine, theirs, atol=1e-7 * np.abs(theirs).max())
    for a, b in zip(fit.errors, seen.errors, strict=True):
        np.testing.assert_allclose(a, b, atol=1e-12)


def test_what_smooth_forces_explain_does_not_depend_on_the_weights_of_the_last_fit():
    """An output that a law explains weighs more in the next fit: not in what the law explains."""
    model, effects = rubbed(), candidates(plant(), ("d",))
    heavy = replace(model, fit=model.fit.weighed(model.scale * (1.0, 0.02)))
    a, b = (measure(m, effects) for m in (model, heavy))
    assert a.of_joint == pytest.approx(b.of_joint, abs=1e-6)
    assert [x.share for x in a.beyond.values()] == pytest.approx(
        [x.share for x in b.beyond.values()], abs=1e-6
    )
    assert a.of_joint["joint shoulder"] > 0.2


@pytest.mark.parametrize("joint", ["shoulder", "elbow"])
def test_the_joint_of_a_force_of_two_variables_is_told_without_a_law(joint):
    size = {"shoulder": 0.03, "elbow": 0.005}[joint]
    _, model = fitted({f"position_dependent_damping.d_q@{joint}": size})
    shares = measure(model, candidates(plant(), ("d",)), is_left=True).of_joint
    other = next(share for name, share in shares.items() if name != f"joint {joint}")
    assert shares[f"joint {joint}"] > max(0.5, 2 * other)
