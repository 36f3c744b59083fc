"""Series begin and end at rest, a search keeps the best, and limits are those of the simulation."""

import mujoco
import numpy as np
import pytest

from identification.experiment.limits import keeps, limits_of, margins
from identification.experiment.search import search
from identification.experiment.series import changed, draw

TIME = np.arange(2001) * 0.005
WALL = """<mujoco><compiler angle="radian"/>
  <option timestep="0.005" gravity="0 0 0"/>
  <worldbody>
    <geom name="wall" type="box" pos="0 0 -0.35" size="1 1 0.1"/>
    <body name="arm"><joint name="hinge" axis="0 1 0" range="-2 3" limited="true"/>
      <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.02" mass="1"/></body></worldbody>
  <actuator><motor name="drive" joint="hinge" ctrlrange="-1 2" ctrllimited="true"
    gear="2" forcerange="-0.5 0.5" forcelimited="true"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/></sensor>
</mujoco>"""


def test_series_begin_and_end_at_rest_and_have_their_own_derivatives():
    series = draw(3, 20, np.random.default_rng(1))
    center, room = np.array([0.1, -1.0, 3.0]), np.array([1.0, 0.2, 0.0])
    x, v, a = series.at(TIME, center, room)
    for ends in (0, -1):
        assert np.allclose(x[ends], center)
        assert np.allclose(v[ends], 0)
        assert np.allclose(a[ends], 0)
    h, inner = TIME[1], slice(2, -2)
    assert np.allclose(np.gradient(x, h, axis=0)[inner], v[inner], atol=2e-3 * np.abs(v).max())
    assert np.allclose(np.gradient(v, h, axis=0)[inner], a[inner], atol=5e-3 * np.abs(a).max())
    assert np.all(x[:, 2] == 3.0)
    half = series.scaled(0.5).at(TIME, center, room)[0]
    assert np.allclose(half - center, 0.5 * (x - center))


def test_a_changed_series_is_near_and_has_whole_tones():
    rng = np.random.default_rng(2)
    series = draw(2, 20, rng)
    for _ in range(50):
        other = changed(series, rng)
        assert np.all(other.waves == np.round(other.waves))
        assert other.waves.min() >= 1
        assert np.abs(other.numbers - series.numbers).max() < 2


def test_a_search_climbs_within_its_budget_and_skips_what_breaks_limits():
    def attempt(x):
        return None if x < 0 else (x, -((x - 3.0) ** 2))

    def tried(seed):
        return [*search(lambda _, rng: rng.normal(0, 4), lambda x, rng: x + rng.normal(0, 0.2),
                        attempt, lambda v: v, 60, np.random.default_rng(seed))]  # fmt: skip

    found = tried(0)
    assert len(found) == 60
    assert min(x for x, _ in found) >= 0
    assert max(v for _, v in found[30:]) >= max(v for _, v in found[:30])
    assert max(v for _, v in found) > -0.01
    assert found == tried(0)
    assert [*search(lambda _, rng: -1.0, lambda x, rng: x, attempt, lambda v: v, 3,
                    np.random.default_rng(0))] == []  # fmt: skip


@pytest.fixture(scope="module")
def wall():
    model = mujoco.MjModel.from_xml_string(WALL)
    return model, limits_of(model, (), [_log()], np.zeros(1))


def _log():
    from identification.logs.log import Log

    t = np.arange(100) * 0.01
    return Log(time=t, inputs=np.sin(t)[:, None], outputs=0.1 * np.sin(t)[:, None],
               input_names=("drive",), output_names=("angle",))  # fmt: skip


def test_ranges_of_the_model_are_the_limits_and_contacts_are_found(wall):
    model, limits = wall
    assert (limits.positions[0].low, limits.positions[0].high) == (-2, 3)
    assert (limits.inputs[0].low, limits.inputs[0].high) == (-1, 2)
    assert (limits.forces[0].low, limits.forces[0].high) == (-0.5, 0.5)
    q = np.linspace(0, 0.5, 11)[:, None]
    u = np.full((11, 1), 0.2)
    found, touch = margins(model, limits, u, q, 0 * q)
    assert touch == ""
    assert keeps(found)
    (force,) = [m for m in found if m.limit.what == "force"]
    assert force.most == pytest.approx(0.2)
    _, touch = margins(model, limits, u, q + 0.7, 0 * q)
    assert touch == "the world and arm"
    cut, _ = margins(model, limits, 4 * u, q, 0 * q)
    assert not keeps(cut)  # the force is cut off at its range


def test_ranges_of_logs_are_widened_where_the_model_has_none():
    text = WALL.replace('range="-2 3" limited="true"', "").replace(
        'ctrlrange="-1 2" ctrllimited="true"', ""
    )
    model, log = mujoco.MjModel.from_xml_string(text), _log()
    limits = limits_of(model, (), [log], np.zeros(1), widen=0.5)
    seen = np.ptp(log.outputs)
    assert limits.positions[0].high - limits.positions[0].low == pytest.approx(2 * seen)
    assert limits.inputs[0].high - limits.inputs[0].low == pytest.approx(2 * np.ptp(log.inputs))
