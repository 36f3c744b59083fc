"""Steps of a search that are kept, so that a search with other options makes few of them again.

A step is a function of a search. What it returned is kept under its arguments, and under what it
asked the options of the search while it ran. A search with other options finds it again where the
arguments are the same and these options answer alike. So it takes as long as what the other options
change, and its answer is that of a search from nothing.

Arguments are the same where their fields, numbers and arrays are. An object that has none of these
is the same as itself alone: a step is then made again, and nothing becomes wrong. What an array
holds must not change after a step has seen it.
"""

from __future__ import annotations

import hashlib
import importlib
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import fields, is_dataclass
from functools import partial, wraps
from inspect import signature
from types import FunctionType, MethodType
from typing import Any

import mujoco
import numpy as np

from identification import DiscoveryOptions

SEARCH = "identification.prediction."
STEPS = (
    *(SEARCH + step for step in (
        "fits.nominal_fit:fit_alone", "fits.nominal_fit:predicted", "fits.nominal_fit:as_begun",
        "scoring.screening:score_all", "scoring.scores:window_scores",
        "scoring.first_fit:begin", "judging.extension:with_effect",
        "judging.extension:with_fitting_steps", "judging.extension:with_finer_steps",
        "judging.extension:as_last_fit", "judging.extension:with_own_weights",
        "judging.extension:refitted", "fits.crossing:at_their_best",
        "fits.crossing:at_all_lengths", "selection.selection:refit_contenders",
        "selection.finer_steps:is_of_steps", "selection.exchange:exchanged",
        "selection.set_choice:choose", "moves.add_set:with_one", "verdict.clocks:record_shifts",
        "verdict.yardstick:measure", "verdict.neighbours:find_neighbour",
        "verdict.remaining:left_by_steps", "verdict.remaining:needed_input_error",
        "fits.model:predict_fitted", "verdict.recovery:recover_over_horizon",
    )),
    "identification.windows.unseen:predict",
    "identification.windows.fit:solve",
)  # fmt: skip
TOLD = ("progress",)  # arguments that are only told what is done

Answers = dict[str, Any]  # of options, by what was asked


class AskedOptions(DiscoveryOptions):
    """Options that note what the steps that run ask them."""

    def __getattribute__(self, name: str) -> Any:
        value = super().__getattribute__(name)
        if name == "without":
            return value if not _RUNNING else _LeftOut(value)
        if name in _OPTIONS:
            for answers in _RUNNING:
                answers[name] = value
        return value


class _LeftOut(tuple[str, ...]):
    """Passes that are left out; steps that run note whether the one that they ask for is."""

    __slots__ = ()

    def __contains__(self, name: object) -> bool:
        is_left_out = super().__contains__(name)
        for answers in _RUNNING:
            answers[f"{_WITHOUT}{name}"] = is_left_out
        return is_left_out


_OPTIONS = frozenset(f.name for f in fields(DiscoveryOptions)) - {"without"}
_WITHOUT = "without "
_NEXT: list[AskedOptions] = []  # of the search that runs
_RUNNING: list[Answers] = []  # of each step that runs now
_KEPT: dict[bytes, list[tuple[Answers, Any, Exception | None]]] = {}
_MARKS: dict[int, tuple[bytes, Any]] = {}  # of objects that are held, so that none takes their id
COUNTS = {"made": 0, "found": 0}  # steps, since the block began


def asked(options: DiscoveryOptions) -> AskedOptions:
    """Returns the same options for the search that comes next; they note what they are asked."""
    _NEXT[:] = [AskedOptions(**{f.name: getattr(options, f.name) for f in fields(options)})]
    return _NEXT[0]


@contextmanager
def kept_steps() -> Iterator[None]:
    """Keeps the steps of all searches in the block; at its end they are forgotten.

    The options of these searches are those of `asked`. The searches have to run in one thread
    (`INCA_MJ_THREADS=1`).
    """
    changed = [one for step in STEPS for one in _replaced(step)]
    COUNTS.update(made=0, found=0)
    try:
        yield
    finally:
        for module, name, original in changed:
            setattr(module, name, original)
        for held in (_KEPT, _MARKS, _NEXT):
            held.clear()


