"""A linear model with varying parameters (LPV): systems on a grid, and interpolated between.

    δẋ = A(p) δx + B(p) δu,   δy = C(p) δx + D(p) δu,    δx = x - x̄(p),  δu = u - ū(p), …

p are the scheduling variables, such as where a robot is. At each point of the grid stands the
linear model about the operating point there; between them every number is interpolated, by straight
lines (an error of order 2 in the spacing) or by cubic splines (of order 4).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np

from identification.errors import InputError, unknown_name
from identification.linear.export import (
    ARRAYS,
    NAMES,
    names_in,
    names_of,
    read_arrays,
    write_arrays,
)
from identification.linear.system import LinearSystem, held_for, sampling_time_of
from identification.runtime.pool import one_blas_thread

FEWEST = {"linear": 2, "cubic": 4}  # points of an axis
DEGREE = {"linear": 1, "cubic": 3}
_AXIS = "axis_"


@dataclass(frozen=True, kw_only=True)
class GriddedSystem:
    """Continuous systems on a grid of k scheduling variables with n₁ × … × n_k points.

    Attributes:
        axes: rising points of each scheduling variable by its name, shape (n_j,), in its unit.
        A: shape (n₁, …, n_k, nx, nx), in the units of a `LinearSystem`, as all below.
        B: shape (n₁, …, n_k, nx, nu), in these units.
        C: shape (n₁, …, n_k, ny, nx), in these units.
        D: shape (n₁, …, n_k, ny, nu), in these units.
        x: operating points, shape (n₁, …, n_k, nx), in these units.
        u: their inputs, shape (n₁, …, n_k, nu), in these units.
        y: their outputs, shape (n₁, …, n_k, ny), in these units.
        rate: ẋ there, shape (n₁, …, n_k, nx), in these units.
        states: names of the nx states.
        inputs: names of the nu inputs.
        outputs: names of the ny outputs.
        method: "linear" or "cubic".

    Raises:
        InputError: an axis does not rise or has too few points, or the method is unknown.
    """

    axes: Mapping[str, np.ndarray]
    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: np.ndarray
    x: np.ndarray
    u: np.ndarray
    y: np.ndarray
    rate: np.ndarray
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    method: Literal["linear", "cubic"] = "linear"

    def __post_init__(self) -> None:
        if self.method not in FEWEST:
            raise unknown_name("interpolation", self.method, FEWEST)
        for name, points in self.axes.items():
            check_axis(name, points, FEWEST[self.method])

    @cached_property
    def _packed(self) -> tuple[np.ndarray, np.ndarray, Any]:
        """All numbers at the first point, which of them vary over the grid, and their function.

        Most entries of the matrices are the same everywhere; they are left out.
        """
        k = len(self.axes)
        every = [getattr(self, name) for name in ARRAYS]
        flat = np.concatenate([a.reshape(*a.shape[:k], -1) for a in every], axis=-1)
        first = flat.reshape(-1, flat.shape[-1])[0]
        varies = (flat != first).reshape(-1, len(first)).any(axis=0)
        return first, varies, spline(tuple(self.axes.values()), flat[..., varies], self.method)

    def at(self, point: Mapping[str, float]) -> LinearSystem:
        """Returns the interpolated system at one point.

        Raises:
            InputError: a variable is missing or unknown, or the point is outside the grid.
        """
        first, varies, function = self._packed
        flat = first.copy()
        flat[varies] = function(self.place(point))
        shapes = {name: getattr(self, name).shape[len(self.axes) :] for name in ARRAYS}
        ends = np.cumsum([int(np.prod(shape)) for shape in shapes.values()])
        parts = zip(shapes.items(), np.split(flat, ends[:-1]), strict=True)
        arrays: dict[str, Any] = {name: part.reshape(shape) for (name, shape), part in parts}
        return LinearSystem(**arrays, **names_of(self))

    def simulate(
        self, start: np.ndarray, inputs: np.ndarray, rate: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Simulates states and outputs under inputs, where the scheduling variables are states.

        At each sample the system at the present p is discretised exactly and holds for one sample:

            x_{k+1} = x̄(p_k) + A_h(p_k) (x_k - x̄(p_k)) + B_h(p_k) (u_k - ū(p_k))

        Args:
            start: state, shape (nx,), in the units of the states.
            inputs: held over each sample, shape (N, nu), in their units.
            rate: of the samples [Hz].

        Returns:
            States, shape (N, nx), and outputs, shape (N, ny), in their units.

        Raises:
            InputError: a scheduling variable is no state, or it leaves the grid; or the rate is not
                above zero.
        """
        for name in self.axes:
            if name not in self.states:
                raise InputError(
                    f"the scheduling variable {name} is no state, so that its course is not known;"
                    " simulate at(point) instead"
                )
        where = {name: self.states.index(name) for name in self.axes}
        x = np.empty((len(inputs), len(self.states)))
        y = np.empty((len(inputs), len(self.outputs)))
        now = np.asarray(start, float)
        h = sampling_time_of(rate)
        with one_blas_thread():
            for k, u in enumerate(np.asarray(inputs, float)):
                s = self.at({name: float(now[i]) for name, i in where.items()})
                δx, δu = now - s.x, u - s.u
                x[k], y[k] = now, s.y + s.C @ δx + s.D @ δu
                A_h, B_h = held_for(s.A, s.B, h)
                now = s.x + A_h @ δx + B_h @ δu
        return x, y

    def place(self, point: Mapping[str, float]) -> np.ndarray:
        """Returns the scheduling variables in the order of the axes, shape (k,), in their units.

        Args:
            point: value of every scheduling variable by its name, in its unit.

        Raises:
            InputError: a variable is missing or unknown, or the point is outside the grid.
        """
        for name in point:
            if name not in self.axes:
                raise unknown_name("scheduling variable", name, self.axes)
        for name, points in self.axes.items():
            if name not in point:
                raise InputError(
                    f"the point gives no {name}; the grid needs {', '.join(self.axes)}"
                )
            if not points[0] <= point[name] <= points[-1]:
                raise InputError(
                    f"{name} = {point[name]:g} is outside the grid, which reaches from"
                    f" {points[0]:g} to {points[-1]:g}; take a point inside, or a wider grid"
                )
        return np.array([point[name] for name in self.axes])

    def save(self, path: str | Path) -> Path:
        """Write the grid to a file whose name ends in .npz or .mat; returns the path.

        The variables are those of one system, with the axes of the grid first; the points of the
        axes are axis_NAME.

        Args:
            path: where to write.

        Raises:
            InputError: the name ends otherwise, or the file cannot be written.
        """
        axes = {f"{_AXIS}{name}": points for name, points in self.axes.items()}
        return write_arrays(
            path,
            {**{name: getattr(self, name) for name in ARRAYS}, **names_of(self), **axes,
             "scheduling": tuple(self.axes), "method": np.array(self.method)},
        )  # fmt: skip


