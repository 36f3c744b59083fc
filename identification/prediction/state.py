"""The search by predictions over a horizon: how it begins, and the moves that it is asked.

fit the nominal model  ->  score all candidates  ->  refit the best  ->  predict unseen records
                                   ^_____________________________________________|   again, with it
then drop effects and places; where all effects are in doubt, curves take their place
"""

from __future__ import annotations

from dataclasses import replace

from identification.discovery.attempts import collected
from identification.discovery.moves import Move, Watch
from identification.discovery.outlook import SCORES
from identification.discovery.passes import uses
from identification.errors import InputError
from identification.prediction.fits.nominal_fit import as_begun, fit_alone, predicted
from identification.prediction.judging.trial import compared, find_doubt
from identification.prediction.moves.add_curve import add_curve
from identification.prediction.moves.add_effect import add_effect
from identification.prediction.moves.add_set import add_set
from identification.prediction.moves.add_yielding_friction import add_yielding_friction
from identification.prediction.moves.curve_for_doubtful import curve_for_doubtful
from identification.prediction.moves.drop_doubtful import drop_doubtful
from identification.prediction.moves.drop_effects import drop_effects
from identification.prediction.moves.drop_places import drop_places
from identification.prediction.moves.likeliest_of_set import likeliest_of_set
from identification.prediction.scoring.screening import score_all
from identification.prediction.task import RecordsTask, WindowSearch, finishing
from identification.runtime.progress import Progress, enter
from identification.shares import change
from identification.windows.blocks import count_blocks
from identification.windows.comparison import rise
from identification.windows.dividing import divide_records
from identification.windows.unseen import HORIZON, Unseen, predict

FEWEST_BLOCKS = 3  # of unseen windows, whose scatter is known
MOVES = (
    Move("likeliest_of_set", finishing(likeliest_of_set)),
    Move("add_effect", add_effect, grows=True),
    Move("add_yielding_friction", add_yielding_friction, grows=True),
    Move("add_set", add_set, grows=True),
    Move("add_curve", add_curve, grows=True),
    Move("drop_effects", finishing(drop_effects)),
    Move("drop_places", finishing(drop_places)),
    Move("drop_doubtful", drop_doubtful),
    Move("curve_for_doubtful", curve_for_doubtful),
)  # fmt: skip


def first_state(task: RecordsTask, progress: Progress) -> WindowSearch:
    """Returns the state after the nominal fit, with all candidates scored.

    Args:
        task: what is asked.
        progress: is told a line per step.

    Raises:
        InputError: windows do not fit a record.
        DivergenceError: the nominal model cannot be simulated.
    """
    watch = Watch()
    base = task.nominal_model
    found, scale = fit_alone(base, task.records, progress)
    if uses(task.options, "untouched_part"):
        divided = divide_records(found.problem.plant, task.records, found, task.horizon, scale)
        task = replace(task, records=divided)
    nominal = predicted(found, scale, task.records, task.horizon)
    _refuse_few(nominal.unseen, task.horizon)
    begun = predict(nominal.plant, task.confirm, task.horizon, nominal.scale, {}, nominal.unseen,
                    lengths=HORIZON)  # fmt: skip
    worse: Unseen | None = None
    refuted = find_doubt(compared(nominal.unseen, begun, task.options), 1, task.options)
    if refuted is None:  # over the other lengths too?
        begun = predict(nominal.plant, task.confirm, task.horizon, nominal.scale, {},
                        nominal.unseen)  # fmt: skip
        refuted = find_doubt(compared(nominal.unseen, begun, task.options), 1, task.options)
    if refuted is None and uses(task.options, "values_of_start"):
        worse = nominal.unseen
        progress(
            "the fitted values predict unseen records worse (mean square"
            f" {change(rise(begun.select, worse.select))}) than those with which the fit"
            " began: these are kept"
        )
        nominal = as_begun(base, nominal, begun)
    watch.stop("nominal fit")
    enter(SCORES)
    with collected(progress) as failed:
        scores = score_all(nominal, task.effects, task.options)
    watch.stop("scores")
    if scores:
        progress(f"{len(scores)} candidates scored, {scores[0].candidate.effect.name} first")
    return WindowSearch(
        task=task, moves=(), begun=begun, nominal=nominal, nominal_scores=scores,
        model=nominal, accepted=(), scores=scores, rejected=(),
        seconds=watch.seconds, worse_fit=worse, failed=tuple(failed),
    )  # fmt: skip


def _refuse_few(unseen: Unseen, horizon: float) -> None:
    """Refuse records that confirm and hold too few windows to prove or to deny anything.

    Raises:
        InputError: they do.
    """
    windows = [len(s) for s in unseen.at_horizon]
    if sum(map(count_blocks, windows)) < FEWEST_BLOCKS:
        raise InputError(
            f"what confirms, other records or the second half of each log, holds {sum(windows)}"
            f" windows of {horizon:g} s, too few to prove anything; give at least"
            f" {2 * FEWEST_BLOCKS} windows, by longer records or a shorter horizon"
        )
