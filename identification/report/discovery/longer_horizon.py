"""A sentence where nothing is missing over the horizon, and much over a longer one.

What acts slowly or seldom, as a catch at one place, moves little within the horizon of a search. Of
a right model the error stays at the sensors' noise over any time.
"""

from __future__ import annotations

import numpy as np

from identification.discovery.result import Discovery
from identification.prediction.fits.model import WindowModel
from identification.quantities import held
from identification.report.discovery.nothing_words import NOISIER


def longer_sentences(found: Discovery) -> list[str]:
    """Returns the sentence on the longest windows; none where they err by the noise.

    Args:
        found: in which nothing is missing.
    """
    model = found.final
    if not isinstance(model, WindowModel) or not found.horizon:
        return []
    unseen = model.unseen.report
    ratios = {
        length: float(np.sqrt(np.concatenate(squares).mean() / unseen.floor))
        for length, squares in zip(unseen.lengths, unseen.squares, strict=True)
        if unseen.floor > 0
    }
    longest = max(ratios, default=1.0)
    if longest <= 1.0 or not ratios[longest] > NOISIER > ratios[1.0]:
        return []
    seconds = longest * found.horizon
    return [
        f"Over {seconds:g} s, however, this error is {held(ratios[longest])} times the sensors'"
        " noise. Either inputs err, or something is missing that acts slowly or seldom. Search"
        f" again with horizon = {seconds:g} in the robot's file."
    ]