def _replaced(step: str) -> list[tuple[Any, str, Callable[..., Any]]]:
    """Puts the kept step in the place of a step, wherever that was imported."""
    name, _, word = step.partition(":")
    original = getattr(importlib.import_module(name), word)
    places = [
        (module, key, original)
        for name, module in sorted(sys.modules.items()) if name.startswith("identification")
        for key, value in vars(module).items() if value is original
    ]  # fmt: skip
    for module, key, _ in places:
        setattr(module, key, _kept(original))
    return places


def _kept(step: Callable[..., Any]) -> Callable[..., Any]:
    """Returns a step that looks for what it has returned before."""
    of_step = signature(step)

    @wraps(step)
    def call(*args: Any, **words: Any) -> Any:
        given = of_step.bind(*args, **words).arguments
        mark = _mark((step.__qualname__, {k: v for k, v in given.items() if k not in TOLD}))
        kept = _KEPT.setdefault(mark, [])
        for answers, result, error in kept:
            if all(_answer(_NEXT[0], question) == a for question, a in answers.items()):
                COUNTS["found"] += 1
                if error is not None:
                    raise error
                return result
        _RUNNING.append({})
        COUNTS["made"] += 1
        result, error = None, None
        try:
            result = step(*args, **words)
        except Exception as failure:
            error = failure
        finally:
            answers = _RUNNING.pop()
        kept.append((answers, result, error))
        if error is not None:
            raise error
        return result

    return call


def _answer(options: AskedOptions, question: str) -> Any:
    """Returns what options answer; the steps that run note it."""
    if question.startswith(_WITHOUT):
        return question.removeprefix(_WITHOUT) in options.without
    return getattr(options, question)


def _mark(x: Any) -> bytes:
    """Returns a digest by which the same arguments are known again."""
    if x is None or isinstance(x, bool | int | float | complex | str | bytes | np.generic):
        return _digest(type(x).__name__, repr(x).encode())
    if isinstance(x, AskedOptions):
        return b"options"
    if id(x) in _MARKS:
        return _MARKS[id(x)][0]
    if isinstance(x, np.ndarray):
        if x.dtype == object:
            return _held(x, _digest("objects", *map(_mark, x.ravel())))
        about = str((x.shape, x.dtype)).encode()
        return _held(x, _digest("array", about, np.ascontiguousarray(x).tobytes()))
    if isinstance(x, tuple | list):
        return _digest(type(x).__name__, *map(_mark, x))
    if isinstance(x, Mapping):
        return _digest("mapping", *map(_mark, x.items()))
    if isinstance(x, set | frozenset):
        return _digest("set", *sorted(map(_mark, x)))
    if isinstance(x, partial):
        return _digest("partial", _mark((x.func, x.args, x.keywords)))
    if isinstance(x, MethodType):
        return _digest("method", _mark((x.__func__, x.__self__)))
    if isinstance(x, FunctionType):
        cells = [c.cell_contents for c in x.__closure__ or ()]
        name = f"{x.__module__} {x.__qualname__}".encode()
        return _digest("function", name, _mark((cells, x.__defaults__)))
    if isinstance(x, mujoco.MjModel):
        data = np.empty(mujoco.mj_sizeModel(x), np.uint8)
        mujoco.mj_saveModel(x, None, data)
        return _held(x, _digest("model", data.tobytes()))
    if is_dataclass(x) and not isinstance(x, type):
        each = (_mark((f.name, getattr(x, f.name))) for f in fields(x))
        return _held(x, _digest(type(x).__qualname__, *each))
    return _held(x, _digest("itself", str((type(x).__qualname__, id(x))).encode()))


def _held(x: Any, mark: bytes) -> bytes:
    """Returns the mark of an object, which is held from now on."""
    _MARKS[id(x)] = mark, x
    return mark


def _digest(kind: str, *parts: bytes) -> bytes:
    digest = hashlib.blake2b(kind.encode(), digest_size=16)
    for part in parts:
        digest.update(len(part).to_bytes(8, "little"))
        digest.update(part)
    return digest.digest()
