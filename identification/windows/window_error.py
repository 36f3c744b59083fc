"""The error with which a model with given values predicts a log over a horizon, from any time.

r_w = y_w - ŷ_w(θ, x̄_w ⊕ d_w),   d_w the state at the start of window w that explains it best

The free run of a robot that integrates its input drifts with every disturbance; over a short window
the error is mainly that of the model. No parameter of the model is fitted here, but initial states
only, so that two models can be compared fairly on unseen data.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from identification.errors import InputError
from identification.logs.log import Log
from identification.model.coordinates import NOTHING
from identification.model.predictor import Plant, Predictor
from identification.windows.held import held_records
from identification.windows.settling import settle
from identification.windows.shooting import Shooting
from identification.windows.windows import (
    Windows,
    first_states,
    noise_whitener,
    some,
    spread,
    windows,
)


def window_error(
    plant: Plant, log: Log, length: float, values: Mapping[str, float] | None = None
) -> np.ndarray:
    """Returns the errors of the outputs in windows of a log, each from its best initial state.

    Args:
        plant: the model.
        log: what was measured.
        length: of a window [s].
        values: parameters that are not the plant's own.

    Returns:
        Shape (W, L, ny), in the outputs' unit.

    Raises:
        InputError: the windows do not fit the log, or a name is unknown.
        DivergenceError: the model cannot be simulated.
    """
    shooting, d = _fixed(plant, log, windows(log, length), values)
    settled = settle(held_records([shooting]), [d], is_thorough=True)  # where a joint sticks
    return shooting.error(settled[0].r)


def first_error(
    plant: Plant, log: Log, length: float, most: int, part: float = 1.0,
    values: Mapping[str, float] | None = None,
) -> np.ndarray:  # fmt: skip
    """Returns errors (W, L, ny) of windows, each from the mean of the prior of its initial state.

    Args:
        plant: the model, with its own values.
        log: what was measured.
        length: of a window [s].
        most: windows, spread over the log.
        part: of these, that is simulated: some of the windows, or the beginning of the only one.
        values: parameters that are not the plant's own.

    Raises:
        InputError: the windows do not fit the log, or a name is unknown.
        DivergenceError: the model cannot be simulated.
    """
    cut = some(spread(windows(log, length), most), part)
    shooting, d = _fixed(plant, log, cut, values)
    return shooting.error(shooting.residual(np.zeros(0), d))


def _fixed(
    plant: Plant, log: Log, cut: Windows, values: Mapping[str, float] | None
) -> tuple[Shooting, np.ndarray]:
    """Returns a model's windows without free parameters, and zero changes of states (W, nx)."""
    none = np.zeros(0)
    predictor = Predictor(plant, log, (), dict(values or {}))
    believed = first_states(predictor, none, cut)
    shooting = Shooting(predictor, NOTHING, cut, believed, noise_whitener(log))
    return shooting, np.zeros((len(cut.starts), 2 * plant.model.nv + plant.model.na))


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
