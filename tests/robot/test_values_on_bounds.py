"""A value that a search ends with on its bound: it lies in its range, and is told with the cause.

The true arm has five times the inertia of the drawing. The two other inertias of a link that turns
in a plane are felt by nothing, and may not keep a fit from that.
"""

import json
import re

import mujoco
import numpy as np
import pytest
from page_text import text_of
from records_cases import MJCF, pendulum, record

from identification import fit, read_robot, write_log
from identification.effects.moving_bodies import Felt
from identification.model.coordinates import coordinates
from identification.model.parameter import Parameter, ParameterSet
from identification.robot.results.fit_files import robot_fit_to_json
from identification.robot.results.write import write_robot

pytestmark = pytest.mark.usefixtures("few_effects")

DRAWN, MORE = 1e-3, 4e-3  # inertia about the centre in the drawing, and what the true arm has more
INERTIA = "body/arm.inertia[1]"
FREE = f'free = ["{INERTIA}", "joint/hinge.damping"]\n[parameters."{INERTIA}"]\nknown = 3.0\n'
ONLY = '[effects]\nonly = ["quadratic_friction"]\n'
# The same arm on a base that turns about the vertical: all three inertias are felt.
ON_BASE = MJCF.replace(
    '<body name="arm">',
    '<body name="base"><joint name="turn" axis="0 0 1"/>'
    '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><body name="arm">',
).replace("</body></worldbody>", "</body></body></worldbody>")
CAUSE = (
    f"At a bound: {INERTIA}; the other two inertias of arm allow 1e-06 to 0.001999 kg m^2: change"
    " these in the model, or free body/arm.spread[0] to [2] in its place."
)


def folder(path, model, text, samples=300):
    (path / "arm.xml").write_text(model.replace("1e-3 1e-3 1e-3", "1e-3 1e-3 0.999e-3"))
    (path / "robot.toml").write_text(f'model = "arm.xml"\noutputs = ["angle"]\n{text}')
    for k in (1, 2):
        write_log(record(k, samples, {"J": MORE}, plant=pendulum()), path / f"{k}.csv")
    return path / "robot.toml"


def over_windows(path, model=MJCF):
    robot = folder(path, model, f"horizon = 0.2\n{FREE}{ONLY}")
    return read_robot(robot, path / "1.csv", [path / "2.csv"])


@pytest.mark.parametrize("scale", [1.0, 1e-3, 7e4])
def test_what_lies_on_a_bound_of_a_search_lies_in_the_range_of_the_values(scale):
    rng = np.random.default_rng(4)
    for _ in range(300):
        low, value, high = np.sort(scale * rng.lognormal(0, 2, 3))
        signs = (1.0, -1.0) if rng.random() < 0.5 else (1.0, 1.0)
        low = min(low * signs[1], value)
        p = Parameter(name="a", value=value, unit="", where="", lower=low, upper=high, scale=scale)
        space = coordinates(ParameterSet("one", (p,)), ["a"], np.array([value]))
        for bound, q in ((low, space.lower), (high, space.upper)):
            reached = float(space.decode(q)[0])
            assert low <= reached <= high
            assert reached == pytest.approx(bound, rel=1e-12)
            assert space.on_bound(q).all()


def test_an_inertia_that_alone_is_felt_is_bound_by_none_that_nothing_feels(tmp_path):
    robot = over_windows(tmp_path)
    (said,) = robot.remarks
    assert said.startswith(f"Of body/arm the motion feels the inertia {INERTIA} alone;")
    found = fit(robot)
    std = found.std[INERTIA]
    assert found.values[INERTIA] == pytest.approx(DRAWN + MORE, abs=4 * std)
    assert std < 0.05 * MORE
    inertia = np.sort(robot.plant.with_values(found.shared).model.body("arm").inertia)
    assert inertia[2] <= inertia[0] + inertia[1]
    assert inertia[2] / inertia[0] == pytest.approx(1 / 0.999)
    assert not any("No body has" in s for s in robot_fit_to_json(found)["verdict"])


def test_the_inertias_that_a_motion_feels_are_those_about_axes_that_it_turns():
    plane, space = map(mujoco.MjModel.from_xml_string, (MJCF, ON_BASE))
    np.testing.assert_array_equal(Felt(plane).inertias(1), [False, True, False])
    np.testing.assert_array_equal(Felt(space).inertias(2), [True, True, True])
    np.testing.assert_array_equal(Felt(space).inertias(1), [False, False, True])


@pytest.mark.parametrize("is_windowed", [True, False])
def test_a_fit_that_ends_on_a_bound_is_told_why_and_can_be_read_again(tmp_path, is_windowed):
    horizon = "horizon = 0.2\n" if is_windowed else ""
    path = folder(tmp_path, ON_BASE, f"{horizon}{FREE}")
    robot = read_robot(path, tmp_path / "1.csv", [tmp_path / "2.csv"] if is_windowed else [])
    found = fit(robot)
    assert found.at_bound[INERTIA]
    assert np.isnan(found.std[INERTIA])
    record_ = json.loads(json.dumps(robot_fit_to_json(found)))
    assert record_["parameters"][INERTIA]["std"] is None
    assert CAUSE in record_["verdict"]
    assert not any("std of" in s and INERTIA in s for s in record_["verdict"])
    page = text_of(found.report(tmp_path / "report.html").read_text()).replace("<wbr />", "")
    assert re.search(rf">{re.escape(INERTIA)}</td>.*\n.*\n.*>[^<±]*, on its bound</td>", page)
    assert found.values[INERTIA] <= 2 * DRAWN
    robot.plant.with_values(found.shared)  # its result is in the range
    again = write_robot(robot, found.shared, tmp_path / "again.toml", tmp_path)
    assert read_robot(again, tmp_path / "1.csv").plant.parameters[INERTIA].value == pytest.approx(
        2 * DRAWN, rel=1e-3
    )
