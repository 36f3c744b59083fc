"""The states of a plant's joints, and the numbers of their gears in its model.

row of a joint = (…, where θ and p stand, side, c, ε, J, ζ, c of friction, key, TAG)
armature - J                     the motor's inertia is moved from the joint, not added to it
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import mujoco
import numpy as np

from identification.effects.axes import Axis
from identification.effects.effect import Effect
from identification.effects.joint_states import (
    WIDTH,
    GearNumbers,
    JointState,
    begun,
    first_states_of,
    gear_numbers,
    places_of,
    shown,
)
from identification.effects.values import Values
from identification.engine import quiet
from identification.errors import DivergenceError, InputError
from identification.logs.names import listed
from identification.model.paths import Slot
from identification.model.predictor import Numbers
from identification.model.rollout import State
from identification.native.gear import GEARS, GRIP, MOTOR, SIDE
from identification.native.joint_callback import LAST

POSES = 8  # random ones, behind the model's own


@quiet()
def mobilities(model: mujoco.MjModel, joints: Sequence[str]) -> np.ndarray:
    """Returns A among some joints in several poses, shape (`POSES`, g, g) [1/kg or 1/(kg m²)]."""
    data, rng = mujoco.MjData(model), np.random.default_rng(0)
    dofs = [int(model.joint(joint).dofadr[0]) for joint in joints]
    units, columns = np.zeros((len(dofs), model.nv)), np.zeros((len(dofs), model.nv))
    units[range(len(dofs)), dofs] = 1.0
    out = np.empty((POSES, len(dofs), len(dofs)))
    for pose in out:
        mujoco.mj_forward(model, data)
        if dofs:
            mujoco.mj_solveM(model, data, columns, units)
        pose[:] = columns[:, dofs]
        mujoco.mj_integratePos(model, data.qpos, rng.normal(0, 1, model.nv), 1.0)
    return out


def felt_inertias(A: np.ndarray) -> np.ndarray:
    """Returns I of each joint, shape (g,) [kg m² or kg], from A of `mobilities`."""
    return np.asarray(1 / np.max(np.diagonal(A, axis1=1, axis2=2), axis=0))


def refuse_greedy(J: np.ndarray, A: np.ndarray, joints: Sequence[str]) -> None:
    """Refuse motors that leave less than nothing to the links.

    Args:
        J: inertias of the motors that move by themselves, else 0, in n value sets, shape (n, g).
        A: of `mobilities`.
        joints: their names.

    Raises:
        DivergenceError: a value set has such motors.
    """
    J = J[np.count_nonzero(J, axis=1) > 1]
    if not len(J):
        return
    root = np.sqrt(J)[:, None]
    share = np.linalg.eigvalsh(root[..., None] * A * root[..., None, :])[..., -1]
    if np.any(share >= 1):
        raise DivergenceError(
            f"the motors of {listed(joints)} would have more inertia than the robot has; take a"
            " smaller share rho"
        )


_WHERE = {"motor": MOTOR, "grip": GRIP}


@dataclass(frozen=True, eq=False)
class Gears:
    """The states of a plant's joints.

    Attributes:
        effects: all of the plant.
        axes: the joints that may have effects.
        states: of joints.
        model: with actuators for the states.
        spec: the model as its file has it, on which shares of inertia are counted.
    """

    effects: tuple[Effect, ...]
    axes: tuple[Axis, ...]
    states: tuple[JointState, ...]
    model: mujoco.MjModel
    spec: mujoco.MjSpec

    @cached_property
    def joints(self) -> dict[str, Axis]:
        """The joints that have states."""
        named = {state.joint for state in self.states}
        return {axis.joint: axis for axis in self.axes if axis.joint in named}

    @cached_property
    def inertia(self) -> dict[str, float]:
        """I of each of these joints, that its drive feels [kg m² or kg]."""
        return dict(zip(self.joints, map(float, felt_inertias(self.mobilities)), strict=True))

    @cached_property
    def mobilities(self) -> np.ndarray:
        """M⁻¹ among these joints in several poses; see `motor_shares`."""
        return mobilities(self.spec.copy().compile() if self.joints else self.model, [*self.joints])

    @cached_property
    def numbers(self) -> tuple[str, ...]:
        """The plant's parameters that effects with states have."""
        every = (
            name
            for effect in self.effects if effect.state
            for joint in self.joints
            for parts in effect.parameters_at(joint)
            for name in parts
        )  # fmt: skip
        return tuple(dict.fromkeys(every))

    def of(self, joint: str, values: Values, n: int) -> GearNumbers:
        """Returns the numbers of a joint's gear under all effects, in n value sets."""
        mine = tuple(x for name in self.numbers if isinstance(x := values[name], float))
        if n == 1 and len(mine) == len(self.numbers):
            return self._of_one(joint, mine)  # a search simulates windows of it again and again
        return gear_numbers(self.effects, joint, self.inertia[joint], values, n)

    @cached_property
    def _of_one(self) -> Callable[[str, tuple[float, ...]], GearNumbers]:
        """The numbers of a gear in one value set, by the joint and the values of `numbers`."""

        @lru_cache(maxsize=64)
        def of_one(joint: str, mine: tuple[float, ...]) -> GearNumbers:
            values = dict(zip(self.numbers, mine, strict=True))
            with_states = [effect for effect in self.effects if effect.state]
            return gear_numbers(with_states, joint, self.inertia[joint], values, 1)

        return of_one

    def rows(self, names: Sequence[str], values: Values, n: int) -> Numbers:
        """Returns the entries of the joints' rows that some parameters change."""
        if not {*self.numbers} & {*names}:
            return []
        last = int(self.model.nuser_jnt) - LAST - GEARS
        out = []
        for joint in self.joints:
            columns = dict(enumerate(self.of(joint, values, n).columns, SIDE))
            where = dict.fromkeys(_WHERE.values(), -1)
            for state, at in zip(self.states, places_of(self.model, self.states), strict=True):
                if state.joint == joint:
                    where[_WHERE[state.kind]] = at
            for column, value in {**where, **columns}.items():
                slot = Slot("jnt_user", (int(self.model.joint(joint).id),), last + column)
                out.append((slot, np.broadcast_to(np.asarray(value, float), n)))
        return out

    def armatures(self, values: Values, n: int, own: Numbers) -> Numbers:
        """Returns armatures without the motors that move by themselves.

        Args:
            values: of all parameters, one or n of each.
            n: how many value sets.
            own: entries of the model that other parameters change.

        Raises:
            DivergenceError: the motors have more inertia than the robot.
        """
        out: list[tuple[Slot, np.ndarray]] = []
        each = {joint: self.of(joint, values, n) for joint in self.joints}
        if len(each) > 1:
            J = np.stack([np.where(g.is_geared, g.J, 0.0) for g in each.values()], axis=1)
            refuse_greedy(J, self.mobilities, [*each])
        for joint, g in each.items():
            if not g.is_geared.any():
                continue
            dof = int(self.model.joint(joint).dofadr[0])
            whole = np.full(n, float(self.model.dof_armature[dof]))
            for slot, column in own:
                if slot.field == "dof_armature" and dof in slot.rows:
                    whole = np.broadcast_to(column, n)
            out.append((Slot("dof_armature", (dof,), None), whole - np.where(g.is_geared, g.J, 0)))
        return out

    def refuse_stateless(
        self, needed: Mapping[str, Sequence[JointState]], names: Sequence[str], values: np.ndarray
    ) -> None:
        """Refuse sizes of effects whose states the plant does not have.

        Raises:
            InputError: there is one that is not zero.
        """
        lacking = [
            name for k, name in enumerate(names)
            if not {*needed.get(name, ())} <= {*self.states} and np.any(values[:, k])
        ]  # fmt: skip
        if lacking:
            raise InputError(
                f"{listed(lacking)} need{'s' * (len(lacking) == 1)} states of its own, which this"
                " plant does not have; take plant.with_states_of(names)"
            )

    def begun(self, values: Values, n: int, known: State) -> State:
        """Returns states as MuJoCo integrates them; see `identification.effects.joint_states`."""
        if not self.states:
            return known
        return begun(self.model, self.states, self._repeated(values, n, len(known.qpos)),
                     self.joints, known)  # fmt: skip

    def shown(
        self, values: Values, n: int, run: Mapping[str, np.ndarray]
    ) -> Mapping[str, np.ndarray]:
        """Returns positions and rates as encoders see them."""
        if not self.states:
            return run
        each = self._repeated(values, n, len(run["qpos"]))
        return shown(self.model, self.states, each, run)

    def first_states(
        self, values: Values, loads: tuple[np.ndarray, np.ndarray, np.ndarray], sampling_time: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Returns the states where windows begin, and how far off they may be."""
        gears = {joint: self.of(joint, values, 1) for joint in self.joints}
        forces = {joint: axis.force for joint, axis in self.joints.items()}
        return first_states_of(self.states, self.model, gears, forces, loads, sampling_time)

    def _repeated(self, values: Values, n: int, m: int) -> dict[str, GearNumbers]:
        """Returns each joint's gear numbers for m simulations, m/n of each value set."""
        out = {}
        for joint in self.joints:
            g = self.of(joint, values, n)
            each = {name: np.repeat(x, m // n) for name, x in vars(g).items()}
            out[joint] = GearNumbers(**each)
        return out


def needed_states(effects: Sequence[Effect]) -> dict[str, tuple[JointState, ...]]:
    """Returns the states that each size of an effect needs, by its name."""
    out: dict[str, tuple[JointState, ...]] = {}
    for effect in effects:
        kind = effect.state
        if kind not in WIDTH:
            continue
        single = [suffix[1:] for suffix in effect.places.values() if suffix]
        for where, suffix in effect.places.items():
            at = [suffix[1:]] if suffix else single
            for size in effect.sizes:
                out[effect.parameter(size.name, where)] = tuple(
                    JointState("motor" if kind == "motor" else "grip", joint) for joint in at
                )
    return out
