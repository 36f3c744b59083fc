"""A grid of systems, files of systems, and the objects of other packages."""

from dataclasses import replace

import numpy as np
import pytest
from linear_cases import random_system, system
from scipy.io import loadmat

from identification import InputError
from identification.linear.export import load_system, save_system
from identification.linear.gridded import gridded, load_grid

F = np.geomspace(1e-2, 10, 20)


def varying(a, b):
    """A smooth function of two scheduling variables."""
    A = np.array([[0.0, 1.0], [-np.exp(a) - b**2, -1 - np.sin(a * b)]])
    one = system(A, np.array([[0.0], [np.cos(b)]]), np.eye(2))
    return replace(one, x=np.array([a, b]), u=np.array([a * b]))


def grid(n, method="linear"):
    axes = {"a": np.linspace(-1, 1, n), "b": np.linspace(0, 2, n)}
    return gridded(axes, [varying(a, b) for a in axes["a"] for b in axes["b"]], method)


@pytest.mark.parametrize("method", ["linear", "cubic"])
def test_it_is_exact_on_the_points_of_the_grid(method):
    g = grid(5, method)
    for a in g.axes["a"]:
        for b in g.axes["b"]:
            one, other = g.at({"b": b, "a": a}), varying(a, b)
            for name in ("A", "B", "C", "D", "x", "u"):
                np.testing.assert_allclose(getattr(one, name), getattr(other, name), atol=1e-12)


@pytest.mark.parametrize(("method", "order"), [("linear", 2), ("cubic", 4)])
def test_the_error_falls_with_the_order_of_the_interpolation(method, order):
    points = np.random.default_rng(0).uniform([-1, 0], [1, 2], (150, 2))
    errors = [
        np.linalg.norm([g.at({"a": a, "b": b}).A - varying(a, b).A for a, b in points])
        for g in (grid(9, method), grid(17, method), grid(33, method))
    ]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (orders > order - 0.5).all()


def test_a_grid_of_one_system_is_that_system():
    s = replace(random_system(0), states=("p", *(f"x{k}" for k in range(5))))
    s = replace(s, A=s.A - 4 * np.eye(6), u=np.ones(2))
    g = gridded({"p": np.linspace(-100, 100, 4)}, [s] * 4)
    u = np.random.default_rng(0).normal(size=(50, 2))
    x, y = g.simulate(s.x, u, 20)
    expected = s.discrete(20).simulate(u)
    np.testing.assert_allclose(x, expected[0], atol=1e-10)
    np.testing.assert_allclose(y, expected[1], atol=1e-10)


def test_files_hold_what_was_written(tmp_path):
    s, g = random_system(1), grid(4, "cubic")
    for one in (s, s.discrete(50)):
        back = load_system(save_system(one, tmp_path / "s.npz"))
        np.testing.assert_array_equal(back.A, one.A)
        assert (back.states, back.outputs) == (one.states, one.outputs)
        assert back.sampling_time == one.sampling_time
    again = load_grid(g.save(tmp_path / "g.npz"))
    np.testing.assert_array_equal(again.at({"a": 0.3, "b": 1}).A, g.at({"a": 0.3, "b": 1}).A)


def test_matlab_gets_matrices_cells_of_names_and_the_axes(tmp_path):
    s, g = random_system(1).discrete(50), grid(3)
    file = loadmat(save_system(s, tmp_path / "s.mat"))
    np.testing.assert_array_equal(file["A"], s.A)
    assert file["Ts"].item() == 1 / 50
    assert [cell.item() for cell in file["states"].ravel()] == [*s.states]
    file = loadmat(g.save(tmp_path / "g.mat"))
    np.testing.assert_array_equal(file["A"], g.A)
    np.testing.assert_array_equal(file["axis_b"].ravel(), g.axes["b"])
    assert [cell.item() for cell in file["scheduling"].ravel()] == ["a", "b"]


@pytest.mark.parametrize("rate", [None, 20.0])
def test_scipy_and_python_control_have_the_same_transfer_function(rate):
    control = pytest.importorskip("control")
    s = random_system(2) if rate is None else random_system(2).discrete(rate)
    at = 2 * np.pi * F
    with_names = s.to_control()
    ours = np.moveaxis(s.response(F), 0, -1)
    z = 1j * at if rate is None else np.exp(1j * at / rate)
    np.testing.assert_allclose(np.asarray(control.evalfr(with_names, z[3])), ours[..., 3])
    assert with_names.state_labels == [*s.states]
    scipy = s.to_scipy()
    np.testing.assert_array_equal(scipy.A, s.A)
    assert (scipy.dt or None) == s.sampling_time


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda: grid(3).at({"a": 0.0}), "gives no b"),
        (lambda: grid(3).at({"a": 1.1, "b": 0.0}), "a = 1.1 is outside the grid"),
        (lambda: grid(3, "cubic"), "needs 4 or more"),
        (lambda: gridded({"a": np.array([1.0, 0.0])}, [random_system(0)] * 2), "that rise"),
        (lambda: save_system(random_system(0), "system.csv"), r"\.npz or \.mat"),
    ],
)
def test_what_cannot_be_is_refused(wrong, words):
    with pytest.raises(InputError, match=words):
        wrong()
