"""The catalogue as a whole: its names, nothing when absent, the same on each as on all."""

import mujoco
import numpy as np
import pytest
from effect_cases import CATALOGUE, EVERYWHERE, bare, forward, full, probes, simulate
from numba import njit
from plain_logs import plain_log

from identification import Predictor
from identification.effects.effect import Effect
from identification.effects.sizes import Size
from identification.kalman.linear import linearise
from identification.model.rollout import rollout
from inca_mj.effects.hooks import DRIVES_EACH
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import ANGLES, CURRENTS
from inca_mj.twin.twin import build_twin


def test_all_sizes_zero_is_the_bare_robot_to_the_bit():
    assert np.array_equal(simulate(full(), seconds=2), simulate(bare(), seconds=2))


@pytest.mark.parametrize("effect", CATALOGUE, ids=lambda e: e.name)
def test_numbers_make_sense(effect):
    for size in effect.sizes:
        assert 0 < size.probe <= size.largest
    for shape in effect.shapes:
        assert all(shape.lower <= value <= shape.upper for value in shape.grid)
        assert list(shape.grid) == sorted(shape.grid)


@pytest.mark.parametrize("effect", CATALOGUE, ids=lambda e: e.name)
def test_a_probe_shows_and_is_nearly_linear(effect):
    """Half the probe moves the angles half as much."""
    jump = effect.name.endswith("_jump")
    shapes = {"current_saturation.i_max": 0.75} if effect.name == "current_saturation" else {}
    shapes |= {f"{effect.name}.t_s": 0.5} if jump else {}
    names = [*shapes, *probes(effect)]
    values = [[*shapes.values(), *(f * p for p in probes(effect).values())] for f in (0, 0.5, 1)]
    # A drift begins at nothing, and a jump comes after half of the first second.
    seconds = 4 if effect.name.endswith("_drift") else 2 if jump else 1
    none, half, whole = simulate(full(), names, values, seconds=seconds)
    size = np.sqrt(np.mean((whole - none) ** 2))
    assert size > (1e-5 if jump else 1e-4)
    assert np.sqrt(np.mean((whole - none - 2 * (half - none)) ** 2)) < 0.5 * size


def test_an_effect_on_each_drive_is_that_effect_on_all():
    for effect in EVERYWHERE:
        everywhere = probes(effect, "all drives")
        each = {}
        for k in range(1, 9):
            each |= probes(effect, f"drive {k}")
        names = [*everywhere, *each]
        on_all = [*everywhere.values(), *(0.0 for _ in each)]
        on_each = [*(0.0 for _ in everywhere), *each.values()]
        one, other = simulate(full(), names, [on_all, on_each], seconds=0.3)
        assert np.array_equal(one, other), effect.name


PRESENT = {
    "pulley_radius": {"pulley_radius.r_p": 0.02},
    "anchor_offset": {"anchor_offset.x@3": 0.01, "anchor_offset.z@3": -0.01},
    "com_offset": {"com_offset.x": 3e-3, "com_offset.y": -1e-3, "com_offset.z": 4e-3},
    "cable_weight": {"cable_weight.rho": 2e-3},
    "external_force": {"external_force.x": 0.05, "external_force.z": -0.1},
    "cable_hardening": {"cable_hardening.kappa": 2000.0},
    "cable_creep": {"cable_creep.c": 0.3},
    "backlash": {"backlash.h": 0.02},
    "drum_radius_mismatch": {"drum_radius_mismatch.delta@2": 0.02},
    "drum_eccentricity": {"drum_eccentricity.a": 0.01, "drum_eccentricity.b": 0.01},
    "air_drag": {"air_drag.c": 0.1},
}
TURNED = {"x": 0.05, "y": -0.03, "z": 1.4, "roll": 0.05, "pitch": -0.08, "yaw": 0.1}


@pytest.mark.parametrize("name", PRESENT)
def test_a_settled_robot_rests(name):
    twin = full(settled=True).with_values({**TURNED, **PRESENT[name]})
    data = forward(twin, twin.state())
    scale = np.abs(forward(bare(), bare().state(), 1.0).qacc).max()
    assert np.abs(data.qacc).max() < 1e-8 * scale
    creep = data.act_dot.reshape(8, -1)
    assert np.abs(creep).max() < 1e-9


def test_a_settled_robot_with_all_of_them_rests():
    present = {k: v / 3 for values in PRESENT.values() for k, v in values.items()}
    twin = full(settled=True).with_values({**TURNED, **present})
    assert np.abs(forward(twin, twin.state()).qacc).max() < 1e-5


