"""The compiled model holds the thesis' numbers; each parameter goes somewhere and acts."""

import numpy as np
import pytest
from twin_cases import every_step, moving

from identification.errors import InputError
from identification.model.paths import read, resolve
from identification.model.rollout import State
from inca_mj.robot import law
from inca_mj.robot.parameters import SETS, parameter_set
from inca_mj.twin.twin import build_twin

# Thesis Tables 2.1 and 3.2, typed from the page.
TABLES = {
    "simulation": {
        "R": 0.0175, "R_s": 0.006, "k_s": 16, "lambda": 32224, "b": 10, "J": 3.0563e-5,
        "b_v": 3e-4, "b_c": 0.005, "beta": 0.8, "K_t": 0.0603, "m": 0.1725,
    },
    "trial": {
        "R": 0.0175, "R_s": 0.006, "k_s": 16, "lambda": 25000, "b": 8, "J": 8e-5,
        "b_v": 2e-4, "b_c": 0.005, "beta": 0.8, "K_t": 0.08, "m": 0.1725,
    },
}  # fmt: skip


@pytest.mark.parametrize("name", SETS)
def test_the_compiled_model_holds_the_tables(name):
    model, table = build_twin(parameter_set(name)).model, TABLES[name]
    for k in range(1, 9):
        drive = model.actuator(f"current_{k}")
        row, cable = drive.user, model.tendon_user[model.tendon(f"cable_{k}").id]
        held = {
            "R": row[law.R], "R_s": row[law.R_S], "k_s": row[law.K_S], "b_c": row[law.B_C],
            "beta": row[law.BETA], "K_t": drive.gear[0],
            "lambda": cable[law.LAMBDA],
            "b": cable[law.B],
            "J": model.joint(f"motor_{k}").armature[0],
            "b_v": model.joint(f"motor_{k}").damping[0],
            "m": model.body("platform").mass[0],
        }  # fmt: skip
        assert held == table
        assert int(row[law.CABLE]) == model.tendon(f"cable_{k}").id
    np.testing.assert_array_equal(model.body("platform").inertia, [0.8e-4, 1.5e-4, 1.8e-4])
    np.testing.assert_array_equal(model.opt.gravity, [0, 0, -9.81])
    np.testing.assert_array_equal(model.key("start").qpos[:7], [0, 0, 1.43, 1, 0, 0, 0])


ALL = [p for p in parameter_set()]


@pytest.mark.parametrize("parameter", ALL, ids=lambda p: p.name)
def test_every_parameter_has_an_effect(parameter):
    robot = build_twin()
    shift = 1e-2 * (parameter.value or 1.0)
    other = robot.with_values({parameter.name: parameter.value + shift})
    ours, theirs = (
        every_step(r, State(r.state().qpos, moving(1).qvel, r.state().act), np.ones((51, 8)))
        for r in (robot, other)
    )
    assert np.abs(ours["qpos"] - theirs["qpos"])[-1].max() > 1e-9


@pytest.mark.parametrize("parameter", [p for p in ALL if p.where != "start"], ids=lambda p: p.name)
def test_every_path_resolves_to_its_value(parameter):
    model = build_twin().model
    slot = resolve(model, parameter.where)
    assert read(model, slot) == parameter.value
    assert len(slot.rows) == (1 if "platform" in parameter.where else 8)


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("motor_1.damping", "is no model path; write kind/name.attribute"),
        ("joint/motor_1", "is no model path"),
        ("motor/motor_1.damping", "unknown kind of object 'motor'.* known: actuator, body"),
        ("joint/moter_1.damping", "unknown joint 'moter_1'; did you mean 'motor_1'"),
        ("joint/drum_*.damping", r"unknown joint 'drum_\*'"),
        ("joint/motor_1.viscosity", "unknown attribute of a joint 'viscosity'"),
        ("body/platform.inertia", "has columns 0 to 2, write one as"),
        ("body/platform.inertia[3]", "has columns 0 to 2"),
        ("body/platform.mass[0]", r"one number, write no \[column\]"),
    ],
)
def test_a_path_that_leads_nowhere_is_refused(path, message):
    with pytest.raises(InputError, match=message):
        resolve(build_twin().model, path)
