"""A discovery as a flat record, what is true of a log as one, and both as a row of rates.

The lists of one record go together: `named[i]` is at `where[i]` with `confidence[i]`; `sizes[j]` is
of `size_of[j]`, written as effect.size@place.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from identification.sweep.method import Column, Record

if TYPE_CHECKING:
    from identification.discovery.result import Discovery

ANSWER = {
    "verdict": Column(str, "the outcome in a word"),
    "unexplained": Column(bool, "whether something is left that no named effect explains"),
    "named": Column(list[str], "effects that are named"),
    "where": Column(list[str], "their places"),
    "confidence": Column(list[float], "of each name, 0 to 1"),
    "one_of": Column(list[bool], "whether the data cannot tell it from its first rival"),
    "rivals": Column(list[str], "the other names of such a set, with | between them, or empty"),
    "size_of": Column(list[str], "sizes and shapes, as effect.size@place"),
    "sizes": Column(list[float], "their values [SI]"),
    "findings": Column(list[str], "kinds of what is left"),
    "scores": Column(list[str], "the five best candidates before any refit, as effect, place"),
    "before": Column(float, "rms on unseen data of the nominal model [unit of the outputs]"),
    "after": Column(float, "rms on unseen data with what is named [unit of the outputs]"),
    "noise": Column(float, "rms noise of the sensors [unit of the outputs]"),
}
PROOF = {  # of a discovery on one free run only
    "t": Column(list[float], "t of the proof of each name"),
    "share": Column(list[float], "share of the unseen mean square that it takes away"),
    "gain": Column(list[float], "by how much it raises the negative BIC"),
    "gains": Column(list[float], "of the five best candidates"),
    "disturbance": Column(float, "what unlogged errors of the inputs do [unit of the outputs]"),
    "gap_closed": Column(float, "share of the mean square above the noise that is closed"),
}
TRUTH = {
    "kind": Column(str, "null, single, pair, triple, unknown, ..."),
    "ratio": Column(float, "what an effect leaves, over the noise; 0 where there is none"),
    "hidden": Column(list[str], "effects of the log"),
    "hidden_where": Column(list[str], "their places; empty where unknown"),
    "hidden_size_of": Column(list[str], "their sizes, as effect.size@place"),
    "hidden_sizes": Column(list[float], "their values [SI]"),
    "other_shape": Column(bool, "whether a law has another shape than that of the catalogue"),
}
JUDGED = {
    "right": Column(bool, "the first name is a true one; null where no listed effect is hidden"),
    "false_name": Column(bool, "a name is not true"),
}


def answer(found: Discovery) -> dict[str, Any]:
    """Returns the columns of `ANSWER` for a discovery."""
    named = found.named
    sizes = {
        size_name(n.name, size, n.where): float(p[0])
        for n in named for size, p in n.parameters.items()
    }  # fmt: skip
    return {
        "verdict": found.verdict, "unexplained": bool(found.unexplained),
        "named": [n.name for n in named], "where": [n.where for n in named],
        "confidence": [float(n.confidence) for n in named],
        "one_of": [bool(n.one_of) for n in named], "rivals": [
            "|".join(r.name for r in n.rivals if n.one_of and r.name != n.name) for n in named
        ],
        "size_of": [*sizes], "sizes": [*sizes.values()],
        "findings": [finding.kind.value for finding in found.findings],
        "scores": [f"{s.candidate.effect.name}, {s.candidate.where}" for s in found.scores[:5]],
        "before": float(found.before.rms), "after": float(found.after.rms),
        "noise": float(found.noise_rms),
    }  # fmt: skip


def proof(found: Discovery) -> dict[str, Any]:
    """Returns the columns of `PROOF` for a discovery on a free run."""
    noise = found.noise_rms**2 + found.disturbance_rms**2
    above = found.before.rms**2 - min(noise, found.after.rms**2)
    closed = (found.before.rms**2 - found.after.rms**2) / above if above > 0 else None
    return {
        "t": [float(n.proof.told.t) for n in found.named],
        "share": [float(n.proof.told.share) for n in found.named],
        "gain": [float(n.bic_gain) for n in found.named],
        "gains": [float(s.explains) for s in found.scores[:5]],
        "disturbance": float(found.disturbance_rms), "gap_closed": closed,
    }  # fmt: skip


def judged(named: Sequence[str], hidden: Sequence[str], kind: str) -> dict[str, bool | None]:
    """Returns the columns of `JUDGED`."""
    listed = bool(hidden) and kind != "unknown"
    return {
        "right": (bool(named) and named[0] in hidden) if listed else None,
        "false_name": any(name not in hidden for name in named),
    }


def nested(record: Record) -> dict[str, Any]:
    """Returns a record with `TRUTH`, `ANSWER`, `PROOF` as a row for `discovery_findings`."""
    sizes, hidden = (
        dict(zip(record[a], record[b], strict=True))
        for a, b in (("size_of", "sizes"), ("hidden_size_of", "hidden_sizes"))
    )
    each = zip(*(record[n] for n in ("named", "where", "confidence", "one_of", "rivals")),
               strict=True)  # fmt: skip
    return {
        "truth": {
            "kind": record["kind"], "ratio": record["ratio"],
            "duration": record.get("set.duration"), "records": record.get("set.records"),
            "other_shape": record["other_shape"],
            "effects": [
                {"name": name, "where": where or None, "sizes": _of(name, where, hidden)}
                for name, where in zip(record["hidden"], record["hidden_where"], strict=True)
            ],
        },
        "answer": {
            "verdict": record["verdict"], "unexplained": record["unexplained"],
            "gap_closed": record.get("gap_closed"),
            "named": [
                {"name": name, "where": where, "confidence": confidence, "one_of": one_of,
                 "set": rivals.split("|") if rivals else [], "sizes": _of(name, where, sizes)}
                for name, where, confidence, one_of, rivals in each
            ],
        },
        "seconds": record["run.processor_seconds"],
    }  # fmt: skip


def size_name(effect: str, size: str, where: str) -> str:
    """Returns how a size of an effect at a place is written: effect.size@place."""
    return f"{effect}.{size}@{where}"


def _of(effect: str, where: str, sizes: Mapping[str, float]) -> dict[str, float]:
    """Returns the sizes that are of one effect at one place."""
    begin, end = f"{effect}.", f"@{where}"
    return {
        name[len(begin) : -len(end)]: value for name, value in sizes.items()
        if name.startswith(begin) and name.endswith(end)
    }  # fmt: skip
