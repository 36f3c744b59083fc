"""Each law against its equation, and that equation in the compiled model."""

from dataclasses import replace
from math import cos, pi, sin, sqrt, tanh

import numpy as np
import pytest
from effect_cases import BY_NAME, bare, drive, forward, full, moving

from inca_mj.effects.hooks import Platform
from inca_mj.robot import law
from inca_mj.twin.twin import build_twin

S = drive()
BREAK = tanh(S.beta * S.omega)
CREEP = 0.5 * S.lambda_ * (S.strain - 1e-4)
WAY = S.R_s * S.phi

LAWS = [
    ("stribeck_friction", "torque", (0.02, 2.0, 2.0), {}, -0.02 * np.exp(-2.25) * BREAK),
    ("stribeck_friction", "torque", (0.02, 2.0, 1.0), {}, -0.02 * np.exp(-1.5) * BREAK),
    ("asymmetric_friction", "torque", (0.002,), {}, -0.002 * BREAK),
    ("asymmetric_friction", "torque", (0.002,), {"omega": -3.0}, -0.002 * BREAK),
    ("load_dependent_friction", "torque", (0.1,), {}, -0.1 * S.R * 4 * BREAK),
    ("quadratic_friction", "torque", (1e-5, 2.0), {"omega": -3.0}, 9e-5),
    ("quadratic_friction", "torque", (1e-5, 3.0), {"omega": -3.0}, 27e-5),
    ("friction_mismatch", "torque", (0.1,), {}, -0.1 * S.b_c * BREAK),
    ("cogging", "torque", (3e-3, 4e-3, 6.0), {}, 3e-3 * cos(4.2) + 4e-3 * sin(4.2)),
    ("torque_constant_drift", "current", (0.01, 0.0), {"x": 9.0}, -0.016),
    ("torque_constant_drift", "current", (0.01, 1.0), {"x": 9.0}, -0.072),
    ("torque_constant_drift", "rate", (0.01, 1.0), {}, 0.64),
    ("torque_constant_mismatch", "current", (0.05,), {}, 0.04),
    ("drum_eccentricity", "radius", (0.01, 0.02), {}, S.R * (0.01 * cos(0.7) + 0.02 * sin(0.7))),
    ("drum_layering", "radius", (1e-5,), {}, 7e-6),
    ("drum_radius_mismatch", "radius", (0.01,), {}, 0.01 * S.R),
    ("backlash", "tension", (0.01,), {}, -S.lambda_ * S.R * 0.01 / S.d),
    ("spring_hardening", "torque", (10.0, 2.0), {}, -10 * S.R_s * S.k_s * WAY**3),
    ("spring_hardening", "torque", (10.0, 1.0), {}, -0.5 * S.R_s * S.k_s * WAY**2),
    ("spring_hardening", "torque", (1e9, 2.0), {}, -S.R_s * S.F_s),
    ("spring_hysteresis", "torque", (0.1,), {}, 0.1 * S.R_s * S.F_s * BREAK),
    ("cable_hardening", "tension", (500.0, 1.0), {}, S.lambda_ * 500 * S.strain**2),
    ("cable_hardening", "tension", (500.0, 2.0), {}, S.lambda_ * 5e5 * S.strain**3),
    ("cable_hardening", "tension", (500.0, 2.0), {"strain": -1e-4}, 0.0),
    ("cable_creep", "tension", (0.5, 2.0), {"x": 1e-4}, CREEP),
    ("cable_creep", "rate", (0.5, 2.0), {"x": 1e-4}, (S.strain - 1e-4) / 2),
    ("cable_elasticity_mismatch", "tension", (0.1,), {}, 0.1 * S.lambda_ * S.strain),
    ("cable_elasticity_drift", "tension", (0.1, 0.0), {"x": 9.0}, -0.2 * S.lambda_ * S.strain),
    ("cable_damping_mismatch", "tension", (0.1,), {}, 0.1 * S.b * S.strain_rate * S.d_0),
    ("cable_damping_drift", "tension", (0.1, 0.0), {"x": 9.0}, -0.2 * S.b * S.strain_rate * S.d_0),
    ("drum_spring_mismatch", "torque", (0.1,), {}, -0.1 * S.k_s * S.R_s * WAY),
    ("drum_spring_mismatch", "torque", (1e9,), {}, -S.R_s * S.F_s),
    ("drum_spring_drift", "torque", (0.1, 0.0), {"x": 9.0}, 0.2 * S.k_s * S.R_s * WAY),
    ("viscous_friction_mismatch", "torque", (0.1,), {}, -0.1 * S.b_v * S.omega),
    ("viscous_friction_drift", "torque", (0.1, 0.0), {"x": 9.0}, 0.2 * S.b_v * S.omega),
    ("friction_drift", "torque", (0.1, 0.0), {"x": 9.0}, 0.2 * S.b_c * BREAK),
    ("friction_drift", "torque", (0.1, 1.0), {"x": 9.0}, 0.9 * S.b_c * BREAK),
    ("friction_drift", "rate", (0.1, 1.0), {}, 0.64),
    ("current_crosstalk", "current", (0.1, 0.2), {"i_before": 0.5, "i_after": 0.3}, 0.11),
]


