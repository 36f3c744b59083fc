"""What a log cannot say is said in words; what it can is not called unknown."""

from fractions import Fraction

import mujoco
import numpy as np
import pytest
from estimation_plants import positive, record, slider

from identification import DivergenceError, InputError, Parameter, ParameterSet
from identification.estimation.estimation import Options, estimate
from identification.estimation.fit import assess
from identification.estimation.scaling_symmetry import ScalingSymmetry, known_products
from identification.model.plant import ModelPlant
from identification.report.fit.verdict import fit_verdict

ALL = ("mass", "damping", "stiffness", "gear")
OFF = {"mass": 2.4, "damping": 2.5, "stiffness": 17.0, "gear": 6.0}
LOG = record(slider(x0=0.0), ("position",), noise=1e-3)


def parameters(*records):
    return ParameterSet("p", records)


def test_a_common_factor_of_all_forces_is_named_as_quotients():
    fit = assess(estimate(slider(x0=0.0, **OFF), LOG, ALL))
    assert fit.found.rank == 3
    assert np.isinf(fit.std).all()
    known = {str(c): (value, std) for c, value, std in fit.combinations}
    assert len(known) == 3
    truth = {"mass": 2.0, "damping": 3.0, "stiffness": 20.0, "gear": 5.0}
    for combination, value, std in fit.combinations:
        assert sum(combination.exponents.values()) == 0
        assert sorted(combination.exponents.values()) == [-1, 1]
        assert abs(value - combination.value(truth)) < 4 * std
    said = " ".join(fit_verdict(fit))
    assert "depend on 3 of 4 directions" in said
    assert "trade off along" in said
    assert "can be known from this log" in said


def test_a_parameter_without_effect_is_refused_by_name():
    records = (
        positive("stiffness", 20.0, "N/m", "joint/slide.stiffness"),
        positive("inertia", 1.0, "kg m²", "body/cart.inertia[0]"),
    )
    plant = ModelPlant(slider().model, parameters(*records))
    with pytest.raises(InputError, match="inertia has no effect on position") as caught:
        estimate(plant, LOG, ("stiffness", "inertia"))
    assert "stiffness" not in str(caught.value)


def test_a_parameter_felt_only_as_round_off_is_refused_by_name():
    """The mass of a body that falls freely: it divides itself out but for the last bits."""
    xml = """<mujoco><option integrator="RK4" timestep="0.005"/><worldbody><body name="ball">
      <joint name="fall" type="slide" axis="0 0 1"/><inertial pos="0 0 0" mass="1.3"
      diaginertia="1 1 1"/></body></worldbody>
      <actuator><motor name="none" joint="fall" gear="0"/></actuator>
      <sensor><jointpos name="height" joint="fall"/></sensor></mujoco>"""
    model = mujoco.MjModel.from_xml_string(xml)
    plant = ModelPlant(model, parameters(positive("mass", 1.3, "kg", "body/ball.mass")))
    with pytest.raises(InputError, match="mass has no effect"):
        estimate(plant, record(plant, ("height",), noise=1e-3), ("mass",))


def test_a_value_at_its_bound_is_reported():
    record_ = Parameter(
        name="stiffness", value=12.0, unit="N/m", where="joint/slide.stiffness", lower=0, upper=15
    )
    plant = ModelPlant(slider(x0=0.0).model, parameters(record_))
    for method in ("trf", "dogbox"):
        fit = assess(estimate(plant, LOG, ("stiffness",), options=Options(method=method)))
        assert fit.at_bound.all(), method
        assert "At a bound: stiffness" in " ".join(fit_verdict(fit))


def test_a_start_on_or_beyond_a_bound_is_refused():
    with pytest.raises(InputError, match=r"damping .* must lie inside \(0, inf\)"):
        estimate(slider(), LOG, ("damping",), {"damping": 0.0})


def test_a_start_that_diverges_is_said_in_a_sentence():
    with pytest.raises(DivergenceError, match=r"diverged at t = .* nearer to the nominal"):
        estimate(slider(), LOG, ("stiffness",), {"stiffness": 1e9})


def test_a_prior_pulls_and_says_how_much_is_its_own():
    """An unknown common factor is settled by a prior on one of its parameters."""
    options = Options(priors={"gear": 0.01})
    start = {**OFF, "gear": 5.0}
    fit = assess(estimate(slider(x0=0.0, **start), LOG, ALL, options=options))
    assert fit.estimate.values["gear"] == pytest.approx(5.0, rel=1e-3)
    assert fit.estimate.values["mass"] == pytest.approx(2.0, rel=0.03)
    assert fit.std[3] == pytest.approx(0.05, rel=0.05)
    assert np.isfinite(fit.std).all()


def test_a_strong_prior_holds_and_a_weak_one_lets_go():
    strong, weak = (
        estimate(
            slider(x0=0.0, stiffness=16.0), LOG, ("stiffness",),
            options=Options(priors={"stiffness": s}),
        ).values["stiffness"]
        for s in (1e-6, 10.0)
    )  # fmt: skip
    assert strong == pytest.approx(16.0, rel=1e-4)
    assert weak == pytest.approx(20.0, rel=1e-2)


def symmetry(**powers):
    return ScalingSymmetry({name: Fraction(power) for name, power in powers.items()})


@pytest.mark.parametrize(
    ("symmetries", "products"),
    [
        ([symmetry(R_s=1, k_s=-2)], ["k_s R_s^2"]),
        ([symmetry(k_s=Fraction(1), R_s=Fraction(-1, 2))], ["k_s R_s^2"]),
        ([symmetry(a=1, b=1, c=1)], ["a c^-1", "b c^-1"]),
        ([symmetry(a=1, b=-1), symmetry(b=1, c=-1)], ["a b c"]),
        ([symmetry(a=1, b=-1), symmetry(c=1, R_s=1)], ["a b", "R_s c^-1"]),
        ([symmetry(a=1)], []),
        ([], []),
    ],
)
def test_the_products_are_those_that_a_person_would_write(symmetries, products):
    names = ("a", "b", "R_s", "k_s", "c")
    assert sorted(map(str, known_products(symmetries, names))) == sorted(products)


def test_no_symmetry_changes_a_product_and_together_they_span_the_space():
    rng = np.random.default_rng(0)
    names = tuple("abcdef")
    for _ in range(30):
        rows = [rng.integers(-2, 3, 6) for _ in range(int(rng.integers(1, 4)))]
        symmetries = [
            ScalingSymmetry({n: Fraction(int(v)) for n, v in zip(names, row, strict=True) if v})
            for row in rows
        ]
        products = known_products(symmetries, names)
        V = np.array(rows, float)
        W = np.array([p.row(names) for p in products]).reshape(-1, 6)
        np.testing.assert_allclose(V @ W.T, 0, atol=1e-12)
        moved = (V != 0).any(axis=0).sum()
        assert np.linalg.matrix_rank(W) == len(products) == moved - np.linalg.matrix_rank(V)
