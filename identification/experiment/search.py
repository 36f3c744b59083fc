"""The search for the best experiment: the first half is random, the second changes the best one.

A search by random changes, which keeps what is better, asks nothing of the criterion: it has kinks
where limits are met, and a model with friction has more (a (1+1) evolution strategy from the best
of many random starts; Rechenberg 1973).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeVar

import numpy as np

R = TypeVar("R")
C = TypeVar("C")
TRIES = 20  # recipes that may break a limit, for each that is evaluated


def search(
    draw: Callable[[int, np.random.Generator], R],
    change: Callable[[R, np.random.Generator], R],
    attempt: Callable[[R], tuple[R, C] | None],
    value: Callable[[C], float],
    budget: int,
    rng: np.random.Generator,
) -> Iterator[tuple[R, C]]:
    """Yields recipes that keep the limits, with what they give, until the budget of these is spent.

    Args:
        draw: returns a random recipe; it is told how many were tried before.
        change: returns a recipe that is near to another one.
        attempt: returns a recipe, made smaller until it keeps the limits, with what it gives.
        value: says how good that is; more is better.
        budget: how many are evaluated.
        rng: of random numbers.
    """
    best: tuple[R, float] | None = None
    count = 0
    for tried in range(TRIES * budget):
        if count == budget:
            return
        is_random = best is None or count < budget // 2
        recipe = draw(tried, rng) if is_random or best is None else change(best[0], rng)
        if (found := attempt(recipe)) is None:
            continue
        count += 1
        yield found
        good = value(found[1])
        if best is None or best[1] < good:
            best = found[0], good
