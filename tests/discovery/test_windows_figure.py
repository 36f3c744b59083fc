"""The figure of what windows predict: its curves are the errors, broken between windows."""

import numpy as np
from discovery_cases import record, slider

from identification.report.page.figures import windows_figure
from identification.windows.window_error import window_error


def test_its_lower_curves_are_the_errors_of_the_windows():
    log, models = record(slider(), 60), {"light": {"mass": 1.5}, "heavy": {"mass": 3.0}}
    upper, lower = windows_figure(slider(), log, 0.4, models).axes
    assert upper.get_title(loc="left").endswith("predicted over 0.4 s")
    assert [line.get_label() for line in lower.lines] == list(models)
    for line, values in zip(lower.lines, models.values(), strict=True):
        error = window_error(slider(), log, 0.4, values)[..., 0]
        drawn = np.asarray(line.get_ydata()).reshape(len(error), -1)
        np.testing.assert_allclose(drawn[:, :-1], error, rtol=1e-9)
        assert np.isnan(drawn[:, -1]).all()
