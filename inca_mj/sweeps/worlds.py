"""Hidden worlds as tasks: what is drawn by chance, the logs, and the truth as columns.

A world has a number. The grid may give it; else the seed of the task does. From the number come the
robot, its input and noise, and which effects are hidden.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from identification import Log
from identification.errors import InputError, unknown_name
from identification.sweep.answers import size_name
from identification.sweep.method import Column, Seed
from inca_mj.worlds import (
    AS_BUILT,
    EXACT,
    HIDDEN_EFFECTS,
    SHAPES,
    UNLISTED,
    HiddenEffect,
    HiddenSetting,
    draw_effect,
    records,
)
from inca_mj.worlds.world import INPUTS

COUNTS = {1: "single", 2: "pair", 3: "triple"}  # the kind of a world by its hidden effects
RATIOS = (1.0, 3.0, 10.0)  # of what cannot be absorbed to the noise, drawn by chance
KINDS = ("mixed", "null", "listed", "unknown")
SIZES = {"delay": "tau", "fraction": "c"}  # sizes of the worlds by the catalogue's names
ERROR = 5e-4  # of the currents, unlogged and coloured [A]
WORLD = {"world": Column(int, "number of the world, from which all else is drawn")}


@dataclass(frozen=True, kw_only=True)
class WorldSettings:
    """A world, and how it is measured.

    Attributes:
        world: its number; from the task's seed where None.
        kind: null, listed, unknown, or mixed: one in six has nothing hidden, one in six an effect
            that no catalogue lists.
        first: of the worlds; mixed counts from it.
        effect: the one that is hidden; by chance where "".
        effects: how many are hidden, 1 to 3.
        ratio: what an effect leaves over the noise; 1, 3 or 10 by chance where None.
        duration: of a log [s].
        rate: samples a second [Hz].
        noise: of the sensors, before the encoders round [rad].
        input: prbs or multisine; by the world's number where "".
        coloured: whether the currents err, unlogged.
        wrong_shapes: whether laws have another shape where they can.
        as_built: whether drives and points differ as those of real robots do.
        records: logs of the world, each with its own input and start.
        spread: what a search believes of drives and points: usual, none, or a TOML.

    Raises:
        InputError: a word is unknown, or a number is out of its range.
    """

    world: int | None = None
    kind: str = "mixed"
    first: int = 0
    effect: str = ""
    effects: int = 1
    ratio: float | None = None
    duration: float = 20.0
    rate: float = 100.0
    noise: float = 5e-4
    input: str = ""
    coloured: bool = False
    wrong_shapes: bool = False
    as_built: bool = False
    records: int = 1
    spread: str = "usual"

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise unknown_name("kind of world", self.kind, KINDS)
        if self.effect and self.effect not in (known := {*HIDDEN_EFFECTS, *UNLISTED}):
            raise unknown_name("effect", self.effect, known)
        if self.effects not in COUNTS:
            raise InputError(f"effects = {self.effects}: a world hides 1, 2 or 3")
        if not self.rate > 0:
            raise InputError(f"rate = {self.rate:g}: give samples a second above zero")
        if self.ratio is not None and not self.ratio > 0:
            raise InputError(f"ratio = {self.ratio:g}: give a number above zero")
        if self.records < 1:
            raise InputError(f"records = {self.records}: give 1 or more")
        self.setting(0)

    def setting(self, number: int) -> HiddenSetting:
        """How a world of a number is measured.

        Raises:
            InputError: a number is out of its range, or the input is unknown.
        """
        return HiddenSetting(
            input=self.input or ("multisine" if number % 2 else "prbs"),
            duration=self.duration, sampling_time=1 / self.rate, noise=self.noise,
            error_rms=ERROR if self.coloured or self.as_built else 0.0,
            tolerances=AS_BUILT if self.as_built else EXACT,
        )  # fmt: skip


def make_world(settings: WorldSettings, seed: Seed) -> tuple[list[Log], dict[str, Any]]:
    """The logs of a world, and its truth: the columns `WORLD` and `TRUTH`.

    Raises:
        InputError: no size of an effect shows so much.
        DivergenceError: the effects are so large that the robot breaks.
    """
    number = seed.number() if settings.world is None else settings.world
    kind, names, ratio = _drawn(settings, number)
    others = [settings.wrong_shapes and name in SHAPES for name in names]
    effects = [
        _balanced(draw_effect(name, number, other_shape=other))
        for name, other in zip(names, others, strict=True)
    ]
    setting = settings.setting(number)
    turn = INPUTS.index(setting.input)
    made = records(
        number, effects, n=settings.records, inputs=(*INPUTS[turn:], *INPUTS[:turn]),
        ratio=ratio if effects else None, setting=setting,
    )  # fmt: skip
    hidden = made[0].truth.effects
    sizes = {
        size_name(e.name, SIZES.get(size, size), e.where): float(getattr(e, size))
        for e in hidden for size in e.sizes
    }  # fmt: skip
    truth = {
        "world": number, "kind": kind, "ratio": ratio if effects else 0.0,
        "hidden": [e.name for e in hidden], "hidden_where": [e.where for e in hidden],
        "hidden_size_of": [*sizes], "hidden_sizes": [*sizes.values()],
        "other_shape": any(others),
    }  # fmt: skip
    return [each.log for each in made], truth


def _drawn(settings: WorldSettings, number: int) -> tuple[str, list[str], float]:
    """The kind of a world, the names of its effects, and their ratio."""
    rng = np.random.default_rng([number, 5])
    kind = settings.kind
    if kind == "mixed":
        kind = {0: "null", 3: "unknown"}.get((number - settings.first) % 6, "listed")
    count = {"null": 0, "unknown": 1}.get(kind, settings.effects)
    known = [*(UNLISTED if kind == "unknown" else HIDDEN_EFFECTS)]
    names = [str(name) for name in rng.choice(known, count, replace=False)]
    ratio = float(settings.ratio or rng.choice(RATIOS))
    if settings.effect in known:
        names = [settings.effect, *(n for n in names if n != settings.effect)][:count]
    return COUNTS[count] if kind == "listed" else kind, names, ratio


def _balanced(effect: Any) -> HiddenEffect:
    """Of a robot that stands with it, as all effects on its geometry do."""
    return replace(effect, balanced=True) if hasattr(effect, "balanced") else effect
