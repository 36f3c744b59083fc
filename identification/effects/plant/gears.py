"""The states of a plant's joints, and the numbers of their gears in its model.

row of a joint = (…, where θ, p and z stand, side, c, ε, J, ζ, c of friction, d_m, k_i, key, TAG)
armature - J                     the motor's inertia is moved from the joint, not added to it

As a window knows them (s and w stay small where a gear becomes stiff):

    motor   s, w       δ = c s + ε s/(|s| + s_0),  dδ/dt = c w             [N m, N m/s or N, N/s]
    grip    p          the force of the friction                                     [N m or N]
    sum     z          ∫ e dt of a servo with an integral part                   [rad s or m s]

As MuJoCo integrates them: θ = q + δ, ω = v + dδ/dt, p and z. Where the encoder sits on the motor's
side, what is measured is θ, so that q = θ - δ. Sizes of zero leave q and v as they are, to the bit.

Where windows begin, a gear that does not swing carries what moves the link:

    s̄ = f_u - J dv/dt          p̄ = the force of friction          w̄ = 0

The states of windows are free about that: s and p by their own rms, w by a change of s by its rms
within a sample; z as `identification.effects.servo_error` says.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import mujoco
import numpy as np

from identification.effects.axes import Axis
from identification.effects.effect import Effect
from identification.effects.plant.joint_states import (
    GearNumbers,
    JointState,
    felt_inertias,
    gear_numbers,
    mobilities,
    places_of,
    refuse_greedy,
)
from identification.effects.servo_error import sum_where
from identification.effects.values import Values
from identification.errors import InputError
from identification.logs.log import Log
from identification.logs.names import listed
from identification.model.paths import Slot
from identification.model.predictor import Numbers
from identification.model.rollout import State
from identification.native.joints.gear import GEARS, GRIP, MOTOR, SIDE, SUM
from identification.native.joints.joint_callback import LAST

_WHERE = {"motor": MOTOR, "grip": GRIP, "sum": SUM}
CERTAIN = 0.02  # s_0, of the largest force of the drives: with more, teeth are sure to touch
LEAST = 1e-3  # of the largest force of the drives: the smallest std of a force


@dataclass(frozen=True, eq=False)
class Gears:
    """The states of a plant's joints."""

    effects: tuple[Effect, ...]  # all of the plant
    axes: tuple[Axis, ...]  # the joints that may have effects
    states: tuple[JointState, ...]  # of joints
    model: mujoco.MjModel  # with actuators for the states
    spec: mujoco.MjSpec  # the model as its file has it, on which shares of inertia are counted

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
        """M⁻¹ among these joints in several poses; see `mobilities`."""
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
        """Returns armatures without the motors that move by themselves."""
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
        """Refuse sizes of effects whose states the plant does not have."""
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
        """Returns states as MuJoCo integrates them, from states as windows know them (m rows)."""
        if not self.states:
            return known
        qpos, qvel, act = np.array(known.qpos), np.array(known.qvel), np.array(known.act)
        for g, at, q, v, axis in self._motors(values, n, len(qpos)):
            s, w = act[:, at].copy(), act[:, at + 1].copy()
            delta = g.c * s + g.gap * s / (abs(s) + CERTAIN * axis.force)
            rate = (g.c + g.gap / (abs(s) + axis.force)) * w
            qpos[:, q] -= g.side * delta
            qvel[:, v] -= g.side * rate
            act[:, at], act[:, at + 1] = qpos[:, q] + delta, qvel[:, v] + rate
        return State(qpos, qvel, act)

    def shown(
        self, values: Values, n: int, run: Mapping[str, np.ndarray]
    ) -> Mapping[str, np.ndarray]:
        """Returns positions and rates as encoders see them: the motor's where they sit there.

        `run` has qpos, qvel and act of m simulations, shape (m, samples, size).
        """
        if not self.states:
            return run
        qpos, qvel, act = np.array(run["qpos"]), np.array(run["qvel"]), run["act"]
        for g, at, q, v, _ in self._motors(values, n, len(qpos)):
            rows = np.flatnonzero(g.is_geared & (g.side > 0))
            qpos[rows, :, q], qvel[rows, :, v] = act[rows, :, at], act[rows, :, at + 1]
        return {**run, "qpos": qpos, "qvel": qvel}

    def first_states(
        self,
        values: Values,
        loads: tuple[np.ndarray, np.ndarray, np.ndarray],
        log: Log,
        starts: np.ndarray,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Returns states where windows begin, shape (W, na), and how far off they may be, (na,).

        `loads` are those of `first_loads`; `starts` first samples of windows of the log, (W,).
        """
        drives, friction, rates = loads
        columns, far = [], []
        for state in self.states:
            dof = int(self.model.joint(state.joint).dofadr[0])
            axis = self.joints[state.joint]
            least = LEAST * axis.force
            if state.kind == "sum":
                z, most = sum_where(self.model, axis.servo, axis.force, log, starts)
                columns.append(z)
                far.append(most)
                continue
            if state.kind == "grip":
                columns.append(friction[:, dof])
                far.append(max(least, _rms(columns[-1])))
                continue
            s = drives[:, dof] - self.of(state.joint, values, 1).J[0] * rates[:, dof]
            columns += [s, np.zeros(len(s))]
            far += [max(least, _rms(s)), max(least, _rms(s)) / log.sampling_time]
        return np.stack(columns, axis=1), np.array(far)

    def _motors(
        self, values: Values, n: int, m: int
    ) -> Iterator[tuple[GearNumbers, int, int, int, Axis]]:
        """Yields of each motor its gear in m simulations, and where θ, q and v stand; its joint.

        Each value set has m/n neighbouring simulations.
        """
        for state, at in zip(self.states, places_of(self.model, self.states), strict=True):
            if state.kind != "motor":
                continue
            each = vars(self.of(state.joint, values, n)).items()
            g = GearNumbers(**{name: np.repeat(x, m // n) for name, x in each})
            joint = self.model.joint(state.joint)
            yield g, at, int(joint.qposadr[0]), int(joint.dofadr[0]), self.joints[state.joint]


def _rms(x: np.ndarray) -> float:
    return float(np.sqrt(np.mean(x**2)))
