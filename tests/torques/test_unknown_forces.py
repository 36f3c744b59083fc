"""What no law of the catalogue is has no law's name, and no load is what no body is."""

import numpy as np
import pytest
from torque_cases import planar_record, planar_robot

from identification import fit_torques
from identification.report.torque_words import torque_verdict
from identification.torques.consistency import nearest_body


def test_a_force_of_two_variables_has_no_laws_name_and_is_told(tmp_path):
    def force(q, v):
        return 4 * np.exp(-(((q[1] - 0.2) / 0.2) ** 2)) * np.tanh(v[1])

    logs = [planar_record(s, force=force, name=n) for s, n in ((1, "a"), (2, "b"))]
    robot = planar_robot(tmp_path, logs[0], confirm=logs[1:])
    found = fit_torques(robot)
    assert all(s.missing.is_curve for s in found.named)
    assert {n.joint for n in found.found.unknown} == {1}
    said = " ".join(torque_verdict(found.found, robot.plant.model))
    assert "What acts there is unknown." in said
    assert "something is left at elbow" in said


@pytest.mark.parametrize(("inertia", "nearest"), [(0.02, 0.02), (0.01, 0.01), (-0.01, 0.0)])
def test_the_nearest_body_is_the_load_itself_where_a_body_is_so(inertia, nearest):
    """I_xx and I_yy of 1 kg whose centre is 0.1 m from the frame: I = m r² for a point mass."""
    K = np.eye(10)[[0, 3, 4, 5]]
    mass, moment = (1.0, 0.1) if inertia > 0 else (1e-9, 0.0)
    values = np.array([mass, moment, inertia, inertia])
    scale = np.array([1.0, *[0.1] * 3, *[0.01] * 6])
    found = nearest_body(K, values, 1e-3 * scale[[0, 3, 4, 5]], scale)
    assert found[2:] == pytest.approx([nearest] * 2, abs=1e-5)
