"""What unseen data prove in which the robot hardly moves, in words: next to nothing."""

from __future__ import annotations

from collections.abc import Sequence

from identification.discovery.result import Discovery
from identification.logs.joined import Record
from identification.logs.log import Log, halves
from identification.logs.rest import is_at_rest
from identification.report.words.parts import records_words


def resting_records(records: Sequence[Record]) -> list[str]:
    """Returns the names of the records that confirm and hardly move beside the fitted ones."""
    fitted = [r.log for r in records if r.role == "fit"]
    return [r.log.name for r in records if r.role == "confirm" and is_at_rest(fitted, r.log)]


def is_all_at_rest(records: Sequence[Record]) -> bool:
    """Tells whether no record that confirms moves."""
    names = [r.log.name for r in records if r.role == "confirm"]
    return bool(names) and resting_records(records) == names


def resting(found: Discovery) -> list[str]:
    """Returns the names of the records whose unseen part hardly moves beside what was fitted."""
    if found.run is None:
        return resting_records(found.records)
    fitted = list(_parts(found, "estimation").values())
    unseen = _parts(found, "validation")
    return [name for name, log in unseen.items() if fitted and is_at_rest(fitted, log)]


def are_all_resting(found: Discovery) -> bool:
    """Tells whether the robot hardly moves in all that a search has not fitted."""
    if found.run is None:
        return is_all_at_rest(found.records)
    return bool(names := resting(found)) and names == [*_parts(found, "validation")]


def _parts(found: Discovery, part: str) -> dict[str, Log]:
    """Returns a part of each record of a free run that has it, by the name of the record."""
    logs = [r.log for r in found.records]
    return {log.name: log.part(part) for log in logs if part in (log.splits or halves(log))}


def rest_sentences(names: Sequence[str], is_part: bool = False) -> list[str]:
    """Returns what records prove in which the robot hardly moves, and which would; none without.

    Args:
        names: of the records.
        is_part: whether it is an unseen part of each of them that is meant.
    """
    if not names:
        return []
    where = f"{'the unseen part of ' if is_part else ''}{records_words(names)}"
    proves = "this proves" if is_part or len(names) == 1 else "they prove"
    return [
        f"In {where} the robot hardly moves, so that {proves} little: a model that is wrong in"
        " motion predicts a robot at rest as well. Confirm on a record that moves as much as the"
        " fitted data do, along another motion."
    ]
