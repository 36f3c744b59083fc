"""The effects that worlds hide: listed ones, which have a name, and forces in no catalogue."""

from __future__ import annotations

from joint_worlds import draws
from joint_worlds import slots as at
from joint_worlds.draws import put_into, signed
from joint_worlds.hidden import Hidden
from joint_worlds.robot import JointRobot

COG = draws.wave(at.COG_COS, at.COG_SIN, at.COG_WAVES)
GRIP = draws.wave(at.GRIP_COS, at.GRIP_SIN, at.GRIP_WAVES)
OFF = draws.wave(at.OFF_COS, at.OFF_SIN, -1)

HIDDEN: dict[str, Hidden] = {h.name: h for h in (
    Hidden(name="coulomb_friction", largest=lambda h: 0.3 * h.force, put=put_into(at.COULOMB),
           known=("coulomb",)),
    Hidden(name="asymmetric_friction", largest=lambda h: 0.8 * h.coulomb,
           put=signed(put_into(at.UNEVEN)), shape=draws.sign),
    Hidden(name="asymmetric_viscous_friction", largest=lambda h: 0.8 * h.damping,
           put=signed(put_into(at.UNEVEN_VISCOUS)), shape=draws.sign),
    Hidden(name="stribeck_friction", largest=lambda h: 0.2 * h.force,
           put=put_into(at.PEAK, v_s=at.PEAK_SPEED, p=at.PEAK_POWER), shape=draws.peak),
    Hidden(name="transmitted_load_friction", largest=lambda h: 0.2, put=put_into(at.LOAD),
           heavy=True),
    Hidden(name="load_dependent_friction", largest=lambda h: 0.2, put=put_into(at.LOAD),
           heavy=False,
           also=("transmitted_load_friction",)),
    Hidden(name="quadratic_friction", largest=lambda h: 0.3 * h.force / h.speed**2,
           put=put_into(at.SQUARE)),
    Hidden(name="sublinear_friction", largest=lambda h: 0.3 * h.force / h.speed**0.5,
           put=put_into(at.ROOT, p=at.ROOT_POWER),
           shape=lambda h, rng: {"p": float(rng.uniform(0.3, 0.7))}),
    Hidden(name="hardening", largest=lambda h: 0.3 * h.force / h.travel**3, put=put_into(at.CUBE)),
    Hidden(name="offset", largest=lambda h: 0.2 * h.force, put=signed(put_into(at.PUSH)),
           shape=draws.sign),
    Hidden(name="cogging", largest=lambda h: 0.2 * h.force, put=COG, shape=draws.wave_of),
    Hidden(name="periodic_friction", largest=lambda h: 0.8 * h.coulomb, put=GRIP,
           shape=draws.wave_of),
    Hidden(name="delay", largest=lambda h: 0.02, put=put_into(at.DELAY), also=("time_shift",)),
    Hidden(name="lag", largest=lambda h: 0.01, put=put_into(at.LAG)),
    Hidden(name="saturation", largest=lambda h: 1.5, put=draws.limit,
           shape=lambda h, rng: {"full": h.force, "often": h.often}),
    Hidden(name="gain_drift", largest=lambda h: 0.01, put=put_into(at.SAG)),
    Hidden(name="presliding", largest=lambda h: 0.02 * h.travel / h.coulomb, put=put_into(at.GIVE)),
    Hidden(name="payload", largest=lambda h: 0.5, body="payload", known=("mass",)),
    Hidden(name="mass_mismatch", largest=lambda h: 0.5, body="link", known=("mass",),
           kinds=("hinge",)),
    Hidden(name="time_shift", largest=lambda h: 0.02, put=put_into(at.SHIFT), everywhere=True,
           also=("delay",)),
    Hidden(name="encoder_lag", largest=lambda h: 0.02, put=put_into(at.SHIFT), coupled=True),
    Hidden(name="encoder_offset", largest=lambda h: 0.1, put=signed(put_into(at.ZERO)),
           shape=draws.sign,
           heavy=True),
    Hidden(name="torque_saturation", largest=lambda h: 0.3 / h.force**2, put=put_into(at.WEAK)),
    Hidden(name="encoder_scale", largest=lambda h: 0.05, put=signed(put_into(at.SCALE)),
           shape=draws.sign),
    Hidden(name="encoder_eccentricity", largest=lambda h: 0.03, put=OFF, shape=draws.wave_of,
           kinds=("hinge",)),
)}  # fmt: skip
UNLISTED: dict[str, Hidden] = {h.name: h for h in (
    Hidden(name="bump", largest=lambda h: 0.5 * h.force, curve="position",
           put=signed(put_into(at.BUMP, place=at.BUMP_PLACE, width=at.BUMP_WIDTH)),
           shape=draws.bump),
    Hidden(name="stop", largest=lambda h: 3.0 * h.force / h.travel, curve="position",
           put=put_into(at.STOP, place=at.STOP_PLACE), shape=draws.stop),
    Hidden(name="fast", largest=lambda h: 3.0 * h.force / h.speed, curve="speed",
           put=put_into(at.FAST, speed=at.FAST_SPEED), shape=draws.fast),
    Hidden(name="beside", largest=lambda h: 0.5 * h.force, coupled=True, curve="beside",
           put=put_into(at.BESIDE, waves=at.BESIDE_WAVES, phase=at.BESIDE_PHASE),
           shape=draws.beside),
    Hidden(name="drag", largest=lambda h: 0.5 * h.force / h.speed, coupled=True,
           curve="speed beside", put=signed(put_into(at.DRAG)), shape=draws.sign),
    Hidden(name="ripple", largest=lambda h: 0.5 * h.force / h.speed, curve="-",
           put=put_into(at.RIPPLE, waves=at.RIPPLE_WAVES), shape=draws.ripple),
)}  # fmt: skip
EVERY = {**HIDDEN, **UNLISTED}
NULL = "nothing"


def effects_of(robot: JointRobot) -> tuple[str, ...]:
    """Names of what a world of a robot may hide, in the order of `EVERY`."""
    return tuple(name for name, hidden in EVERY.items() if hidden.joints(robot))
