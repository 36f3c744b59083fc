"""The recovered force of an effect that was named over a horizon: see `recovered_force`.

    ĉ = argmin Σ_w ‖(I - P_w) (r_w - S_w c)‖²,   cov(ĉ) = H⁻¹ (Σ_b g_b g_bᵀ B/(B - 1)) H⁻¹

r_w is the residual of window w with the law, S_w the response of its outputs to a unit force at
each node, P_w projects on what the state at its start makes up for, g_b = Σ_{w in b} S_wᵀ(I - P_w)
(r_w - S_w ĉ): a window may begin elsewhere where another force acts in it. Blocks of windows are
the sample of the noise, which need not be white (White 1980); where white noise of the same size
would give a node a larger std, it has that one.

Each window is simulated from its own state with the first set of values, and the inputs that reach
it are cut out of those of the whole record: what an effect does to an input may last longer than
the time since the window began.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.discovery.effect_results import Rival
from identification.discovery.forces.force_along import Stretch, forces_along
from identification.discovery.forces.free_nodes import MAX_FORCE_POINTS
from identification.discovery.forces.recovered_force import (
    RecoveredForce,
    Shown,
    compare_force,
    law_steps,
    moved_by,
    show_forces,
    show_readings,
)
from identification.effects.effect import Candidate
from identification.kalman.trajectory import COARSE_POINTS, average_inputs, divided
from identification.model.coordinates import NOTHING
from identification.model.protocol import with_numbers
from identification.model.rollout import hold, rollout, substeps, without_sensors
from identification.prediction.fits.model import WindowModel
from identification.runtime.pool import one_blas_thread
from identification.windows.fit import STD_BLOCKS
from identification.windows.held import NO_VALUES
from identification.windows.problem import MIN_WINDOWS
from identification.windows.shooting import Shooting, Tangent


def recover_over_horizon(
    model: WindowModel, candidate: Candidate, rivals: Sequence[Rival] = ()
) -> RecoveredForce | None:
    """Returns the force of an effect, recovered from the fitted windows.

    Args:
        model: with the effect.
        candidate: the effect.
        rivals: what else was refitted in its place; their laws are drawn with their own sizes.

    Returns:
        None where the effect makes no force, forces that are no function of one quantity of each
        joint, forces inside a joint (a compliance), or is each record's own.

    Raises:
        DivergenceError: the model cannot be simulated.
    """
    if candidate.effect.state or candidate.effect.own:
        return None
    is_reading = "reading" in candidate.effect.hooks
    rivals = [r for r in rivals if _is_alike(r.candidate, is_reading)]
    steps = law_steps(candidate, model.std)
    with one_blas_thread():
        each = [_windows(model, k, candidate, steps, rivals) for k in range(len(model.fit.moves))]
        shown = (_of_readings if is_reading else _of_forces)(candidate, each)
        if shown is None or shown.is_mixed:
            return None
        c, std = _solve(each, shown.response)
    fit = model.fit
    slope = fit.problem.prior.space.slope(fit.q)
    moved_so = moved_by(steps, fit.problem.names, fit.covariance, slope)
    return compare_force(candidate, shown, c, std, moved_so, [r.candidate for r in rivals])


@dataclass(frozen=True)
class _Windows:
    """Some windows of a record: values without the effect, with it, and with other values."""

    tangent: Tangent
    values: dict[str, float]
    base: HeldWindows
    sets: tuple[HeldWindows, ...]

    @property
    def part(self) -> Shooting:
        return self.base.part


def _windows(
    model: WindowModel, record: int, candidate: Candidate, steps: dict[str, float],
    rivals: Sequence[Rival],
) -> _Windows:  # fmt: skip
    fit = model.fit
    part, d, t = fit.problem.parts[record], fit.moves[record], fit.tangents[record]
    most = max(MIN_WINDOWS, MAX_FORCE_POINTS // (len(fit.moves) * part.cut.inputs.shape[1]))
    at = np.unique(np.linspace(0, len(d) - 1, min(most, len(d))).astype(int))
    part, d, t = part.rows(at), d[at], t.rows(at)
    values = {**part.predictor.fixed, **fit.of_record(record)}
    base = {**values, **dict.fromkeys(candidate.sizes, 0.0)}
    moved = [{**values, name: values[name] + step} for name, step in steps.items()]
    sets = [values, *moved, *({**base, **r.values} for r in rivals)]
    return _Windows(
        t, values, with_values(part, d, base), tuple(with_values(part, d, s) for s in sets)
    )


def _of_forces(candidate: Candidate, each: Sequence[_Windows]) -> Shown | None:
    """Returns forces on joints; None where the law has none, or not on joints of one kind alone."""
    stretches = [s for windows in each for s in stretches_of(windows.base, windows.sets)]
    along = forces_along(stretches, np.concatenate([_flat(w.sets[0].outputs) for w in each]))
    return None if along is None else show_forces(candidate, each[0].values, along)


def _of_readings(candidate: Candidate, each: Sequence[_Windows]) -> Shown | None:
    """Returns the errors of sensors."""
    log = each[0].part.predictor.log
    own = [w.base.outputs for w in each]
    rate = [np.gradient(y, log.sampling_time, axis=1) for y in own]
    readings = [
        np.concatenate([_flat(of.outputs) for of in same])
        for same in zip(*(w.sets for w in each), strict=True)
    ]
    length = own[0].shape[1]
    time = [
        (w.part.times[:, None] + log.sampling_time * np.arange(length)).ravel() for w in each
    ]  # fmt: skip
    y, ydot = (np.concatenate([*map(_flat, parts)]) for parts in (own, rate))
    return show_readings(log, y, ydot, np.concatenate(time), readings)


def _solve(each: Sequence[_Windows], S: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns the likeliest forces at the nodes, and their std, each of shape (m,)."""
    out, left, done = [], [], 0
    for windows in each:
        t, part = windows.tangent, windows.part
        W, L, ny = part.cut.outputs.shape
        own = S[done : done + W * L].reshape(W, L, ny, -1)
        done += W * L
        whitened = np.einsum("ij,wljm->wlim", part.whitener, own).reshape(W, L * ny, -1)
        rows = np.zeros((W, t.r.shape[1], S.shape[-1]))  # moves of the states stay as they are
        rows[:, : L * ny] = whitened
        U = t.U * (t.s > 0)[:, None]
        out.append(rows - U @ (np.swapaxes(U, 1, 2) @ rows))
        left.append(t.r - np.einsum("wmk,wk->wm", U, np.einsum("wmk,wm->wk", U, t.r)))
    H = np.sum([np.einsum("wmi,wmj->ij", s, s) for s in out], axis=0)
    g = np.sum([np.einsum("wmi,wm->i", *pair) for pair in zip(out, left, strict=True)], axis=0)
    inverse = np.linalg.pinv(H, rcond=1e-12, hermitian=True)
    c = inverse @ g
    scores = np.concatenate(
        [np.einsum("wmi,wm->wi", s, r - s @ c) for s, r in zip(out, left, strict=True)]
    )
    blocks = min(STD_BLOCKS, max(2, len(scores)))
    b = np.array([part.sum(axis=0) for part in np.array_split(scores, blocks)])
    by_blocks = np.diag(inverse @ (b.T @ b * blocks / (blocks - 1)) @ inverse)
    rest = np.concatenate([(r - s @ c).ravel() for s, r in zip(out, left, strict=True)])
    white = np.mean(rest**2) * np.diag(inverse)
    # A node in a few windows only has luck in its blocks, so that its variance is the larger one.
    return c, np.where(np.diag(H) > 0, np.sqrt(np.maximum(by_blocks, white)), np.inf)


