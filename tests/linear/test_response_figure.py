"""The figure of a frequency response: magnitude with its unit, and phase."""

import numpy as np

from identification.linear.system import LinearSystem
from identification.report.linear import response_figure

CORNER = 2.0  # of a lag of first order [Hz]


def lag(outputs=("angle_1",), inputs=("current_1",)):
    """Lags of first order of gain 3, each input with an output of its own."""
    n, pole = len(inputs), 2 * np.pi * CORNER
    return LinearSystem(
        A=-pole * np.eye(n), B=pole * np.eye(n), C=3.0 * np.eye(n), D=np.zeros((n, n)),
        states=tuple(f"x{k}" for k in range(n)), inputs=inputs, outputs=outputs,
        x=np.zeros(n), u=np.zeros(n), y=np.zeros(n), rate=np.zeros(n),
    )  # fmt: skip


def test_magnitude_and_phase_are_those_of_a_lag():
    magnitude, phase = response_figure(lag()).axes
    (gain,), (turned,) = magnitude.lines, phase.lines
    f, degrees = gain.get_xdata(), turned.get_ydata()
    np.testing.assert_allclose(gain.get_ydata(), 3 / np.sqrt(1 + (f / CORNER) ** 2), rtol=1e-9)
    np.testing.assert_allclose(degrees, -np.degrees(np.arctan(f / CORNER)), atol=1e-7)
    assert phase.get_ylabel() == "phase [°]"


def test_inputs_that_are_held_lag_by_half_a_sample():
    system, h = lag(), 1e-3
    _, phase = response_figure(system, system.discrete(1 / h)).axes
    whole, held = phase.lines
    f = held.get_xdata()
    late = whole.get_ydata()[: len(f)] - held.get_ydata()
    np.testing.assert_allclose(late, 180 * f * h, atol=0.01)
    assert f.max() < 0.5 / h
