"""A saved twin with effects is the twin: the same numbers, the same trajectory, bit for bit."""

import json
from pathlib import Path

import numpy as np
import pytest
from fake_discovery import SIZES, found, log, truth

from identification.errors import InputError
from inca_mj.effects.catalogue import CATALOGUE
from inca_mj.effects.motor import STRIBECK_FRICTION
from inca_mj.twin.saved import load_twin, save_twin
from inca_mj.workflows.discovery_model import named_twin, rerun


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    save_twin(named_twin(found()), tmp_path)
    return tmp_path


def test_the_trajectory_comes_back_bit_for_bit(saved: Path) -> None:
    robot, again = named_twin(found()), load_twin(saved)
    assert again.parameters.values() == robot.parameters.values()
    assert again.effects == (STRIBECK_FRICTION,)
    a, b = rerun(robot, log()), rerun(again, log())
    for name in ("qpos", "qvel", "act", "tension"):
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name))


@pytest.mark.parametrize("file", ["model.xml", "effects.json"])
def test_either_file_may_be_named(saved: Path, file: str) -> None:
    values = load_twin(saved / file).parameters.values()
    assert {name: values[name] for name in SIZES} == SIZES


def test_every_place_and_input_effect_comes_back(tmp_path: Path) -> None:
    robot = truth().with_values({"friction_mismatch.delta@3": 0.1 / 3, "delay.tau": 0.001 / 7})
    save_twin(robot, tmp_path)
    again = load_twin(tmp_path)
    assert again.parameters.values() == robot.parameters.values()
    np.testing.assert_array_equal(rerun(robot, log()).qpos, rerun(again, log()).qpos)


def test_the_named_twin_is_the_final_fit() -> None:
    robot = named_twin(found())
    np.testing.assert_allclose(
        rerun(robot, log()).motor_angle, log().outputs - found().run.after, rtol=0, atol=1e-9
    )


def test_only_what_was_free_has_the_log_as_its_source() -> None:
    fit = found().final.point.space.names
    for p in named_twin(found()).parameters:
        assert (p.source == "fitted to the log") == (p.name in fit), p.name


def test_a_law_that_is_not_at_hand_is_named(saved: Path) -> None:
    with pytest.raises(InputError, match=r"stribeck_friction; pass them"):
        load_twin(saved, effects=CATALOGUE[1:])


def test_files_that_do_not_belong_together_are_refused(saved: Path) -> None:
    path = saved / "effects.json"
    record = json.loads(path.read_text())
    record["values"]["m"] = 0.2
    path.write_text(json.dumps(record))
    with pytest.raises(InputError, match="actuator_user differs"):
        load_twin(saved)


@pytest.mark.parametrize(
    ("change", "names"),
    [
        (lambda t: t.replace("exp(-|ω", "exp(-|2 ω"), "another law"),
        (lambda t: t.replace('"geometry"', '"geometrie"'), "damaged"),
        (lambda t: t[:40], "cannot be read as JSON"),
        (lambda t: "[]", "no object"),
    ],
)
def test_damaged_files(saved: Path, change, names: str) -> None:
    path = saved / "effects.json"
    path.write_text(change(path.read_text()))
    with pytest.raises(InputError, match=names):
        load_twin(saved)


def test_missing_files(tmp_path: Path, saved: Path) -> None:
    (saved / "model.xml").unlink()
    with pytest.raises(InputError, match=r"no .*model\.xml"):
        load_twin(saved)
    (saved / "effects.json").unlink()
    with pytest.raises(InputError, match="inca discover --out"):
        load_twin(saved)
