"""Which sensors can be outputs, and what to write where none is found."""

import pytest

from identification import read_robot

ARM = """<mujoco><option timestep="0.005" integrator="RK4"/>
  <worldbody><body name="a"><joint name="q1" axis="0 1 0" damping="0.3"/>
    <inertial pos="0 0 -0.2" mass="1" diaginertia="0.01 0.01 0.01"/>
    <body name="b" pos="0 0 -0.4"><joint name="q2" axis="0 1 0" damping="0.1"/>
      <inertial pos="0 0 -0.1" mass="1" diaginertia="0.01 0.01 0.01"/>
      <site name="tip"/></body></body></worldbody>
  {actuator}<sensor>{sensors}</sensor></mujoco>"""
MOTOR = '<actuator><motor name="u" joint="q1"/></actuator>'
TOML = 'model = "arm.xml"\nfree = ["joint/q1.damping"]\n'


@pytest.fixture
def read(tmp_path, refusal):
    def told(sensors, actuator=MOTOR, more="", header="time,u,q1"):
        (tmp_path / "arm.xml").write_text(ARM.format(sensors=sensors, actuator=actuator))
        (tmp_path / "arm.toml").write_text(more + TOML)
        rows = "".join(f"{0.01 * k},0,{0.1 * k}\n" for k in range(20))
        (tmp_path / "log.csv").write_text(f"{header}\n{rows}")
        said = refusal(read_robot, tmp_path / "arm.toml", tmp_path / "log.csv")
        return said.replace(str(tmp_path), "DIR")

    return told


@pytest.mark.parametrize(
    ("sensors", "said"),
    [
        (
            '<accelerometer name="imu" site="tip"/><framepos name="p" objtype="site" '
            'objname="tip"/>',
            "sensor 'imu' of DIR/arm.xml is an accelerometer, 'p' is a framepos; outputs are joint",
        ),
        (
            '<jointvel name="w1" joint="q1"/><jointvel name="w2" joint="q2"/>',
            "DIR/arm.xml has no jointpos sensor, and DIR/arm.toml names no outputs; write outputs"
            ' = ["w1", "w2"] into DIR/arm.toml',
        ),
        ("", "DIR/arm.xml has no sensor; it needs a jointpos or jointvel sensor for every output"),
    ],
)
def test_a_sensor_of_another_kind_is_told_by_its_kind(read, sensors, said):
    assert said in read(sensors)


TWO = '<jointpos name="q1" joint="q1"/><jointpos name="q2" joint="q2"/>'


def test_a_log_of_some_of_the_joints_is_told_which_key_names_them(read):
    said = read(TWO)
    assert "lacks column q2" in said
    assert said.endswith('; or, where these are not measured, write outputs = ["q1"] into DIR/arm'
                         ".toml")  # fmt: skip
    assert "outputs =" not in read(TWO, header="time,w,q1")  # an input is missing too
    assert "outputs =" not in read(TWO, more='outputs = ["q1", "q2"]\n')
    assert "outputs =" not in read(TWO, header="time,u,q")  # none of them is there
