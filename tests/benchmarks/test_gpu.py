"""The benchmark of GPUs, as far as it goes without one."""

import gpu_speed
import numpy as np
from gpu import kernel, processor
from gpu.worlds import FREE, drawn, moved

STEPS = 40


def test_without_a_gpu_it_says_so(monkeypatch, capsys):
    monkeypatch.setattr(gpu_speed, "device", lambda: None)
    monkeypatch.setattr("sys.argv", ["gpu_speed.py"])
    assert gpu_speed.main() == 2
    assert "No NVIDIA GPU was found" in capsys.readouterr().out


def test_the_function_of_the_kernel_is_the_twin_to_rounding():
    """Moving starts, other parameters in each world: 1e-11 rad is rounding over the steps."""
    worlds = drawn().widened(4, STEPS)
    twin = processor.on_processor(worlds, 1)
    assert np.abs(twin).max() > 0.01
    np.testing.assert_allclose(kernel.on_processor(worlds), twin, rtol=0, atol=1e-11)


def test_worlds_of_a_fit_have_the_columns_of_their_parameters():
    """The twin beside itself: no error but that of the forward difference, h ŷ″/2 and round-off."""
    worlds = moved(0.1).widened(32, 100)
    assert len(moved(0.1)) == 1 + 3 * len(FREE)
    own = processor.accuracy(worlds, processor.on_processor(worlds, 1))
    assert own["free_run_largest_rad"] == 0
    assert set(own["central_columns"].values()) == {0.0}
    assert own["forward_columns"]["K_t"] < 1e-5


def test_motors_without_the_law_turn_as_their_currents_say():
    """J ω̇ = K_t i - b_v ω with nothing else on a drum: ω after a step, to O(h²)."""
    worlds = moved(0.01).widened(1, 10)
    angles = processor.on_processor(worlds, 1, law=False)[0]
    values, t = worlds.robot.parameters.values(), 1e-3 * np.arange(1, 11)[:, None]
    rate = values["b_v"] / values["J"]
    end = values["K_t"] * worlds.currents[0] / values["b_v"]
    np.testing.assert_allclose(angles, end * (t - (1 - np.exp(-rate * t)) / rate), rtol=1e-9)
