"""States of joints begin at loads that do not depend on the effects that have these states."""

import numpy as np
from chain_cases import chain_log, chain_text, with_some

from identification.effects.plant.joint_states import first_loads
from identification.model.rollout import State


def test_states_begin_at_the_loads_of_the_plant_without_states():
    log = chain_log(2)
    plant = with_some(chain_text(2, "RK4"), log)
    starts, rng = np.array([3, 20, 40]), np.random.default_rng(0)
    known = State(rng.normal(size=(3, 2)), rng.normal(size=(3, 2)), np.zeros((3, 0)))
    sizes = ("joint_elasticity.c@j0", "joint_elasticity.c", "gear_backlash.eps@j1")
    there = plant.with_states_of(sizes)
    for size in (*sizes, *sizes):
        shapes = ["joint_elasticity.link", "coulomb_friction.f_c@j0"]
        names, values = [size, *shapes], np.array([[0.01, 0.0, 0.2]])
        found = there.first_loads(names, values, known, log, starts)
        plain, inputs = there.without_states(), log.inputs[starts - 1]
        numbers = plain.settings(names, values)[1]
        loads = first_loads(plain.bare.model, plain.layout, numbers, known, inputs)
        every = {**there.parameters.values(), **dict(zip(names, values.T, strict=True))}
        slow = there.gears.first_states(every, loads, log, starts)
        assert all(np.array_equal(*pair) for pair in zip(found, slow, strict=True))
