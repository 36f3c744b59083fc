"""What the messages of a log's checks tell to write makes the log a right one."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from advice import advised

from identification import InputError, write_log
from inca_mj.cli import main
from inca_mj.twin.logs import JUDGED, read_inca_log
from inca_mj.twin.twin import build_twin
from inca_mj.twin.wiring import refuse_miswired
from inca_mj.workflows.comparison import compare, compare_twin

LOG = read_inca_log(Path(__file__).parents[2] / "examples" / "log.csv").between(0.0, 4.0)
UNIT = {"deg": np.pi / 180, "mrad": 1e-3, "rev": 2 * np.pi, "rad": 1.0}
pytestmark = pytest.mark.usefixtures("each_run_once")


@pytest.fixture(scope="module")
def plant():
    return build_twin()


def mistaken(at=range(8), back=(), word="rad"):
    """A log whose column k is angle at[k], with signs turned, in another unit."""
    y = LOG.outputs[:, list(at)] * np.where(np.isin(np.arange(8), back), -1, 1) / UNIT[word]
    return replace(LOG, outputs=y)


def written(log, folder, units=None):
    """The CSV of a log, with its SI units out of the way."""
    path = folder / "log.csv"
    write_log(replace(log, units=units or {}), path)
    path.with_suffix(".toml").unlink(missing_ok=True)
    return path


def said_of(log, plant, trust=()):
    with pytest.raises(InputError) as refused:
        refuse_miswired(log, plant, trust)
    return str(refused.value)


@pytest.mark.parametrize(
    ("at", "back", "word"),
    [
        (range(8), (2,), "rad"),
        (range(8), (), "deg"),
        ((0, 1, 5, 3, 4, 2, 6, 7), (), "rad"),
        ((1, 2, 0, 3, 4, 5, 6, 7), (1, 6), "rad"),
        *[(range(8), (k,), word) for k, word in ((7, "mrad"), (0, "rev"))],
        (range(8), (1, 4, 6), "deg"),
        ((1, 2, 0, 3, 4, 5, 6, 7), (0, 5), "deg"),
    ],
)
def test_what_is_told_mends_the_log(plant, tmp_path, at, back, word):
    wrong = mistaken(at, back, word)
    said = said_of(wrong, plant)
    path = written(wrong, tmp_path)
    path.with_suffix(".toml").write_text(advised(said))
    mended = read_inca_log(path)
    np.testing.assert_allclose(mended.outputs, LOG.outputs, rtol=1e-9, atol=1e-12)
    refuse_miswired(mended, plant)


def test_degrees_and_a_turned_sign_are_told_in_one_sentence_and_overruled_by_two_words(plant):
    wrong = mistaken(back=(2,), word="deg")
    said = said_of(wrong, plant)
    assert "turn the sign of angle_3: write angle_3 = -1 under [factors]" in said
    assert 'write angle = "deg" under [units] of the log\'s TOML' in said
    assert "write --trust wiring units" in said
    assert "write --trust units" in said_of(wrong, plant, ["wiring"])
    assert "write --trust wiring" in said_of(wrong, plant, ["units"])
    refuse_miswired(wrong, plant, ["wiring", "units"])


def test_one_angle_in_degrees_is_told_beside_the_turned_sign_of_another(plant):
    factors = np.array([1, -1, 1, 1, 1, 1 / UNIT["deg"], 1, 1])
    said = said_of(replace(LOG, outputs=LOG.outputs * factors), plant)
    assert "angle_2 = -1 under [factors]" in said
    assert 'write angle_6 = "deg" under [units]' in said


@pytest.mark.parametrize(
    ("wrong", "word", "told"),
    [
        (mistaken(back=(2,)), "wiring", "turn the sign of angle_3"),
        (mistaken(word="rev"), "units", "must be in radians"),
    ],
)
def test_compare_judges_a_log_as_the_searches_do(plant, tmp_path, capsys, wrong, word, told):
    path = str(written(wrong, tmp_path))
    assert main(["compare", path, "--json"]) == 2
    said = capsys.readouterr()
    assert told in said.err
    assert said.err.count("\n") == 1
    assert said.out == ""
    assert main(["compare", path, "--trust", word, "--json"]) == 0
    shown = json.loads(capsys.readouterr().out)
    assert shown["samples"] == len(wrong)
    for judged in (compare, lambda log, **trust: compare_twin(log, plant, **trust)):
        with pytest.raises(InputError, match=f"write --trust {word}, with which `inca compare`"):
            judged(wrong)
        np.testing.assert_allclose(judged(wrong, trust=[word]).rms, shown["rms"], rtol=1e-9)


def test_compare_judges_currents_and_large_numbers_too(tmp_path, capsys):
    turned = replace(LOG, inputs=LOG.inputs * np.where(np.arange(8) == 2, -1, 1))
    large = replace(LOG, outputs=LOG.outputs * np.where(np.arange(8) == 2, 1e3, 1))
    for wrong, told, words in (
        (turned, "turn the sign of current_3: write current_3 = -1", "wiring units"),
        (large, "beyond the plausible 400 rad", "units wiring sensors"),
    ):
        path = str(written(wrong, tmp_path))
        assert main(["compare", path]) == 2
        said = capsys.readouterr().err
        assert told in said
        assert f"write --trust {words.split()[0]}" in said
        assert main(["compare", path, "--trust", *words.split(), "--json"]) == 0
        capsys.readouterr()


def test_a_log_in_degrees_is_not_told_to_begin_elsewhere(tmp_path, capsys):
    path = written(mistaken(word="deg"), tmp_path)
    assert main(["film", str(path)]) == 2  # it draws a log as it is, however far it moves
    said = capsys.readouterr().err
    assert "rad, far more than an encoder makes, so that the file is likely not in radians" in said
    assert "if its angles are in degrees, and else the unit that they are in" in said
    assert "subtract" not in said
    path.with_suffix(".toml").write_text(advised(said))
    np.testing.assert_allclose(read_inca_log(path).outputs, LOG.outputs, rtol=1e-9, atol=1e-12)


def test_a_log_that_begins_in_motion_is_told_to_begin_at_rest(tmp_path):
    moving = LOG.between(1.0, 4.0)
    with pytest.raises(InputError, match="cut it where the robot rests and subtract its angles"):
        read_inca_log(written(moving, tmp_path))


def test_compare_shows_a_right_log_the_same_whether_it_is_judged_or_not():
    np.testing.assert_array_equal(compare(LOG).rms, compare(LOG, trust=tuple(JUDGED)).rms)


def test_compare_refuses_an_unknown_word():
    with pytest.raises(InputError, match=r"'wires'.*sensors, units, wiring"):
        compare(LOG, trust=["wires"])
