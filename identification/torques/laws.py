"""A candidate as columns of the equations, and the laws of joints along a motion.

force        -f(s) at the joint             f, b: a law of the catalogue, by its own hook
friction     b(s) sign v at the joint
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from types import FunctionType
from typing import Any

import mujoco
import numpy as np

from identification.discovery.candidates import iterate_shapes
from identification.effects.effect import CURVE, Effect
from identification.effects.sizes import Shape
from identification.effects.variables import variables
from identification.native.joints.joint_callback import Joint
from identification.torques.equations.equations import Columns, Equations

# What the curves of a joint depend on, by the ends of their names, as fields of its state.
CURVES = {"_speed": "v", "_load": "f_u", "_position": "q", "_time": "time"}
RIDGE = 0.01  # of a curve's nodes: one that is felt less is held where it is, at zero
PLACES = 801  # of a curve, between which it is straight


@dataclass(frozen=True, kw_only=True)
class Missing:
    """A candidate."""

    name: str  # of the effect, as in the catalogue where it has one
    where: str  # its place, in words
    phrase: str  # what it is, in words
    sizes: tuple[str, ...]  # names of its sizes
    units: tuple[str, ...]  # of the sizes
    signs: tuple[int, ...]  # that physics admits of the sizes, 0 where it admits both
    shape: tuple[tuple[str, float, str], ...] = ()  # name, value and unit of each of its shapes
    columns: Callable[[], Columns]  # returns its columns
    most: tuple[float, ...]  # magnitudes of the sizes beyond which it is not believed
    # of a load: its sizes as combinations of its ten numbers, (m, 10), and how large these may be
    of_body: tuple[np.ndarray, np.ndarray] | None = None
    shapes: tuple[Shape, ...] = ()  # with their bounds, in the order of `shape`
    reshaped: Callable[[Sequence[float]], Missing] | None = None  # returns it with other shapes
    ridges: tuple[float, ...] = ()  # of each size; none where empty (`scores.held_by`)
    variables: frozenset[str] = frozenset()  # of a joint, on which its force depends

    @property
    def is_curve(self) -> bool:
        """Tells whether it is a force that is drawn from the data, and in no catalogue."""
        return self.name.startswith(CURVE)

    @property
    def numbers(self) -> int:
        """How many numbers it takes from the data: sizes and shapes."""
        return len(self.sizes) + len(self.shape)

    @property
    def key(self) -> tuple[str, str]:
        """Its effect and its place, whatever its shapes."""
        return self.name, self.where

    def only(self, some: np.ndarray) -> Missing:
        """Returns it with some of its sizes, by a mask."""
        places = np.flatnonzero(some).tolist()

        def columns() -> Columns:
            whole = self.columns()
            return Columns(whole.values[:, :, places], whole.joints)

        def kept(of: tuple[Any, ...]) -> tuple[Any, ...]:
            return tuple(of[k] for k in places)

        return replace(
            self, columns=columns, sizes=kept(self.sizes), units=kept(self.units),
            signs=kept(self.signs), most=kept(self.most),
            ridges=self.ridges and kept(self.ridges),
            of_body=self.of_body and (self.of_body[0][places], self.of_body[1]),
        )  # fmt: skip

    @property
    def title(self) -> str:
        """Its effect and its place."""
        return f"{self.name}, {self.where}"


class Laws:
    """Laws of joints at all equations.

    Args:
        model: of the robot.
        equations: of its records.
        f: the drives' forces, shape (N, nv) [N m or N].
    """

    def __init__(self, model: mujoco.MjModel, equations: Equations, f: np.ndarray) -> None:
        self.names = [model.joint(int(j)).name for j in model.dof_jntid]
        q, v, g = (equations.stacked(n) for n in ("q", "v", "gravity"))
        time, self.sign = equations.stacked("time"), equations.stacked("sign")
        self.used = equations.stacked("used")
        self.states: dict[str, Joint] = {}
        for j, name in enumerate(self.names):
            some = self.used[:, j]
            low, high = (float(x) for x in (q[:, j].min(), q[:, j].max()))
            reach = (
                (low + high) / 2, (high - low) / 2 or 1.0, float(np.abs(v[:, j]).max()) or 1.0,
                float(np.abs(f[:, j]).max()) or 1.0, float(time.max()),
            )  # fmt: skip
            state = (time, q[:, j], v[:, j], f[:, j], g[:, j], np.sign(v[:, j]))
            self.states[name] = Joint(*(*(x[some] for x in state), *reach))

    def of(self, effect: Effect) -> Iterator[Missing]:
        """Yields an effect at each of its places, with each of its shapes."""
        for where, suffix in effect.places.items():
            joints = [suffix[1:]] if suffix else [p[1:] for p in effect.places.values() if p]
            make = partial(self._listed, effect, where, joints)
            yield from map(make, map(tuple, map(dict.values, iterate_shapes(effect))))

    def _listed(
        self, effect: Effect, where: str, joints: Sequence[str], values: Sequence[float]
    ) -> Missing:
        """Returns an effect at a place with values of its shapes."""
        shape = dict(zip((s.name for s in effect.shapes), values, strict=True))
        made = listed(effect, where, shape, partial(self.columns, effect, joints, shape))
        again = partial(self._listed, effect, where, joints)
        return replace(
            made, shapes=effect.shapes, reshaped=again if shape else None,
            variables=variables(effect), ridges=(RIDGE,) * len(effect.sizes) * effect.is_curve,
        )  # fmt: skip

    def columns(self, effect: Effect, joints: Sequence[str], shape: dict[str, float]) -> Columns:
        """Returns the columns of a law, of one size each, at joints that have it in common."""
        (hook,) = effect.hooks
        law = effect.hooks[hook]
        at = [self.names.index(joint) for joint in joints]
        out = np.zeros((*self.used.shape, len(effect.sizes)))
        for k in range(len(effect.sizes)):
            p = (*(float(i == k) for i in range(len(effect.sizes))), *shape.values())
            for j in at:
                some = self.used[:, j]
                states = self.states[self.names[j]]
                force = (_along_curve if effect.is_curve else along)(law, states, p)
                out[some, j, k] = -force if hook == "force" else force * self.sign[some, j]
        return Columns(out, tuple(at))


_ARRAYS = {  # of what a law calls, for all points at once
    "exp": np.exp, "cos": np.cos, "sin": np.sin, "sqrt": np.sqrt, "floor": np.floor,
    "abs": np.abs, "min": np.minimum, "max": np.maximum, "tanh": np.tanh, "log": np.log,
}  # fmt: skip


def along(law: Any, states: Joint, p: Sequence[float]) -> np.ndarray:
    """Returns a law at many states of a joint, shape (n,), whose fields are arrays or numbers.

    Its own Python is run once on the arrays; where it branches by a state, or calls a function of
    numbers such as `math.exp`, once for each of them.
    """
    try:
        with np.errstate(all="ignore"):
            return np.asarray(_on_arrays(law)(states, p) + np.zeros(len(states.q)))
    except (ValueError, TypeError):  # the truth of an array, or a function that takes a number
        fields = [np.broadcast_to(x, states.q.shape).tolist() for x in states]
        return np.array([law.py_func(Joint(*one), p) for one in zip(*fields, strict=True)])


def _along_curve(law: Any, states: Joint, p: Sequence[float]) -> np.ndarray:
    """Returns a curve at many states of a joint, shape (n,), between its values at many places."""
    name = law.py_func.__name__
    field = next(f for end, f in CURVES.items() if name.endswith(end))
    z = {
        "v": _root(states.v / states.v_top), "f_u": _root(states.f_u / states.f_top),
        "q": (states.q - states.q_mid) / states.q_far, "time": 2.0 * states.time / states.t_end - 1,
    }[field]  # fmt: skip
    return np.interp(z, np.linspace(-1.0, 1.0, PLACES), _on_unit(law, field, tuple(p)))


@cache
def _on_unit(law: Any, field: str, p: tuple[float, ...]) -> np.ndarray:
    """Returns a curve at places of a joint whose reaches are one, shape (PLACES,).

    The nodes of each curve lie at shares of a joint's reach, so that all joints have these values.
    """
    z = np.linspace(-1.0, 1.0, PLACES)
    place = {"v": z * np.abs(z), "f_u": z * np.abs(z), "q": z, "time": z + 1.0}[field]
    one = Joint(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0)  # from `q_mid` on: reaches
    return np.array([law.py_func(one._replace(**{field: float(x)}), p) for x in place])


def _root(x: np.ndarray) -> np.ndarray:
    """Returns sgn(x) √|x|, in which curves of rates and drives are straight between nodes."""
    return np.asarray(np.sign(x) * np.sqrt(np.abs(x)))


@cache
def _on_arrays(law: Any) -> Any:
    """Returns the Python of a compiled law, which calls numpy's functions."""
    python = law.py_func
    known = {**python.__globals__, **_ARRAYS}
    for name in python.__code__.co_names:
        if hasattr(known.get(name), "py_func"):
            known[name] = _on_arrays(known[name])
    return FunctionType(python.__code__, known, closure=python.__closure__)


def listed(
    effect: Effect, where: str, shape: dict[str, float], columns: Callable[[], Columns]
) -> Missing:
    """Returns an effect of the catalogue at a place as a candidate.

    Its columns are made when they are asked for: all of them at once fill the memory.
    """
    return Missing(
        name=effect.name, where=where, phrase=effect.phrase,
        sizes=tuple(s.name for s in effect.sizes), units=tuple(s.unit for s in effect.sizes),
        signs=tuple(s.sign for s in effect.sizes), columns=columns,
        shape=tuple((s.name, shape[s.name], s.unit) for s in effect.shapes if shape),
        most=tuple(s.farthest for s in effect.sizes),
    )  # fmt: skip
