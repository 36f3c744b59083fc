"""Where nothing is missing over the horizon, a longer one may show more, and it is said."""

from dataclasses import replace

import numpy as np
import pytest
from gap_cases import named

from identification import discovery_text
from identification.report.discovery.longer_horizon import longer_sentences


def nothing(*ratios):
    """A discovery that misses nothing and errs so many times the noise over windows by length."""
    answer = named()
    model = answer.final
    unseen = replace(model.unseen, parts=(None,) * len(model.unseen.parts))
    powers = tuple(
        tuple(np.tile(ratio**2 * unseen.noise, (len(of), 1)) for of in each)
        for ratio, each in zip(ratios, unseen.powers, strict=True)
    )
    model = replace(model, unseen=replace(unseen, powers=powers))
    return replace(
        answer, verdict="nothing missing", named=(), findings=(), final=model, nominal=model,
        before=answer.after, unexplained=False,
    )  # fmt: skip


@pytest.mark.parametrize(("ratios", "is_told"), [
    ((1.0, 1.0, 1.0), False),
    ((1.0, 1.1, 2.5), True),
    ((1.0, 1.1, 1.4), False),
    ((1.9, 2.0, 2.5), False),  # it is far off over the horizon too, and the verdict says so
])  # fmt: skip
def test_an_error_that_only_longer_windows_show_is_told_with_what_to_do(ratios, is_told):
    found = nothing(*ratios)
    assert found.final.unseen.lengths == (0.5, 1.0, 2.0)
    told = longer_sentences(found)
    assert len(told) == is_told
    if is_told:
        (sentence,) = told
        seconds = f"{2 * found.horizon:g}"
        assert sentence.startswith(f"Over {seconds} s, however, this error is 2.5 times the")
        assert f"horizon = {seconds} in the robot's file" in sentence
        assert sentence in discovery_text(found)
