"""Find where a model and a log disagree, name what is missing, add it, prove it.

fit the nominal model  ->  score all candidates  ->  refit the best  ->  prove on unseen data
                                   ^__________________________________________|   up to 3 times
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

import numpy as np

from identification.discovery.along import goes_along
from identification.discovery.both import both
from identification.discovery.changed import changed
from identification.discovery.columns import Column, columns, common, single
from identification.discovery.confidence import named_of
from identification.discovery.detectable import detectable
from identification.discovery.extend import Base
from identification.discovery.forward import add
from identification.discovery.held import held_otherwise
from identification.discovery.locate import believed, in_doubt, input_error, left_over, located
from identification.discovery.missing import missing_forces
from identification.discovery.passes import backward, swap
from identification.discovery.proof import prove
from identification.discovery.result import Discovery, Tried, Verdict
from identification.discovery.score import Score
from identification.discovery.significant import too_large
from identification.discovery.steps import Accepted, Step, fitted, scores_of
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
    base: Base,
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
    nominal = fitted(base, log, (), {})
    refuse_without_effect(nominal.refit.at.J, base.names, log)
    clock("nominal fit")
    say(f"nominal fit: {1e3 * nominal.unseen.rms:.3g}e-3 on unseen data")
    sensed = _sensitivities(base, nominal, effects)
    clock("sensitivities")
    first = ranked = scores_of(nominal, sensed)
    clock("scores")
    say(f"{len(ranked)} candidates scored, {ranked[0].candidate.effect.name} first")
    accepted: list[Accepted] = []
    rejected: tuple[Tried, ...] = ()
    step = nominal
    while len(accepted) < MOST:
        new, rejected, hopeful = add(base, log, step, ranked, say)
        more: tuple[Accepted, ...] = () if new is None else (new,)
        if hopeful is not None and len(accepted) + 2 <= MOST:
            more = both(base, log, step, hopeful, sensed, say)
        clock("refits")
        if not more:
            break
        accepted += more
        step, rejected = accepted[-1].step, ()
        ranked = scores_of(step, sensed)
        clock("scores")
    kept, step = backward(base, log, accepted, step)
    kept, step = swap(base, log, nominal, kept, step, sensed)
    if len(accepted) > 1:
        ranked = scores_of(step, sensed)
    clock("refits")
    along = goes_along(step)
    left = (*left_over(step), *changed(step), *along, *(() if accepted else in_doubt(rejected)))
    if (other := too_large(first, [a.step.candidates[-1].effect.name for a in kept])) is not None:
        left += (beyond(other),)
    explained = _explained(nominal, step, random=not along)
    left = (*(held_otherwise(nominal) if left else ()), *left)
    named = named_of(base, kept, step, sensed, explained if left else 1.0)
    verdict: Verdict = "nothing missing"
    if named and (not left or (explained > EXPLAINED and believed(step) and other is None)):
        verdict = "named"
    elif named or left:
        verdict = "unknown effect"
        rejected = (*(Tried(n.candidate, n.parameters, n.gain, n.proof) for n in named), *rejected)
        named, step, ranked = (), nominal, first
    missing = missing_forces(nominal.refit) if verdict != "nothing missing" else ()
    where = located(nominal, missing) if verdict != "nothing missing" else ()
    return Discovery(
        log, verdict, named, bool(left), step.refit.level.sigma,
        0.0 if along else step.unseen.disturbance,
        nominal.unseen.gap, step.unseen.gap, nominal.refit, step.refit,
        log.outputs - nominal.unseen.e, log.outputs - step.unseen.e, first, ranked,
        detectable(ranked), where, left, missing, clock.seconds, base.horizon, rejected,
    )  # fmt: skip


def _explained(nominal: Step, step: Step, random: bool) -> float:
    """Share of the gap on unseen data that effects close.

    The gap ends at what sensors and input errors make, if these can be believed: as small as noise
    is, and random.
    """
    proof = prove(nominal.unseen, step.unseen)
    return proof.share if random and input_error(step.refit) <= ALLOWED else proof.above


def _sensitivities(base: Base, nominal: Step, effects: Sequence[Effect]) -> tuple[Column, ...]:
    """Of every effect everywhere, then of the best shape of each at its single places."""
    everywhere = columns(nominal.refit.at, common(effects))
    best: dict[str, Score] = {}
    for s in scores_of(nominal, everywhere):
        best.setdefault(s.candidate.effect.name, s)
    return everywhere + columns(nominal.refit.at, single([s.candidate for s in best.values()]))


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
