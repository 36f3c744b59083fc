"""What torques say of a robot: its base parameters, its friction, and what its model lacks.

    search       laws and curves beside the model fit (`identification.torques.search`)
    differences  a load at each body in one record alone, beside the base fit

The fits are those of `identification.torques.fits`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import compress
from typing import Literal

import mujoco
import numpy as np

from identification.discovery.impossible import Impossible, forbids, is_servo
from identification.discovery.passes import uses
from identification.effects.effect import Effect
from identification.effects.moving_bodies import MovingBody
from identification.logs.log import Log
from identification.torques.candidates import in_record, list_missing
from identification.torques.clock import Clocks, find_clocks
from identification.torques.equations.base import BaseParameters, find_base
from identification.torques.equations.consistency import find_inconsistent
from identification.torques.equations.equations import Equations
from identification.torques.equations.frictions import read_friction
from identification.torques.equations.others import FreeNumber, Others
from identification.torques.equations.rows import make_rows
from identification.torques.fits import Fitted, expect_drives, gains_fit
from identification.torques.laws import Missing
from identification.torques.moments import Base
from identification.torques.passive import fit_base
from identification.torques.scores import Score, rank
from identification.torques.search import Search, add_proven, draw_curves, others_of
from identification.torques.shapes import with_shapes

Doubt = Impossible | Literal["beside"]
OTHER_BAND = 0.6  # factor of the bands of a second fit, which tells what they matter


@dataclass(frozen=True, kw_only=True)
class Evidence:
    """What torques say."""

    equations: Equations  # of the records
    base: BaseParameters  # the combinations of inertial numbers
    whole: Fitted  # the base fit
    clocks: Clocks  # how much later the inputs of each record act than their stamps say
    other: np.ndarray  # sizes of the base fit in a narrower band, shape (p,)
    model: Fitted  # the model fit, without effects
    final: Fitted  # the model fit with the effects that were found
    scores: tuple[Score, ...]  # of all candidates beside the model fit, the best first
    found: tuple[Score, ...]  # scores of the effects that were added, each when it was
    # scores beside the final fit; those of `scores` where nothing was found
    rest: tuple[Score, ...]
    # scores of loads in single records beside the base fit, the best first
    differences: tuple[Score, ...]
    asked: int  # number of candidates beside the model fit, each shape counted
    # residual of each joint by fits that did not see it, of base, model and final fit, shape (3,
    # nv) [N m or N]
    unseen: np.ndarray
    friction: np.ndarray  # of the model, three numbers a joint as the fits have them, shape (3 nv,)
    inconsistent: tuple[int, ...]  # places of base parameters that no bodies have, within 3 std
    gains: tuple[str, ...]  # of drives, that are free in the model fit and held in the base fit
    # of effects that were added and are no names, by effect and place: what physics forbids of it,
    # or that it was found beside such a one
    doubts: Mapping[tuple[str, str], Doubt] = field(default_factory=dict)

    @property
    def noise(self) -> np.ndarray:
        """What noise alone would leave of each joint, shape (nv,), where it is white."""
        return self.equations.noise

    @property
    def passive(self) -> np.ndarray:
        """Which joints have no drive, shape (nv,)."""
        return np.asarray(~self.equations.stacked("drives").any(axis=(0, 2)))

    @property
    def named(self) -> tuple[Score, ...]:
        """The effects that were added and that are names, as `added`."""
        return tuple(s for s in self.added if s.missing.key not in self.doubts)

    @property
    def tried(self) -> tuple[Score, ...]:
        """The effects that were added and that are no names, as `added`."""
        return tuple(s for s in self.added if s.missing.key in self.doubts)

    @property
    def rivals(self) -> tuple[Score, ...]:
        """Other candidates that predict as well as the first effect added, the best first."""
        if not self.found:
            return ()
        first = self.found[0]
        others = (s for s in self.scores if s.missing.key != first.missing.key and s.is_proven)
        return tuple(s for s in others if s.is_like(first))

    @property
    def added(self) -> tuple[Score, ...]:
        """The effects that were added, each with its sizes and their std in the final fit."""
        fit, begin, out = self.final.fit, len(self.model.names), []
        for score in self.found:
            some = slice(begin, begin + len(score.size))
            fitted = replace(score, size=fit.θ[some], std=fit.std[some])
            out.append(replace(fitted, size=fitted.possible))
            begin += len(score.size)
        return tuple(out)


def find_evidence(
    model: mujoco.MjModel, logs: Sequence[Log], *, own: Sequence[mujoco.MjModel] = (),
    confirm: int = 0, free: Sequence[FreeNumber] = (), effects: Sequence[Effect] = (),
    bodies: Sequence[MovingBody] = (), friction: np.ndarray | None = None,
    say: Callable[[str], None] | None = None, without: Collection[str] = (),
) -> Evidence:  # fmt: skip
    """Returns what torques say of a robot.

    Args:
        model: of hinges and slides.
        logs: records with all positions and all inputs.
        own: the model of each log, where some of its values hold in that log alone.
        confirm: how many of the logs, the last ones, nothing is fitted to.
        free: parameters that are fitted with what was known of them.
        effects: of the catalogue, that may be missing.
        bodies: with places for payloads.
        friction: of the model, shape (3 nv,); its damping and friction loss where None.
        say: is told one line a step.
        without: passes of the search that are left out (`identification.discovery.passes`).

    Raises:
        InputError: no equations can be made of the model or of a log (`make_rows`).
    """
    say = say or (lambda text: None)
    measured = Equations.of(make_rows(model, logs, own), confirm)
    measured = replace(measured, all_judge="blocks_of_all_records" not in without)
    base = find_base(model)
    others = Others.of(free, measured, logs)
    clocks = find_clocks(model, measured, base, others, effects)
    measured = measured.shifted(clocks.shift.tolist())
    others = others.at(measured)
    equations, whole = fit_base(model, measured, base, others)
    expected = expect_drives(model, equations, whole)
    narrow = Equations.of(make_rows(model, logs, own, OTHER_BAND), confirm)
    narrow = narrow.shifted(clocks.shift.tolist())
    there = Others.of(free, narrow, logs, OTHER_BAND)
    other = fit_base(model, narrow, base, there)[1].fit.θ
    nominal = gains_fit(model, equations, free, others, expected)
    say(f"{int(equations.counts.sum())} equations, {len(base.names)} base parameters")
    candidates = list_missing(model, equations, expected, effects, bodies, [f.where for f in free])
    search = Search(equations, nominal, say, without)
    if not uses(search, "held_nodes"):
        candidates = tuple(replace(c, ridges=()) for c in candidates)
    scores, found, final = _searched(search, candidates)
    rest = rank(equations, final.base, others_of(scores, found)) if found else scores
    final = gains_fit(model, equations, free, others, expected, final.added)
    loads = [c for c in candidates if c.name == "load"]
    fitted = len(logs) - confirm
    single = [in_record(c, equations, k) for c in loads for k in range(fitted)]
    differences = rank(equations, whole.base, single) if fitted > 1 else ()
    unseen = [_unseen_residual(equations, f.base) for f in (whole, nominal, final)]
    r = len(base.names)
    evidence = Evidence(
        equations=equations, base=base, whole=whole, other=other, model=nominal, final=final,
        clocks=clocks, scores=scores,
        gains=tuple(compress([f.name for f in others.free], others.gains)),
        found=tuple(found), rest=rest, differences=differences,
        asked=len(candidates), unseen=np.array(unseen),
        friction=read_friction(model) if friction is None else friction,
        inconsistent=find_inconsistent(base, whole.fit.θ[:r], whole.fit.std[:r]),
    )  # fmt: skip
    if not uses(search, "impossible_sizes"):
        return evidence
    masses = {body.label: body.mass for body in bodies}
    return replace(evidence, doubts=_doubts(evidence, model, logs[:fitted], masses))


def _searched(
    search: Search, candidates: Sequence[Missing]
) -> tuple[tuple[Score, ...], list[Score], Fitted]:
    """Returns scores of all candidates, the effects that were found, and the fit with them."""
    scores = rank(search.equations, search.nominal.base, candidates)
    if uses(search, "fitted_shapes"):
        scores = with_shapes(search.equations, search.nominal.base, scores, len(candidates))
    first = f", {scores[0].missing.title} first" if scores else ""
    search.say(f"{len(candidates)} candidates scored{first}")
    laws = [s for s in scores if not s.missing.is_curve]
    found, _ = add_proven(search, [], laws)
    return scores, *draw_curves(search, found, scores)


def _doubts(
    evidence: Evidence, model: mujoco.MjModel, logs: Sequence[Log], masses: Mapping[str, float]
) -> dict[tuple[str, str], Doubt]:
    """Returns what is against the names of effects that were added, by effect and place.

    What was found beside a size that physics forbids makes up for what this one leaves.
    """
    out = dict[tuple[str, str], Doubt]()
    for score in evidence.added:
        name, where = score.missing.key
        thing = where.partition(" ")[2]
        sizes = [(float(v), masses.get(thing, np.inf)) for v in score.size]
        asked = "time_shift" if name == "delay" else name
        word = forbids(asked, sizes, logs, partial(_is_servo, model, thing))
        if word is not None or out:
            out[name, where] = word or "beside"
    return out


def _is_servo(model: mujoco.MjModel, name: str) -> bool:
    return is_servo(model, int(model.actuator(name).id))


def _unseen_residual(equations: Equations, base: Base) -> np.ndarray:
    """Returns the residual of each joint by fits that did not see it, shape (nv,)."""
    squares = base.unseen(equations.confirms)[:, equations.judges].sum(axis=1)
    n = equations.counts[:, equations.judges].sum(axis=1)
    return np.sqrt(np.where(n > 0, squares / np.maximum(n, 1), np.nan))
