"""The force that a joint would need in place of all that a model lacks, drawn as finely as it can.

    r_w ≈ Σ_s R_ws f(x_ws, v_ws),   f(x, v) = Σ_k h_k(x) (c_k + sgn(v) d_k)
    c = L z,   L Lᵀ = K,   K_kl = Σ_λ exp(-|x_k - x_l|/λ),   d likewise

R_ws are the outputs of window w for a unit force on the joint in its short time s, h_k hats about
`NODES` places x_k over the range of the motion: a bump that is far narrower than the nodes of a
curve that a search can add (`identification.effects.laws.curves`) is seen. The lengths λ reach from
a quarter of the range to a node, so that a wide force is smooth all the same; how strong common
force c and force d against the motion may be is told by blocks of windows that the force was not
fitted to (`identification.discovery.forces.smooth_force`). Free parameters of the model make room
for the force, so that what they can imitate, such as a damping over the rate, is no part of it.

Of all that a force on a joint may depend on, the one is taken by which it predicts most of those
blocks, or a simpler one that predicts nearly as much. Its chance is that of the mean of the blocks'
log gains, paid for all that were tried:

    g_b = -ln(1 - gain_b/(‖r_b‖² + s)),   s = 0 and s = mean over blocks of ‖r_b‖² - gain_b

With the second s a block counts little in which nothing is missing, such as one that never passes a
bump: the smallest force there is many times what noise leaves of it. With s = 0 those count little
that are explained worst. The better of the two chances is taken, and both are paid for.

The std of the force is that of a jackknife over the folds (Efron 1982). It tells where a model
fails, and names nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from identification.chances import mean_above_zero
from identification.discovery.forces.smooth_force import SmoothForce, find_smooth_force
from identification.effects.named import SIDES, neighbour
from identification.effects.plant.jointed import JointPlant
from identification.native.joints.joint_callback import Joint
from identification.prediction.scoring.columns import forces_of, whitened, without_states
from identification.prediction.scoring.forced import Forces
from identification.prediction.scoring.scores import Condensed, each_condensed
from identification.prediction.scoring.screening import some_windows
from identification.windows.fit import WindowFit

NODES = 64  # over the range of what a force depends on
LENGTHS = (1 / 4, 1 / 12, 1 / 36)  # λ, of that range
OUTSIDE = 1e-3  # share of the motion beyond each end of the range: a spike is no range
# Of what a force explains: what one that is less simple must add, as where it differs by direction.
ENOUGH = 0.1
FEWEST = 5  # steps of the simulation about a node, from which the force there is known
MOST_TIMES = 48  # short times of a window, at most
AT_ONCE = 24  # forces whose outputs are computed at once: bounds the memory
MOST_SAMPLES = 20_000  # of the windows that are asked
MOST_JOINTS = 12  # that are asked: each takes seconds
FIELDS = {"position": "q", "speed": "v", "load": "f_u", "time": "time"}  # of `Joint`, by words


@dataclass(frozen=True, kw_only=True)
class FineForce:
    """The force that a joint would need, over what it depends on."""

    joint: str  # on which it acts
    depends_on: str  # the last words of the name of such a curve: "position", "speed_before", ...
    at: np.ndarray  # the nodes, shape (m,), in SI units
    # at the nodes, where the joint's position rises and where it falls, or once where it is the
    # same in both directions; shape (1 or 2, m) [N m or N]
    force: np.ndarray
    std: np.ndarray  # of it; infinite where no motion tells it
    fall: float  # share of the fitted error that it takes away in blocks that it was not fitted to
    chance: float  # of as much by luck, for the best of all that were tried


@lru_cache(maxsize=2)  # a report asks often about the same fit
def fine_forces(
    fit: WindowFit, scale: tuple[float, ...]
) -> tuple[tuple[FineForce, ...], int] | None:
    """Returns the force that each joint would need by itself, the one that explains most first.

    Args:
        fit: a model.
        scale: of each output, in its unit, by which its error counts.

    Returns:
        The forces, and how many were tried; None where forces have no linear response: where joints
        have states of their own, a pose is a quaternion, or limits act in most windows.

    Raises:
        DivergenceError: the model cannot be simulated.
    """
    plant, fit = fit.problem.plant, _some(fit.weighed(np.array(scale)))
    if not isinstance(plant, JointPlant) or len(plant.joints) > MOST_JOINTS:
        return None
    along = [f for f in forces_of(fit) if f is not None]
    is_smooth = [f.along.is_smooth for f in along]
    if len(along) < len(fit.moves) or not np.mean(np.concatenate(is_smooth)) > 0.5:
        return None
    tried, best = 0, list[FineForce]()
    for j, joint in enumerate(plant.joints):
        responses = [_responses(fit, k, f, j) for k, f in enumerate(along)]
        signs = [np.sign(v) for v in _fields(along, j, "v")]
        asked = [*_asked(along, plant, j)]
        told = each_condensed(fit, (a.columns(responses, signs) for a in asked))
        every = [_drawn(joint, a, signs, of) for a, of in zip(asked, told, strict=True)]
        tried += len(every)
        least = max((f.fall for f in every), default=0.0) / (1 + ENOUGH)
        best += sorted((f for f in every if f.fall >= least), key=lambda f: len(f.force))[:1]
    paid = (replace(f, chance=min(1.0, tried * f.chance)) for f in best)
    return tuple(sorted(paid, key=lambda f: -f.fall)), tried


def _some(fit: WindowFit) -> WindowFit:
    """Returns a fit seen through as many of its windows as are told of in seconds."""
    samples = sum(p.cut.outputs[..., 0].size for p in fit.problem.parts)
    return some_windows(fit, every=-(-samples // MOST_SAMPLES)) if samples > MOST_SAMPLES else fit


@dataclass(frozen=True)
class _Asked:
    """What a force may depend on, in the windows of each record."""

    word: str
    x: list[np.ndarray]  # at the steps of the windows, shape (W, K) a record
    at: np.ndarray  # nodes, shape (m,)

    def hats(self, record: int) -> np.ndarray:
        """Returns h_k at the steps of the windows of a record, shape (W, K, m)."""
        x = np.clip(self.x[record], self.at[0], self.at[-1])[..., None]
        return np.asarray(np.maximum(0.0, 1 - np.abs(x - self.at) / (self.at[1] - self.at[0])))

    def columns(self, responses: Sequence[np.ndarray], signs: Sequence[np.ndarray]) -> np.ndarray:
        """Returns the rows of unit forces at the nodes, and of those along the motion, (N, k)."""
        out = []
        for record, (R, sign) in enumerate(zip(responses, signs, strict=True)):
            h = self.hats(record)
            h = np.concatenate([h, h * sign[..., None]], axis=2)
            first = np.flatnonzero(np.diff(_times(h.shape[1]), prepend=-1))
            count = np.diff(first, append=h.shape[1])[:, None]
            out.append(R @ (np.add.reduceat(h, first, axis=1) / count))
        return np.concatenate([S.reshape(-1, S.shape[2]) for S in out])


def _fields(along: Sequence[Forces], joint: int, field: str) -> list[np.ndarray]:
    """Returns what is known of a joint at the steps of the windows, shape (W, K) a record."""
    at = Joint._fields.index(field)
    return [f.along.slopes.joints[:, joint, at].reshape(len(f.along.times), -1) for f in along]


def _asked(along: Sequence[Forces], plant: JointPlant, joint: int) -> Iterator[_Asked]:
    """Yields all that the force on a joint may depend on and that changes along the windows."""
    joints = [*plant.joints]
    every = [(word, joint, field) for word, field in FIELDS.items()]
    for side in SIDES:
        if (other := neighbour(side, joints[joint], plant)) in joints:
            k = joints.index(other)
            every += [(side, k, "q"), (f"speed_{side}", k, "v")]
    for word, k, field in every:
        x = _fields(along, k, field)
        low, high = np.quantile(np.concatenate(x, axis=None), [OUTSIDE, 1 - OUTSIDE])
        if high > low:
            yield _Asked(word, x, np.linspace(low, high, NODES))


def _times(steps: int) -> np.ndarray:
    """Returns the short time to which each step of a window belongs, shape (steps,)."""
    return np.arange(steps) * min(MOST_TIMES, steps) // steps


def _responses(fit: WindowFit, record: int, forces: Forces, joint: int) -> np.ndarray:
    """Returns R of a unit force on a joint in each of n short times of a window, shape (W, m, n).

    It is zero in windows in which a limit or a contact acts.
    """
    along, (P, J) = forces.along, forces.along.slopes.g.shape
    W, parts = len(along.times), []
    times = _times(P // W)
    for some in np.array_split(np.unique(times), -(-len(np.unique(times)) // AT_ONCE)):
        τ = np.zeros((len(some), P, J))
        τ[..., joint] = np.tile(times == some[:, None], W)
        y = along.outputs(forces.passed(τ), np.ones(len(some)))
        parts.append(whitened(fit, record, y))
    R = np.concatenate(parts, axis=2)
    R[~along.is_smooth] = 0.0
    return without_states(fit.tangents[record], R)


def _drawn(joint: str, asked: _Asked, signs: Sequence[np.ndarray], told: Condensed) -> FineForce:
    """Returns the force on a joint over one thing that it may depend on."""
    m, apart = len(asked.at), np.abs(asked.at[:, None] - asked.at) / np.ptp(asked.at)
    L = np.linalg.cholesky(sum(np.exp(-apart / λ) for λ in LENGTHS))
    near = sum((_near(asked.hats(k), sign) for k, sign in enumerate(signs)), np.zeros((2, m)))
    found, sides = _best(told, L, 1), 1
    if (two := _best(told, L, 2)).gain > (1 + ENOUGH) * found.gain:
        found, sides = two, 2
    # c and d by all blocks, then without those of each fold
    f = np.vstack([found.c, found.left_out]).reshape(-1, sides, m) @ L.T
    if sides == 2:
        f = np.stack([f[:, 0] + f[:, 1], f[:, 0] - f[:, 1]], axis=1)
    if asked.word == "speed":  # on either side of zero it is of one direction
        f = np.where(asked.at >= 0, f[:, :1], f[:, -1:])
        near = np.where(asked.at >= 0, near[:1], near[1:])
    elif sides == 1:
        near = near.sum(axis=0, keepdims=True)
    std = np.sqrt((len(f) - 2) * f[1:].var(axis=0))
    chance = _chance(found.gains, told.squares) if found.gain > 0 else 1.0
    return FineForce(
        joint=joint, depends_on=asked.word, at=asked.at, force=f[0],
        std=np.where(near < FEWEST, np.inf, std), fall=found.gain / float(told.squares.sum()),
        chance=chance,
    )  # fmt: skip


def _chance(gains: np.ndarray, squares: np.ndarray) -> float:
    """Returns the chance of such gains of blocks (B,), of their sums of squares (B,), by luck."""
    each = []
    for s in (1e-300, float(np.mean(squares - gains))):
        share = gains / (squares + s)
        each.append(mean_above_zero(-np.log(np.maximum(1e-9, 1 - share)))[1])
    return min(1.0, len(each) * min(each))


def _best(told: Condensed, L: np.ndarray, sides: int) -> SmoothForce:
    """Returns the force of the same size in both directions, or with one along the motion too."""
    basis = np.kron(np.eye(sides), L)
    k = len(basis)
    return find_smooth_force(
        basis.T @ told.G[:, :k, :k] @ basis, told.a[:, :k] @ basis, [len(L)] * sides
    )


def _near(hats: np.ndarray, sign: np.ndarray) -> np.ndarray:
    """Returns how many steps of rising and of falling motion are about each node, shape (2, m)."""
    return np.array([hats[s].sum(axis=0) for s in (sign >= 0, sign < 0)])
