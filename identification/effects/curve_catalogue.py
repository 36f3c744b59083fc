"""Curves drawn from the data, which explain what no listed law does; see `curve_laws`.

A curve has eight sizes, so that a law that explains as much with fewer wins by its criterion. It
acts on one joint, because each joint has a range of its own. What it depends on may be a neighbour:
a hose, a spring or a cable between two bodies pulls at one joint by the position of another, and a
belt or a motor that both joints turn rubs by its speed. It may be as strong as the drives: a soft
stop holds them.
"""

from __future__ import annotations

from dataclasses import replace

from identification.effects import curve_laws as laws
from identification.effects.effect import CURVE, Effect, Size
from identification.effects.joint_group import Group
from identification.native.element import Function


def curve_effects(g: Group) -> list[Effect]:
    """Returns curves of some joints; those without a place are left out by the caller."""
    single = {where: suffix for where, suffix in g.plain.items() if suffix}
    out = [
        _curve(g, laws.curve_speed, "f(v), none at rest", "force: some curve of speed"),
        replace(_curve(g, laws.curve_load, "f(f_u), f_u the drive's force",
                       "force: some curve of the drive's force"), places=single),
        _curve(g, laws.curve_position, "f(q)", "force: some curve of position"),
    ]  # fmt: skip
    if g.both or len(g.axes) > 1:
        out += [
            _curve(g, laws.curve_before, "f(q) of the joint before it",
                   "force: some curve of the position of the joint before it"),
            _curve(g, laws.curve_behind, "f(q) of the joint behind it",
                   "force: some curve of the position of the joint behind it"),
            _curve(g, laws.curve_speed_before, "f(v) of the joint before it, none at rest",
                   "force: some curve of the speed of the joint before it"),
            _curve(g, laws.curve_speed_behind, "f(v) of the joint behind it, none at rest",
                   "force: some curve of the speed of the joint behind it"),
        ]  # fmt: skip
    if g.T > 0:
        out.append(_curve(g, laws.curve_time, "f(t)", "force: some curve of time"))
    return out


def _curve(g: Group, law: Function, said: str, phrase: str) -> Effect:
    sizes = tuple(_size(g, k) for k in range(1, laws.NODES + 1))
    made = g.force(law, said, sizes, phrase, where=g.each)
    what = law.__name__.removeprefix(CURVE)  # the word stands first, so that it is seen to be one
    return replace(made, name=f"{CURVE}_{g.prefix}".rstrip("_") + what)


def _size(g: Group, k: int) -> Size:
    return g.size(f"c_{k}", g.F, g.f, f"force at node {k}")
