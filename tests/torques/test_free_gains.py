"""Free gains of drives: a drive without a gain and an arm without masses explain any torque."""

import numpy as np
import pytest
from torque_cases import TOML, planar_record, planar_robot

from identification import fit_torques
from identification.robot.torques import free_numbers
from identification.torques.fits import Others
from identification.torques.scores import rank

GAIN = "actuator/t2.gear[0]"
FREE = (
    TOML.replace("free = [", f'free = ["{GAIN}", ')
    + f"""
[parameters."{GAIN}"]
known = 0.3
"""
)


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("gain")
    records = [planar_record(k, name=f"r{k}") for k in (51, 52)]
    return fit_torques(planar_robot(folder, records[0], confirm=[records[1]], toml=FREE))


def test_a_gain_is_told_from_others_by_its_column(found):
    robot = found.robot
    logs = (robot.log, *robot.records)
    others = Others.of(free_numbers(robot, logs), found.found.equations, logs)
    assert [f.name for f in others.free] == [GAIN]
    assert others.gains.tolist() == [True]
    plain = others.without_gains()
    assert plain.free == ()
    # what is held at its mean, which is the model's value here, adds nothing
    np.testing.assert_allclose(plain.start, 0.0, atol=1e-12)


def test_the_masses_of_the_model_tell_the_gain_and_no_fit_without_them_has_it(found):
    model, whole = found.found.model, found.found.whole
    at = model.names.index(GAIN)
    assert model.fit.θ[at] == pytest.approx(5.0, rel=0.03)  # the gear with which the log was made
    assert GAIN not in whole.names
    assert found.named == ()


def test_a_candidate_does_not_gain_by_taking_the_drive_away(found):
    """The centre of mass may cancel the weight: with the gain at zero nothing would be left."""
    e = found.found
    candidates = [s.missing for s in e.scores if s.missing.name in ("com_offset", "load")]
    for score in rank(e.equations, e.model.base, candidates):
        assert score.fall < 0.5
