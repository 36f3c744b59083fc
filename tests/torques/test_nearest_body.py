"""No load is what no body can be."""

import numpy as np
import pytest

from identification.torques.equations.consistency import nearest_body


@pytest.mark.parametrize(("inertia", "nearest"), [(0.02, 0.02), (0.01, 0.01), (-0.01, 0.0)])
def test_the_nearest_body_is_the_load_itself_where_a_body_is_so(inertia, nearest):
    """I_xx and I_yy of 1 kg whose centre is 0.1 m from the frame: I = m r² for a point mass."""
    K = np.eye(10)[[0, 3, 4, 5]]
    mass, moment = (1.0, 0.1) if inertia > 0 else (1e-9, 0.0)
    values = np.array([mass, moment, inertia, inertia])
    scale = np.array([1.0, *[0.1] * 3, *[0.01] * 6])
    found = nearest_body(K, values, 1e-3 * scale[[0, 3, 4, 5]], scale)
    assert found[2:] == pytest.approx([nearest] * 2, abs=1e-5)
