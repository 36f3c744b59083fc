"""Laws beside the smooth force that a joint could have in their place.

The smooth force of a joint depends on its rate, position, drive and time, and on two of them at
once (`identification.prediction.verdict.yardstick`). Two kinds of laws draw it wherever it comes
from:

states     What a servo has summed up, or where a spring in a gear stands, is found anew in each
           window, unseen ones too. So proof on unseen records is not enough, and such a law must
           gain far more than the smooth force of its joints gains without it:

               g_j < -1/2 ln(1 - share of the law),      g_j = -ln(1 - share of the force)

elsewhere  A sensor's error, a mass or a fault of all inputs is no force of one joint, but it acts
           on the joints, and on a robot for which no law is exact one of many draws a part of what
           a joint has. A joint refutes it whose smooth force gains more, and beside which it does
           little; a law at k places is asked beside the forces of the k joints that gain most, too:

               g_l < 0.85 g_j    and    g_jl - g_j < 1/2 g_l     g_l: gain of the law, g_jl: of both

Gains are of the fitted windows of the model without the law, those of forces over blocks of windows
to which they were not fitted. A law that is a force of joints is asked in another way after the
search, because other effects may act there: the zero of an encoder beside a dry friction
(`identification.prediction.verdict.neighbours`).
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.plant.jointed import JointPlant
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.trial import Contender
from identification.prediction.scoring.forced import acts_on_joints
from identification.prediction.scoring.screening import single_places
from identification.prediction.verdict.neighbours import MOST_OF_BOTH
from identification.prediction.verdict.yardstick import list_forces, measure

# Of a law's gain: a smooth force that has more explains as much as the law, but for what free
# states add. A friction that gives left it less than a tenth in two pendulums; of an integral part
# that was not there, it had more than half in two legs, and less in one arm.
MOST_OF_GAIN = 0.5


def without_imitated(model: WindowModel, found: Contender, options: DiscoveryOptions) -> Contender:
    """Returns a contender, unproven where a smooth force of a joint does what its law does.

    Args:
        model: without it.
        found: what was refitted.
        options: the switches `free_states` and `smooth_rivals`.
    """
    if not found.is_proven:
        return found
    of_states = uses(options, "free_states") and is_smooth_force(model, found.model)
    if of_states or (uses(options, "smooth_rivals") and does_as_much(model, found.model)):
        return replace(found, doubt="smooth")
    return found


def is_smooth_force(model: WindowModel, new: WindowModel) -> bool:
    """Returns whether smooth forces gain about what the last effect of a model does, with states.

    Args:
        model: without the effect.
        new: with it.
    """
    plant, law = model.plant, new.candidates[-1]
    if not law.effect.state or not isinstance(plant, JointPlant):
        return False
    at = single_places(law)
    stick = attempt(None, partial(measure, model, plant.effects, is_left=True, joints=at))
    if stick is None:
        return False
    left = new.fitted_power / model.fitted_power
    return bool(np.log(max(1e-12, 1 - stick.every)) < MOST_OF_GAIN * np.log(left))


def does_as_much(model: WindowModel, new: WindowModel) -> bool:
    """Returns whether the smooth force of one joint does what a law does that is none of a joint.

    Args:
        model: without the law.
        new: with it.
    """
    plant, law = model.plant, new.candidates[-1]
    effect = law.effect
    is_asked = not (effect.is_curve or effect.state or effect.is_of_records or effect.own)
    if not is_asked or not isinstance(plant, JointPlant):
        return False
    if acts_on_joints(effect):
        return False
    where = [f"joint {axis.joint}" for axis in plant.axes]
    forces = attempt(None, partial(list_forces, model, plant.effects, True, where, law))
    if forces is None:
        return False
    refitted = 1 - new.fitted_power / model.fitted_power  # a law may be far from linear
    of_law = _gain(max(refitted, forces.share([forces.count])))
    at = {joint: forces.at(joint) for joint in forces.joints}
    alone = {joint: _gain(forces.share(some)) for joint, some in at.items()}
    groups = [[joint] for joint in at if _has_more(alone[joint], of_law)]
    most = sorted(at, key=lambda joint: -alone[joint])[: len(single_places(law))]
    if len(most) > 1:
        groups.append(most)
    for joints in groups:
        some = [k for joint in joints for k in at[joint]]
        force = alone[joints[0]] if len(joints) == 1 else _gain(forces.share(some))
        both = _gain(forces.share([*some, forces.count])) if _has_more(force, of_law) else np.inf
        if both - force < MOST_OF_GAIN * of_law:
            return True
    return False


def _has_more(force: float, law: float) -> bool:
    """Returns whether a law has less than most of what a smooth force gains."""
    return law < (1 - MOST_OF_BOTH) * force


def _gain(share: float) -> float:
    """Returns -ln(1 - share)."""
    return float(-np.log(max(1e-12, 1 - share)))
