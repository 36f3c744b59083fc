"""What is said of runs that are no runs of the real robot."""

import numpy as np

from inca_mj.robot.inputs import make_input
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.limits import remarks
from inca_mj.workflows.pulled import with_force


def test_a_usual_run_has_no_remarks():
    assert remarks(simulate(build_twin(), make_input("prbs", 1.0))) == ()


def test_a_handle_that_is_torn_off_is_told_with_the_time_and_its_slack_cables():
    run = simulate(with_force(build_twin(), (0, 0, -90)), np.zeros((101, 8)))
    slack, outside = remarks(run)
    first = run.time[np.argmax(run.position[:, 2] < 0.1)]
    assert f"leaves the room between the exit points at {first:.2f} s" in outside
    for k in range(8):
        assert (f"{k + 1}" in slack.split("(")[0]) == bool((run.tension[:, k] <= 0).any())
