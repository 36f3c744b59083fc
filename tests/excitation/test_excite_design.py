"""The designed input keeps its limits, repeats itself, and is no worse than what people try."""

import json

import numpy as np
import pytest

from identification import InputError
from inca_mj.cli import main
from inca_mj.robot.inputs import make_input
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.excitation import excite
from inca_mj.workflows.limits import Limits, remarks
from inca_mj.workflows.pulled import with_force
from inca_mj.workflows.recipes import changed, draw

NAMES = ("b", "J", "b_v")
STEP = 2e-3  # [s]


@pytest.fixture(scope="module")
def robot():
    return build_twin(timestep=STEP)


def test_the_design_keeps_its_limits_and_repeats(robot):
    limits = Limits(0.2, 1.2, 2.0, 0.1, 0.3)
    one, two = (excite(robot, 0.3, free=NAMES, limits=limits, budget=2, seed=4) for _ in range(2))
    assert np.array_equal(one.best.run.currents, two.best.run.currents)
    assert one.best.found.e_value == two.best.found.e_value
    again = simulate(robot, one.best.run.currents)
    assert again.tension.min() > 2.0
    assert np.abs(again.position - again.position[0]).max() <= 0.1
    assert 0.2 <= again.currents.min() < again.currents.max() <= 1.2
    assert one.best.allowed
    assert all(one.best.found.e_value >= t.found.e_value for t in one.standard if t.allowed)
    assert one.worst_gain >= 1


def test_recipes_stay_inside_the_currents():
    rng, limits = np.random.default_rng(0), Limits(0.3, 1.7)
    for kind in ("multisine", "prbs"):
        recipe = draw(kind, rng)
        for _ in range(20):
            recipe = changed(recipe, rng, 0.5)
            u = recipe.currents(101, 0.01, limits)
            assert u.shape == (101, 8)
            assert 0.3 - 1e-12 <= u.min() <= u.max() <= 1.7 + 1e-12


def test_bad_designs_are_refused(robot):
    for keywords, word in (
        ({"duration": 0.01}, "cannot be designed"),
        ({"budget": 0}, "budget"),
        ({"limits": Limits(margin=50.0)}, "rests with"),
        ({"free": ("lamda",), "duration": 0.3}, "did you mean"),
    ):
        with pytest.raises(InputError, match=word):
            excite(robot, **keywords)
    with pytest.raises(InputError, match="keeps the limits"):
        excite(robot, 0.3, free=("J",), limits=Limits(reach=1e-9), budget=1)


@pytest.mark.usefixtures("undrawn")
def test_excite_writes_what_simulate_replays(tmp_path, capsys):
    arguments = ["excite", "--duration", "0.3", "--budget", "1", "--free", "J", "b_v",
                 "--step", str(STEP), "--out", str(tmp_path), "--json"]  # fmt: skip
    assert main(arguments) == 0
    result = json.loads(capsys.readouterr().out)
    assert set(result["parameters"]) == {"J", "b_v"}
    assert (tmp_path / "report.html").exists()
    assert (tmp_path / "result.json").exists()
    replay = ["simulate", "--input", str(tmp_path / "excite.csv"), "--out", str(tmp_path / "again")]
    assert main([*replay, "--step", str(STEP), "--json"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert again["tension_min"] == pytest.approx(result["tension_min"], rel=1e-9)


def test_sensitivity_names_what_trades_off(tmp_path, capsys):
    arguments = ["sensitivity", "--duration", "0.3", "--free", "R_s", "k_s", "J"]
    assert main([*arguments, "--json", "--out", str(tmp_path)]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["parameters"]["R_s"]["std"] is None
    assert result["parameters"]["J"]["std"] > 0
    assert result["E"] == 0
    assert "R_s" in result["verdict"][0]
    assert "k_s" in result["verdict"][0]
    assert list(tmp_path.glob("*.png"))
    assert main(["sensitivity", "--noise", "-1"]) == 2


def test_a_usual_run_has_no_remarks():
    assert remarks(simulate(build_twin(), make_input("prbs", 1.0))) == ()


def test_a_handle_that_is_torn_off_is_told_with_the_time_and_its_slack_cables():
    run = simulate(with_force(build_twin(), (0, 0, -90)), np.zeros((101, 8)))
    slack, outside = remarks(run)
    first = run.time[np.argmax(run.position[:, 2] < 0.1)]
    assert f"leaves the room between the exit points at {first:.2f} s" in outside
    for k in range(8):
        assert (f"{k + 1}" in slack.split("(")[0]) == bool((run.tension[:, k] <= 0).any())
