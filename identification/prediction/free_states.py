"""Laws that bring states of joints, beside the smooth force that the same joints could have.

What a servo has summed up, or where a spring in a gear stands, is found anew in each window, unseen
ones too. A law with such states draws a slow force in every window, whatever makes it, and proof on
unseen records is not enough. So it must also gain far more than the smooth force of its joints, of
rate, position, drive and time and of two of them at once, gains without it:

    ln(1 - share of the smooth force) > 1/2 ln(1 - share of the law)

Both shares are of the fitted windows of the model without the law, the one of the smooth force over
blocks of windows to which it was not fitted (`identification.prediction.yardstick`).
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.jointed import JointPlant
from identification.prediction.model import WindowModel
from identification.prediction.screening import places_of
from identification.prediction.trial import Contender
from identification.prediction.yardstick import measure

# Of a law's gain: a smooth force that has more explains as much as the law, but for what free
# states add. A friction that gives left it less than a tenth in two pendulums; of an integral part
# that was not there, it had more than half in two legs, and less in one arm.
MOST_OF_GAIN = 0.5


def is_smooth_force(model: WindowModel, new: WindowModel) -> bool:
    """Returns whether smooth forces gain about what the last effect of a model does, with states.

    Args:
        model: without the effect.
        new: with it.
    """
    plant, law = model.plant, new.candidates[-1]
    if not law.effect.state or not isinstance(plant, JointPlant):
        return False
    single = [where for where, suffix in law.effect.places.items() if suffix]
    at = places_of(law.where) if law.effect.places.get(law.where) else single
    stick = attempt(None, partial(measure, model, plant.effects, is_left=True, joints=at))
    if stick is None:
        return False
    left = new.fitted_power / model.fitted_power
    return bool(np.log(max(1e-12, 1 - stick.every)) < MOST_OF_GAIN * np.log(left))


def without_free_states(
    model: WindowModel, found: Contender, options: DiscoveryOptions
) -> Contender:
    """Returns a contender, unproven where a smooth force gains as much as its states do.

    Args:
        model: without it.
        found: what was refitted.
        options: the switch `free_states`.
    """
    is_asked = found.is_proven and uses(options, "free_states")
    return (
        replace(found, doubt="drawn") if is_asked and is_smooth_force(model, found.model) else found
    )
