"""The thesis' third trial on one second of its data: all six parameters come out right."""

from dataclasses import replace

import numpy as np

from identification.estimation.estimation import estimate
from inca_mj.robot.parameters import parameter_set
from inca_mj.thesis.trials import SMALL, trial_data
from inca_mj.twin.twin import build_twin


def test_the_six_parameters_of_trial_3_are_recovered_from_one_second():
    robot = build_twin(parameter_set("trial"))
    log = replace(trial_data(robot).between(0.0, 1.0), name="one second")
    found = estimate(robot, log, tuple(SMALL), SMALL)
    true = parameter_set("trial").values()
    np.testing.assert_allclose(
        [found.values[n] for n in SMALL], [true[n] for n in SMALL], rtol=1e-6
    )
