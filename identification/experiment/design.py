"""The design of the next experiment: what tells the free values best, or rival models apart.

    values      min Σ_j var(q_j)       A-optimal: the worst-known values weigh most, and one that no
                                       motion tells adds the same to every design
    rivals      max min_ij λ_ij        T-optimal for the two that are hardest to tell apart

q are the coordinates of a fit: relative where a value is positive, else in units of its scale.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.effects.plant.jointed import JointPlant
from identification.errors import DivergenceError, InputError
from identification.experiment.hypotheses import Hypothesis, Seen, separations, shares_after
from identification.experiment.playing import Played, Stage
from identification.experiment.search import search
from identification.experiment.series import Series, changed, draw
from identification.runtime.progress import counted


@dataclass(frozen=True)
class Tried:
    """An experiment that keeps the limits, and what it would tell."""

    played: Played
    seen: tuple[Seen, ...]  # by the hypotheses

    @property
    def std(self) -> np.ndarray:
        """Expected std of the free values of the first hypothesis, shape (p,), in their units."""
        return self.seen[0].of.std(self.seen[0].precision)

    @property
    def separations(self) -> np.ndarray:
        """λ, shape (n, n)."""
        return separations(self.seen)

    @property
    def value(self) -> float:
        """The criterion; more is better."""
        if len(self.seen) > 1:
            return float(self.separations.min())
        covariance = np.linalg.pinv(self.seen[0].precision, rcond=1e-14, hermitian=True)
        return -float(np.trace(covariance))


@dataclass(frozen=True, kw_only=True)
class Design:
    """The next experiment."""

    stage: Stage  # the robot, its limits, and how the experiment is played
    hypotheses: tuple[Hypothesis, ...]  # the model that is believed, then its rivals
    best: Tried  # the designed experiment
    random: Tried  # a random one within the same limits, the median of those that were tried
    evaluations: int  # how many were evaluated
    seed: int  # of the search

    @property
    def before(self) -> np.ndarray:
        """Std of the free values before the experiment, shape (p,), in their units."""
        first = self.hypotheses[0]
        return first.std(first.known)

    @property
    def shares(self) -> tuple[float, ...]:
        """Probabilities of the hypotheses before, each of them the right one, sum one."""
        total = sum(h.share for h in self.hypotheses)
        return tuple(h.share / total for h in self.hypotheses)

    @property
    def shares_after(self) -> np.ndarray:
        """Expected probability of each where it is the right one, shape (n,)."""
        return shares_after(self.shares, self.best.separations)


def design(
    stage: Stage,
    hypotheses: Sequence[Hypothesis],
    budget: int = 60,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
) -> Design:
    """Search the next experiment.

    Raises:
        InputError: the budget is too small, or nothing that was tried keeps the limits.
    """
    if budget < 4:
        raise InputError(f"a budget of {budget} experiments finds nothing; give at least 4")
    plants = [_begun(h, stage) for h in hypotheses]
    n, most = len(stage.center), stage.most_waves

    def attempt(series: Series) -> tuple[Series, Tried] | None:
        found = stage.attempt(series)
        if found is None:
            return None
        smaller, played = found
        pairs = zip(hypotheses, plants, strict=True)
        try:
            return smaller, Tried(played, tuple(h.seen(played.log, p) for h, p in pairs))
        except DivergenceError:
            return None

    rng = np.random.default_rng(seed)
    steps = search(
        lambda _, rng: draw(n, most, rng), lambda s, rng: changed(s, rng), attempt,
        lambda t: t.value, budget, rng,
    )  # fmt: skip
    tried: list[Tried] = []
    best: Tried | None = None
    for count, (_, one) in enumerate(counted(steps, "experiments", budget), 1):
        if count <= budget // 2:
            tried.append(one)
        if best is None or one.value > best.value:
            best = one
            if progress is not None:
                progress(f"experiment {count} of {budget}: {_told(one)}")
    if best is None:
        raise InputError(
            "no experiment that was tried keeps the limits; widen them, or give another duration"
        )
    middle = sorted(tried, key=lambda t: t.value)[len(tried) // 2]
    return Design(
        stage=stage, hypotheses=tuple(hypotheses), best=best, random=middle,
        evaluations=budget, seed=seed,
    )  # fmt: skip


def _begun(h: Hypothesis, stage: Stage) -> JointPlant:
    plant = h.plant
    return replace(plant, bare=replace(plant.bare, start=stage.plant.bare.start))


def _told(one: Tried) -> str:
    if len(one.seen) > 1:
        return f"expected log odds of the nearest rivals {0.5 * one.value:.3g}"
    return f"mean expected std {np.sqrt(-one.value / len(one.std)):.3g}, relative or of its scale"