@pytest.mark.parametrize("name", PRESENT)
def test_else_it_starts_with_the_nominal_tension(name):
    twin, nominal = full().with_values({**TURNED, **PRESENT[name]}), bare().with_values(TURNED)
    begin = twin.start
    assert begin.tension == pytest.approx(nominal.start.tension, abs=1e-12)
    lambda_ = twin.parameters["lambda"].value
    data = forward(twin, twin.state())
    if name not in ("pulley_radius", "anchor_offset"):  # MuJoCo's own length is then the path
        d_0 = lambda_ * data.ten_length / (lambda_ + begin.tension)
        assert begin.no_load_length == pytest.approx(d_0, rel=1e-12)


def test_one_call_with_many_starts_is_many_calls():
    twin = full()
    names = [k for values in PRESENT.values() for k in values]
    row = [v / 3 for values in PRESENT.values() for v in values.values()]
    state, numbers = twin.settings(names, np.array([row, np.zeros(len(row))]))
    with_it = twin.with_values(dict(zip(names, row, strict=True)))
    assert np.array_equal(state.act[0], with_it.state().act)
    for slot, column in numbers:
        written = getattr(with_it.model, slot.field)[slot.index()]
        assert np.array_equal(written, np.full_like(written, column[0])), slot


MODEL = [e for e in CATALOGUE if "input" not in e.hooks]


def some_of_everything():
    out = {"cogging.n": 7.0, "torque_constant_drift.kind": 1.0, "cable_creep.tau": 2.0}
    for effect in MODEL:
        out |= probes(effect, list(effect.places)[-1], 0.5)
    return out


def test_new_values_are_a_fresh_build_to_the_bit(tmp_path):
    values = some_of_everything()
    parameters = full().parameters.with_values(values)
    fresh = build_twin(parameters, effects=CATALOGUE)
    changed = full().with_values(values)
    batch = simulate(full(), list(values), [list(values.values())])
    assert np.array_equal(simulate(fresh), simulate(changed))
    assert np.array_equal(batch, simulate(changed))

    read = mujoco.MjModel.from_xml_path(str(changed.save(tmp_path / "robot.xml")))
    for field in ("actuator_user", "body_user", "site_pos", "body_ipos", "key_act", "key_qpos"):
        assert np.array_equal(getattr(read, field), getattr(fresh.model, field)), field
    u = make_input("prbs", 0.5)
    runs = [rollout(m, changed.state(), u, 0.01, record=("qpos",)) for m in (read, fresh.model)]
    assert np.array_equal(runs[0]["qpos"], runs[1]["qpos"])


@njit
def torque(s, p):
    """A stuck brake: constant torque against winding in."""
    return -p[0]


STUCK = Effect(
    "stuck_brake", "-f", (Size("f", "N m", 0.01, 1e-3),), places=DRIVES_EACH,
    hooks={"torque": torque},
)  # fmt: skip


def test_an_effect_of_a_users_own():
    """One function, one record: a constant torque is a current of -f/K_t."""
    twin = build_twin(effects=(STUCK,))
    assert np.array_equal(simulate(twin), simulate(bare()))
    f = 2e-3
    K_t = twin.parameters["K_t"].value
    braked = simulate(twin, ["stuck_brake.f"], [[f]])[0]
    u = make_input("prbs", 0.5)
    start = bare().state()
    weaker = rollout(bare().model, start, u - f / K_t, 0.01, record=("qpos",))["qpos"][0]
    assert np.abs(braked - weaker[:, 7:]).max() < 1e-9


SMALL = 1e-4  # of a current's error [A]


def test_the_answer_to_an_unlogged_current_is_that_of_the_simulation():
    """To what the Jacobian changes within a sample; without the activations it is 200 % off."""
    u = make_input("prbs", 2.0)
    log = plain_log(u, np.zeros_like(u), CURRENTS, ANGLES)
    error = SMALL * np.random.default_rng(0).standard_normal(u.shape)
    none = np.empty((1, 0))
    plain, moved = (
        Predictor(
            full(),
            plain_log(inputs, log.outputs, CURRENTS, ANGLES, time=log.time),
            (),
        ).predict(none)[0]
        for inputs in (u, u + error)
    )
    linear = linearise(Predictor(full(), log, ()), none[0])
    x, y = np.zeros(linear.A.shape[1]), [np.zeros(8)]
    for A, B, w in zip(linear.A, linear.B, error[:-1], strict=True):
        x = A @ x + B @ w
        y.append(linear.C @ x)
    answer = moved - plain
    assert np.linalg.norm(answer - y) < 0.1 * np.linalg.norm(answer)
