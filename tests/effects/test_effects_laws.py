"""Laws against their equations, and these equations in the compiled model.

What hidden worlds have too is compared with them in `tests/worlds/test_worlds_base.py`.
"""

from dataclasses import replace
from math import tanh

import numpy as np
import pytest
from effect_cases import BY_NAME, bare, drive, forward, full, moving

from inca_mj.robot import law
from inca_mj.twin.twin import build_twin

S = drive()
BREAK = tanh(S.beta * S.omega)
WAY = S.R_s * S.phi

LAWS = [
    ("torque_constant_drift", "rate", (0.01, 1.0), {}, 0.64),
    ("backlash", "tension", (0.01,), {}, -S.lambda_ * S.R * 0.01 / S.d),
    ("spring_hardening", "torque", (1e9, 2.0), {}, -S.R_s * S.F_s),
    ("cable_hardening", "tension", (500.0, 2.0), {"strain": -1e-4}, 0.0),
    ("cable_elasticity_drift", "tension", (0.1, 0.0), {"x": 9.0}, -0.2 * S.lambda_ * S.strain),
    ("cable_damping_drift", "tension", (0.1, 0.0), {"x": 9.0}, -0.2 * S.b * S.strain_rate * S.d_0),
    ("drum_spring_mismatch", "torque", (0.1,), {}, -0.1 * S.k_s * S.R_s * WAY),
    ("drum_spring_mismatch", "torque", (1e9,), {}, -S.R_s * S.F_s),
    ("drum_spring_drift", "torque", (0.1, 0.0), {"x": 9.0}, 0.2 * S.k_s * S.R_s * WAY),
    ("viscous_friction_drift", "torque", (0.1, 0.0), {"x": 9.0}, 0.2 * S.b_v * S.omega),
    ("friction_drift", "torque", (0.1, 0.0), {"x": 9.0}, 0.2 * S.b_c * BREAK),
    ("friction_drift", "torque", (0.1, 1.0), {"x": 9.0}, 0.9 * S.b_c * BREAK),
    ("friction_drift", "rate", (0.1, 1.0), {}, 0.64),
]


@pytest.mark.parametrize(("name", "hook", "p", "known", "expected"), LAWS)
def test_law(name, hook, p, known, expected):
    law = BY_NAME[name].hooks[hook].py_func
    assert law(drive(**known), p) == pytest.approx(expected, rel=1e-12, abs=1e-15)


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


ANCHOR = BY_NAME["anchor_offset"].hooks["path"].py_func
SPANS = [(1.2, -1.4, 1.3), (-1.5, 1.5, -1.6), (0.4, 1.9, 0.2), (0.05, 0.3, -2.0)]


def at(r):
    return drive(**dict(zip(("rx", "ry", "rz"), map(float, r), strict=True)))


@pytest.mark.parametrize("r", SPANS)
def test_the_gradient_of_an_anchor_offset_makes_a_direction_of_unit_length(r):
    r, h, p = np.array(r), 1e-6, (0.01, -0.02, 0.03)
    _, *gradient = ANCHOR(at(r), p)
    differences = [
        (ANCHOR(at(r + h * e), p)[0] - ANCHOR(at(r - h * e), p)[0]) / (2 * h) for e in np.eye(3)
    ]
    assert gradient == pytest.approx(differences, abs=1e-8)
    direction = r / np.linalg.norm(r) + gradient
    assert np.linalg.norm(direction) == pytest.approx(1, abs=1e-12)


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
