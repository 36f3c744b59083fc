"""A law is told from what is only near it, by curves that predict what it leaves, and by shapes."""

from dataclasses import replace

import numpy as np
import pytest
from torque_cases import planar_record, planar_robot

from identification import fit_torques
from identification.torques.candidates import list_missing
from identification.torques.equations.equations import Columns, Equations
from identification.torques.equations.others import Others
from identification.torques.equations.rows import make_rows
from identification.torques.fits import extended, model_fit
from identification.torques.laws import Missing
from identification.torques.neighbours import curves_beside
from identification.torques.scores import rank
from identification.torques.shapes import explained_by, refined

ELBOW, DRAWS = 1, 12
SPEED, POWER = 0.17, 1.4  # of the peak of friction, between values of the grids


def at_elbow(equations, force):
    """Returns a force of positions and rates as a candidate at the elbow."""
    q, v = equations.stacked("q"), equations.stacked("v")
    out = np.zeros((*q.shape, 1))
    out[:, ELBOW, 0] = force(q[:, ELBOW], v[:, ELBOW])
    return Missing(
        name="force", where="joint elbow", phrase="", sizes=("s",), units=("N m",), signs=(0,),
        columns=lambda: Columns(out, (ELBOW,)), most=(np.inf,),
    )  # fmt: skip


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    """Equations of two records of an arm, its candidates, and what makes a fit of drawn torques."""
    records = [planar_record(k, name=f"r{k}") for k in (51, 52)]
    robot = planar_robot(tmp_path_factory.mktemp("arm"), records[0], confirm=[records[1]])
    model = robot.plant.model
    equations = Equations.of(make_rows(model, records), 1)
    still = np.zeros_like(equations.stacked("y"))

    def fitted(equations):
        others = Others.of((), equations, records)
        return model_fit(model, equations, (), others)

    every = list_missing(model, equations, still, robot.candidates, robot.plant.bodies, ())
    first = fitted(equations)
    left = float(np.nanmean(first.fit.σ))

    def drawn(rng, missing, size):
        """The fit where the torques have a missing force, and else noise of the records' size."""
        y = first.predicted() + left * rng.standard_normal(still.shape)
        y = y + size * missing.columns().values[:, :, 0]
        y = y + equations.stacked("y") - first.base.y
        parts = zip(equations.rows, equations.divided(y), strict=True)
        there = replace(equations, rows=tuple(replace(r, y=part) for r, part in parts))
        return there, fitted(there)

    return equations, every, drawn, left


def named(candidates, name):
    return next(c for c in candidates if c.key == (name, "joint elbow"))


def test_curves_predict_nothing_beside_the_right_law_and_much_beside_its_neighbour(bench):
    equations, every, drawn, left = bench
    rng, curves = np.random.default_rng(0), [c for c in every if c.is_curve]
    law = named(every, "hardening")
    stop = at_elbow(equations, lambda q, v: -np.maximum(0.0, np.abs(q) - 0.3) * np.sign(q))
    count = {}
    for truth in (law, stop):
        size = 30 * left / np.abs(truth.columns().values).max()
        judged = []
        for _ in range(DRAWS):
            there, fit = drawn(rng, truth, size)
            judged.append(curves_beside(there, fit.base, law, curves))
        count[truth.name] = sum(b.has_neighbours_name for b in judged)
        if truth is law:  # nodes cost more than they tell
            assert np.mean([b.share for b in judged]) < 0
    assert count["hardening"] == 0
    assert count["force"] == DRAWS


def test_the_shapes_of_a_law_are_fitted_between_the_values_of_the_grids(bench):
    _, every, drawn, left = bench
    truth = named(every, "stribeck_friction").reshaped((SPEED, POWER))
    there, fit = drawn(np.random.default_rng(1), truth, 40 * left)  # far above the noise
    grid = [c for c in every if c.key == truth.key]
    (best,) = rank(there, fit.base, grid)
    explained = explained_by(there, fit.base)
    found = refined(explained, best.missing)
    (_, v_s, _), (_, n, _) = found.shape
    assert v_s == pytest.approx(SPEED, rel=0.1)
    assert n == pytest.approx(POWER, rel=0.15)
    assert explained(found) > explained(best.missing)
    assert explained(found) >= explained(truth)  # as least squares must


def test_a_curve_says_nothing_of_where_the_fitted_record_never_was(bench):
    """Its nodes there are held at zero: free ones predict anything at all."""
    equations, every, drawn, left = bench
    curve = named(every, "curve_position")
    seen = ~equations.confirms[equations.block]
    q = equations.stacked("q")[:, ELBOW]
    far = np.quantile(q[seen], 0.6)
    used = [r.used & (s | (r.q[:, [ELBOW]] < far)) for r, s in
            zip(equations.rows, (False, True), strict=True)]  # fmt: skip
    rows = [replace(r, used=u) for r, u in zip(equations.rows, used, strict=True)]
    short = replace(equations, rows=tuple(rows))
    bump = at_elbow(short, lambda q, v: np.exp(-(((q - far + 0.15) / 0.1) ** 2)))
    there, fit = drawn(np.random.default_rng(2), bump, 3 * left)
    there = replace(there, rows=tuple(replace(r, used=u) for r, u in
                                      zip(there.rows, used, strict=True)))  # fmt: skip
    (held,), (free,) = (rank(there, fit.base, [c]) for c in (curve, replace(curve, ridges=())))
    assert held.fall > free.fall
    assert held.fall > -0.05
    assert extended(there, fit, curve).base.P[-1] > 0
    assert extended(there, fit, replace(curve, ridges=())).base.P[-1] == 0


def test_a_soft_stop_is_drawn_and_a_spring_that_hardens_is_named(tmp_path):
    def stop(q, v):
        return -12.0 * max(0.0, abs(q[1]) - 0.25) * np.sign(q[1])

    def spring(q, v):
        return -12.0 * q[1] ** 3

    for force, name in ((stop, "curve_position"), (spring, "hardening")):
        records = [planar_record(k, name=f"r{k}", force=force) for k in (61, 62)]
        found = fit_torques(planar_robot(tmp_path, records[0], confirm=[records[1]]))
        assert found.named[0].missing.title == f"{name}, joint elbow"
