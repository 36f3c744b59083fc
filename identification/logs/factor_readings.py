"""A log without the factors that its TOML gives to outputs: are these factors wrong?

A factor turns the numbers of a file into those of the right sign and unit. One that is wrong makes
an output too large or too small, as a wrong unit does; but its cure is to correct the factor, and
not to write a unit beside it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from identification.logs.log import Log
from identification.logs.names import listed
from identification.logs.readings import Reading


def factor_readings(log: Log, bad: np.ndarray, column: Mapping[str, str]) -> Iterator[Reading]:
    """Yields the log without the factor of an unexplained output, and of all such outputs.

    A factor of 1 or -1 changes no size; `output_turns` tells of a wrong sign.

    Args:
        log: as it is read.
        bad: true where an output is not explained, shape (ny,).
        column: what an output is called in the log's file.
    """
    given = {
        k: log.factors[n]
        for k, n in enumerate(log.output_names)
        if bad[k] and abs(log.factors.get(n, 1.0)) != 1.0
    }
    for some in [*([k] for k in given), *([[*given]] if len(given) > 1 else [])]:
        divisors = [given[k] if k in some else 1.0 for k in range(len(log.output_names))]
        named = [column[log.output_names[k]] for k in some]
        factors = listed(f"{given[k]:g} of {n}" for k, n in zip(some, named, strict=True))
        yield Reading(
            replace(log, outputs=log.outputs / divisors), some,
            f"without the factor {factors} that the log's TOML gives",
            f"correct the factor of {listed(named)} under [factors] there", ("units",),
        )  # fmt: skip
