"""The variables of a joint on which the force of an effect depends.

They are found by trying: a law that gives another force where one variable alone is another number
depends on it. A friction depends on the rate as well, because it is counted against the motion, and
gravity's force f_g is one of the positions. A servo's error e is one of its force f_u.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from identification.effects.effect import Effect
from identification.native.joints.joint_callback import Joint

VARIABLES = ("time", "q", "v", "f_u", "f_g", "x_before", "x_behind", "v_before", "v_behind",
             "e")  # fmt: skip
POSITIONS = ("q", "x_before", "x_behind")
TRIES = 40  # states: a law with a dead zone or a stop gives a force in some of them only


@cache
def variables(effect: Effect) -> frozenset[str]:
    """Returns the fields of `Joint` on which the forces of an effect depend; none for a constant.

    Args:
        effect: with hooks "force" or "friction"; those of other hooks are not looked at.
    """
    rng, found = np.random.default_rng(0), set[str]()
    # sizes of one place: an effect at several has them once for each
    sizes = dict.fromkeys(size.name.partition("@")[0] for size in effect.sizes)
    # numbers that differ, because a curve whose nodes are alike is a constant
    p = (*rng.uniform(0.5, 1.5, len(sizes)), *(s.at_first for s in effect.shapes))
    for hook in ("force", "friction"):
        if hook not in effect.hooks:
            continue
        law = getattr(effect.hooks[hook], "py_func", effect.hooks[hook])
        found |= {"v"} if hook == "friction" else set()
        for _ in range(TRIES):
            at, other = (dict(zip(VARIABLES, rng.uniform(-1, 1, len(VARIABLES)), strict=True))
                         for _ in range(2))  # fmt: skip
            s = Joint(**at, sign=1.0, k_p=1.0)
            force = _force(law, s, p)
            found |= {x for x in VARIABLES
                      if _force(law, s._replace(**{x: other[x]}), p) != force}  # fmt: skip
    more = {*(POSITIONS if "f_g" in found else ()), *(("f_u",) if "e" in found else ())}
    return frozenset(found | more)


def _force(law: Callable[..., float], s: Joint, p: tuple[float, ...]) -> float | None:
    """Returns the force of a law; None where it has none.

    A user's own may divide by zero or take the root of a negative number in states that its robot
    does not reach, and no finished search is lost to that.
    """
    try:
        return law(s, p)
    except (ArithmeticError, ValueError):
        return None
