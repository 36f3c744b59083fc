"""What the minimal realisation drops, and that nothing else changes."""

import numpy as np
import pytest
from linear_cases import padded, random_system

from identification import InputError
from identification.linear.modes import minimal

F = np.geomspace(1e-3, 10, 30)


@pytest.mark.parametrize("seed", range(8))
def test_hidden_states_are_found_and_the_transfer_function_stays(seed):
    """Also where the system is unstable, and the units of its states differ by decades."""
    small = random_system(seed, n=4)
    whole = padded(small, unreached=3, unfelt=2, seed=seed)
    found = minimal(whole)
    assert (found.unreached, found.unfelt, len(found.system.A)) == (3, 2, 4)
    scale = np.abs(small.response(F)).max()
    np.testing.assert_allclose(found.system.response(F), small.response(F), atol=1e-6 * scale)


@pytest.mark.parametrize("seed", range(3))
def test_a_minimal_system_keeps_all_its_states(seed):
    found = minimal(random_system(seed))
    assert (found.unreached, found.unfelt) == (0, 0)


def test_the_minimal_states_say_what_the_states_do():
    """δx = V δz satisfies the system's own equations for what inputs reach."""
    whole = padded(random_system(3, n=4), unreached=2, unfelt=0, seed=3)
    found = minimal(whole)
    V = found.to_states
    scale = np.linalg.norm(V, axis=1, keepdims=True)
    np.testing.assert_allclose(whole.A @ V / scale, V @ found.system.A / scale, atol=1e-6)
    np.testing.assert_allclose(V @ found.system.B / scale, whole.B / scale, atol=1e-6)


@pytest.mark.parametrize("tolerance", [0.0, -1.0])
def test_a_tolerance_is_a_share(tolerance):
    with pytest.raises(InputError, match="between 0 and 1"):
        minimal(random_system(0), tolerance)
