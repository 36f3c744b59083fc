"""A result that was saved, read again: what its result.json tells, without robot and records.

The numbers are those of docs/json.md. A model goes on from its own file: robot.toml, which
`identification fit` and `discover` take, or model.xml, which `inca_mj.load_twin` reads.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import nan
from pathlib import Path
from typing import Any

from identification.errors import InputError
from identification.storage.results import CURE, read_result
from identification.storage.shown import Shown, verdict_of

Parameters = Mapping[str, tuple[float, float, str]]


@dataclass(frozen=True)
class SavedRival:
    """Another effect that may explain the same data."""

    name: str  # of the effect
    where: str  # the place where it acts, in words
    confidence: float  # probability that it is the right one of those considered


@dataclass(frozen=True)
class SavedEffect:
    """An effect that was named, or refitted and not believed."""

    name: str  # of the effect
    where: str  # the place where it acts, in words
    confidence: float  # probability that the name is right among its rivals, 0 to 1
    # its sizes and shapes by name: value, std, unit; NaN where a number is not known
    parameters: Parameters
    rivals: tuple[SavedRival, ...] = ()  # other effects that were refitted in its place


@dataclass(frozen=True, repr=False)
class SavedDiscovery(Shown):
    """The result of a search for what a model lacks, as it was saved.

    Attributes:
        verdict: the outcome in a word: "named", "unlisted effect", "unknown effect" or "nothing
            missing".
        unexplained: whether something is left that no named effect explains.
        named: the missing effects, in the order in which they were found.
        rejected: effects that were refitted beside the named ones and not accepted.
        values: of all parameters of the final fit by name, in their units.
        record: all that was saved, as plain values.
    """

    verdict: str
    unexplained: bool
    named: tuple[SavedEffect, ...]
    rejected: tuple[SavedEffect, ...]
    values: Mapping[str, float]
    record: Mapping[str, Any]

    def to_dict(self) -> dict[str, Any]:
        """Returns all that was saved as plain values."""
        return dict(self.record)


@verdict_of.register
def _sentences(saved: SavedDiscovery) -> Sequence[str]:
    """Returns the sentences of the verdict; the word and the names of a result without them."""
    names = "; ".join(f"{n.name}, {n.where}" for n in saved.named)
    return saved.record.get("sentences") or [": ".join(filter(None, [saved.verdict, names]))]


@dataclass(frozen=True)
class SavedFit:
    """The result of a fit, as it was saved.

    Attributes:
        values: the fitted values by name, in their units; a record's own ones are `name [record]`.
        std: of the values, in their units; NaN where it is not known.
        start: the values with which the fit began.
        at_bound: whether a value lies on a bound, by name.
        units: of the values by name.
        verdict: sentences on what the fit means.
        record: all that was saved, as plain values.
    """

    values: Mapping[str, float]
    std: Mapping[str, float]
    start: Mapping[str, float]
    at_bound: Mapping[str, bool]
    units: Mapping[str, str]
    verdict: tuple[str, ...] = field(repr=False)
    record: Mapping[str, Any] = field(repr=False)

    def to_dict(self) -> dict[str, Any]:
        """Returns all that was saved as plain values."""
        return dict(self.record)


def load(path: str | Path) -> SavedDiscovery | SavedFit:
    """Returns what `found.save(folder)`, or a command with `--out`, has saved of a search or a fit.

    Args:
        path: the folder, or its result.json.

    Raises:
        InputError: there is no such file, or it is no result of a search or a fit.
    """
    record = read_result(path)
    read = next((read for keys, read in READERS.items() if {*keys} <= {*record}), None)
    if read is None:
        known = " or ".join(f"{', '.join(keys[:-1])} and {keys[-1]}" for keys in READERS)
        raise InputError(
            f"{path} is no result of a search or a fit, which has the keys {known}; {CURE}"
        )
    try:
        return read(record)
    except (KeyError, TypeError, AttributeError) as error:
        raise InputError(
            f"{path} is damaged or was changed ({type(error).__name__}: {error}); {CURE}"
        ) from error


def _discovery(record: Mapping[str, Any]) -> SavedDiscovery:
    return SavedDiscovery(
        verdict=record["verdict"],
        unexplained=record["unexplained"],
        named=tuple(map(_effect, record["effects"])),
        rejected=tuple(map(_effect, record["rejected"])),
        values={name: _number(each["value"]) for name, each in record["final"].items()},
        record=record,
    )


def _effect(record: Mapping[str, Any]) -> SavedEffect:
    return SavedEffect(
        name=record["name"],
        where=record["where"],
        confidence=_number(record["confidence"]),
        parameters={
            name: (_number(each["value"]), _number(each["std"]), each["unit"])
            for name, each in record["parameters"].items()
        },
        rivals=tuple(
            SavedRival(each["name"], each["where"], _number(each["confidence"]))
            for each in record.get("rivals", ())
        ),
    )


def _fit(record: Mapping[str, Any]) -> SavedFit:
    each = record["parameters"]
    return SavedFit(
        values={name: _number(p["value"]) for name, p in each.items()},
        std={name: _number(p["std"]) for name, p in each.items()},
        start={name: _number(p["initial"]) for name, p in each.items()},
        at_bound={name: p["at_bound"] for name, p in each.items()},
        units={name: p["unit"] for name, p in each.items()},
        verdict=tuple(record["verdict"]),
        record=record,
    )


def _number(value: float | None) -> float:
    """Returns a number of JSON; NaN for null."""
    return nan if value is None else float(value)


READERS: Mapping[tuple[str, ...], Callable[[Mapping[str, Any]], SavedDiscovery | SavedFit]] = {
    ("verdict", "effects", "rejected"): _discovery,
    ("verdict", "parameters"): _fit,
}
