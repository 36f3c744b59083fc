"""Values into the model: in one call, by building afresh, through a file; and a user's effect."""

import mujoco
import numpy as np
from effect_cases import CATALOGUE, bare, full, probes, simulate
from numba import njit

from identification.effects.effect import Effect, Size
from identification.model.rollout import rollout
from inca_mj.effects.hooks import DRIVES_EACH
from inca_mj.robot.inputs import make_input
from inca_mj.twin.twin import build_twin

MODEL = [e for e in CATALOGUE if "input" not in e.hooks]


def some_of_everything() -> dict[str, float]:
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
