"""Numbers of actuators have the names that MJCF gives them, and are found from a log."""

import mujoco
import numpy as np
import pytest
from estimation_plants import record, steps
from plain_logs import noise, stepped

from identification import Parameter, ParameterSet, fit, read_robot
from identification.estimation.estimation import estimate
from identification.model.plant import ModelPlant
from identification.model.rollout import State
from identification.model.tied import value_of
from identification.robot.file.model_file import unit_of

pytestmark = pytest.mark.usefixtures("few_effects")

ARM = """<mujoco><option timestep="0.002" integrator="implicitfast"/>
  <worldbody><body name="arm"><joint name="q" axis="0 1 0" damping="0.2"/>
    <inertial pos="0 0 -0.3" mass="0.8" diaginertia="0.02 0.02 0.001"/></body></worldbody>
  <actuator>{actuator}</actuator>
  <sensor><jointpos name="q" joint="q"/></sensor></mujoco>"""
DRIVES = {  # an actuator of MJCF, what it is driven with, and its numbers
    '<velocity name="a" joint="q" kv="{kv}"/>': (1.0, {"kv": (2.5, 4.0)}),
    '<damper name="a" joint="q" kv="{kv}" ctrlrange="0 9"/>': (1.0, {"kv": (0.5, 0.8)}),
    '<intvelocity name="a" joint="q" kp="{kp}" kv="{kv}" actrange="-9 9"/>': (
        1.0, {"kp": (12.0, 9.0), "kv": (0.7, 0.4)},
    ),
    '<position name="a" joint="q" kp="{kp}" kv="{kv}" timeconst="{timeconst}"/>': (
        0.6, {"kp": (12.0, 9.0), "kv": (0.6, 0.5), "timeconst": (0.05, 0.08)},
    ),
    '<position name="a" joint="q" kp="{kp}" kv="0.6" forcerange="-{forcerange} {forcerange}"/>': (
        0.6, {"kp": (12.0, 9.0), "forcerange": (2.0, 1.6)},
    ),
    '<general name="a" joint="q" dyntype="filter" dynprm="{timeconst}" gainprm="3"/>': (
        0.6, {"timeconst": (0.05, 0.08)},
    ),
    '<general name="a" joint="q" dyntype="filterexact" dynprm="{timeconst}" gainprm="3"/>': (
        0.6, {"timeconst": (0.05, 0.08)},
    ),
    '<dcmotor name="a" joint="q" gear="20" motorconst="{motorconst}" resistance="{resistance}"/>': (
        3.0, {"motorconst": (0.05, 0.06), "resistance": (2.0, 1.7)},
    ),
}  # fmt: skip
EACH = [(xml, size, numbers) for xml, (size, numbers) in DRIVES.items()]
WHICH = [f"{xml.split()[0][1:]}-{'-'.join(numbers)}" for xml, _, numbers in EACH]


def compiled(xml, numbers, which):
    given = {name: pair[which] for name, pair in numbers.items()}
    return mujoco.MjModel.from_xml_string(ARM.format(actuator=xml.format(**given)))


def plant(model, numbers, values=()):
    given = (
        Parameter(name=n, value=dict(values).get(n, value_of(model, f"actuator/a.{n}")), unit="",
                  where=f"actuator/a.{n}", lower=0.0)
        for n in numbers
    )  # fmt: skip
    start = State(np.array([0.8]), np.zeros(1), np.zeros(model.na))
    return ModelPlant(model, ParameterSet("arm", tuple(given)), start)


def truth(numbers):
    return {name: pair[1] for name, pair in numbers.items()}


@pytest.mark.parametrize(("xml", "size", "numbers"), EACH, ids=WHICH)
def test_a_number_makes_the_model_whose_file_says_it(xml, size, numbers):
    drawn, other = (compiled(xml, numbers, which) for which in (0, 1))
    for name, pair in numbers.items():
        assert value_of(drawn, f"actuator/a.{name}") == pair[0]
    made = plant(drawn, numbers, truth(numbers).items()).model
    for field in ("gainprm", "biasprm", "dynprm", "forcerange"):
        made_field, said = (getattr(m, f"actuator_{field}") for m in (made, other))
        assert (made_field == said).all()


@pytest.mark.parametrize(("xml", "size", "numbers"), EACH, ids=WHICH)
def test_the_numbers_are_found_from_a_log(xml, size, numbers):
    u = size * (steps(300, seed=3) + (1.5 if "damper" in xml else 0.0))
    log = record(plant(compiled(xml, numbers, 1), numbers), ("q",), inputs=u)
    found = estimate(plant(compiled(xml, numbers, 0), numbers), log, (*numbers,))
    assert found.values == pytest.approx(truth(numbers), rel=1e-5)


@pytest.mark.parametrize(
    ("actuator", "name", "said"),
    [
        ('<motor name="a" joint="q"/>', "timeconst", "has no filter between command and force"),
        ('<motor name="a" joint="q"/>', "resistance", "is no <dcmotor>"),
        ('<motor name="a" joint="q"/>', "kv", "is no <position> or <velocity> servo, or <damper>"),
        ('<motor name="a" joint="q" forcerange="-1 2"/>', "forcerange", "with ends -f and f"),
    ],
)
def test_a_number_that_an_actuator_lacks_is_told(refusal, actuator, name, said):
    model = mujoco.MjModel.from_xml_string(ARM.format(actuator=actuator))
    assert said in refusal(value_of, model, f"actuator/a.{name}")


def test_a_servo_with_a_filter_and_a_limit_is_fitted_over_a_horizon(tmp_path):
    xml = (
        '<position name="a" joint="q" kp="{kp}" kv="0.6" timeconst="{timeconst}"'
        ' forcerange="-{f} {f}"/>'
    )
    model = mujoco.MjModel.from_xml_string(
        ARM.format(actuator=xml.format(kp=9, timeconst=0.08, f=1.6))
    )
    u = 0.7 * steps(500, seed=1)
    rows = np.hstack([0.01 * np.arange(500)[:, None], u, stepped(model, u) + noise(u.shape, 2e-4)])
    np.savetxt(tmp_path / "log.csv", rows, "%.9g", ",", header="time,a,q", comments="")
    drawn = ARM.format(actuator=xml.format(kp=12, timeconst=0.05, f=2))
    (tmp_path / "arm.xml").write_text(drawn)
    names = ("actuator/a.kp", "actuator/a.timeconst", "actuator/a.forcerange")
    free = str([*names]).replace("'", '"')
    (tmp_path / "robot.toml").write_text(f'model = "arm.xml"\nfree = {free}\nhorizon = 0.3\n')
    found = fit(read_robot(tmp_path / "robot.toml", tmp_path / "log.csv"))
    for name, value in zip(names, (9, 0.08, 1.6), strict=True):
        assert found.values[name] == pytest.approx(value, rel=0.05)
    drawn_model = mujoco.MjModel.from_xml_string(drawn)
    assert [unit_of(drawn_model, name) for name in names] == ["N m/rad", "s", "N m"]
