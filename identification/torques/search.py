"""What torques find missing: laws, one after the other, and curves where no law explains a joint.

laws      the best proven one is added beside the model fit, until none is proven; then what has
          become needless is dropped
curves    take the place of all laws of a joint that together predict unseen blocks worse, as
          the laws nearest to a force in no catalogue do; and are added where no law is proven
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial, reduce

from identification.discovery.neighbour import MORE_LIKELY_THAN_NOT, MOST_LEFT
from identification.shares import fall_words
from identification.torques.candidates import together
from identification.torques.equations import Equations
from identification.torques.fits import Fitted, extended
from identification.torques.laws import Missing
from identification.torques.scores import CHANCE, Score, choose, rank, rises

MOST_NAMED = 4  # effects that a search adds


def add_proven(
    equations: Equations, nominal: Fitted, found: Sequence[Score], scores: Sequence[Score],
    say: Callable[[str], None],
) -> tuple[list[Score], Fitted]:  # fmt: skip
    """Returns effects with the best proven ones more, as long as there are any, and the fit.

    Args:
        equations: of the records.
        nominal: the model fit without effects.
        found: effects that are there.
        scores: of those that may be added, beside all that are there, the best first.
        say: is told one line an effect.
    """
    out, final, rest = [*found], _extended(equations, nominal, [s.missing for s in found]), scores
    while len(out) < MOST_NAMED and (score := choose(rest)) is not None:
        more = extended(equations, final, score.missing)
        if rises(equations, final.base, more.base):
            rest = [s for s in rest if s.missing.key != score.missing.key]
            continue
        final = more
        out.append(score)
        say(f"{score.missing.title}: {fall_words(score.fall)} on unseen blocks, t {score.t:.1f}")
        # A law keeps the shape that was its best beside the model.
        rest = rank(equations, final.base, others_of(rest, [score]))
    needed = [s for s in out if _is_needed(equations, nominal, out, s)]
    if len(needed) < len(out):
        out, final = needed, _extended(equations, nominal, [s.missing for s in needed])
    return out, final


def draw_curves(
    equations: Equations, nominal: Fitted, found: Sequence[Score], scores: Sequence[Score],
    say: Callable[[str], None],
) -> tuple[list[Score], Fitted]:  # fmt: skip
    """Returns effects with curves where laws do not explain a joint, and the fit with them.

    A curve takes the place of all laws of a joint that together predict unseen blocks worse, as
    the laws nearest to a force in no catalogue do, or beside which a curve still explains much of
    what the joint's torque leaves, beyond chance. Where the curve is not proven, and is more likely
    than not to be no luck, they are left out all the same. Where no law is proven, curves may be.
    """
    curves, out = [s.missing for s in scores if s.missing.is_curve], [*found]
    for where in dict.fromkeys(s.missing.where for s in found):
        mine = [s for s in out if s.missing.where == where]
        there = [c for c in curves if c.where == where]
        rest = [s for s in out if s not in mine]
        if not there:
            continue
        bare = _extended(equations, nominal, [s.missing for s in rest])
        likely = [s for s in rank(equations, bare.base, there) if s.chance < MORE_LIKELY_THAN_NOT]
        own = rank(equations, bare.base, [together([s.missing for s in mine])])
        best = choose(likely) or next(iter(likely), None)
        whole = _extended(equations, nominal, [s.missing for s in out])
        beside = rank(equations, whole.base, there)
        has_pattern = any(s.chance < CHANCE and s.fall > MOST_LEFT * s.share for s in beside)
        if best is not None and (has_pattern or not any(o.is_like(best) for o in own)):
            say(f"{best.missing.title}: predicts unseen blocks better than the laws there")
            out = [*rest, *([best] if best.is_proven else [])]
    final = _extended(equations, nominal, [s.missing for s in out])
    places = {s.missing.where for s in out}
    beside = rank(equations, final.base, [c for c in curves if c.where not in places])
    return add_proven(equations, nominal, out, beside, say)


def others_of(scores: Sequence[Score], found: Sequence[Score]) -> list[Missing]:
    """Returns the candidates of scores that are none of those that were found."""
    keys = {s.missing.key for s in found}
    return [s.missing for s in scores if s.missing.key not in keys]


def _is_needed(equations: Equations, nominal: Fitted, found: Sequence[Score], score: Score) -> bool:
    """Returns whether an effect is still proven beside all that were found after it."""
    if len(found) < 2:
        return True
    others = [s.missing for s in found if s is not score]
    again = rank(equations, _extended(equations, nominal, others).base, [score.missing])
    return bool(again) and again[0].is_proven


def _extended(equations: Equations, fitted: Fitted, effects: Sequence[Missing]) -> Fitted:
    """Returns a fit with some effects more."""
    return reduce(partial(extended, equations), effects, fitted)