@pytest.mark.parametrize(("name", "hook", "p", "known", "expected"), LAWS)
def test_law(name, hook, p, known, expected):
    law = BY_NAME[name].hooks[hook].py_func
    assert law(drive(**known), p) == pytest.approx(expected, rel=1e-12, abs=1e-15)


def test_half_of_a_cable_hangs_on_its_connector():
    x, y, z = BY_NAME["cable_weight"].hooks["force"].py_func(S, (0.004,))
    d = sqrt(S.rx**2 + S.ry**2 + S.rz**2)
    assert (x, y) == (0, 0)
    assert z == pytest.approx(-0.004 * d * 9.81 / 2)


def test_wrenches():
    at = Platform(0, *(0, 0, 1), *(0.3, -0.4, 1.2), *(9, 9, 9), *np.eye(3).ravel())
    drag = BY_NAME["air_drag"].hooks["wrench"].py_func(at, (0.5, 2.0))
    assert drag == pytest.approx((-0.5 * 1.3 * 0.3, 0.5 * 1.3 * 0.4, -0.5 * 1.3 * 1.2, 0, 0, 0))
    force = BY_NAME["external_force"].hooks["wrench"].py_func(at, (1.0, 2.0, 3.0))
    assert force == (1, 2, 3, 0, 0, 0)


@pytest.mark.parametrize(("name", "values"), [
    ("stribeck_friction", {"f_s": 0.01}),
    ("asymmetric_friction", {"f_a": 0.002}),
    ("load_dependent_friction", {"mu": 0.05}),
    ("quadratic_friction", {"c": 1e-5}),
    ("cogging", {"a": 1e-3, "b": 2e-3}),
    ("spring_hardening", {"k_3": 400.0}),
    ("spring_hysteresis", {"eta": 0.1}),
    ("torque_constant_drift", {"alpha": 0.01, "kind": 0.0}),
])  # fmt: skip
def test_what_a_motor_feels_is_the_law(name, values):
    """J Δω̇ of the compiled model is the hook's torque, or K_t times its current."""
    effect, twin, current = BY_NAME[name], full(), np.linspace(0.4, 1.2, 8)
    with_it = twin.with_values({f"{name}.{n}": v for n, v in values.items()})
    at = moving(twin)
    none, some = forward(twin, at, current, 3.0), forward(with_it, at, current, 3.0)
    v, w = with_it.parameters.values(), at.qvel[6:]
    T = [none.sensor(f"tension_{k}").data[0] for k in range(1, 9)]
    expected = []
    for k in range(8):
        F_s = v["R"] / v["R_s"] * twin.start.balance[k] - v["k_s"] * v["R_s"] * at.qpos[7 + k]
        s = drive(phi=at.qpos[7 + k], omega=w[k], i=current[k], T=T[k], F_s=F_s, time=3.0)
        p = tuple(v[f"{name}.{n}"] for n in effect.names)
        ((hook, law),) = [(h, f) for h, f in effect.hooks.items() if h != "rate"]
        expected.append({"torque": 1.0, "current": v["K_t"]}[hook] * law.py_func(s, p))
    assert v["J"] * (some.qacc - none.qacc)[6:] == pytest.approx(expected, rel=1e-6, abs=1e-12)
    assert np.array_equal(some.qacc[:6], none.qacc[:6])


def test_a_larger_roller_winds_faster_and_loads_its_motor_more():
    twin = full()
    with_it = twin.with_values({"drum_radius_mismatch.delta@3": 0.01})
    at = moving(twin)
    none, some = forward(twin, at), forward(with_it, at)
    of_d_0 = twin.model.actuator_actadr
    ratio = some.act_dot[of_d_0] / none.act_dot[of_d_0]
    assert ratio == pytest.approx(np.where(np.arange(8) == 2, 1.01, 1.0), rel=1e-12)
    T = [some.sensor(f"tension_{k}").data[0] for k in range(1, 9)]
    T_0 = [none.sensor(f"tension_{k}").data[0] for k in range(1, 9)]
    J, R = twin.parameters["J"].value, twin.parameters["R"].value
    load = R * (np.where(np.arange(8) == 2, 1.01, 1.0) * T - np.array(T_0))
    assert J * (some.qacc - none.qacc)[6:] == pytest.approx(-load, rel=1e-6, abs=1e-12)


@pytest.mark.parametrize(
    ("name", "p"), [("cable_hardening.kappa", (500.0, 1.0)), ("backlash.h", (2e-3,))]
)
def test_tension_of_the_compiled_model(name, p):
    twin = full()
    effect = BY_NAME[name.partition(".")[0]]
    at = moving(twin)
    none, some = forward(twin, at), forward(twin.with_values({name: p[0]}), at)
    d, d_0 = none.ten_length, at.act[twin.model.actuator_actadr]
    for k in range(8):
        s = drive(strain=(d[k] - d_0[k]) / d_0[k], d=d[k])
        more = (some.sensor(f"tension_{k + 1}").data - none.sensor(f"tension_{k + 1}").data)[0]
        assert more == pytest.approx(effect.hooks["tension"].py_func(s, p), rel=1e-6)


