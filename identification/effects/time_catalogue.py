"""Candidate effects that change with time: drifts, jumps and pushes; see `time_laws`.

Time is that of the record, from its first sample on, also in its parts and in windows of it.
"""

from __future__ import annotations

from identification.effects import time_laws as laws
from identification.effects.effect import Effect, Shape
from identification.effects.joint_group import Group

MOMENTS = 8  # times of a record at which a jump or a push is tried
EDGE = 0.02  # of the record: how long a jump takes, so that its time can be searched


def time_effects(g: Group) -> list[Effect]:
    """Returns effects of time on some joints; none where the records' duration is not known."""
    F, V, T = g.F, g.V, g.T
    if T <= 0:
        return []
    jump = (_moment("t_j", T, "when"), _edge(T))
    lasting = Shape("t_p", "s", (T / MOMENTS,), 2 * EDGE * T, T, about="how long it lasts")
    d, drag = f"{g.f} s/{g.x}", 0.3 * F / V
    growth = f"{g.f}/s"
    return [
        g.friction(laws.friction_drift, "at most f_t t more",
                   (g.size("f_t", 0.3 * F / T, growth, "growth with time"),),
                   "friction: Coulomb level drifts"),
        g.force(laws.viscous_friction_drift, "-d_t t v",
                (g.size("d_t", drag / T, f"{g.f}/{g.x}", "growth with time"),),
                "friction: viscous, drifts"),
        g.friction(laws.friction_jump, "at most f_j more from t_j on",
                   (g.size("f_j", 0.3 * F, g.f, "height of the jump"),),
                   "friction: Coulomb level jumps", shapes=jump),
        g.force(laws.viscous_friction_jump, "-d_j v from t_j on",
                (g.size("d_j", drag, d, "height of the jump"),), "friction: viscous, jumps",
                shapes=jump),
        g.force(laws.push, "f_p from t_0 to t_0 + t_p",
                (g.size("f_p", 0.5 * F, g.f, "the push"),), "force: a push that begins and ends",
                shapes=(_moment("t_0", T, "when it begins", 0.0), lasting, _edge(T)),
                where=g.each),
    ]  # fmt: skip


def _moment(name: str, T: float, about: str, first: float = 0.5) -> Shape:
    grid = tuple(T * max(EDGE, (k + first) / MOMENTS) for k in range(MOMENTS))
    return Shape(name, "s", grid, 0.5 * EDGE * T, T, about=about)


def _edge(T: float) -> Shape:
    return Shape("w", "s", (EDGE * T,), 0.1 * EDGE * T, 10 * EDGE * T, free=False,
                 about="how long the change takes")  # fmt: skip
