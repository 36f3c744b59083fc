"""Worlds that depart from what a search takes for granted are what they say, and judged as that."""

from itertools import pairwise

import numpy as np
import pytest
import wrong_worlds
from departures import DEPARTURES, LOUDER, Departure
from inca_departures import _controlled, make_inca
from joint_worlds.world import make_world

from inca_mj.reference import layout as base
from inca_mj.robot.geometry import INCA
from inca_mj.robot.inputs import prbs
from inca_mj.robot.parameters import parameter_set
from inca_mj.studies.worlds import effect, make_plant, simulate_world

N, H = 20_000, 0.01
USUAL = Departure(name="usual", about="")
STD = np.array([1.0, 2.0])


def noise(name):
    return DEPARTURES[name].noise((N, 2), STD, np.random.default_rng(1))


def error(name):
    u = np.random.default_rng(2).normal(size=(N, 2)) + 1.0
    return u, DEPARTURES[name].error(u, H, STD, 0.05, np.random.default_rng(3))


def test_heavy_tails_have_the_usual_std_and_more_far_samples():
    z = noise("heavy_tails") / STD
    assert z.std(axis=0) == pytest.approx(1, rel=0.1)
    assert np.mean(np.abs(z) > 5) > 1e-3  # of a Gaussian 6e-7


def test_unequal_sensors_differ_within_their_range():
    ratio = noise("unequal_sensors").std(axis=0) / STD
    assert abs(np.log(ratio[0] / ratio[1])) > 0.1
    assert np.all((ratio > 0.97 / LOUDER) & (ratio < 1.03 * LOUDER))


@pytest.mark.parametrize(("name", "time"), [("short_errors", 0.005), ("long_errors", 1.0)])
def test_errors_last_as_long_as_is_said(name, time):
    w = error(name)[1] / STD
    assert w.std() == pytest.approx(1, rel=0.15)
    assert np.mean(w[1:] * w[:-1]) / np.mean(w**2) == pytest.approx(np.exp(-H / time), abs=0.03)


def test_errors_are_in_proportion_to_the_input_or_follow_it():
    u, w = error("proportional_errors")
    large = np.abs(u) > 2
    assert np.std(w[large]) > 2 * np.std(w[~large])
    u, w = error("following_errors")
    lagged = np.array([np.correlate(u[:-6, 0] - 1, w[k : k - 6, 0])[0] for k in range(6)])
    assert np.abs(lagged).max() / N > 0.1  # white inputs follow slowly, and each sample a little
    usual = USUAL.error(u, H, STD, 0.05, np.random.default_rng(3))
    none = np.array([np.correlate(u[:-6, 0] - 1, usual[k : k - 6, 0])[0] for k in range(6)])
    assert np.abs(none).max() / N < 0.05


def test_a_robot_of_joints_gets_the_departure_and_else_stays_as_it_was():
    usual, heavy = (
        make_world("pendulum", "nothing", 3, 4.0, DEPARTURES[name]) if name else
        make_world("pendulum", "nothing", 3, 4.0) for name in ("", "heavy_tails")
    )  # fmt: skip
    assert heavy.truth == usual.truth
    assert not np.array_equal(heavy.records[0].outputs, usual.records[0].outputs)
    jumped = make_world("pendulum", "nothing", 3, 4.0, DEPARTURES["jumps"])
    assert jumped.names == ("offset",)
    assert jumped.truth == usual.truth
    wide = make_world("pendulum", "nothing", 3, 4.0, DEPARTURES["wide_deviations"])
    assert wide.truth != usual.truth


@pytest.mark.parametrize("name", ["delay", "current_lag"])
def test_the_currents_of_a_controller_arrive_as_a_simulation_lets_them(name):
    """Without a gain they are the reference, and with one they are what the law says of them."""
    hidden = (effect(name),)
    plant = make_plant(parameter_set("trial"), INCA, hidden)
    u = prbs(150, H, seed=1)
    still = np.zeros_like(u)
    aim = simulate_world(make_plant(parameter_set("trial"), INCA), u, H)[:, base.ANGLES]
    np.testing.assert_array_equal(_controlled(plant, u, still, aim, still, 0.0, H)[:-1], u[:-1])
    held = _controlled(plant, u, still, aim, still, 0.3, H)
    seen = simulate_world(plant, held, H)[:, base.ANGLES]
    np.testing.assert_allclose(held[:-1], (u + 0.3 * (aim - seen))[:-1], atol=1e-9)


def row(named=(), verdict="named", names=("drag",), is_null=False, **more):
    each = [{"name": n, "one_of": False, "rivals": [], **more} for n in named]
    return {"named": each, "verdict": verdict, "is_null": is_null, "truth": {"names": list(names)},
            "departure": "powers"}  # fmt: skip


@pytest.mark.parametrize(
    ("answer", "expected"),
    [
        (row(["drag"]), "right"),
        (row(["drag", "lag"]), "false"),
        (row(["lag"]), "false"),
        (row(["lag"], one_of=True, rivals=["drag", "delay"]), "right"),
        (row(["lag"], one_of=True, rivals=["delay", "drag"]), "false"),
        (row(["curve_speed"]), "unknown"),
        (row([], "unknown effect"), "unknown"),
        (row([], "nothing missing"), "silent"),
        (row(["lag"], names=(), is_null=True), "false"),
    ],
)
def test_every_answer_is_one_thing(answer, expected):
    tests = {w: getattr(wrong_worlds, f"is_{w}") for w in ("right", "false", "unknown", "silent")}
    assert [w for w, test in tests.items() if test(answer)] == [expected]


def test_every_world_has_a_seed_of_its_own_and_nulls_alternate():
    every = wrong_worlds.tasks([*DEPARTURES], 24)
    assert len({seed for *_, seed in every}) == len(every)
    for name in DEPARTURES:
        for is_inca in (True, False):
            mine = [t[2] for t in every if t[0] == name and (t[1] == "inca") is is_inca]
            if DEPARTURES[name].hides == "listed":
                assert all(a != b for a, b in pairwise(mine))
            else:
                assert not any(mine)
    few = wrong_worlds.tasks(["jumps"], 24)
    assert few == [t for t in every if t[0] == "jumps"]


def test_a_world_of_inca_tells_what_it_hides_with_its_sizes():
    log, truth = make_inca(DEPARTURES["two_unlisted"], False, 7009000, 4.0)
    assert np.isfinite(log.outputs).all()
    assert truth["names"] == []
    assert len(truth["hidden"]) == 2
    assert all(any(hidden["sizes"].values()) for hidden in truth["hidden"])
