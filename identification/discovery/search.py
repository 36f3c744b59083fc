"""Find where a model and a log disagree, name what is missing, add it, prove it.

fit the nominal model  ->  score all candidates  ->  refit the best  ->  prove on unseen data
                                   ^__________________________________________|   up to 3 times
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

import numpy as np

from identification.discovery.confidence import name_effects
from identification.discovery.findings.input_error import find_input_error
from identification.discovery.findings.input_hold import find_input_hold
from identification.discovery.findings.location import (
    believed,
    find_doubtful_effect,
    find_structure,
    input_error,
    located,
)
from identification.discovery.findings.robot_change import find_robot_change
from identification.discovery.fitted_model import (
    AcceptedEffect,
    FittedModel,
    fit_model,
    score_candidates,
)
from identification.discovery.missing_forces import estimate_missing_forces
from identification.discovery.nominal_model import NominalModel
from identification.discovery.proof import prove
from identification.discovery.result import Discovery, Tried, Verdict
from identification.discovery.scoring.detectability import detectable
from identification.discovery.scoring.scores import Score
from identification.discovery.scoring.sensitivities import Sensitivity, columns, common, single
from identification.discovery.scoring.significance import find_oversized
from identification.discovery.selection.forward_selection import select_effect
from identification.discovery.selection.pairs import find_pair
from identification.discovery.selection.pruning import backward, swap
from identification.effects.effect import Effect
from identification.errors import InputError
from identification.kalman.noise_fit import ALLOWED
from identification.logs.log import Log
from identification.model.sensitivity import refuse_without_effect
from identification.report.discovery_words import beyond

MOST = 3  # effects
EXPLAINED = 0.5  # of the gap on unseen data that named effects must close to be more than a guess
SHORTEST = 200  # samples to fit, and as many to confirm: blocks of 5 and 10 samples at least


def discover(
    base: NominalModel,
    log: Log,
    effects: Sequence[Effect],
    progress: Callable[[str], None] | None = None,
) -> Discovery:
    """Name what a model lacks to explain a log.

    Args:
        base: the nominal model with every candidate effect compiled in, its free parameters and
            what is known of them.
        log: its part `estimation` (or first half) is fitted, the rest confirms.
        effects: the candidates.
        progress: is told a line per stage.

    Raises:
        InputError: the log is too short, a name is unknown, or a free parameter has no effect.
        DivergenceError: the nominal model cannot be simulated.
    """
    refuse_unfit(log)
    say = progress or (lambda line: None)
    clock = _Clock()
    nominal = fit_model(base, log, (), {})
    refuse_without_effect(nominal.refit.point.J, base.names, log)
    clock("nominal fit")
    say(f"nominal fit: {1e3 * nominal.validation.rms:.3g}e-3 on unseen data")
    sensed = _sensitivities(base, nominal, effects)
    clock("sensitivities")
    first = ranked = score_candidates(nominal, sensed)
    clock("scores")
    say(f"{len(ranked)} candidates scored, {ranked[0].candidate.effect.name} first")
    accepted: list[AcceptedEffect] = []
    rejected: tuple[Tried, ...] = ()
    step = nominal
    while len(accepted) < MOST:
        new, rejected, hopeful = select_effect(base, log, step, ranked, say)
        more: tuple[AcceptedEffect, ...] = () if new is None else (new,)
        if hopeful is not None and len(accepted) + 2 <= MOST:
            more = find_pair(base, log, step, hopeful, sensed, say)
        clock("refits")
        if not more:
            break
        accepted += more
        step, rejected = accepted[-1].step, ()
        ranked = score_candidates(step, sensed)
        clock("scores")
    kept, step = backward(base, log, accepted, step)
    kept, step = swap(base, log, nominal, kept, step, sensed)
    if len(accepted) > 1:
        ranked = score_candidates(step, sensed)
    clock("refits")
    along = find_input_error(step)
    left = (
        *find_structure(step),
        *find_robot_change(step),
        *along,
        *(() if accepted else find_doubtful_effect(rejected)),
    )
    if (
        other := find_oversized(first, [a.step.candidates[-1].effect.name for a in kept])
    ) is not None:
        left += (beyond(other),)
    explained = _explained(nominal, step, random=not along)
    left = (*(find_input_hold(nominal) if left else ()), *left)
    named = name_effects(base, kept, step, sensed, explained if left else 1.0)
    verdict: Verdict = "nothing missing"
    if named and (not left or (explained > EXPLAINED and believed(step) and other is None)):
        verdict = "named"
    elif named or left:
        verdict = "unknown effect"
        rejected = (*(Tried(n.candidate, n.parameters, n.gain, n.proof) for n in named), *rejected)
        named, step, ranked = (), nominal, first
    missing = estimate_missing_forces(nominal.refit) if verdict != "nothing missing" else ()
    where = located(nominal, missing) if verdict != "nothing missing" else ()
    return Discovery(
        log, verdict, named, bool(left), step.refit.level.sigma,
        0.0 if along else step.validation.disturbance,
        nominal.validation.gap, step.validation.gap, nominal.refit, step.refit,
        log.outputs - nominal.validation.e, log.outputs - step.validation.e, first, ranked,
        detectable(ranked), where, left, missing, clock.seconds, base.horizon, rejected,
    )  # fmt: skip


def _explained(nominal: FittedModel, step: FittedModel, random: bool) -> float:
    """Share of the gap on unseen data that effects close.

    The gap ends at what sensors and input errors make, if these can be believed: as small as noise
    is, and random.
    """
    proof = prove(nominal.validation, step.validation)
    return proof.share if random and input_error(step.refit) <= ALLOWED else proof.above


def _sensitivities(
    base: NominalModel, nominal: FittedModel, effects: Sequence[Effect]
) -> tuple[Sensitivity, ...]:
    """Of every effect everywhere, then of the best shape of each at its single places."""
    everywhere = columns(nominal.refit.point, common(effects))
    best: dict[str, Score] = {}
    for s in score_candidates(nominal, everywhere):
        best.setdefault(s.candidate.effect.name, s)
    return everywhere + columns(nominal.refit.point, single([s.candidate for s in best.values()]))


def refuse_unfit(log: Log) -> None:
    """Refuse a log that cannot be fitted at its beginning and confirmed on the rest.

    Raises:
        InputError: it is too short, or its part `estimation` is not its beginning.
    """
    part = log.part("estimation")
    n, rest = len(part), len(log) - len(part)
    if min(n, rest) < SHORTEST:
        raise InputError(
            f"the log has {n} samples to fit and {rest} that are not fitted; discovery needs at"
            f" least {SHORTEST} of each: record longer, or change the split in the log's TOML"
        )
    if not np.array_equal(part.inputs, log.inputs[:n]):
        raise InputError(
            "the log's part 'estimation' does not begin where the log begins; discovery fits the"
            " beginning and confirms on the rest: change the split in the log's TOML"
        )


class _Clock:
    """Wall time by stage."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self.last = time.perf_counter()

    def __call__(self, stage: str) -> None:
        now = time.perf_counter()
        self.seconds[stage] = self.seconds.get(stage, 0.0) + now - self.last
        self.last = now