def test_weight_of_the_cables_and_a_force_accelerate_the_platform():
    twin = full()
    at = twin.state()
    at = type(at)(at.qpos, 0 * at.qvel, at.act)
    rho = forward(twin.with_values({"cable_weight.rho": 1e-3}), at)
    d = rho.ten_length.sum()
    m = twin.parameters["m"].value
    assert m * rho.qacc[:3] == pytest.approx([0, 0, -1e-3 * 9.81 * d / 2], abs=1e-9)
    force = {"external_force.x": 0.1, "external_force.y": -0.2, "external_force.z": 0.3}
    assert m * forward(twin.with_values(force), at).qacc[:3] == pytest.approx([0.1, -0.2, 0.3])


def test_an_offset_centre_of_mass_is_a_lever_of_the_cables():
    """The frame stays in the centre of mass: T(0) pulls at b - c, which turns the platform."""
    c = np.array([1e-3, -2e-3, 3e-3])
    moved = full().with_values(
        {f"com_offset.{n}": v for n, v in zip("xyz", c.tolist(), strict=True)}
    )
    B = moved.geometry.B - c
    r = moved.start.pose[:3] + B - moved.geometry.A
    pull = -moved.start.tension[:, None] * r / np.linalg.norm(r, axis=1)[:, None]
    m, *I = (moved.parameters[n].value for n in ("m", "I_x", "I_y", "I_z"))
    qacc = forward(moved, moved.state()).qacc
    assert m * qacc[:3] == pytest.approx(pull.sum(axis=0) - [0, 0, m * 9.81], abs=1e-9)
    assert I * qacc[3:6] == pytest.approx(np.cross(B, pull).sum(axis=0), abs=1e-9)
    assert np.abs(I * qacc[3:6]).max() > 1e-3


PULLEY, ANCHOR = (BY_NAME[n].hooks["path"].py_func for n in ("pulley_radius", "anchor_offset"))
SPANS = [(1.2, -1.4, 1.3), (-1.5, 1.5, -1.6), (0.4, 1.9, 0.2), (0.05, 0.3, -2.0)]


def at(r):
    return drive(**dict(zip(("rx", "ry", "rz"), map(float, r), strict=True)))


@pytest.mark.parametrize("r", SPANS)
@pytest.mark.parametrize(
    ("path", "p"), [(PULLEY, (0.03, 0.0)), (PULLEY, (0.03, 1.0)), (ANCHOR, (0.01, -0.02, 0.03))]
)
def test_gradient_and_unit_length(path, p, r):
    r, h = np.array(r), 1e-6
    _, *gradient = path(at(r), p)
    differences = [
        (path(at(r + h * e), p)[0] - path(at(r - h * e), p)[0]) / (2 * h) for e in np.eye(3)
    ]
    assert gradient == pytest.approx(differences, abs=1e-8)
    direction = r / np.linalg.norm(r) + gradient
    assert np.linalg.norm(direction) == pytest.approx(1, abs=1e-12)


@pytest.mark.parametrize("r", SPANS)
@pytest.mark.parametrize("over", [0.0, 1.0])
def test_pulley_is_the_shortest_way_around_a_disc(r, over):
    """Wrapped arc and tangent, drawn point by point from where the cable enters."""
    r_p, (across, z) = 0.03, (sqrt(r[0] ** 2 + r[1] ** 2), abs(r[2]) * (-1 if over else 1))
    angle = np.linspace(0, pi, 20001)
    leave = np.stack([r_p * (1 - np.cos(angle)), r_p * np.sin(angle)], axis=1)
    to = np.array([across, z]) - leave
    heading = np.stack([np.sin(angle), np.cos(angle)], axis=1)
    turn = heading[:, 0] * to[:, 1] - heading[:, 1] * to[:, 0]
    ahead = np.sum(heading * to, axis=1) > 0
    k = np.argmin(np.where(ahead, np.abs(turn), np.inf))
    length = r_p * angle[k] + np.linalg.norm(to[k])
    assert PULLEY(at(r), (r_p, over))[0] + np.linalg.norm(r) == pytest.approx(length, abs=1e-6)


def test_an_anchor_offset_is_a_robot_with_that_anchor():
    """Same accelerations as a robot built with the exit point there, in any state."""
    o = np.array([0.01, -0.02, 0.015])
    exits = bare().geometry.A.copy()
    exits[4] += o
    other = build_twin(geometry=replace(bare().geometry, exits=tuple(map(tuple, exits))))
    offset = full().with_values({f"anchor_offset.{n}@5": v for n, v in zip("xyz", o, strict=True)})
    state = moving(offset)
    a = forward(offset, state)
    d_0 = state.act[offset.model.actuator_actadr]
    other.model.actuator_user[:, law.T_0] = offset.start.balance
    b = forward(other, type(state)(state.qpos, state.qvel, d_0))
    assert a.qacc == pytest.approx(b.qacc, rel=1e-9, abs=1e-9)
