"""Find where a model and a log disagree, name what is missing, add it, and prove it."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from identification.discovery.moves import Evidence
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.discovery.outlook import Rests
from identification.discovery.result import Discovery
from identification.effects.effect import Effect
from identification.errors import InputError
from identification.innovations.forecast import forecast, refuse_large
from identification.innovations.state import MOVES, InnovationSearch, first_state
from identification.innovations.task import DiscoveryTask
from identification.innovations.verdict import conclude
from identification.logs.joined import records_of, rows_of
from identification.logs.log import Log
from identification.runtime.progress import Progress

RESTS: Rests = {}  # of searches along a free run none is timed yet: no forecast is told


def times_noise(state: InnovationSearch) -> float:
    """Returns the rms error of the free run on unseen samples that decide, over the noise."""
    sigma, rms = state.model.refit.level.sigma, state.model.validation.rms("select")
    return rms / sigma if sigma > 0 else inf


INNOVATIONS = Evidence(first_state, MOVES, conclude, times_noise, RESTS)


def discover(
    nominal_model: NominalModel,
    log: Log,
    effects: Sequence[Effect],
    progress: Progress | None = None,
    options: DiscoveryOptions | None = None,
) -> Discovery:
    """Name what a model lacks to explain a log.

    Args:
        nominal_model: the model with every candidate effect compiled in, its free parameters and
            what is known of them.
        log: its part `estimation` (or first half) is fitted; the rest is unseen and confirms.
        effects: the candidates. Two kinds are left out: those whose size is each record's own,
            which one record cannot tell from what is the same in all, and curves drawn from the
            data, which need several records as proof (see `discover_records`).
        progress: is told a line per step.
        options: what is believed; the defaults of `DiscoveryOptions` when None.

    Raises:
        InputError: the log is too short or too long for this machine's memory, a name is unknown,
            or a free parameter has no effect.
        DivergenceError: the nominal model cannot be simulated.
    """
    options = options or DiscoveryOptions()
    refuse_unfit(log, options)
    shared = tuple(effect for effect in effects if not (effect.own or effect.is_curve))
    task = DiscoveryTask(nominal_model=nominal_model, log=log, effects=shared, options=options)
    needs = forecast(task)
    refuse_large(needs, options.max_memory_share, least=2 * options.min_samples)
    if needs.is_large and progress is not None:
        progress(str(needs))
    return INNOVATIONS.search(task, progress)


def refuse_unfit(log: Log, options: DiscoveryOptions) -> None:
    """Refuse a log that cannot be fitted at its beginning and confirmed on the rest.

    Args:
        log: the log.
        options: the fewest samples of each part.

    Raises:
        InputError: it is too short, or its part `estimation` is not its beginning.
    """
    seen, least = rows_of(log, "estimation"), options.min_samples
    n, rest = int(seen.sum()), int((~seen).sum())
    if min(n, rest) < least:
        raise InputError(
            f"the log has {n} samples to fit and {rest} that are not fitted; discovery needs at"
            f" least {least} of each: record longer, or change the split in the log's TOML"
        )
    for _, record in records_of(log):
        mine = rows_of(record, "estimation")
        if not mine.any() or mine[: int(mine.sum())].all():
            continue
        raise InputError(
            "the log's part 'estimation' does not begin where the log begins; discovery fits the"
            " beginning and confirms on the rest: change the split in the log's TOML"
        )
