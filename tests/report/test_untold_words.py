"""What a log does not tell is said of one parameter and of several, each with its grammar."""

from fractions import Fraction

import numpy as np
import pytest

from identification.estimation.scaling_symmetry import ScalingSymmetry
from identification.report.untold_words import cure, too_weak, untold

NAMES = ("m", "b", "k")
ALONE = ScalingSymmetry({"b": Fraction(1)})
PAIR = ScalingSymmetry({"m": Fraction(1), "k": Fraction(-2)})
WORDS = {"b": "damping b, elbow"}


@pytest.mark.parametrize(
    ("symmetries", "said"),
    [
        ([ALONE], "the data do not tell damping b, elbow"),
        ([PAIR], "m and k trade off along (k -0.89, m +0.45) without any output feeling it"),
        (
            [PAIR, ALONE],
            "the data do not tell damping b, elbow; m and k trade off along (k -0.89, m +0.45)"
            " without any output feeling it",
        ),
        (
            [ALONE, ScalingSymmetry({"k": Fraction(1)})],
            "the data do not tell damping b, elbow and k",
        ),
    ],
)
def test_what_no_output_feels(symmetries: list[ScalingSymmetry], said: str) -> None:
    assert untold(symmetries, NAMES, WORDS) == said
    moved = {name for s in symmetries for name in s.powers}
    assert np.all([WORDS.get(name, name) in said for name in moved])


def test_one_weak_parameter_is_an_it() -> None:
    assert too_weak(["b"], "noise") == (
        "Too weakly for this noise: b, its std exceeds half the value."
    )
    assert cure(["b"]) == "Fix it, or record a motion that tells more of it."
    assert too_weak(["b", "k"], "windows") == (
        "Too weakly for these windows: b, k, their std exceeds half the value."
    )
    assert cure(["b", "k"]).startswith("Fix one of them, or")
