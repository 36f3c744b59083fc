"""Values that are alike but for their spread, told in a robot's TOML."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from joint_cases import steps
from plain_logs import plain_log
from robot_cases import refused, run

from identification import InputError, ParameterSet, Predictor, read_robot, write_log
from identification.discovery.options import DiscoveryOptions
from identification.innovations.fit import fit_with_effects
from identification.model.plant import ModelPlant
from identification.robot.file.file import read_robot_file

pytestmark = pytest.mark.usefixtures("few_effects")
AXES = ("left", "middle", "right")
DAMPINGS = {"left": 3.0, "middle": 6.0, "right": 1.5}  # [N s/m] as the model has them


def mjcf(dampings):
    """Three axes of 2 kg, each with a damping of its own."""
    return f"""<mujoco><option timestep="0.005" integrator="RK4" gravity="0 0 0"/><worldbody>
{
        "".join(
            f'''<body name="{a}"><joint name="{a}" type="slide" axis="1 0 0" damping="{d}"/>
<inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/></body>'''
            for a, d in dampings.items()
        )
    }
</worldbody><actuator>{"".join(f'<motor name="u_{a}" joint="{a}"/>' for a in AXES)}</actuator>
<sensor>{"".join(f'<jointpos name="{a}" joint="{a}"/>' for a in AXES)}</sensor></mujoco>"""


MODEL = mjcf(DAMPINGS)
NAMES = ("damping", *(f"damping@{a}" for a in AXES))
PATHS = [f"joint/{a}.damping" for a in AXES]
SPREAD = f"\n[spread.damping]\nof = {PATHS}\nstd = 0.2\nknown = 0.5\n".replace("'", '"')
TOML = 'model = "axes.xml"\nfree = ["body/left.mass"]\n'
OFF = dict(zip(AXES, (0.25, -0.2, 0.05), strict=True))  # of 1.2 times the model's
TRUE = {"damping": 3.6, **{f"damping@{a}": off for a, off in OFF.items()}}
NOTHING = np.empty((1, 0))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The axes, their TOML, and logs of axes that differ and of axes that do not."""
    here = tmp_path_factory.mktemp("axes")
    (here / "axes.xml").write_text(MODEL)
    (here / "robot.toml").write_text(TOML + SPREAD)
    u = np.hstack([steps(400, seed=k, hold=25) for k in range(3)])
    still = plain_log(u, np.zeros_like(u), tuple(f"u_{a}" for a in AXES), AXES)
    for name, off in (("differ", OFF), ("alike", dict.fromkeys(AXES, 0.0))):
        dampings = {a: 1.2 * d * (1 + off[a]) for a, d in DAMPINGS.items()}
        model = mujoco.MjModel.from_xml_string(mjcf(dampings))
        y = Predictor(ModelPlant(model, ParameterSet("axes", ())), still, ()).predict(NOTHING)[0]
        noise = 2e-4 * np.random.default_rng(1).standard_normal(y.shape)
        write_log(replace(still, outputs=y + noise), here / f"{name}.csv")
    return here


def robot_of(folder, log="differ", **more):
    return read_robot(folder / "robot.toml", folder / f"{log}.csv", **more)


def test_a_value_is_the_nominal_one_times_the_common_factor_and_its_deviation(folder):
    plant = robot_of(folder).plant
    numbers = plant.settings(NAMES, np.array([[3.6, 0.25, -0.2, 0.05], [3.0, 0.0, 0.0, 0.0]]))[1]
    found = {slot.rows[0]: column for slot, column in numbers if slot.field == "dof_damping"}
    for k, d in enumerate(DAMPINGS.values()):
        expected = [d * 1.2 * (1 + TRUE[NAMES[1 + k]]), d]
        np.testing.assert_allclose(found[k], expected, rtol=1e-14)
    at = plant.with_values(TRUE).model.dof_damping
    np.testing.assert_allclose(at, [column[0] for _, column in sorted(found.items())], rtol=1e-14)


def test_the_columns_of_the_deviations_add_up_to_that_of_the_common_value(folder):
    robot = robot_of(folder)
    h, predictor = 1e-5, Predictor(robot.plant, robot.log, NAMES)
    rows = np.tile([3.6, 0.0, 0.0, 0.0], (9, 1))
    for k, size in enumerate((3.6 * h, h, h, h)):
        rows[1 + 2 * k, k] += size
        rows[2 + 2 * k, k] -= size
    y = predictor.predict(rows)
    columns = (y[1::2] - y[2::2]) / (2 * h)
    np.testing.assert_allclose(columns[1:].sum(axis=0), columns[0], atol=1e-7)


