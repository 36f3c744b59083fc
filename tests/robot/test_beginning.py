"""A free run begins where its log does as well as noise lets one know, and no better."""

import mujoco
import numpy as np
import pytest

from identification import confirm, fit, read_robot

pytestmark = pytest.mark.usefixtures("few_effects")

PENDULUM = """<mujoco><option timestep="0.005" integrator="RK4"/><worldbody><body name="rod">
  <joint name="pivot" axis="0 1 0" damping="{damping}"/>
  <inertial pos="0 0 -0.4" mass="0.7" diaginertia="0.01 0.01 0.001"/></body></worldbody>
  <sensor><jointpos name="angle" joint="pivot"/></sensor></mujoco>"""
CART = """<mujoco><option timestep="0.004" integrator="RK4"/><worldbody><body name="cart">
  <joint name="pivot" type="slide" axis="1 0 0" stiffness="45" damping="{damping}"/>
  <geom size="0.1" mass="2.3"/></body></worldbody>
  <sensor><jointpos name="angle" joint="pivot"/></sensor></mujoco>"""
WORLDS = {  # model, true damping, that of the file, noise, sampling time, position, rate
    "pendulum": (PENDULUM, 0.02, 0.05, 2e-3, 0.02, 0.9, 1.5),
    "cart": (CART, 0.35, 0.2, 4e-4, 0.02, 0.12, 0.5),
}
DAMPING = "joint/pivot.damping"


def swing(path, world, seed, made_by=None, samples=700):
    """A swing that is released somewhere, in motion or at rest."""
    xml, damping, _, noise, h, position, rate = WORLDS[world]
    xml = made_by or xml
    model, rng = (
        mujoco.MjModel.from_xml_string(xml.format(damping=damping)),
        np.random.default_rng(seed),
    )
    data = mujoco.MjData(model)
    data.qpos[0] = position * rng.uniform(0.5, 1)
    data.qvel[0] = rate * rng.uniform(-1, 1) * (seed % 2)
    start, y = [float(data.qpos[0]), float(data.qvel[0])], []
    for _ in range(samples):
        y.append(data.qpos[0])
        mujoco.mj_step(model, data, round(h / model.opt.timestep))
    y = np.array(y) + noise * rng.standard_normal(samples)
    np.savetxt(path, np.c_[h * np.arange(samples), y], delimiter=",", header="time,angle",
               comments="")  # fmt: skip
    return start


def fitted(folder, world, seed, said="", **swung):
    start = swing(folder / "log.csv", world, seed, **swung)
    (folder / "robot.xml").write_text(WORLDS[world][0].format(damping=WORLDS[world][2]))
    (folder / "robot.toml").write_text(f'model = "robot.xml"\nfree = ["{DAMPING}"]\n{said}')
    return fit(read_robot(folder / "robot.toml", folder / "log.csv")), start


@pytest.mark.parametrize("world", WORLDS)
def test_of_many_swings_the_damping_is_right_within_its_std_and_nothing_is_missing(tmp_path, world):
    errors, begun = [], []
    for seed in range(24):
        found, start = fitted(tmp_path, world, seed)
        assert list(found.values) == [DAMPING]  # where one log begins is no value of the robot
        errors.append((found.values[DAMPING] - WORLDS[world][1]) / found.std[DAMPING])
        begun.append([found.begun.qpos[0] - start[0], found.begun.qvel[0] - start[1]])
        verdict = found.to_dict()["verdict"]
        assert "is missing" not in " ".join(verdict)
        assert verdict[0].startswith("The model with the fitted values explains the log")
    # Of 24 errors of one std 95 % lie within two, and their rms is 1 within 0.15.
    assert np.mean(np.abs(errors) < 2) > 0.8
    assert 0.6 < np.sqrt(np.mean(np.square(errors))) < 1.5
    # Better than the first sample knows it.
    assert np.sqrt(np.mean(np.square(begun), axis=0))[0] < 0.5 * WORLDS[world][3]


def test_where_the_model_rests_or_the_file_says_where_nothing_of_the_start_is_estimated(tmp_path):
    """The seed 1 begins in motion; these files know where."""
    _, (position, rate) = fitted(tmp_path, "cart", 1)
    given = f'[start]\n"qpos[0]" = {position}\n"qvel[0]" = {rate}\n'
    found, _ = fitted(tmp_path, "cart", 1, given)
    assert found.found.information.asked == len(found.found.information.names)
    np.testing.assert_array_equal([*found.begun.qpos, *found.begun.qvel], [position, rate])
    one, _ = fitted(tmp_path, "cart", 1, f'[start]\n"qvel[0]" = {rate}\n')
    assert one.found.information.names == (DAMPING, "qpos[0]")
    assert one.begun.qvel[0] == rate
    free, _ = fitted(tmp_path, "cart", 1)
    freed = tmp_path / "robot.toml"
    freed.write_text(
        freed.read_text().replace(f'"{DAMPING}"', f'"{DAMPING}", "qpos[0]", "qvel[0]"')
    )
    by_user = fit(read_robot(freed, tmp_path / "log.csv"))
    assert [*by_user.values] == [DAMPING, "qpos[0]", "qvel[0]"]
    # It is the fit of who frees them by hand.
    assert by_user.values[DAMPING] == pytest.approx(
        free.values[DAMPING], abs=0.1 * free.std[DAMPING]
    )
    assert by_user.std[DAMPING] == pytest.approx(free.std[DAMPING], rel=0.05)


def test_it_is_told_predicts_what_was_not_fitted_and_is_no_value_of_the_robot(tmp_path):
    found, _ = fitted(tmp_path, "pendulum", 2)
    told = found.to_dict()
    assert [s for s in told["verdict"] if s.startswith("Where the log begins (qpos[0], qvel[0])")]
    assert [*told["parameters"]] == [DAMPING]
    (unseen,) = confirm(found.robot, found)
    assert unseen.after == pytest.approx(found.found.validation_rms, rel=1e-9)
    found.save(tmp_path / "out")
    assert "qpos" not in (tmp_path / "out" / "robot.toml").read_text()


def test_friction_that_the_model_lacks_is_missing_all_the_same(tmp_path):
    """A start and a damping do not make up for a swing that ends by dry friction."""
    dry = PENDULUM.replace('damping="{damping}"', 'damping="{damping}" frictionloss="0.02"')
    found, _ = fitted(tmp_path, "pendulum", 3, made_by=dry)
    assert found.to_dict()["verdict"][0].startswith("Something is missing from the model")
