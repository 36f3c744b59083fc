"""The gains of a servo in a robot's TOML: fitted, alike in several servos, never half of one."""

import pytest
from touching_cases import simulated

from identification import InputError, fit, read_robot, write_log

LINK = """<mujoco><option timestep="0.002" integrator="implicitfast"/>
  <worldbody><body name="upper"><joint name="q1" axis="0 1 0" damping="0.1" armature="0.02"/>
    <inertial pos="0 0 -0.1" mass="0.6" diaginertia="0.004 0.004 0.001"/>
    <body name="lower" pos="0 0 -0.25"><joint name="q2" axis="0 1 0" damping="0.05"/>
      <inertial pos="0 0 -0.1" mass="0.4" diaginertia="0.004 0.004 0.001"/></body></body>
  </worldbody>
  <actuator><position name="s1" joint="q1" kp="{0}" kv="{1}"/>
    <position name="s2" joint="q2" kp="{2}" kv="{1}"/></actuator>
  <sensor><jointpos name="q1" joint="q1"/><jointpos name="q2" joint="q2"/></sensor></mujoco>"""
TRUTH = (9.0, 0.5, 6.0)
FREE = {"actuator/s1.kp": 9.0, "actuator/s1.kv": 0.5, "actuator/s2.kp": 6.0}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("servos")
    write_log(simulated(LINK.format(*TRUTH), samples=400, noise=1e-4), path / "log.csv")
    (path / "link.xml").write_text(LINK.format(14.0, 0.5, 14.0))
    return path


def read(folder, text):
    path = folder / "link.toml"
    path.write_text(f'trust = ["steps"]\nmodel = "link.xml"\n{text}')
    return read_robot(path, folder / "log.csv")


@pytest.mark.parametrize("horizon", ["", "horizon = 0.3\n"])
def test_the_gains_are_found(folder, horizon):
    names = ", ".join(f'"{name}"' for name in FREE)
    found = fit(read(folder, f"{horizon}free = [{names}]\n"))
    for name, value in FREE.items():
        assert found.values[name] == pytest.approx(value, rel=0.01)  # noise of 0.1 mrad


def test_the_gains_of_servos_of_one_make_are_alike(folder):
    table = '[spread.kp]\nof = ["actuator/s1.kp", "actuator/s2.kp"]\nstd = 0.3\n'
    robot = read(folder, f'horizon = 0.3\nfree = ["actuator/s1.kv"]\n{table}')
    values = {"kp": 10.0, "kp@s1": -0.1, "kp@s2": -0.4}
    model = robot.plant.with_values(values).model
    assert model.actuator_gainprm[:, 0] == pytest.approx([9.0, 6.0])
    assert model.actuator_biasprm[:, 1] == pytest.approx([-9.0, -6.0])


def test_half_a_gain_is_told_with_the_file_that_frees_it(folder):
    half = 'free = ["k"]\n[parameters.k]\npath = "actuator/s1.gainprm[0]"\n'
    with pytest.raises(InputError, match=r"free in .*link.toml: k moves gainprm\[0\] of the <posi"):
        read(folder, half)