def _is_alike(rival: Candidate, is_reading: bool) -> bool:
    """Returns whether a rival's law can be drawn beside the named one."""
    effect = rival.effect
    return not (effect.state or effect.own) and ("reading" in effect.hooks) == is_reading


@dataclass(frozen=True)
class HeldWindows:
    """The windows of one record at one set of values."""

    part: Shooting  # the windows, of a predictor with no free parameters
    moves: np.ndarray  # of their states, shape (W, nx)

    @property
    def outputs(self) -> np.ndarray:
        """The predicted outputs, shape (W, L, ny)."""
        return self.part.outputs(NO_VALUES, [self.moves])[0]

    @property
    def every(self) -> int:
        """Steps of the simulation in a sample."""
        predictor = self.part.predictor
        return substeps(predictor.log.sampling_time, predictor.plant.model.opt.timestep)

    @property
    def reaching(self) -> np.ndarray:
        """Inputs that reach the model at each step, shape (W, steps, nu)."""
        inputs, each, kind = self.part.held_inputs(NO_VALUES)
        return hold(inputs, self.every, kind) if each == 1 else inputs[:, :-1]


def with_values(part: Shooting, moves: np.ndarray, values: Mapping[str, float]) -> HeldWindows:
    """Returns the windows of a record with all values given.

    Args:
        part: the windows.
        moves: of their states, shape (W, nx).
        values: of the parameters that differ from the plant's own, by name.
    """
    predictor = replace(part.predictor, names=(), fixed=values)
    return HeldWindows(replace(part, predictor=predictor, space=NOTHING), moves)


def stretches_of(base: HeldWindows, sets: Sequence[HeldWindows]) -> list[Stretch]:
    """Returns each window as a stretch, simulated with the first of some sets of values.

    Args:
        base: with θ₀.
        sets: each with a θ; the windows and the moves are the same.

    Raises:
        DivergenceError: a window cannot be simulated.
    """
    law = sets[0]
    predictor, every = law.part.predictor, law.every
    plant, step = predictor.plant.model, predictor.plant.model.opt.timestep
    models, reaching = [], []
    for each in (base, *sets):
        numbers = each.part.predictor.settings(NO_VALUES)[1]
        models.append(with_numbers(without_sensors(plant), numbers, 0))
        reaching.append(each.reaching)
    held, W = reaching[1], len(law.moves)
    run = rollout(
        plant, predictor.begun(NO_VALUES, law.part.states(law.moves)),
        np.concatenate([held, held[:, -1:]], axis=1), step,
        numbers=[(slot, np.repeat(column, W)) for slot, column in predictor.settings(NO_VALUES)[1]],
        record=("qpos", "qvel", "act") if plant.na else ("qpos", "qvel"), time=law.part.times,
    )  # fmt: skip
    out = []
    for w, begun in enumerate(law.part.times.tolist()):
        states = {field: x[w] for field, x in run.items()}
        along = divided(models[1], states, held[w], every, begun, COARSE_POINTS)
        reached = [
            (model, average_inputs(inputs[w], along.steps, plant.nu)[0])
            for model, inputs in zip(models, reaching, strict=True)
        ]
        out.append(Stretch(predictor, along, reached))
    return out


def _flat(outputs: np.ndarray) -> np.ndarray:
    """Returns the outputs of windows (W, L, ny) one after the other, shape (W L, ny)."""
    return outputs.reshape(-1, outputs.shape[-1])
