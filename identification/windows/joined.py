"""Several records of one robot as one log, for a fit over windows within the records."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.errors import InputError
from identification.logs.log import Log
from identification.windows.windows import windows


def joined(logs: Sequence[Log], length: float, name: str = "joined") -> Log:
    """Returns records joined one after the other, each cut to whole windows.

    No window of this length crosses the border between two records. A free run and a discovery know
    nothing of these borders, so that only functions that start again in each window of this length
    (`estimate_windows`, `window_error`) may use the result.

    Args:
        logs: the records; they have the same inputs, outputs and sampling time.
        length: length of a window [s].
        name: name of the result.

    Raises:
        InputError: there is no record, the records differ, or one is shorter than a window, or a
            window has fewer than 3 samples.
    """
    if not logs:
        raise InputError("no records to join; give one at least")
    first = logs[0]
    for log in logs:
        same = (log.input_names, log.output_names, log.hold) == (
            first.input_names, first.output_names, first.hold,
        )  # fmt: skip
        if not same or abs(log.sampling_time - first.sampling_time) > 1e-9 * first.sampling_time:
            raise InputError(
                f"record {log.name!r} differs from {first.name!r} in its columns, hold or sampling"
                " time; join records of one experiment"
            )
    cuts = [windows(log, length) for log in logs]
    u = np.concatenate([cut.inputs.reshape(-1, first.inputs.shape[1]) for cut in cuts])
    y = np.concatenate([cut.outputs.reshape(-1, first.outputs.shape[1]) for cut in cuts])
    time = first.sampling_time * np.arange(len(u), dtype=float)
    # The windows that touch a gap are not among these.
    return replace(
        first, time=time, inputs=u, outputs=y, extras={}, name=name, splits={}, gaps=()
    )  # fmt: skip