def spline(axes: Sequence[np.ndarray], values: np.ndarray, method: str) -> Any:
    """Returns the tensor-product spline through values on a grid, as a function of points (M, k).

    The values have shape (n₁, …, n_k, numbers). It is solved axis by axis, exactly:
    `RegularGridInterpolator` solves cubic splines by an iteration that leaves an error of 1e-6.
    """
    from scipy.interpolate import NdBSpline, make_interp_spline

    knots, coefficients = [], values
    for k, points in enumerate(axes):
        along = make_interp_spline(points, np.moveaxis(coefficients, k, 0), k=DEGREE[method])
        knots.append(along.t)
        coefficients = np.moveaxis(along.c, 0, k)
    return NdBSpline(tuple(knots), np.ascontiguousarray(coefficients), DEGREE[method])


def check_axis(name: str, points: np.ndarray, fewest: int) -> None:
    """Refuse points of a scheduling variable that do not rise or are too few."""
    points = np.asarray(points, float)
    if points.ndim != 1 or not np.isfinite(points).all() or not (np.diff(points) > 0).all():
        raise InputError(f"the points of {name} must be finite numbers that rise; got {points}")
    if len(points) < fewest:
        raise InputError(
            f"the grid has {len(points)} points of {name}; its interpolation needs {fewest} or more"
            f" ({', '.join(f'{method} {n}' for method, n in FEWEST.items())})"
        )


def gridded(
    axes: Mapping[str, np.ndarray], systems: Sequence[LinearSystem],
    method: Literal["linear", "cubic"] = "linear",
) -> GriddedSystem:  # fmt: skip
    """Put continuous systems on a grid, one for each point, the last axis running fastest.

    Raises InputError if the number of systems is not that of the points, one is discrete, or their
    names differ; or for the reasons of `GriddedSystem`.
    """
    shape = tuple(len(points) for points in axes.values())
    if len(systems) != np.prod(shape):
        raise InputError(f"the grid has {np.prod(shape)} points, and {len(systems)} systems came")
    first = systems[0]
    for system in systems:
        if system.sampling_time is not None:
            raise InputError("a grid takes continuous systems; discretise what it gives")
        if names_of(system) != names_of(first):
            raise InputError("the systems of a grid must have the same states, inputs and outputs")
    stacked = {name: np.stack([getattr(s, name) for s in systems]) for name in ARRAYS}
    arrays: dict[str, Any] = {n: v.reshape(*shape, *v.shape[1:]) for n, v in stacked.items()}
    points = {name: np.asarray(values, float) for name, values in axes.items()}
    return GriddedSystem(axes=points, **arrays, **names_of(first), method=method)


def load_grid(path: str | Path) -> GriddedSystem:
    """Read a grid of systems that `GriddedSystem.save` wrote as .npz.

    Args:
        path: of the file.

    Raises:
        InputError: there is no such file, or it is no such grid.
    """
    content = read_arrays(path, (*ARRAYS, *NAMES, "scheduling", "method"), "grid of systems")
    arrays: dict[str, Any] = {name: content[name] for name in ARRAYS}
    names, scheduling = names_in(content, path), np.atleast_1d(content["scheduling"]).tolist()
    axes = {name: content.get(f"{_AXIS}{name}", np.zeros(())) for name in scheduling}
    grid = tuple(axis.size for axis in axes.values() if axis.ndim == 1)
    numbers = {**arrays, **axes}.values()
    if not (
        all(a.dtype.kind in "fiu" and np.isfinite(a).all() for a in numbers)
        and len(grid) == len(axes)
        and all(a.shape[: len(grid)] == grid for a in arrays.values())
    ):
        raise InputError(
            f"{path} is damaged: its arrays are no finite numbers over the grid of"
            f" {', '.join(map(str, scheduling))}; write it again"
        )
    method: Any = str(content["method"])
    return GriddedSystem(axes=axes, **arrays, **names, method=method)
