"""What the step of a simulation does to an estimate is what a search with a finer step finds."""

import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from identification import Log, fit
from identification.model.protocol import FINER
from identification.prediction.fits.std import step_shift, told_std
from identification.robot.file.file import read_robot_file
from identification.robot.robot import robot_of

EXAMPLE = Path(__file__).parents[2] / "examples" / "elbow"
FRICTION = "coulomb_friction.f_c@elbow"


def recorded(elbow, seed):
    """The first half of a record of the example."""
    time, current, angle = np.array_split(elbow["record"](seed), 2)[0].T
    names = {"input_names": ("current",), "output_names": ("angle",), "name": f"log {seed}"}
    return Log(time=time, inputs=current[:, None], outputs=angle[:, None], **names)


@pytest.fixture(scope="module")
def elbow(tmp_path_factory):
    """The elbow with dry friction, fitted with its own step and with a quarter of it."""
    source = runpy.run_path(str(EXAMPLE / "record.py"))
    logs = [recorded(source, seed) for seed in (21, 121)]
    folder = tmp_path_factory.mktemp("elbow")
    toml = (EXAMPLE / "elbow.toml").read_text()
    toml = toml.replace('"damping"]', f'"damping", "{FRICTION}"]')
    (folder / "elbow.toml").write_text(
        toml + f'\n[parameters."{FRICTION}"]\nunit = "N m"\nvalue = 0.1\nknown = 1.0\n'
    )
    model, fits = (EXAMPLE / "elbow.xml").read_text(), []
    for step in (0.005, 0.005 / FINER):
        text = model.replace('timestep="0.005"', f'timestep="{step}"')
        (folder / "elbow.xml").write_text(text)
        robot = robot_of(read_robot_file(folder / "elbow.toml"), logs[0], (), (logs[1],))
        fits.append(fit(robot).found)
    return fits


@pytest.mark.long
def test_it_is_the_change_of_a_search_with_a_finer_step(elbow):
    coarse, fine = (found.model for found in elbow)
    shift, std = coarse.step_shift, dict(zip(coarse.fit.values, told_std(coarse.fit), strict=True))
    real = {n: fine.fit.values[n] - v for n, v in coarse.fit.values.items()}
    moved = {n: real[n] / std[n] for n in real}
    assert max(map(abs, moved.values())) > 3  # the std by blocks know nothing of it
    for name in real:
        assert shift[name] / std[name] == pytest.approx(moved[name], abs=0.6)
    # From the values of the finer step there is little left to move.
    assert all(abs(real[n]) < 1.5 * coarse.told_std[n] for n in real)
    left = {n: s / std[n] for n, s in fine.step_shift.items()}
    assert max(map(abs, left.values())) < 0.5 * max(map(abs, moved.values()))


def test_the_error_that_finer_steps_leave_is_that_of_a_search_with_them(elbow):
    coarse, fine = (found.model for found in elbow)
    real = np.sqrt(np.mean(fine.fit.errors[0] ** 2) / np.mean(coarse.fit.errors[0] ** 2))
    assert real < 0.99
    assert coarse.finer.error == pytest.approx(real, abs=0.02)


def test_a_finer_step_moves_nothing_where_all_is_smooth(elbow):
    """RK4 errs by so little there that no std feels it."""
    coarse = elbow[0].model.fit
    problem, names = coarse.problem, coarse.problem.names
    at = problem.prior.space.decode(coarse.q)
    at[names.index(FRICTION)] = 1e-12
    q = problem.prior.space.encode(at)
    smooth = replace(coarse, q=q, tangents=problem.tangents(q, coarse.moves))
    shift = step_shift(smooth).values[[names.index(n) for n in ("mass", "damping")]]
    std = coarse.std[[names.index(n) for n in ("mass", "damping")]]
    assert np.all(np.abs(shift) < 0.01 * std)
