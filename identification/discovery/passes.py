"""The passes of a search beside its fits and scores: what each does, and whether it is left out.

Each of them answers a way in which a plain forward selection went wrong. None is needed to search:
`DiscoveryOptions.without` leaves out any of them, so that a benchmark can measure on many worlds
what it changes.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from types import MappingProxyType
from typing import Protocol

from identification.errors import InputError, unknown_name

# Which search makes a pass.
RUN, HORIZON, BOTH, TORQUES, ALL = "free run", "horizon", "both", "torques", "all"
# By the name that leaves it out: which search makes it, and what it does.
PASSES: Mapping[str, tuple[str, str]] = MappingProxyType({
    "untouched_part": (
        BOTH, "keeps blocks of what no fit sees from the search too, and tells errors of these",
    ),
    "add_pair": (
        RUN, "adds two effects of which none is proven alone, because each hides the other",
    ),
    "suggested_effects": (
        HORIZON, "refits effects that the joints' torques have named, whatever their scores are",
    ),
    "add_yielding_friction": (
        HORIZON, "fits a friction that gives before it slips from its largest compliance",
    ),
    "add_set": (HORIZON, "adds several effects that are proven together and not alone"),
    "add_curve": (HORIZON, "adds a curve of the data where neither a law nor a set is proven"),
    "plain_sets": (
        HORIZON, "leaves laws with states of joints, on which a linear choice errs, out of sets",
    ),
    "add_deviants": (RUN, "makes effects of parts that deviate by more than parts do"),
    "shape_bounds": (HORIZON, "names no law whose shape ends on the bound of its range"),
    "impossible_sizes": (ALL, "names no effect of a size that physics forbids"),
    "drop_effects": (BOTH, "drops an effect that later ones have made needless"),
    "exchange_effects": (
        RUN, "puts a rival in the place of an effect, where the model with it is better",
    ),
    "other_kinds": (
        RUN, "exchanges the kind of an accepted effect once another effect is beside it",
    ),
    "kinds_of_rivals": (
        RUN, "fits each rival in its likeliest kind, so that none loses by its kind",
    ),
    "other_shapes": (RUN, "fits the next likely and the usual shape of the best effect"),
    "finer_shapes": (RUN, "scores likely effects at more values of their shapes, as a refit asks"),
    "jumps_at_outliers": (RUN, "scores jumps of a sensor where the outputs jump"),
    "begin_anew": (RUN, "refits from the nominal values where a parameter ended at a limit"),
    "hidden_effects": (RUN, "refits effects beyond no level where the noise model may hide them"),
    "limits_of_much_left": (
        HORIZON, "fits limits of motors and inputs, whatever their scores are, where much is left",
    ),
    "weak_scores": (
        HORIZON, "refits effects whose scores may be luck, because unseen records decide",
    ),
    "scores_of_much_left": (
        HORIZON, "refits effects by their own chance, not that of all, where much is left",
    ),
    "proof_by_both_roles": (
        HORIZON, "proves the likeliest law by blocks of fitted records too, as fits of the others"
        " predict them",
    ),
    "free_states": (
        HORIZON, "takes no law with states of its joints where a smooth force there gains as much",
    ),
    "smooth_rivals": (
        HORIZON, "takes no law of a sensor, a body or all inputs where a smooth force of one joint"
        " does as much",
    ),
    "large_scores": (
        HORIZON, "refits effects whose scores ask for too large a size: the refit judges the size",
    ),
    "exchange_roles": (
        HORIZON, "asks whether an effect holds where fitted and unseen records change places",
    ),
    "numbers_of_roles": (
        HORIZON, "lets records contradict an effect only where its numbers differ between roles",
    ),
    "losing_blocks": (
        HORIZON, "lets a record contradict an effect only where its blocks lose on average too",
    ),
    "loud_windows": (
        HORIZON, "takes the windows that err most where effects are fitted to some windows first",
    ),
    "simpler_laws": (HORIZON, "fits laws with fewer numbers that act as the best one does"),
    "several_places": (
        HORIZON, "scores an effect with a size of its own at each of several places",
    ),
    "imitated_effects": (
        HORIZON, "leaves out a candidate that the free parameters of the model imitate",
    ),
    "states_of_others": (
        HORIZON, "lets windows begin where another model begins them with less error",
    ),
    "exact_set_points": (
        HORIZON, "takes set points of servos as exact where errors of inputs excuse what is left",
    ),
    "signed_ranks": (
        HORIZON, "proves by the ranks of the gains of blocks too, and not by their mean alone",
    ),
    "gains_of_outputs": (
        HORIZON, "weighs laws by what each output gains, and not by the mean over all outputs",
    ),
    "independent_readings": (
        HORIZON, "counts readings whose errors are independent for the evidence, and not windows",
    ),
    "falls_within_noise": (
        HORIZON, "names no law that takes less than a tenth of an error that is the sensors'",
    ),
    "strata_of_records": (
        HORIZON, "tests the mean gain by how blocks scatter within each record, and not by how"
        " records differ",
    ),
    "own_weights": (
        HORIZON, "weighs outputs and priors by the errors of the model with what was found so far",
    ),
    "values_of_start": (
        HORIZON, "begins at the given values where fitted ones predict unseen records worse",
    ),
    "record_differences": (
        HORIZON, "tells zeros of sensors and constant forces that differ between records",
    ),
    "finer_steps": (
        HORIZON, "goes on with finer steps where those of the simulation may make an effect",
    ),
    "drop_places": (
        HORIZON, "drops places at which an effect that has several does nothing after all",
    ),
    "neighbours_names": (
        HORIZON, "names no law beside which a curve of the data still explains much",
    ),
    "smooth_neighbours": (
        HORIZON, "names no law beside which a smooth force of two variables explains much",
    ),
    "further_laws": (
        HORIZON, "names no law beside a surer one that explains less than 92 % of what smooth"
        " forces of its joint could, and no curve that explains less than half of it",
    ),
    "scatter_of_noise": (
        HORIZON, "tells an error above the noise only beyond what the noise's estimate may miss",
    ),
    "closed_gap": (HORIZON, "names no law that closes less than half of the gap"),
    "priors_of_last_fit": (
        HORIZON, "weighs outputs and priors of the last fit by its own errors, which are smaller",
    ),
    "drop_doubtful": (
        HORIZON, "keeps effects that are sure where others are in doubt, and tells what is left",
    ),
    "curve_for_doubtful": (
        HORIZON, "puts curves of the data in the place of effects that are all in doubt",
    ),
    "likeliest_of_set": (
        HORIZON, "asks an effect that is not the likeliest again beside what was found later, and"
        " puts the likeliest into the model",
    ),
    "fitted_shapes": (
        TORQUES, "fits the shapes of the best laws, of which the grids try only a few values",
    ),
    "held_nodes": (
        TORQUES, "holds nodes of curves at zero where the fitted motion hardly is",
    ),
    "blocks_of_all_records": (
        TORQUES, "proves by blocks of all records what those that confirm make likely",
    ),
    "neighbours_of_torques": (
        TORQUES, "names no law of a joint beside which curves of its variables still predict",
    ),
})  # fmt: skip


class Without(Protocol):
    """Options that leave out passes."""

    @property
    def without(self) -> Collection[str]:
        """Names of the passes that are left out."""


def uses(options: Without, name: str) -> bool:
    """Returns whether a search with these options makes a pass.

    Args:
        options: of the search.
        name: of the pass.
    """
    if name not in PASSES:
        raise KeyError(name)
    return name not in options.without


def refuse_unknown(names: object) -> None:
    """Refuse what is no list of names of passes.

    Args:
        names: to be left out.

    Raises:
        InputError: it is no list, or one of the names is unknown.
    """
    if not isinstance(names, tuple | list) or not all(isinstance(name, str) for name in names):
        raise InputError(
            f'option without is {names!r}; give a list of names of passes, such as ["begin_anew"]'
        )
    for name in names:
        if name not in PASSES:
            raise unknown_name("pass of a search to leave out:", name, PASSES)
