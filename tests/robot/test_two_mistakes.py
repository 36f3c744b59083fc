"""A log in another unit and with a sign turned is refused, and what is told mends it."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from advice import advised
from test_right_logs import ARM, MOTION, PENDULUM, payload, robot, tracked

from identification import InputError, write_log
from identification.logs.units import UNITS
from identification.robot.robot import read_robot_log
from identification.robot.wiring import refuse_miswired

HORIZON = "horizon = 0.2"
CASES = [
    (PENDULUM, [-1], "mrad", HORIZON),
    (ARM, [-1, 1], "deg", ""),
    (ARM, [1, -1], "rev", HORIZON),
]


def mistaken(xml, word, signs, world=lambda model: None):
    """A log of a robot that is written in another unit and with other signs."""
    truth = mujoco.MjModel.from_xml_string(xml)
    world(truth)
    log = tracked(truth, MOTION[xml])
    return replace(log, outputs=log.outputs * signs / UNITS[word][1])


@pytest.mark.parametrize(("xml", "signs", "word", "horizon"), CASES)
def test_both_are_told_and_what_is_told_mends_the_log(tmp_path, xml, signs, word, horizon):
    own, read = robot(tmp_path, xml, mistaken(xml, word, signs), horizon)
    with pytest.raises(InputError) as refused:
        refuse_miswired(own, read)
    said = str(refused.value)
    assert f"were it in {word} and with the other sign" in said
    assert f'write trust = ["units", "wiring"] into {own.file.path}' in said
    (tmp_path / "log.toml").write_text(advised(said))
    mended = read_robot_log(own.file, tmp_path / "log.csv")
    np.testing.assert_allclose(
        mended.outputs, read.outputs * signs * UNITS[word][1], rtol=1e-12, atol=0
    )
    refuse_miswired(own, mended)


def test_who_knows_better_overrules_both(tmp_path):
    own, read = robot(tmp_path, ARM, mistaken(ARM, "rev", [-1, 1]), "")
    refuse_miswired(replace(own, file=replace(own.file, trust=("units", "wiring"))), read)


@pytest.mark.parametrize(
    ("lacking", "horizon"),
    [
        (payload, HORIZON),
    ],
)
def test_what_a_model_lacks_is_no_unit_and_no_sign(tmp_path, lacking, horizon):
    """Forces decide: where a payload or gravity explains them, no two mistakes are looked for."""
    truth = mujoco.MjModel.from_xml_string(ARM)
    lacking(truth)
    log = tracked(truth, MOTION[ARM], seed=3)
    write_log(log, tmp_path / "log.csv")
    refuse_miswired(*robot(tmp_path, ARM, log, horizon))


def exchanged(log, of, signs, turned):
    """A log with two columns exchanged, and after that with other signs of inputs or outputs."""
    log = replace(log, **{of: getattr(log, of)[:, ::-1]})
    return replace(log, **{turned: getattr(log, turned) * signs})


@pytest.mark.parametrize(
    ("of", "turned", "signs", "horizon"),
    [
        ("outputs", "inputs", [1, -1], HORIZON),
        ("inputs", "outputs", [-1, 1], HORIZON),
    ],
)
def test_an_exchange_beside_a_turned_sign_is_told_and_mended(tmp_path, of, turned, signs, horizon):
    right = tracked(mujoco.MjModel.from_xml_string(ARM), MOTION[ARM])
    own, read = robot(tmp_path, ARM, exchanged(right, of, signs, turned), horizon)
    with pytest.raises(InputError, match="exchanged and with the other sign") as refused:
        refuse_miswired(own, read)
    said = str(refused.value)
    assert f'write trust = ["wiring"] into {own.file.path}' in said
    (tmp_path / "log.toml").write_text(advised(said))
    mended = read_robot_log(own.file, tmp_path / "log.csv")
    turns = [np.sign(np.sum(getattr(mended, of) * getattr(right, of), axis=0))
             for of in ("inputs", "outputs")]  # fmt: skip
    for of, turn in zip(("inputs", "outputs"), turns, strict=True):
        np.testing.assert_allclose(getattr(mended, of), turn * getattr(right, of), rtol=1e-12)
    np.testing.assert_array_equal(*turns)  # joint and drive turned together: seen from behind
    refuse_miswired(own, mended)


@pytest.mark.parametrize(
    ("outputs", "inputs", "horizon"),
    [
        ((-1, 1), (1, -1), HORIZON),
    ],
)
def test_two_turned_signs_are_told_and_mended(tmp_path, outputs, inputs, horizon):
    right = tracked(mujoco.MjModel.from_xml_string(ARM), MOTION[ARM])
    wrong = replace(right, outputs=right.outputs * outputs, inputs=right.inputs * inputs)
    own, read = robot(tmp_path, ARM, wrong, horizon)
    with pytest.raises(InputError, match=r'turn the sign of .*trust = \["wiring"\]') as refused:
        refuse_miswired(own, read)
    (tmp_path / "log.toml").write_text(advised(str(refused.value)))
    mended = read_robot_log(own.file, tmp_path / "log.csv")
    turns = [np.sign(np.sum(getattr(mended, of) * getattr(right, of), axis=0))
             for of in ("inputs", "outputs")]  # fmt: skip
    np.testing.assert_array_equal(*turns)  # all turned together: seen from behind
    assert len({*turns[0]}) == 1
    refuse_miswired(own, mended)
