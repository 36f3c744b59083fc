"""Laws that have the name of a neighbour of what is missing, judged by curves beside them.

    share = (f_c - f)/f_c,   t of ln ‖r_b‖² - ln ‖r_b - ...‖²         over blocks b

f, f_c: falls of the mean square of unseen blocks by a law, and by the law with the curves of its
own variables at its joint beside it. The right law leaves nothing that curves would predict: they
predict worse with it, by as much as their nodes cost. What is near the right one leaves a pattern,
such as a spring that hardens where a soft stop is. The law's shapes are fitted first, because a
wrong shape leaves a pattern too.

Blocks of all records are cut into folds for this. A record that confirms moves where no fitted one
has been; a law knows something of that, and a curve does not, so that such a record speaks for any
law. Laws of the drive's force are not judged: their columns have the force that a fit without them
expects, which is off by as much as the law itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.torques.candidates import together
from identification.torques.equations.equations import Equations, unseen_squares
from identification.torques.laws import Missing
from identification.torques.moments import Base, Weighted, held_by, joined
from identification.torques.scores import t_of

# Of the power of both, a fourteenth of their force: a judgement. The rates with it are in
# docs/benchmarks.md.
MOST_BESIDE = 0.005
SURE = 2.5  # t of what curves predict beside it


@dataclass(frozen=True)
class Beside:
    """What curves explain beside a law."""

    share: float  # of what both explain
    t: float  # of what they predict of unseen blocks

    @property
    def has_neighbours_name(self) -> bool:
        """Tells whether the law is only near what is missing."""
        return self.share > MOST_BESIDE and self.t > SURE


def curves_beside(
    equations: Equations, bare: Base, law: Missing, curves: Sequence[Missing]
) -> Beside | None:
    """Returns what the curves of a law's variables explain beside it; None where there are none.

    `bare` is the fit without the law, which is of one joint, and `curves` are all of them.
    """
    mine = [c for c in curves if c.where == law.where and c.variables & law.variables]
    if law.is_curve or not mine or "f_u" in law.variables:
        return None
    none, of_law, of_both = (
        _unseen(equations, bare, m) for m in (None, law, replace(together([law, *mine]), ridges=()))
    )
    both = float((none - of_both).sum())
    share = float((of_law - of_both).sum()) / both if both > 0 else 0.0
    return Beside(share, t_of(np.log(of_law / of_both)))


def _unseen(equations: Equations, base: Base, missing: Missing | None) -> np.ndarray:
    """Returns the weighted squares of each block of all records, by fits that did not see it.

    Blocks of records that confirm are in the folds too: a curve is then asked nowhere where no fit
    has seen the motion. `missing` is a candidate that is added, if any.
    """
    whole = np.einsum("j,jbpq->bpq", base.fit.weights, base.M)
    held, of = np.zeros(0), None
    if missing is not None and (of := Weighted(equations, base).moments(missing.columns())):
        whole, held = joined(whole, *of), held_by(missing, of[1])
    P, θ_0 = np.append(base.P, held), np.append(base.θ_0, 0 * held)
    none = np.zeros(len(equations.record), bool)
    left = unseen_squares(whole[None], np.ones(1), P, θ_0, none)[0]
    return np.asarray(left[equations.counts.sum(axis=0) > 0])