def known(folder, log, std=0.2):
    """The fit by innovations of the nominal model, with a std of the deviations."""
    robot = robot_of(folder, log)
    model = robot.nominal_model
    std = np.array(
        [std if "@" in name else s for name, s in zip(model.names, model.std, strict=True)]
    )
    model = replace(model, std=std)
    return model, fit_with_effects(model, robot.log.part("estimation"), (), {}, DiscoveryOptions())


def test_deviations_come_back_and_their_scatter_is_that_of_the_robot(folder):
    model, found = known(folder, "differ")
    assert model.groups == {"damping": NAMES[1:]}
    values = found.point.values
    for a, d in zip(AXES, DAMPINGS.values(), strict=True):
        true = d / 3.0 * TRUE["damping"] * (1 + TRUE[f"damping@{a}"])
        assert d / 3.0 * values["damping"] * (1 + values[f"damping@{a}"]) == pytest.approx(
            true, rel=0.01
        )
    scatter = found.problem.scatter(model.groups)["damping"]
    assert 0.1 < scatter <= 0.2
    assert known(folder, "alike")[1].problem.scatter(model.groups)["damping"] < 0.02


def test_without_room_to_deviate_they_are_one_factor(folder):
    tight = known(folder, "differ", std=1e-6)[1].point.values
    robot = robot_of(folder, spread="none")
    assert robot.file.free == ("body/left.mass", "damping")
    one = fit_with_effects(
        robot.nominal_model, robot.log.part("estimation"), (), {}, DiscoveryOptions()
    ).point.values
    assert tight["damping"] == pytest.approx(one["damping"], rel=1e-3)
    assert max(abs(tight[name]) for name in NAMES[1:]) < 1e-4


def test_a_fit_of_a_free_run_has_each_place_by_itself_and_is_read_again(folder, tmp_path, capsys):
    out = tmp_path / "out"
    found = run(capsys, "fit", folder / "robot.toml", folder / "differ.csv", "--out", out)
    assert [*found["parameters"]] == ["body/left.mass", *NAMES[1:]]
    again = read_robot(out / "robot.toml", folder / "differ.csv")
    true = [d / 3.0 * 3.6 * (1 + TRUE[f"damping@{a}"]) for a, d in DAMPINGS.items()]
    np.testing.assert_allclose(again.plant.model.dof_damping, true, rtol=0.01)
    assert again.file.spread == read_robot_file(folder / "robot.toml").spread
    assert again.file.by_itself == ("body/left.mass",)


def test_a_spread_of_another_file_takes_the_place_of_its_own(folder, tmp_path):
    other = tmp_path / "spread.toml"
    other.write_text(
        '[spread.friction]\nof = ["joint/left.damping", "joint/right.damping"]\nstd = 0.1\n'
    )
    robot = robot_of(folder, spread=str(other))
    assert robot.file.free[1:] == ("friction", "friction@left", "friction@right")
    with pytest.raises(InputError, match=r"no spread 'wide'; give none, usual, or a TOML file"):
        robot_of(folder, spread="wide")


@pytest.mark.parametrize(("table", "said"), [
    ('of = ["joint/left.damping"]\nstd = 0.1', "names 1 places under `of`; give two or more"),
    ('of = ["body/left.mass", "body/right.mass"]\nstd = 0.1', "keep one of both"),
    ('of = ["qpos[0]", "qpos[1]"]\nstd = 0.1', "give paths to numbers of the model"),
])  # fmt: skip
def test_what_cannot_be_a_spread_is_refused(folder, tmp_path, capsys, table, said):
    (tmp_path / "axes.xml").write_text(MODEL)
    (tmp_path / "robot.toml").write_text(f"{TOML}[spread.some]\n{table}\n")
    assert said in refused(capsys, "fit", tmp_path / "robot.toml", folder / "differ.csv")


def test_places_that_differ_are_no_missing_effect(folder, tmp_path, capsys):
    (tmp_path / "axes.xml").write_text(MODEL)
    (tmp_path / "robot.toml").write_text(
        TOML + SPREAD + '[effects]\nonly = ["quadratic_friction"]\n'
    )
    asked = (tmp_path / "robot.toml", folder / "differ.csv", "--out", tmp_path / "out")
    assert run(capsys, "discover", *asked)["verdict"] == "nothing missing"
    again = read_robot(tmp_path / "out" / "robot.toml", folder / "differ.csv")
    true = [1.2 * d * (1 + OFF[a]) for a, d in DAMPINGS.items()]
    np.testing.assert_allclose(again.plant.model.dof_damping, true, rtol=0.02)
