"""The bench of measured robots, and where its data are, for the tests."""

import os
import sys
from pathlib import Path

import numpy as np
import pytest

HERE = Path(__file__).parents[2]
sys.path.insert(0, str(HERE / "benchmarks"))

from robots.measured_robot import Free, MeasuredRobot  # noqa: E402
from robots.silverbox import FREE, HORIZON, SAMPLING_TIME  # noqa: E402

from identification import Log  # noqa: E402

DATA = Path(os.environ.get("MEASURED_DATA", HERE.parent / "shared" / "data"))
with_data = pytest.mark.skipif(
    not DATA.exists(), reason="no records of measured robots in ../shared/data or MEASURED_DATA"
)


def oscillator_log(seed=0, n=600, k_3=4.0, noise=0.0):
    """A log of the Silverbox's equations, integrated here, under a random multisine."""
    rng = np.random.default_rng(seed)
    t = SAMPLING_TIME * np.arange(n)
    lines = rng.uniform(5, 90, 12), rng.uniform(0, 2 * np.pi, 12)
    m, d, fine = 5.4e-6, 2.3e-4, 40
    h = SAMPLING_TIME / fine

    def u(s):
        return 0.02 * np.sum(np.sin(2 * np.pi * lines[0] * s + lines[1]))

    def rate(x, force):
        return np.array([x[1], (force - d * x[1] - x[0] - k_3 * x[0] ** 3) / m])

    x, inputs, outputs = np.zeros(2), [u(s) for s in t], []
    for k in range(n):
        outputs.append(x[0])
        rise = (inputs[min(k + 1, n - 1)] - inputs[k]) / fine
        for i in range(fine):
            a, b, c = (inputs[k] + (i + s) * rise for s in (0.0, 0.5, 1.0))
            k1 = rate(x, a)
            k2 = rate(x + h / 2 * k1, b)
            k3 = rate(x + h / 2 * k2, b)
            x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + rate(x + h * k3, c))
    y = np.array(outputs) + noise * rng.standard_normal(n)
    return Log(
        time=t, inputs=np.array(inputs)[:, None], outputs=y[:, None], input_names=("V1",),
        output_names=("V2",), name=f"made up {seed}", hold="foh",
    )  # fmt: skip


def oscillator(logs, **more):
    """A measured robot of such logs: the first is fitted, the others confirm."""
    from robots.measured_robot import MODELS

    said = {
        "name": "oscillator", "title": "a made-up oscillator", "source": "nobody",
        "model": MODELS / "silverbox.xml", "free": FREE, "horizon": HORIZON, "fit": logs[:1],
        "confirm": logs[1:],
    }  # fmt: skip
    return MeasuredRobot(**{**said, **more})


__all__ = ["DATA", "Free", "MeasuredRobot", "oscillator", "oscillator_log", "with_data"]
