"""Laws that are the same force by two names, as long as they are smaller than the Coulomb level.

    a force f_0, a level f_c                 levels f_c + f_a and f_c - f_a by direction, f_a = -f_0

    moves    f_0 - f_c sign v                -(f_c + f_a sign v) sign v = f_0 - f_c sign v
    rests    |g + f_0| < f_c                 -(f_c - f_a) < g < f_c + f_a, g all other forces

No record tells them apart, whatever moves. Where f_0 is larger than f_c they differ: friction only
brakes.
"""

from __future__ import annotations

from identification.effects.effect import Candidate
from identification.effects.joint_group import SLIDE
from identification.prediction.model import WindowModel

TWINS = {"offset": "asymmetric_friction", "asymmetric_friction": "offset"}
LEVEL = "coulomb_friction.f_c"


def find_twin(model: WindowModel, candidate: Candidate) -> str:
    """Returns the name of the effect that is the same force as a candidate; "" where there is none.

    Args:
        model: fitted, with the candidate.
        candidate: the effect at its place.
    """
    effect = candidate.effect
    prefix = SLIDE if effect.name.startswith(SLIDE) else ""
    name, level = effect.name.removeprefix(SLIDE), prefix + LEVEL
    values = {**model.plant.parameters.values(), **model.values}
    every = [s for s in effect.places.values() if s.startswith("@")]

    def is_small(size: str) -> bool:
        _, at, joint = size.partition("@")
        places = [at + joint] if joint else every
        levels = (values.get(level, 0.0) + values.get(level + p, 0.0) for p in places)
        return abs(values.get(size, 0.0)) < min(levels, default=0.0)

    small = name in TWINS and all(map(is_small, candidate.sizes))
    return prefix + TWINS[name] if small else ""
