"""The film of a discovery shows seconds that no fit has seen."""

from dataclasses import replace

import fake_discovery
import numpy as np
import pytest
from PIL import Image

from inca_mj.commands.filmed import FILMED, film_discovery, filmed_seconds
from inca_mj.workflows.discovery_model import nominal_twin


@pytest.mark.parametrize(
    ("splits", "seconds"),
    [
        ({}, (0.5, 0.99)),
        ({"estimation": (0.0, 0.3), "validation": (0.3, 1.0)}, (0.3, 0.99)),
    ],
)
def test_the_first_unseen_seconds_are_filmed(splits, seconds):
    log = replace(fake_discovery.log(), splits=splits)
    long = replace(
        log,
        time=10 * log.time,
        splits={name: (10 * a, 10 * b) for name, (a, b) in splits.items()},
    )  # fmt: skip
    begin, end = filmed_seconds(long)
    assert begin == pytest.approx(10 * seconds[0], abs=0.11)
    assert end <= long.time[-1]
    assert end - begin <= FILMED
    fitted = (long.splits or {"estimation": (0.0, 5.0)})["estimation"]
    assert begin >= fitted[1] - 1e-9


def test_what_is_left_before_the_fitted_part_is_filmed_where_nothing_follows_it():
    log = fake_discovery.log()
    long = replace(log, time=10 * log.time, splits={"estimation": (4.0, 10.1)})
    assert filmed_seconds(long) == (0.0, 4.0)


def test_the_nominal_twin_has_the_values_of_the_fit_without_effects():
    robot = nominal_twin(fake_discovery.found())
    values = robot.parameters.values()
    assert values["b_v"] == pytest.approx(2.4e-4)
    assert values["x"] == pytest.approx(0.003)
    assert not [name for name in values if "." in name]


@pytest.mark.usefixtures("opengl")
def test_both_models_are_filmed_and_the_section_says_when(tmp_path, monkeypatch):
    monkeypatch.setattr("inca_mj.commands.filmed.FPS", 4)
    section = film_discovery(fake_discovery.found(), tmp_path)
    assert section.video.exists()
    assert section.first
    assert "which was fitted" in section.text  # half a second is left, too little for a film
    begin, end = filmed_seconds(fake_discovery.log())
    assert f"{begin:.4g} to {end:.4g}" in section.title
    with Image.open(section.poster) as picture:
        pixels = np.asarray(picture, int)
    left, right = pixels[:, :640], pixels[:, 640:]
    assert np.abs(left - right).max() > 60  # two models, two pictures


@pytest.mark.parametrize(("seconds", "said"), [((0.6, 1.0), "unseen"), ((0.3, 0.8), "fitted")])
def test_the_section_says_whether_a_fit_has_seen_what_is_filmed(
    tmp_path, monkeypatch, seconds, said
):
    """As the first record is fitted whole where others confirm."""
    filmed = []
    monkeypatch.setattr("inca_mj.commands.filmed.film", lambda *given, **_: filmed.append(given[0]))
    monkeypatch.setattr("inca_mj.commands.filmed.filmed_seconds", lambda log: seconds)
    section = film_discovery(fake_discovery.found(), tmp_path)
    (scene,) = filmed
    assert scene.run.time[0] == pytest.approx(seconds[0])
    assert scene.run.time[-1] <= seconds[1]
    assert section.title.startswith(f"The film: {said} seconds")
    assert ("no fit has seen" in section.text) == (said == "unseen")
