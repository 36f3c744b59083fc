"""A gear that gives in one joint of an arm is scored first, and a fit has its compliance."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from arm_cases import DAMPING, FULL, SAMPLE, Arm, inertias, text
from chain_cases import WANTED
from joint_cases import arm_log

from identification import Parameter
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.joint_plant import candidates, joint_plant
from identification.prediction.nominal_fit import fit_nominal
from identification.prediction.records import as_records
from identification.prediction.screening import score_all

TRUTH = {"m2": 0.7, "d1": DAMPING[0], "d2": DAMPING[1]}
PATHS = {"m2": "body/lower.mass", "d1": "joint/shoulder.damping", "d2": "joint/elbow.damping"}
KNOWN = (*WANTED, "delay", "lag")
C, RHO, ZETA = 0.05, 0.3, 0.05


@cache
def measured(seed):
    """A record of the arm, whose second encoder sits on the motor's side."""
    rng = np.random.default_rng(seed)
    t = SAMPLE * np.arange(300)
    size, f, phase = (rng.uniform(a, b, (8, 2)) for a, b in ((0.3, 1), (0.2, 6), (0, 6.3)))
    u = 0.6 * FULL * np.sum(size * np.sin(2 * np.pi * f * t[:, None, None] + phase), axis=1)
    x = Arm(c=(0.0, C), J=tuple(inertias(RHO)), zeta=ZETA).moved(u, tight=1e-7)
    y = x[:, [0, 5]] + 1e-4 * rng.standard_normal((300, 2))
    return replace(arm_log(u), outputs=y, name=f"record {seed}")


def model(**more):
    """The arm without it, its parameters wrong; or with it, from wrong values."""
    start = {"m2": 0.6, "d1": 0.15, "d2": 0.03}
    given = [Parameter(name=n, value=x, unit="", where=PATHS[n], lower=0.0, upper=10.0)
             for n, x in start.items()]  # fmt: skip
    whole = joint_plant(text(0.005, "RK4"), given, measured(0))
    effects = [e for e in whole.effects if e.name in KNOWN]
    plant = joint_plant(text(0.005, "RK4"), given, measured(0), effects=effects)
    names = (*start, *more)
    return NominalModel(plant.with_values(more), names, np.full(len(names), 0.5), 0.2)


def test_a_gear_that_gives_in_one_joint_of_an_arm_is_scored_first():
    task = model()
    fitted = fit_nominal(task, as_records([measured(0), measured(1)]))
    best, *others = score_all(fitted, candidates(task.plant, task.names), DiscoveryOptions())
    assert (best.candidate.effect.name, best.candidate.where) == ("joint_elasticity", "joint elbow")
    assert best.candidate.fixed["joint_elasticity.link"] == 0.0
    assert best.fall > 0.7
    assert best.size[0] == pytest.approx(C, rel=0.3)
    for score in others:
        assert score.candidate.effect.name == "joint_elasticity" or score.fall < 0.8 * best.fall


def test_a_fit_of_windows_has_its_numbers():
    names = {"joint_elasticity.c@elbow": (0.07, C), "joint_elasticity.rho": (0.4, RHO),
             "joint_elasticity.zeta": (0.1, ZETA)}  # fmt: skip
    begun = {name: start for name, (start, _) in names.items()}
    found = fit_nominal(model(**begun), as_records([measured(0), measured(1)])).values
    for name, value in {**TRUTH, **{n: right for n, (_, right) in names.items()}}.items():
        assert found[name] == pytest.approx(value, rel=0.15 if "zeta" in name else 0.03)
