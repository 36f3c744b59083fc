"""A profile agrees with the std on a parabola, and is flat where nothing is known."""

import numpy as np
import pytest
from estimation_plants import record, slider

from identification import InputError
from identification.estimation import Options, estimate
from identification.fit import assess
from identification.profiles import profile

ONCE = Options(horizons=(1.0,))


def test_a_profile_of_a_nearly_linear_problem_gives_the_interval_of_the_std():
    log = record(slider(), ("position",), noise=5e-4)
    found = estimate(slider(), log, ("damping", "stiffness"), options=ONCE)
    std = dict(zip(found.space.names, assess(found).std, strict=True))
    for name in found.space.names:
        known = profile(found, name, points=7)
        value = found.values[name]
        wald = (value - 1.96 * std[name], value + 1.96 * std[name])
        np.testing.assert_allclose(known.interval, wald, atol=0.35 * std[name])
        assert not known.open
        assert (known.rise > -1e-3).all()
        assert known.rise[0] == pytest.approx(9, rel=0.1)
        assert known.rise[-1] == pytest.approx(9, rel=0.1)


def test_the_profile_of_what_cannot_be_known_is_flat():
    log = record(slider(x0=0.0), ("position",), noise=5e-4)
    names = ("mass", "damping", "stiffness", "gear")
    found = estimate(slider(x0=0.0), log, names, options=ONCE)
    flat = profile(found, "gear", points=[3.5, 4.5, 5.5, 6.5])
    assert flat.open
    assert np.abs(flat.rise).max() < 0.05
    np.testing.assert_allclose(flat.others["mass"] / flat.values, 0.4, rtol=0.02)


def test_only_what_was_estimated_has_a_profile():
    found = estimate(slider(), record(slider(), ("position",), noise=1e-3), ("damping",))
    with pytest.raises(InputError, match="profile one of damping"):
        profile(found, "stiffness")
    one = profile(found, "damping", points=5)
    assert one.interval[0] < 3.0 < one.interval[1]
