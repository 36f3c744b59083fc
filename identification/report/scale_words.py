"""What an error of each output counts, where outputs have several units, in a sentence."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from identification.quantities import quantity


def describe_scale(outputs: Mapping[str, str], scale: np.ndarray | None) -> list[str]:
    """Returns a sentence on what a mean square over unlike outputs is; none for outputs alike.

    Args:
        outputs: the unit of each output by name.
        scale: what counts as one of each output, shape (ny,), in its unit: its rms error under the
            nominal model; None where 1 counts alike in each unit.
    """
    units = [*dict.fromkeys(outputs.values())]
    if len(units) == 1:
        return []
    if scale is None:
        return [
            f"The outputs have several units ({', '.join(unit or 'none' for unit in units)}), and a"
            " free run counts an error of 1 in each of them alike, with one noise for all: give the"
            " nominal model a horizon, over which each output counts in its own scale."
        ]
    each = ", ".join(
        f"{quantity(float(s), unit=unit)} of {name}"
        for (name, unit), s in zip(outputs.items(), scale, strict=True)
    )
    return [
        "A mean square over outputs of several units counts the error of each output in multiples"
        f" of its rms error under the fitted nominal model: {each}."
    ]
