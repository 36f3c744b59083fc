"""What a force is drawn over: a law that only holds or slips is drawn over the rate."""

from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

from identification.discovery.forces.law_regressors import (
    FAIR_TOLERANCE,
    find_regressor,
    unexplained,
)


@pytest.mark.parametrize(("is_switch", "along"), [(True, "rate"), (False, "law")])
def test_a_law_with_hardly_more_than_two_values_is_no_axis(is_switch, along):
    """Nothing else explains the force, so that what the law multiplies would be taken."""
    rng, size = np.random.default_rng(0), 0.3
    q, v, drive, x = rng.uniform(-1, 1, (4, 400, 1))
    if is_switch:  # it slips, or holds at any small rate
        x = -np.sign(v) * (rng.uniform(0, 1, v.shape) < 0.5)
    of = SimpleNamespace(
        position=q, rate=v, drives=drive, kind=int(mujoco.mjtJoint.mjJNT_HINGE), is_timed=False,
        turning=np.zeros((400, 1), bool), forces=(size * x,),
    )  # fmt: skip
    effect = SimpleNamespace(sizes=(SimpleNamespace(name="f_c"),), shapes=())
    candidate = SimpleNamespace(effect=effect, sizes=("law.f_c",), where="joint a")
    found = find_regressor(candidate, {"law.f_c": size}, of)
    assert found.along == along
    assert unexplained(found, of.forces[0]) < FAIR_TOLERANCE
