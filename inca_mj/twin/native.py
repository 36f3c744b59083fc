"""The cable law as MuJoCo callbacks: numba cfuncs that run without Python and without the GIL.

    mjcb_passive    -T ∂d/∂q on the platform, -R T + R_s F_s - τ_c on the motor joint
    mjcb_act_dyn    activation of a drive is d₀, its rate ḋ₀; RK4 integrates it with the rest
    mjcb_act_bias   force of a drive is its current [A]; the gear K_t makes it a torque
    mjcb_sensor     user sensors on a drive: tension [N], no-load length [m] of its cable
    share           all of these of one drive (`native.installer`); MuJoCo has no such

A drive is an actuator whose `actuator_user` row starts with `law.TAG`. Every other actuator, sensor
and model is left unchanged. The row also holds the key of a set of effects, and only the law of
that set computes the drive. If no law in this process has the key, the drive gets NaN, which MuJoCo
reports as a divergence. A compiled callback must not raise an error, so a length of zero gives NaN
as well.

Candidate effects are terms of the same law (see `inca_mj.effects.hooks`). They are added to the
quantities that they change: i + Δi, R + ΔR, d + Δd, T + ΔT, τ + Δτ. An empty set of effects costs
no time.

MuJoCo's reset sets every activation to zero. No cable has the length zero, so a d₀ of exactly zero
means "just reset", and the law begins there with the cable of tension T(0):

    d₀ = λ d/(λ + T(0))                                                   (thesis 2.24 at rest)

It is the start of the robot where the reset put it into its start pose. States of effects begin at
zero then.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Sequence
from functools import cache
from typing import Any

import mujoco
import numpy as np

from identification.native import installer
from identification.native.compose import rates, total
from identification.native.element import Function, Term, refuse_unfit_functions
from identification.native.memory import inlined, load_constant, load_double, replacer, store_double
from identification.native.table import SHARE, is_compiled
from inca_mj.effects.hooks import DRIVE, PLATFORM, Drive, Layout
from inca_mj.robot import law
from inca_mj.twin import drives
from inca_mj.twin.drives import (
    FIELDS,
    D,
    M,
    cable,
    dof,
    double,
    drawn_line,
    drive,
    found_line,
    integer,
    platform,
    push,
    velocity,
    word,
    wrench,
)
from inca_mj.twin.numbers import owners

_USER = int(mujoco.mjtSensor.mjSENS_USER)
_ACTUATOR = int(mujoco.mjtObj.mjOBJ_ACTUATOR)
_STAGE_VEL = int(mujoco.mjtStage.mjSTAGE_VEL)
with_neighbours = replacer(Drive, "i_before i_after")
with_strain = replacer(Drive, "d strain strain_rate")
with_tension = replacer(Drive, "d strain strain_rate T F_s")
# A drive and the results of its law.
#   drive: a `Drive`, as the hooks behind the tension see it; d_0_dot: rate of d₀ [m/s]
#   R: radius of the roller with what effects add to it [m]; gx, gy, gz: ∂Δd/∂r
Winding: Any = namedtuple("Winding", "drive d_0_dot R gx gy gz")


def install(layout: Layout | None = None) -> None:
    """Installs the law with the effects of a layout in this process, once.

    Raises InputError if another library has installed callbacks or a function does not fit its
    hook, and RuntimeError if MuJoCo's structs are not laid out as declared.
    """
    layout = layout or Layout()
    installer.install(_law(layout.key, layout.on_drives, layout.on_platform))


@cache
def _law(key: float, on_drives: tuple[Term, ...], on_platform: tuple[Term, ...]) -> installer.Law:
    """Returns the law of the drives with a set of effects."""

    def check() -> None:
        refuse_unfit_functions(DRIVE, on_drives)
        refuse_unfit_functions(PLATFORM, on_platform)

    return installer.Law(
        name="drives",
        key=key,
        functions=callbacks(key, on_drives, on_platform),
        fields=FIELDS,
        check=check,
        owners=lambda model: owners(model, key),
    )


def callbacks(
    key: float, on_drives: Sequence[Term], on_platform: Sequence[Term]
) -> dict[str, Function]:
    """Returns the callbacks of the law with terms of effects, to be compiled; key 0 without any."""
    added_current, added_radius, added_path, added_tension, added_torque, added_force = (
        total(DRIVE, on_drives, hook)
        for hook in ("current", "radius", "path", "tension", "torque", "force")
    )
    added_wrench, advance = total(PLATFORM, on_platform, "wrench"), rates(DRIVE, on_drives)
    some = key != 0.0

    @inlined
    def winding(m, d, i, line):
        """Returns drive i with all that follows from its state."""
        s, k = drives.drive_state(m, d, i, line), line.k
        length, rate, R = s.d, line.rate, s.R
        gx, gy, gz, more = 0.0, 0.0, 0.0, 0.0
        if some:
            row, act = drives.row_of(m, i), drives.activations_of(m, d, i)
            R += added_radius(s, row, act)
            longer, gx, gy, gz = added_path(s, row, act)
            length += longer
            if gx != 0.0 or gy != 0.0 or gz != 0.0:
                v = velocity(m, d, line.body, (line.rx, line.ry, line.rz))
                rate += gx * v[0] + gy * v[1] + gz * v[2]
            d_0_dot = law.no_load_rate(length, s.d_0, s.omega, R)
            strain, strain_rate = (length - s.d_0) / s.d_0, (rate - d_0_dot) / s.d_0
            more = added_tension(with_strain(s, (length, strain, strain_rate)), row, act)
        d_0_dot = law.no_load_rate(length, s.d_0, s.omega, R)
        T = law.tension(length, rate, s.d_0, d_0_dot, s.lambda_, cable(m, k, law.B), more)
        F_s = law.spring_force(s.phi, s.R, s.R_s, s.k_s, drive(m, i, law.T_0))
        seen = with_tension(s, (length, (length - s.d_0) / s.d_0, np.nan, T, F_s))
        return Winding(drive=seen, d_0_dot=d_0_dot, R=R, gx=gx, gy=gy, gz=gz)

    @inlined
    def pull(m, d, i, line, now):
        """Put the forces of drive i on its motor, and those of its effects on the platform."""
        s = now.drive
        tau = -law.coulomb_friction(s.omega, s.b_c, s.beta)
        if some:
            row, act = drives.row_of(m, i), drives.activations_of(m, d, i)
            tau += added_torque(s, row, act)
            f = added_force(s, row, act)
            push(m, d, line, (f[0] - s.T * now.gx, f[1] - s.T * now.gy, f[2] - s.T * now.gz))
        at = word(d, D.qfrc_passive) + 8 * drives.motor_dof(m, i)
        store_double(at, load_double(at) - now.R * s.T + s.R_s * s.F_s + tau)

    @inlined
    def pull_as_found(m, d, i, line):
        """Put the forces of drive i on its motor and on the platform."""
        now = winding(m, d, i, line)
        qfrc, start = word(d, D.qfrc_passive), integer(m, M.ten_J_rowadr, line.k)
        for a in range(start, start + integer(m, M.ten_J_rownnz, line.k)):
            at = qfrc + 8 * integer(m, M.ten_J_colind, a)
            store_double(at, load_double(at) - now.drive.T * double(d, D.ten_J, a))
        pull(m, d, i, line, now)

    def passive(m, d):
        if not drives.has_drives(m):
            return
        body = -1
        for i in range(word(m, M.nactuator)):
            own = drives.key_of(m, i)
            if own == key:
                drives.restart(m, d, i)
                line = found_line(m, d, drives.cable_of(m, i))
                pull_as_found(m, d, i, line)
                body = line.body
            elif own == own and not is_compiled(own):
                store_double(word(d, D.qfrc_passive) + 8 * drives.motor_dof(m, i), np.nan)
        if some and body >= 0 and word(m, M.nuser_body) > 0:
            row = word(m, M.body_user) + 8 * word(m, M.nuser_body) * body
            wrench(m, d, body, added_wrench(platform(d, dof(m, body), body), row, 0))

    @inlined
    def wind(m, d, i, now):
        """Put the rates of all states of drive i into `act_dot`."""
        out = word(d, D.act_dot) + 8 * integer(m, M.actuator_actadr, i)
        if some:
            advance(now.drive, drives.row_of(m, i), drives.activations_of(m, d, i), out)
        store_double(out, now.d_0_dot)  # MuJoCo stores the rate of a single activation only

    @inlined
    def sent(m, d, i, line):
        """Returns the current of drive i with what effects add to it [A]."""
        current = drives.current_of(m, d, i)
        if some:
            beside = (drives.neighbour_current(m, d, i - 1), drives.neighbour_current(m, d, i + 1))
            s = with_neighbours(drives.drive_state(m, d, i, line), beside)
            current += added_current(s, drives.row_of(m, i), drives.activations_of(m, d, i))
        return current

    def act_dyn(m, d, i):
        if not drives.has_drives(m) or drives.key_of(m, i) != key:
            return 0.0
        now = winding(m, d, i, found_line(m, d, drives.cable_of(m, i)))
        wind(m, d, i, now)
        return now.d_0_dot

    def act_bias(m, d, i):
        if not drives.has_drives(m) or drives.key_of(m, i) != key:
            return 0.0
        return sent(m, d, i, found_line(m, d, drives.cable_of(m, i)))

    def share(m, d, i):
        if not drives.has_drives(m) or drives.key_of(m, i) != key:
            return 0.0
        line = drawn_line(m, d, drives.cable_of(m, i))
        now = winding(m, d, i, line)
        s, at = now.drive, word(d, D.qfrc_passive) + 8 * drives.motor_dof(m, i)
        along = -s.T / line.length
        push(m, d, line, (along * line.x, along * line.y, along * line.z))
        pull(m, d, i, line, now)
        wind(m, d, i, now)
        store_double(at, load_double(at) + s.K_t * sent(m, d, i, line) - s.b_v * s.omega)
        return 1.0

    def sensor(m, d, stage):
        if stage != _STAGE_VEL or not drives.has_drives(m) or word(m, M.nuser_sensor) < 1:
            return
        for s in range(word(m, M.nsensor)):
            if (
                integer(m, M.sensor_type, s) != _USER
                or integer(m, M.sensor_objtype, s) != _ACTUATOR
            ):
                continue
            i = integer(m, M.sensor_objid, s)
            own, at = drives.key_of(m, i), word(d, D.sensordata) + 8 * integer(m, M.sensor_adr, s)
            shown = double(m, M.sensor_user, word(m, M.nuser_sensor) * s)
            if own == key and shown == law.TENSION:
                line = found_line(m, d, drives.cable_of(m, i))
                store_double(at, winding(m, d, i, line).drive.T)
            elif own == key and shown == law.NO_LOAD_LENGTH:
                store_double(at, load_constant(drives.activations_of(m, d, i)))
            elif own == own and not is_compiled(own):
                store_double(at, np.nan)

    return {
        "passive": passive, "act_dyn": act_dyn, "act_bias": act_bias, "sensor": sensor,
        SHARE: share,
    }  # fmt: skip
