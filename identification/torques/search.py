"""What torques find missing: laws, one after the other, and curves where no law explains a joint.

laws      the best proven one is added beside the model fit, until none is proven; then what has
          become needless is dropped
curves    take the place of all laws of a joint that together predict unseen blocks worse, or of
          which one has the name of a neighbour of what is missing; and are added where no law is
          proven
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from functools import partial, reduce

from identification.discovery.neighbour import MORE_LIKELY_THAN_NOT
from identification.discovery.passes import uses
from identification.shares import fall_words
from identification.torques.candidates import together
from identification.torques.equations.equations import Equations
from identification.torques.fits import Fitted, extended
from identification.torques.laws import Missing
from identification.torques.neighbours import curves_beside
from identification.torques.scores import Score, choose, rank, rises

MOST_NAMED = 4  # effects that a search adds


@dataclass(frozen=True)
class Search:
    """What a search has from its beginning to its end."""

    equations: Equations  # of the records
    nominal: Fitted  # the model fit without effects
    say: Callable[[str], None]  # is told one line an effect
    without: Collection[str] = ()  # passes that are left out

    def extended(self, effects: Sequence[Missing]) -> Fitted:
        """Returns the model fit with some effects."""
        return reduce(partial(extended, self.equations), effects, self.nominal)


def add_proven(
    search: Search, found: Sequence[Score], scores: Sequence[Score]
) -> tuple[list[Score], Fitted]:
    """Returns the effects that were found with the best proven ones more, and the fit.

    `scores` are of those that may be added, beside all that are there, the best first.
    """
    equations, rest = search.equations, scores
    out, final = [*found], search.extended([s.missing for s in found])
    while len(out) < MOST_NAMED and (score := choose(rest)) is not None:
        more = extended(equations, final, score.missing)
        if rises(equations, final.base, more.base):
            rest = [s for s in rest if s.missing.key != score.missing.key]
            continue
        final = more
        out.append(score)
        fall = fall_words(score.fall)
        search.say(f"{score.missing.title}: {fall} on unseen blocks, t {score.t:.1f}")
        # A law keeps the shape that was its best beside the model.
        rest = rank(equations, final.base, others_of(rest, [score]))
    needed = [s for s in out if _is_needed(search, out, s)]
    if len(needed) < len(out):
        out, final = needed, search.extended([s.missing for s in needed])
    return out, final


def draw_curves(
    search: Search, found: Sequence[Score], scores: Sequence[Score]
) -> tuple[list[Score], Fitted]:
    """Returns effects with curves where laws do not explain a joint, and the fit with them.

    A curve takes the place of all laws of a joint that together predict unseen blocks worse, or of
    which one has a neighbour's name. Where the curve is not proven, and is more likely than not to
    be no luck, they are left out all the same. Where no law is proven, curves may be.
    """
    equations = search.equations
    curves, out = [s.missing for s in scores if s.missing.is_curve], [*found]
    for where in dict.fromkeys(s.missing.where for s in found):
        mine = [s for s in out if s.missing.where == where]
        there = [c for c in curves if c.where == where]
        rest = [s for s in out if s not in mine]
        if not there:
            continue
        bare = search.extended([s.missing for s in rest])
        likely = [s for s in rank(equations, bare.base, there) if s.chance < MORE_LIKELY_THAN_NOT]
        own = rank(equations, bare.base, [together([s.missing for s in mine])])
        best = choose(likely) or next(iter(likely), None)
        if best is not None and (
            any(_has_neighbours_name(search, out, s, there) for s in mine)
            or not any(o.is_like(best) for o in own)
        ):
            search.say(f"{best.missing.title}: predicts what the laws there leave")
            out = [*rest, *([best] if best.is_proven else [])]
    final = search.extended([s.missing for s in out])
    places = {s.missing.where for s in out}
    beside = rank(equations, final.base, [c for c in curves if c.where not in places])
    return add_proven(search, out, beside)


def others_of(scores: Sequence[Score], found: Sequence[Score]) -> list[Missing]:
    """Returns the candidates of scores that are none of those that were found."""
    keys = {s.missing.key for s in found}
    return [s.missing for s in scores if s.missing.key not in keys]


def _has_neighbours_name(
    search: Search, found: Sequence[Score], law: Score, curves: Sequence[Missing]
) -> bool:
    """Returns whether a law is only near what is missing, beside all others that were found."""
    if not uses(search, "neighbours_of_torques"):
        return False
    bare = search.extended([s.missing for s in found if s is not law])
    beside = curves_beside(search.equations, bare.base, law.missing, curves)
    return beside is not None and beside.has_neighbours_name


def _is_needed(search: Search, found: Sequence[Score], score: Score) -> bool:
    """Returns whether an effect is still proven beside all that were found after it."""
    if len(found) < 2:
        return True
    others = search.extended([s.missing for s in found if s is not score])
    again = rank(search.equations, others.base, [score.missing])
    return bool(again) and again[0].is_proven
