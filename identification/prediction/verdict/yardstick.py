"""What share of all that smooth forces could explain the effects of a model explain.

The smooth forces are the curves of rate, position, drive and time of each joint, all at once
(`identification.discovery.forces.smooth_force`). What they would explain beside a model is a moment
of its linearisation over the fitted windows; blocks of windows judge it that it was not fitted to.

Near a force of two variables, such as a motor's that falls with its speed, lies some law of the
catalogue, and no curve of one variable tells them apart. So where a model leaves something, the
surfaces over two variables (`identification.effects.laws.surfaces`) of the joints on which its laws
act are part of the smooth force. They are simulated in a plant of their own.

What speaks against the name of a law is what smooth forces of its own variables explain beyond
those of other variables: a force of the position that is left beside a friction is another thing
that is missing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.chances import mean_above_zero
from identification.discovery.candidates import list_common
from identification.discovery.forces.smooth_force import (
    SmoothForce,
    explained_share,
    find_smooth_force,
)
from identification.effects.effect import Candidate, Effect
from identification.effects.laws.curves import OF_JOINT
from identification.effects.laws.surfaces import surface_effects
from identification.effects.plant.jointed import JointPlant
from identification.effects.variables import variables
from identification.prediction.fits.model import WindowModel
from identification.prediction.scoring.forced import acts_on_joints
from identification.prediction.scoring.scores import (
    Condensed,
    WindowScore,
    condensed,
    window_scores,
)
from identification.prediction.scoring.screening import MAX_SCORED, places_of, some_windows
from identification.windows.fit import WindowFit

# A smooth force is found by solving for all of its nodes some thousand times.
MAX_SURFACE_JOINTS = 3


@dataclass(frozen=True)
class Beyond:
    """What smooth forces of a law's variables explain beyond those of other variables."""

    joint: str  # in words, where they take most
    share: float  # of what the model leaves
    chance: float  # of as much by luck, over blocks


@dataclass(frozen=True)
class Yardstick:
    """What smooth forces would still explain beside a model, over what the model leaves."""

    every: float  # share of the sum of squares that forces at all joints would take
    of_joint: Mapping[str, float]  # share that forces at one joint would take, by its name
    # of each law of the model: what smooth forces of its variables would take beyond others
    beyond: Mapping[tuple[str, str], Beyond]
    curves: tuple[WindowScore, ...]  # each curve at each joint by itself

    def share(self, before: float, after: float) -> float | None:
        """Returns what a model explains of what it and smooth forces at all joints could.

        Args:
            before: sum of squares without its effects.
            after: with them.
        """
        return explained_share(before, after, self.every * after)

    def share_of(self, candidate: Candidate, explained: float, curves: float = 0.0) -> float | None:
        """Returns what an effect explains of what it and smooth forces at its joints could.

        The joints of a law of sensors are those that they measure: a servo that is pushed aside
        looks like an encoder that errs.

        Args:
            candidate: the effect at its place.
            explained: sum of squares that it took away, over what the model leaves.
            curves: likewise of the curves that the model has at its joints.

        Returns:
            None for what is no law of a joint or of its sensor.
        """
        left = [self.of_joint[j] for j in own_joints(candidate) if j in self.of_joint]
        if not left:
            return None
        return explained_share(explained, 0.0, max(left) + curves)


def own_joints(law: Candidate) -> list[str]:
    """Returns the joints on which a law acts or which its sensors measure; none of other laws."""
    places = places_of(law.where)
    if acts_on_joints(law.effect):
        return places
    return [law.effect.joints[where] for where in places if where in law.effect.joints]


def may_draw(curve: Effect, law: Effect) -> bool:
    """Returns whether a curve or surface depends on a variable of a law, or the law on none."""
    of_law = variables(law) if acts_on_joints(law) else frozenset()
    return not of_law or bool(variables(curve) & of_law)


@dataclass(frozen=True)
class Forces:
    """Curves and surfaces of joints, and perhaps a law, beside a model: what windows tell of them.

    A law stands last.
    """

    candidates: tuple[Candidate, ...]
    count: int  # of curves and surfaces
    scores: tuple[WindowScore, ...]  # of each curve by itself
    known: Condensed

    @property
    def joints(self) -> tuple[str, ...]:
        """The places of curves and surfaces, in words."""
        return tuple(dict.fromkeys(c.where for c in self.candidates[: self.count]))

    def at(self, joint: str) -> list[int]:
        """Returns the indices of curves and surfaces at a joint."""
        return [k for k in range(self.count) if self.candidates[k].where == joint]

    def force(self, some: Sequence[int]) -> SmoothForce:
        """Returns the best force of some candidates, by their indices."""
        ends = np.cumsum([len(c.sizes) for c in self.candidates])
        nodes = [len(self.candidates[k].sizes) for k in some]
        here = np.concatenate(
            [np.arange(ends[k] - n, ends[k]) for k, n in zip(some, nodes, strict=True)]
        )
        G, a = self.known.G, self.known.a
        return find_smooth_force(G[:, here][:, :, here], a[:, here], nodes)

    def share(self, some: Sequence[int]) -> float:
        """Returns the share of what the model leaves that this force takes away."""
        return self.share_of(self.force(some))

    def share_of(self, force: SmoothForce) -> float:
        """Returns the share of what the model leaves that a force takes away."""
        return min(1.0, force.gain / float(self.known.squares.sum()))


