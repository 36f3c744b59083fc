"""Find what a model lacks to explain several records of a robot, and prove it on unseen ones."""

from __future__ import annotations

from collections.abc import Sequence

from identification.discovery.moves import Evidence
from identification.discovery.nominal_model import NominalModel, without_starts
from identification.discovery.options import DiscoveryOptions
from identification.discovery.outlook import CHECKS, EFFECT, LEFT, SCORES, Rests
from identification.discovery.result import Discovery
from identification.effects.effect import Candidate, Effect
from identification.errors import InputError
from identification.logs.log import Log
from identification.prediction.records_fit import NO_HORIZON
from identification.prediction.state import MOVES, first_state
from identification.prediction.task import RecordsTask, WindowSearch
from identification.prediction.verdict.remaining import noise_ratio
from identification.prediction.verdict.verdict import conclude
from identification.runtime.progress import Progress
from identification.windows.records import as_records

# Time left over time passed when a stage begins, by the number of effects that the model has then.
# One timed search gave these ranges, and they were widened by hand: they are guesses.
# `python benchmarks/forecast.py --worlds` times more searches, `--rests` prints their ranges.
RESTS: Rests = {
    (SCORES, 0): (4.0, 50.0),
    (EFFECT, 0): (2.0, 20.0),
    (EFFECT, 1): (0.7, 5.0),
    (EFFECT, 2): (0.5, 2.0),
    (CHECKS, 0): (0.0, 0.8),
    (LEFT, 0): (0.0, 0.4),
}


def times_noise(state: WindowSearch) -> float:
    """Returns the rms error over unseen windows of the horizon that decide, over the noise."""
    return noise_ratio(state, state.model.unseen.select)


WINDOWS = Evidence(first_state, MOVES, conclude, times_noise, RESTS)


def discover_records(
    nominal_model: NominalModel,
    fit: Sequence[Log],
    confirm: Sequence[Log],
    effects: Sequence[Effect],
    progress: Progress | None = None,
    options: DiscoveryOptions | None = None,
    suggested: Sequence[Candidate] = (),
) -> Discovery:
    """Name what a model lacks to explain records, judged by predictions over its horizon.

    Args:
        nominal_model: the model with every candidate effect compiled in, its free parameters, what
            is known of them, and the horizon of predictions.
        fit: logs to fit.
        confirm: logs that no fit may see; where there is none, the first half of each log is fitted
            and the second half confirms.
        effects: the candidates.
        progress: is told a line per step.
        options: what is believed; the defaults of `DiscoveryOptions` when None.
        suggested: what another evidence has found missing: it is refitted whatever its score over
            windows is.

    Raises:
        InputError: there is no horizon, windows do not fit a log, or a name is unknown.
        DivergenceError: the nominal model cannot be simulated.
    """
    if nominal_model.horizon is None:
        raise InputError(NO_HORIZON)
    records = as_records(fit, confirm)
    task = RecordsTask(
        nominal_model=without_starts(nominal_model), records=records, effects=tuple(effects),
        options=options or DiscoveryOptions(), suggested=tuple(suggested),
    )  # fmt: skip
    return WINDOWS.search(task, progress)
