"""Products that survive scaling symmetries, in whole numbers."""

from fractions import Fraction

import numpy as np
import pytest

from identification.estimation.scaling_symmetry import ScalingSymmetry, known_products


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


def test_the_value_of_a_product_is_that_of_its_factors():
    (product,) = known_products([symmetry(R_s=1, k_s=-2)], ("R_s", "k_s"))
    assert product.value({"R_s": 0.006, "k_s": 16.0}) == pytest.approx(16.0 * 0.006**2)
    scaled = {"R_s": 0.006 * 1.3, "k_s": 16.0 / 1.3**2}
    assert product.value(scaled) == pytest.approx(16.0 * 0.006**2)