def list_forces(
    model: WindowModel, effects: Sequence[Effect], is_left: bool = False,
    joints: Sequence[str] = (), law: Candidate | None = None,
) -> Forces | None:  # fmt: skip
    """Returns the smooth forces beside a model; None where there are none.

    Args:
        model: fitted.
        effects: of the catalogue, of which the curves of a joint make the smooth forces.
        is_left: whether the model leaves something, so that forces of two variables are asked too.
        joints: the only ones that are asked, in words; all of them when empty.
        law: which the model lacks.

    Raises:
        DivergenceError: the model cannot be simulated beside its values.
    """
    has = {c.key for c in model.candidates}
    curves = [e for e in effects if e.is_curve and e.name.endswith(OF_JOINT)]
    each = [c for c in list_common(curves) if c.key not in has and c.effect.places[c.where]]
    each = [c for c in each if c.where in joints or not joints]
    if not each:
        return None
    # What laws took away was measured in these units too.
    fit = model.fit.weighed(model.scale)
    scores = window_scores(fit, each)
    surfaces, fit = _with_surfaces(model, fit, joints) if is_left else ([], fit)
    smooth = (*each, *surfaces)
    every = (*smooth, law) if law else smooth
    fit = some_windows(fit) if sum(len(c.sizes) for c in smooth) > MAX_SCORED else fit
    return Forces(every, len(smooth), scores, condensed(fit, every))


def measure(
    model: WindowModel, effects: Sequence[Effect], is_left: bool = False,
    joints: Sequence[str] = (),
) -> Yardstick | None:  # fmt: skip
    """Returns what smooth forces would still explain beside a model; None where there are none.

    Args:
        model: fitted.
        effects: as in `list_forces`, and so are the others.
        is_left: likewise.
        joints: likewise.

    Raises:
        DivergenceError: the model cannot be simulated beside its values.
    """
    smooth = list_forces(model, effects, is_left, joints)
    if smooth is None:
        return None
    forces = {j: smooth.force(smooth.at(j)) for j in smooth.joints}
    of_joint = {j: smooth.share_of(f) for j, f in forces.items()}
    every = next(iter(of_joint.values()))
    if len(forces) > 1:
        every = smooth.share(range(smooth.count))

    def beyond(law: Candidate, joint: str) -> Beyond:
        others = [
            k for k in smooth.at(joint) if not may_draw(smooth.candidates[k].effect, law.effect)
        ]
        gains = forces[joint].gains - (smooth.force(others).gains if others else 0.0)
        share = float(gains.sum() / smooth.known.squares.sum())
        return Beyond(joint, min(1.0, share), mean_above_zero(gains)[1] if share > 0 else 1.0)

    found = {}
    for law in model.candidates:
        at = [j for j in places_of(law.where) if j in forces]
        if at and acts_on_joints(law.effect) and not law.effect.is_curve:
            found[law.key] = max((beyond(law, j) for j in at), key=lambda b: b.share)
    return Yardstick(every, of_joint, found, smooth.scores)


def _with_surfaces(
    model: WindowModel, fit: WindowFit, joints: Sequence[str]
) -> tuple[list[Candidate], WindowFit]:
    """Returns the surfaces at some joints, and a fit in a plant that has them.

    Where no joints are given, they are those on which laws act; without laws, all. There are none
    at very many joints.
    """
    plant = model.plant
    if not isinstance(plant, JointPlant):
        return [], fit
    laws = [c for c in model.candidates if acts_on_joints(c.effect)]
    at = {*joints} or {
        joint
        for c in laws
        for joint in (places_of(c.where) if c.effect.places.get(c.where) else c.effect.places)
    }
    effects = surface_effects(plant.axes)
    chosen = [c for c in list_common(effects) if c.where in at or not at]
    if not 0 < len({c.where for c in chosen}) <= MAX_SURFACE_JOINTS:
        return [], fit
    there = plant.with_effects(effects)
    parts = tuple(
        replace(p, predictor=replace(p.predictor, plant=there)) for p in fit.problem.parts
    )
    return chosen, replace(fit, problem=replace(fit.problem, parts=parts))
