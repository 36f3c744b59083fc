"""Hidden worlds as tasks: what is drawn by chance, the logs, and the truth as columns.

A world has a number. The grid may give it; else the seed of the task does. From the number come the
robot, its input and noise, and which effects are hidden.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np

from identification import Log
from identification.errors import InputError, refuse_negative, refuse_number, unknown_name
from identification.sweep.answers import size_name
from identification.sweep.method import Column, Seed
from identification.sweep.settings import file_setting, setting
from inca_mj.studies.worlds import (
    ALL_EFFECTS,
    AS_BUILT,
    CHANGES,
    EXACT,
    FAULTS,
    HIDDEN_EFFECTS,
    SHAPES,
    UNLISTED,
    HiddenEffect,
    HiddenSetting,
    draw_effect,
    records,
)
from inca_mj.studies.worlds.world import INPUTS
from inca_mj.workflows.spread import WORDS

COUNTS = {1: "single", 2: "pair", 3: "triple"}  # the kind of a world by its hidden effects
RATIOS = (1.0, 3.0, 10.0)  # of what cannot be absorbed to the noise, drawn by chance
HIDES = {"listed": HIDDEN_EFFECTS, "unknown": UNLISTED, "rule": CHANGES, "sensor": FAULTS}
KINDS = ("mixed", "null", *HIDES)
SIZES = {"delay": "tau", "fraction": "c"}  # sizes of the worlds by the catalogue's names
ERROR = 5e-4  # of the currents, unlogged and coloured [A]
SPREAD = "what a search believes of drives and points: none, usual, or a TOML file"
WORLD = {"world": Column(int, "number of the world, from which all else is drawn")}


@dataclass(frozen=True, kw_only=True)
class WorldSettings:
    """A world, and how it is measured; every field says what it is in its metadata.

    Raises:
        InputError: a word is unknown, or a number is out of its range.
    """

    world: int | None = setting("number of the world; from the seed of the task if not given", None)
    kind: str = setting(
        "null, listed, unknown (in no catalogue), rule (a parameter drifts or jumps), sensor (an"
        " encoder's fault), or mixed: one world in six null, one in six unknown, the rest listed",
        "mixed",
    )
    first: int = setting("number of the first world; mixed counts from it", 0)
    effect: str = setting('effect that is hidden, of the kind; by chance if ""', "")
    effects: int = setting("how many effects are hidden, 1 to 3", 1)
    ratio: float | None = setting(
        "what an effect leaves over the noise, above 0; 1, 3 or 10 by chance if not given", None
    )
    duration: float = setting("length of a log, two samples or more [s]", 20.0)
    rate: float = setting("samples a second, above 0 [Hz]", 100.0)
    noise: float = setting("noise of the sensors, before the encoders round [rad]", 5e-4)
    input: str = setting('prbs or multisine; by the number of the world if ""', "")
    coloured: bool = setting("whether the currents err, unlogged", False)
    wrong_shapes: bool = setting("whether laws have another shape where they can", False)
    as_built: bool = setting("whether drives and points differ as those of real robots do", False)
    records: int = setting("logs of the world, each with its own input and start", 1)
    spread: str = file_setting(SPREAD, "usual", words=WORDS)

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise unknown_name("kind of world", self.kind, KINDS)
        if self.effect and self.effect not in ALL_EFFECTS:
            raise unknown_name("effect", self.effect, ALL_EFFECTS)
        self._refuse_other_kind()
        if self.effects not in COUNTS:
            raise InputError(f"effects = {self.effects}: a world hides 1, 2 or 3")
        for name in ("world", "first"):
            refuse_negative(name, getattr(self, name) or 0)
        refuse_number("rate", self.rate, 0 < self.rate < inf, "samples a second above zero")
        if self.ratio is not None:
            refuse_number("ratio", self.ratio, 0 < self.ratio < inf, "a number above zero")
        refuse_number("records", self.records, self.records >= 1, "1 or more")
        self.setting(0)

    def _refuse_other_kind(self) -> None:
        """Refuse an effect that worlds of this kind never hide, so that it would be left out.

        Raises:
            InputError: it is of another kind.
        """
        hidden = {**HIDES, "mixed": {**HIDDEN_EFFECTS, **UNLISTED}, "null": {}}[self.kind]
        if not self.effect or self.effect in hidden:
            return
        own = next(kind for kind, names in HIDES.items() if self.effect in names)
        good = f", or one of kind {self.kind}: {', '.join(sorted(hidden))}" if hidden else ""
        raise InputError(
            f'effect = "{self.effect}" is of kind {own}, and worlds of kind {self.kind} do not hide'
            f' it; write kind = "{own}", or leave effect out{good}'
        )

    def setting(self, number: int) -> HiddenSetting:
        """Returns how a world of a number is measured.

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
    """Returns the logs of a world, and its truth: the columns `WORLD` and `TRUTH`.

    Raises:
        InputError: no size of an effect shows so much.
        DivergenceError: the effects are so large that the robot breaks.
    """
    number = seed.number() if settings.world is None else settings.world
    kind, names, others, ratio = _drawn(settings, number)
    setting = settings.setting(number)
    turn = INPUTS.index(setting.input)
    made = records(
        number, _effects(settings, number, names), n=settings.records,
        inputs=(*INPUTS[turn:], *INPUTS[:turn]), ratio=ratio if names else None, setting=setting,
        others=_effects(settings, number, others),
    )  # fmt: skip
    hidden = made[0].truth.effects
    sizes = {
        size_name(e.name, SIZES.get(size, size), e.where): float(getattr(e, size))
        for e in hidden for size in e.sizes
    }  # fmt: skip
    truth = {
        "world": number, "kind": kind, "ratio": ratio if names else 0.0,
        "hidden": [e.name for e in hidden], "hidden_where": [e.where for e in hidden],
        "hidden_size_of": [*sizes], "hidden_sizes": [*sizes.values()],
        "other_shape": settings.wrong_shapes and any(e.name in SHAPES for e in hidden),
    }  # fmt: skip
    return [each.log for each in made], truth


def _drawn(settings: WorldSettings, number: int) -> tuple[str, list[str], list[str], float]:
    """Returns the kind of a world, the names of its effects, those in reserve, and their ratio.

    One in reserve takes the place of one that leaves too little with every size of a robot; an
    effect that is asked for has none.
    """
    rng = np.random.default_rng([number, 5])
    kind = settings.kind
    if kind == "mixed":
        kind = {0: "null", 3: "unknown"}.get((number - settings.first) % 6, "listed")
    count = settings.effects if kind == "listed" else int(kind != "null")
    known = [*HIDES.get(kind, HIDDEN_EFFECTS)]
    names = [str(name) for name in rng.choice(known, count, replace=False)]
    ratio = float(settings.ratio or rng.choice(RATIOS))
    others = [str(name) for name in rng.permutation(known) if name not in names]
    if settings.effect in known:
        names = [settings.effect, *(n for n in names if n != settings.effect)][:count]
        others = []
    return COUNTS[count] if kind == "listed" else kind, names, others if count else [], ratio


def _effects(settings: WorldSettings, number: int, names: list[str]) -> list[HiddenEffect]:
    """Returns the effects of a world by name; the robot stands with all of them."""
    drawn: list[Any] = [
        draw_effect(name, number, other_shape=settings.wrong_shapes and name in SHAPES)
        for name in names
    ]
    return [replace(e, balanced=True) if hasattr(e, "balanced") else e for e in drawn]
