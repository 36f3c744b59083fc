"""The judgement constants of a discovery that a user may set: what it takes to be named.

Statistics give the distributions; how sure is sure enough, and how large is large enough to matter,
is judgement. `docs/discovery.md` lists every option, and a TOML file may set any of them. Every
other constant stands in the module that reads it, with its reason.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from pathlib import Path

from identification.discovery.passes import PASSES, refuse_unknown
from identification.effects.sizes import FARTHEST
from identification.errors import InputError, unknown_name
from identification.kalman.options import KalmanOptions, option
from identification.storage.files import read_toml


@dataclass(frozen=True, kw_only=True)
class DiscoveryOptions(KalmanOptions):
    """Options of what a discovery believes, those of the noise model and of a horizon among them.

    Every number has its unit, reason and source in its metadata (`dataclasses.fields`).

    Attributes:
        without: names of the passes that are left out, of `identification.discovery.passes`.

    Raises:
        InputError: a value is no number, or lies outside the range that makes sense, or a pass is
            unknown.
    """

    without: tuple[str, ...] = ()

    # The search.
    min_samples: int = option(
        200, "samples",
        "Fewest samples to fit, and as many to confirm: the blocks of scores and proof then have"
        " at least 10 samples each.",
        "judgement", least=50,
    )  # fmt: skip
    max_memory_share: float = option(
        0.8, "of the free memory",
        "A search that is forecast to take more is refused before it begins; a machine that swaps"
        " does not end.",
        "judgement", least=0.01, most=100.0,
    )  # fmt: skip
    max_effects: int = option(
        8, "effects",
        "Largest number of effects that are named. The search ends before, where unseen samples"
        " gain nothing by a further one.",
        "judgement", least=1,
    )  # fmt: skip
    max_horizon_effects: int = option(
        3, "effects",
        "Over a horizon: largest number of effects that are named; each further one costs minutes"
        " of an arm, all places of which are refitted.",
        "judgement", least=1,
    )  # fmt: skip
    max_minutes: float = option(
        10.0, "min",
        "No further effect is sought after this time; effects refitted by then are judged, and"
        " the fit without effects, scores and last checks are always finished. What was found"
        " is the answer, which says what was not tried. Most searches end far before.",
        "judgement",
    )  # fmt: skip
    nominal_factor: float = option(
        3.0, "factor",
        "A positive parameter of the nominal model stays within this factor of its nominal value; a"
        " wrong model would carry it anywhere to imitate what is missing.",
        "judgement", least=1.0,
    )  # fmt: skip
    max_scatter: float = option(
        3.0, "std of its group",
        "A part of a robot that deviates from the others by more is no scatter: it is an effect,"
        " and the nominal model does not follow it.",
        "0.3 % of a normal distribution", least=1.0,
    )  # fmt: skip

    # Scores, and which candidates are refitted.
    significance: float = option(
        0.01, "probability",
        "Chance that any candidate is taken for significant where nothing is missing (Bonferroni);"
        " the proof comes after it.",
        "judgement", most=1.0,
    )  # fmt: skip
    score_blocks: int = option(
        40, "blocks",
        "Blocks of the fitted samples whose scatter checks a score without the noise model.",
        "White 1980 for the test, judgement for the number", least=8,
    )  # fmt: skip
    size_factor: float = option(
        FARTHEST, "of the largest plausible size",
        "A size beyond this is not believed. The bounds of the parameters are at the default, so it"
        " can only be lowered.",
        "judgement", most=FARTHEST,
    )  # fmt: skip
    equal_share: float = option(
        0.8, "of a gain",
        "A candidate whose gain is at least this share of another one's explains as much as it.",
        "judgement", most=1.0,
    )  # fmt: skip
    max_refits: int = option(
        3, "candidates",
        "Largest number of candidates that are refitted in a round, and in the place of a named"
        " effect; a refit takes seconds.",
        "judgement", least=1,
    )  # fmt: skip
    refit_share: float = option(
        0.3, "of the best gain",
        "A candidate with a smaller gain is not refitted: a score is linear and errs, but not so"
        " much.",
        "judgement", most=1.0,
    )  # fmt: skip
    other_place_share: float = option(
        0.7, "of an effect's best gain",
        "An effect with a smaller gain at another place is not refitted there.",
        "judgement", most=1.0,
    )  # fmt: skip
    retry_share: float = option(
        0.5, "of the gain of the named effect",
        "An effect that was refitted in its place is tried again beside the other named effects"
        " unless its negative BIC was lower by more than this share; so is another kind of it where"
        " structure is left, unless it loses more to first order.",
        "judgement", most=1.0,
    )  # fmt: skip

    # The proof on unseen samples.
    proof_blocks: int = option(
        20, "blocks",
        "Blocks of the unseen samples over which gains are compared; each is to be longer than the"
        " memory of the residual.",
        "judgement", least=3,
    )  # fmt: skip
    min_proof_t: float = option(
        2.0, "t of the mean gain of the blocks",
        "The proof is beyond chance where flips of the blocks' signs are as seldom as a t above"
        " this is for normal gains: 3 % with 20 blocks.",
        "Student's t; Fisher 1935 for the flips",
    )  # fmt: skip
    min_fall: float = option(
        0.03, "of the mean square of the error on unseen samples",
        "An effect matters when the error falls by more than this.",
        "judgement, as min_structure_share", most=1.0,
    )  # fmt: skip
    min_gap_share: float = option(
        0.1, "of the mean square above the sensors' noise",
        "An effect matters when it closes more than this share of the gap.",
        "judgement", most=1.0,
    )  # fmt: skip

    # The verdict.
    min_explained_share: float = option(
        0.5, "of the gap on unseen samples",
        "Effects are named although something is left only when they close more than this.",
        "judgement", most=1.0,
    )  # fmt: skip
    min_confidence: float = option(
        0.5, "probability",
        "An effect is named when its name is at least as likely as not, or one of the set's names.",
        "even odds", most=1.0,
    )  # fmt: skip
    max_input_error: float = option(
        0.01, "of the inputs' own rms",
        "Over a horizon: an error of prediction that inputs make which are off by no more, constant"
        " over each window, is no reason to say that something is missing; currents and commanded"
        " torques are seldom better.",
        "judgement",
    )  # fmt: skip

    # The confidence.
    temperature: float = option(
        10.0, "factor of BIC's scale",
        "The likelihood believes its noise model, so that BIC alone is sure of everything; this"
        " flattens the probabilities.",
        "judgement; calibration in docs/benchmarks.md", least=1.0,
    )  # fmt: skip
    max_confidence: float = option(
        0.95, "probability",
        "No name is certain that was confirmed under one kind of input.",
        "judgement; calibration in docs/benchmarks.md", most=1.0,
    )  # fmt: skip
    left_confidence: float = option(
        0.85, "probability",
        "The upper limit where something is left that no name explains: a neighbour of what is left"
        " may have been named. In hidden worlds as built 16 of 18 such names were right, and 164 of"
        " 167 where nothing was left; this is (16 + 1)/(18 + 2).",
        "worlds up to 9620 of an older search, rule of succession", most=1.0,
    )  # fmt: skip
    set_confidence: float = option(
        0.2, "probability",
        "A rival that is more likely than this makes the answer a set of look-alikes.",
        "judgement", most=1.0,
    )  # fmt: skip

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse_unknown(self.without)
        object.__setattr__(self, "without", tuple(dict.fromkeys(self.without)))


def options_of(path: Path | None, minutes: float | None) -> DiscoveryOptions:
    """Returns the options of a command.

    Args:
        path: of a TOML file of options; defaults when None.
        minutes: the time limit [min], which counts before that of the file; None for none.

    Raises:
        InputError: as `read_options`, or the time is no positive number.
    """
    options = DiscoveryOptions() if path is None else read_options(path)
    if minutes is None:
        return options
    if not minutes > 0:
        raise InputError(f"--minutes {minutes:g} leaves no time; give a positive number of minutes")
    return replace(options, max_minutes=minutes)


def read_options(path: str | Path) -> DiscoveryOptions:
    """Returns the options of a TOML file of lines `name = value`; defaults where none is given.

    Args:
        path: of the file.

    Raises:
        InputError: the file cannot be read as TOML, a name is unknown, or a value has the wrong
            type or lies outside the range that makes sense.
    """
    path = Path(path)
    values = read_toml(path)
    known = {f.name for f in fields(DiscoveryOptions)}
    for name in values:
        if name in PASSES:
            raise InputError(f'{path}: {name} is no option; write without = ["{name}"]')
        if name not in known:
            raise unknown_name(f"option in {path}:", name, known)
    try:
        return DiscoveryOptions(**values)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
