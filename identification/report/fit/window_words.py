"""What windows leave, and what they do not tell of the values that were fitted to them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from identification.estimation.identifiability import in_words
from identification.report.fit.untold_words import scale_of_forces
from identification.report.words.errors import error_words, listed, times_words

if TYPE_CHECKING:  # it is slow to import
    from identification.prediction.records_fit import RecordsFit


def left_by_windows(
    count: int, length: float, rms: Mapping[str, float], floor: Mapping[str, float],
    names: str = "",
) -> str:  # fmt: skip
    """Returns a sentence on the error that windows of a length [s] leave, and on the noise."""
    (left,), (noise,) = error_words([rms]), error_words([floor], "")
    ratio = f", {times_words(rms, floor)} times the noise floor of {noise}"
    of = f"of {length:g} s{names and f' of {names}'}"
    each = f"1 window {of} leaves" if count == 1 else f"{count} windows {of} leave"
    return f"{each} {left}{ratio if any(floor.values()) else ''}."


def blind_sentences(fit: RecordsFit) -> list[str]:
    """Returns sentences on directions that the windows tell less of than was known before."""
    names = fit.model.fit.problem.names
    words = [in_words(direction, names) for direction in fit.blind]
    several = [f"({word})" for word in words if "," in word]
    single = [names[int(abs(d).argmax())] for d, word in zip(fit.blind, words, strict=True)
              if "," not in word]  # fmt: skip
    out = []
    if several:
        out.append(
            f"The windows tell less than was known before the fit along {listed(several)}, where"
            " the prior knowledge decides: if it is not sure, hold one parameter of each (held), or"
            " record a motion that tells them apart."
            f"{scale_of_forces([r.log for r in fit.records if r.role == 'fit'])}"
        )
    if single:
        out.append(
            f"The windows tell less about {listed(single)} than was known before the fit, so that"
            " the prior knowledge decides. If it is not sure, record a motion that shows more."
        )
    return out


def few_sentences(fit: RecordsFit) -> list[str]:
    """Returns the sentence on values that are fitted and of which few windows tell."""
    rows = zip(fit.values, fit.is_told_by_few, fit.std, fit.at_bound, strict=True)
    few = [n for n, is_few, std, at_bound in rows if is_few and np.isfinite(std) and not at_bound]
    if not few:
        return []
    count = count_windows(fit)
    values, their, it = ("value", "Its", "it") if len(few) == 1 else ("values", "Their", "they")
    told = "One window tells" if count == 1 else f"Few of the {count} windows tell"
    return [
        f"{told} the {values} of {', '.join(few)}. {their} std is right if the model errs there as"
        f" it does elsewhere. To be sure that {it} {'is' if it == 'it' else 'are'} right, record"
        " longer or give more logs."
    ]


def count_windows(fit: RecordsFit) -> int:
    """Returns how many windows were fitted."""
    return sum(len(part.cut.starts) for part in fit.model.fit.problem.parts)
