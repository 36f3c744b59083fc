"""The parts of what no fit has seen, in words and as plain values (`identification.logs.parts`)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from identification.discovery.passes import uses
from identification.discovery.result import Discovery
from identification.logs.joined import Record
from identification.quantities import held
from identification.report.words.errors import listed

MOST_NAMES = 6  # of records, that are told one by one


def parts_sentence(found: Discovery) -> str:
    """Returns sentences that say of which part of the unseen data all errors are told."""
    unseen = _unseen(found)
    kept = [r for r in unseen if _is_kept(r)]
    short = [r.log.name for r in unseen if not _is_kept(r)]
    if not uses(found.options, "untouched_part"):
        return "Errors and gains are those of the same unseen data on which the search has decided."
    said = []
    if kept:
        decided, told = (held(sum(_seconds(r)[k] for r in kept)) for k in ("select", "report"))
        said.append(
            "The blocks of the unseen data form two parts. The search has decided on one part"
            f" ({decided} s). The other part ({told} s) is untouched, and errors and gains are"
            " computed on it."
        )
    if short:
        one = len(short) == 1
        said.append(
            f"{listed(short)} {'is' if one else 'are'} too short to keep a part untouched: errors"
            " and gains are those of the same data on which the search has decided, so that they"
            " are somewhat too good."
        )
    return " ".join(said)


def unseen_of(found: Discovery) -> str:
    """Returns of which records the unseen data are over a horizon, in brackets behind these words.

    It is "" along a free run, where they are of the log itself.
    """
    names = [r.log.name for r in _unseen(found)] if found.run is None else []
    return f" ({records_words(names)})" if names else ""


def records_words(names: Sequence[str]) -> str:
    """Returns names of records in words; of many how many they are."""
    return listed(names) if len(names) <= MOST_NAMES else f"{len(names)} records"


def is_untouched(found: Discovery) -> bool:
    """Returns whether the search has decided on nothing of which errors and gains are told."""
    unseen = _unseen(found)
    return bool(unseen) and all(map(_is_kept, unseen))


def parts_to_json(found: Discovery) -> list[dict[str, Any]]:
    """Returns of each record with unseen data what is kept, and how long blocks and parts are."""
    return [
        {"file": r.log.name, "kept": _is_kept(r),
         **(_seconds(r) if _is_kept(r) else dict.fromkeys(("block", "select", "report")))}
        for r in _unseen(found)
    ]  # fmt: skip


def _unseen(found: Discovery) -> list[Record]:
    """Returns the records of which a part is unseen."""
    if found.run is None:
        return [r for r in found.records if r.role == "confirm"]
    return [r for r in found.records if r.parts is not None]


def _is_kept(record: Record) -> bool:
    return record.parts is not None and record.parts.is_kept


def _seconds(record: Record) -> dict[str, float]:
    """Returns the lengths of a block and of both parts of a record that is divided [s]."""
    parts, h = record.parts, record.log.sampling_time
    if parts is None:
        return {}
    rows = {"block": parts.block, "select": parts.select.sum(), "report": parts.report.sum()}
    return {name: float(h * n) for name, n in rows.items()}
