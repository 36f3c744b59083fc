"""Effects of position servos, which follow a setpoint u with the error e = u/γ - q.

    rate limit      |du'/dt| <= 1/w            u': what the servo follows in place of u
    gain            f_s + γ_p k_p e            in place of f_s, within the limits of the force
    dead band       f_s - k_p clip(e, ±d)      likewise
    integral part   f_s + k_i ∫ e dt           likewise

    r = |u - x| w/h,   x(t + h) = u where r <= 1, else x + (u - x)/r          x: u' as a step begins
    m = u - (u - x) r/2,   D = (u - x)(r/4 - r²/6)                            where r <= 1
    m = x + (u - x)/(2 r),   D = (u - x)/(12 r)                               else

f_s is the servo's force without its limits, k_p its stiffness, γ its gear (mostly 1), h a step.
Servos run along a profile (a "goal velocity"), or turn no faster than their supply lets them: a
stiff servo then follows u'. w is the time for a radian or a metre, zero where there is no limit; u'
begins at the first setpoint. Mean m and moment D of a step (`identification.native.input_filter`)
are exact while u is held. The state ∫ e dt is that of `identification.native.joints.gear`.
"""

from __future__ import annotations

from dataclasses import replace

from numba import njit

from identification.effects.effect import Effect, places
from identification.effects.laws.joint_group import PROBE, Group
from identification.effects.sizes import Size
from identification.quantities import per

# Largest plausible sizes. A joint is about as fast as its limit lets it, and one of several may be
# ten times slower than the fastest. Another voltage of the supply changes a gain by less than half.
# The band is a part of the travel. An integral gain winds up the largest force in this time, at an
# error that makes this force at once.
SLOWEST, GAIN, BAND, SOONEST = 10.0, 0.5, 0.05, 0.03
RATES = (0.5, 0.8, 1.1, 2.0, 4.0)  # to try, of w over one over the top speed
BANDS = (1.0, 5.0, 20.0)


@njit
def rate_limit(s, p):
    far = s.u - s.x
    r = abs(far) * p[0] / s.step
    if r <= 1.0:
        return s.u - far * r / 2, far * (r / 4 - r * r / 6)
    return s.x + far / r / 2, far / r / 12


@njit
def rate_start(s, p):
    return s.u


@njit
def rate_next(s, p):
    far = s.u - s.x
    r = abs(far) * p[0] / s.step
    return s.u if r <= 1.0 else s.x + far / r


@njit
def dead_band(s, p):
    lost = s.k_p * max(-p[0], min(p[0], s.e))
    least, most = s.f_low, s.f_high
    return max(least, min(most, s.f_s - lost)) - max(least, min(most, s.f_s))


@njit
def servo_gain(s, p):
    least, most = s.f_low, s.f_high
    more = p[0] * s.k_p * s.e
    return max(least, min(most, s.f_s + more)) - max(least, min(most, s.f_s))


@njit
def integral_part(s, p):
    return p[0]


def servo_effects(g: Group) -> list[Effect]:
    """Returns the effects of servos that act on joints; the caller leaves out those without one."""
    gain = per(g.f, f"{g.x} s")
    soon = g.k / SOONEST
    return [
        g.force(servo_gain, "f_s + γ_p k_p e in place of f_s, e = u/γ - q",
                "servo: another gain",
                Size("gamma", "", GAIN, PROBE * GAIN, 0, "what its gain has more"),
                places=g.servos),
        g.force(dead_band, "f_s - k_p clip(e, ±d) in place of f_s, e = u/γ - q",
                "servo: has a dead band",
                Size("d", g.x, BAND * g.A, PROBE * BAND * g.A, 1, "half the dead band"),
                probes=BANDS, places=g.servos),
        g.effect("integral", integral_part, "f_s + k_i ∫ e dt in place of f_s, e = u/γ - q",
                 "servo: has an integral part",
                 Size("k_i", gain, soon, PROBE * soon, 1, "integral gain"),
                 probes=BANDS, places=g.servos),
    ]  # fmt: skip


def rate_limits(g: Group) -> list[Effect]:
    """Returns the limit of the setpoints' rates, at servos of joints of one kind, if any."""
    servos = tuple(a.servo for a in g.axes if a.servo)
    if not servos:
        return []
    w = 1 / max(abs(a.gear) * a.speed for a in g.axes if a.servo)
    size = Size("w", f"s/{g.x}", SLOWEST * w, PROBE * w, 1, "one over the largest rate")
    limit = g.effect(
        "input", rate_limit, "|du'/dt| <= 1/w", "servo: follows no faster than at a largest rate",
        size, places=places("input", servos), probes=tuple(r / PROBE for r in RATES),
    )  # fmt: skip
    more = {"start": rate_start, "next": rate_next}
    return [replace(limit, hooks={**limit.hooks, **more})]
