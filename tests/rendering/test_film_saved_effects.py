"""A saved run of a twin with a force on it is filmed like any other."""

from inca_mj.rendering.film import stills
from inca_mj.rendering.scene import make_scene
from inca_mj.robot.inputs import make_input
from inca_mj.twin.run import save_run, simulate
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.pulled import with_force


def test_a_reloaded_run_with_an_effect_gives_a_picture(opengl, tmp_path):
    run = simulate(with_force(build_twin(), (0, 0, 1.0)), make_input("zero", 0.1))
    scene = make_scene(save_run(run, tmp_path / "run.npz"))
    assert [e.name for e in scene.run.twin.effects] == ["pull"]
    (picture,) = stills(scene, tmp_path, (0.1,), plots=False)
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert picture.stat().st_size > 10_000
