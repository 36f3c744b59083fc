"""The figure of a fit's report draws the errors that `confirm` tells."""

import numpy as np
import pytest
from pendulum_robot import OFFSET, TOML, make_folder, measured, written

from identification import confirm, fit, read_robot


def drawn(found):
    """Rms of each line of errors that the report draws, in the unit of the first output."""
    (_, figure), *rest = found.files.sections[1].figures
    assert not rest
    return [float(np.sqrt(np.nanmean(line.get_ydata() ** 2))) for line in figure.axes[1].lines]


@pytest.mark.parametrize("confirming", [0, 1])
def test_over_a_horizon_each_record_has_its_own_values(tmp_path, confirming):
    truth = 0.05, -0.03, 0.02
    folder = make_folder(tmp_path)
    paths = written(folder, *(measured(k, {OFFSET: f}) for k, f in enumerate(truth, start=1)))
    last = len(paths) - confirming
    found = fit(read_robot(folder / "own.toml", paths[:last], confirm=paths[last:]))
    first, *_ = confirm(found.robot, found)
    assert drawn(found) == pytest.approx([first.before, first.after], rel=0.02)


@pytest.mark.parametrize("confirming", [0, 1])
def test_a_free_run_is_drawn_with_the_fitted_values(tmp_path, confirming):
    folder = make_folder(tmp_path)
    (folder / "robot.toml").write_text(TOML.replace("horizon = 0.2\n", ""))
    paths = written(folder, *(measured(k, {}) for k in range(1, 2 + confirming)))
    found = fit(read_robot(folder / "robot.toml", paths[0], confirm=paths[1:]))
    (first,) = confirm(found.robot, found)
    expected = first.after if confirming else float(np.sqrt(np.mean(residual(found) ** 2)))
    assert drawn(found) == pytest.approx([expected], rel=1e-6)


def residual(found):
    """y - ŷ of the whole log with the fitted values."""
    predictor = found.found.estimate.predictor
    whole = type(predictor)(predictor.plant, found.robot.log, (), found.values)
    return found.robot.log.outputs - whole.predict(np.empty((1, 0)))[0]
