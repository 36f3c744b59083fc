"""A pendulum with dry friction: what a search over a horizon finds, and what is left without it."""

from dataclasses import replace
from functools import cache

from records_cases import records, search

LEVEL = 0.03  # of the hidden friction [N m]
EFFECTS = ("coulomb_friction", "curve_speed", "curve_position")


@cache
def named():
    """A discovery that names the friction."""
    return search(records(4, {"coulomb_friction.f_c@hinge": LEVEL}, samples=300), EFFECTS)


def unknown():
    """The same, as if no candidate had been proven."""
    answer = named()
    return replace(answer, verdict="unknown effect", named=(), final=answer.nominal,
                   after=answer.before, remaining=answer.scores, findings=())  # fmt: skip
