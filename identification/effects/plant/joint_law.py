"""One law of joints for every set of effects of the catalogue, so that it is compiled once.

    columns of a joint's row = (all laws of the catalogue, and again where a set has a law twice)

A set of effects takes its columns of this row. What it lacks has sizes of zero there and adds
nothing. So robots whose sets differ share their machine code, which takes numba 12 s; a step asks
of each law that is not there whether its sizes are zero. A robot with hinges and slides has each
law twice. A set with an effect of a user's own has a law of its own, and so has the empty set.
Surfaces, by which a finished search judges its names, stand behind the catalogue in a second law:
their ninety sizes would be asked for in every step of every search.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import ceil
from zlib import crc32

from identification.effects.axes import Axis
from identification.effects.catalogue import joint_effects
from identification.effects.laws.surfaces import surface_effects
from identification.effects.values import terms_of
from identification.native.element import Term
from identification.native.joints.joint_callback import JOINT

# Joints on which every law of the catalogue has a place: each has joints before and behind it.
_AXES = tuple(
    Axis(joint=name, kind="hinge", force=1.0, speed=1.0, travel=1.0, plain=True, heavy=True,
         duration=1.0, middle=0.0, share=0.5, give=1.0, servo=name, stiffness=1.0)
    for name in ("before", "between", "behind")
)  # fmt: skip


@dataclass(frozen=True)
class JointTerms:
    """The effects of a set that act on joints, and those of the law that is compiled for it."""

    own: tuple[Term, ...]  # of the set, with their columns in a joint's row
    law: tuple[Term, ...]  # of the law


@cache
def joint_terms(own: tuple[Term, ...]) -> JointTerms:
    """Returns the terms of a set of effects with columns of the law that is compiled for it.

    Args:
        own: terms of the set on joints, with columns of a law that has them alone.
    """
    counts = {t.functions: sum(o.functions == t.functions for o in own) for t in own}
    if not own or not all(_is_known(t) for t in own):
        return JointTerms(own, own)
    has_surfaces = any(_is_one_of(t, _surfaces()) for t in own)
    known = [t.functions for t in _listed(has_surfaces)]
    copies = max(ceil(count / known.count(of)) for of, count in counts.items())
    law = _law(copies, has_surfaces)
    left = {of: iter([t for t in law if t.functions == of]) for of in counts}
    return JointTerms(tuple(replace(t, column=next(left[t.functions]).column) for t in own), law)


def key_of_law(law: Sequence[Term], of: str) -> float:
    """Returns the number that tells a law of the catalogue from other laws.

    Args:
        law: its terms.
        of: what else tells it apart.
    """
    return float(crc32((of + repr([(t.effect, t.names, t.column) for t in law])).encode()))


def _is_known(own: Term) -> bool:
    """Returns whether a term is one of the catalogue's or a surface, whatever it is called."""
    return _is_one_of(own, _listed(True))


def _is_one_of(own: Term, terms: Sequence[Term]) -> bool:
    return any(
        (own.functions, len(own.names), own.sizes) == (t.functions, len(t.names), t.sizes)
        for t in terms
    )


@cache
def _listed(has_surfaces: bool) -> tuple[Term, ...]:
    """Returns the terms of all effects of the catalogue that act on joints, and of surfaces."""
    every = joint_effects(_AXES)
    return terms_of((*every, *surface_effects(_AXES)) if has_surfaces else every, JOINT)


@cache
def _surfaces() -> tuple[Term, ...]:
    return terms_of(surface_effects(_AXES), JOINT)


@cache
def _law(copies: int, has_surfaces: bool) -> tuple[Term, ...]:
    """Returns these terms so many times, one column behind the other."""
    listed = _listed(has_surfaces)
    width = sum(len(t.names) for t in listed)
    return tuple(replace(t, column=t.column + k * width) for k in range(copies) for t in listed)
