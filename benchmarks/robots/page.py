"""The page of the measured robots, made from their JSON records and from nothing else."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from robots import ROBOTS
from robots.evidence_text import evidence_lines
from robots.words import amount, number, percent, table

HEAD = """# Measured robots

What a discovery says of robots that others measured, beside what they published. This page is
made by `python benchmarks/measured.py` from the JSON records in `benchmarks/results/measured`; it
is not written by hand. The data are not part of this project: `benchmarks/robots` says whose they
are, and reads them.

Errors are those of predictions over windows of the horizon, on records that no fit has seen. Each
model begins each window at the state that explains it best. *Before* is the nominal model, fitted
to the same records as the discovery; *after* is the model with what is named; the *published model*
is the best of the models of others, made again from their equations and numbers and used on the
same windows.

Each robot's part says which commit recorded it. These are older searches than the present one,
which may answer otherwise: the records have to be made again.
"""
FIRST, LAST, BEGUN = "nominal, fitted", "with what is named", "as begun"


def page(records: Path) -> str:
    """The page as Markdown.

    Args:
        records: folder of the JSON records.
    """
    kept = {path.stem: json.loads(path.read_text(encoding="utf-8"))
            for path in sorted(records.glob("*.json"))}  # fmt: skip
    main = [n for name in ROBOTS for n in kept if n == name or n.startswith(f"{name}_start")]
    rows = [_row(kept[n]) for n in main]
    head = ("robot", "records: fitted, unseen", "named", "size", "published", "before", "after",
            "published model", "better on", "time")  # fmt: skip
    parts = [HEAD, table(head, rows)]
    for name in ROBOTS:
        if name in kept:
            parts.append(_section(name, kept))
    return "\n".join(parts)


def _row(record: dict[str, Any]) -> tuple[str, ...]:
    """A robot in the table at the top."""
    name = record["robot"] + (f", {record['start']}" if "start" in record else "")
    counts = f"{len(record['fit'])}, {len(record['confirm'])}"
    if "refused" in record:
        return (name, counts, "refused", *[""] * 6, _time(record))
    seen, effects = record["unseen"], record["discovery"]["effects"]
    unit, rms = record["unit"], seen["rms"]
    others = {n: v for n, v in rms.items() if n in record["published_models"]}
    best = min(others, key=lambda n: others[n], default="")
    after = ""
    if LAST in rms:
        after = f"{amount(rms[LAST], unit)} ({percent(seen['change'][LAST])})"
    return (
        name, counts,
        "; ".join(f"{e['name']}, {e['where']}" for e in effects) or record["discovery"]["verdict"],
        "; ".join(_sizes(e) for e in effects), "; ".join(_published(record)),
        amount(rms[FIRST], unit), after,
        f"{amount(others[best], unit)} ({best})" if best else "",
        f"{seen['better'][LAST]} of {len(record['confirm'])}" if LAST in rms else "",
        _time(record),
    )  # fmt: skip


def _time(record: dict[str, Any]) -> str:
    """How long it took, and whether the machine did other things as well."""
    beside = ", beside other jobs" if record.get("load", 0) > record.get("cores", 0) + 0.5 else ""
    return f"{record['seconds']:.0f} s{beside}"


def _sizes(effect: dict[str, Any]) -> str:
    """Sizes of an effect with their std."""
    return ", ".join(
        f"{name.partition('@')[0].rpartition('.')[2]} {number(p['value'], p['std'], p['unit'])}"
        for name, p in effect["parameters"].items()
    )


def _published(record: dict[str, Any]) -> list[str]:
    """Published sizes of what a search should find."""
    return [
        f"{p['name'].partition('@')[0].rpartition('.')[2]} {number(p['value'], None, p['unit'])}"
        for p in record["published"]
        if any(p["name"].startswith(name) for name in record["expected"])
    ]


def _section(name: str, kept: dict[str, Any]) -> str:
    """What the records of one robot say."""
    record = kept[name]
    lines = [f"\n## {name}: {record['title']}\n",
             f"{record['source']}. Fitted: {'; '.join(record['fit'])}. Unseen:"
             f" {'; '.join(record['confirm'])}. Horizon {record['horizon']:.3g} s."
             f" {record['date']}, version {record['version']} ({record['commit']}).\n"]  # fmt: skip
    if "refused" in record:
        lines.append(f"The files are refused: {record['refused']}\n")
        return "\n".join(lines)
    discovery, unit = record["discovery"], record["unit"]
    words = f"Verdict: {discovery['verdict']}"
    if discovery["effects"]:
        words += f"; {percent(discovery['share'])} of the power above the sensors' noise".replace(
            "+", ""
        )
    lines.append(words + (", and something is left." if discovery["unexplained"] else ".") + "\n")
    for effect in discovery["effects"]:
        lines += [_named(effect), ""]
    tried = [f"{e['name']}, {e['where']} ({_sizes(e)})" for e in discovery["rejected"]]
    if tried:
        lines.append(f"Refitted, and not proven on unseen data: {'; '.join(tried)}.\n")
    models = [n for n in record["unseen"]["rms"] if n != BEGUN]
    rows = [(log, *(amount(each[m], unit) for m in models))
            for log, each in record["unseen"]["records"].items()]  # fmt: skip
    rows.append(("all", *(amount(record["unseen"]["rms"][m], unit) for m in models)))
    lines += [table(("unseen record", *models), rows),
              f"As begun, before any fit: {amount(record['unseen']['rms'][BEGUN], unit)}.\n",
              _fitted(record)]  # fmt: skip
    lines += [line for each in record.get("apart", []) for line in _apart(each, unit)]
    lines += _again(name, kept)
    lines += evidence_lines(name, record.get("evidence", {}))
    return "\n".join(lines)


def _named(effect: dict[str, Any]) -> str:
    said = f"- **{effect['name']}**, {effect['where']}: {_sizes(effect)}."
    if effect["rivals"]:
        at = effect["where"]
        each = "; ".join(
            r["name"] + (f", {r['where']}" if r["where"] != at else "") for r in effect["rivals"]
        )
        said += f" {'Not told from' if effect['one_of'] else 'Less likely'}: {each}."
    if effect["disagrees"]:
        said += f" Worse on: {'; '.join(effect['disagrees'])}."
    return said


def _fitted(record: dict[str, Any]) -> str:
    """The table of values."""
    rows = []
    for name, s in record["sizes"].items():
        cells = [number(s[k], s.get(f"{k}_std"), s["unit"]) for k in ("nominal", "final")]
        rows.append((name, *cells, number(s["published"], None, s["unit"])))
    return table(("parameter", "nominal, fitted", "with what is named", "published"), rows)


def _apart(apart: dict[str, Any], unit: str) -> list[str]:
    """What the models make of the robot as it was changed."""
    seen = apart["unseen"]
    rows = [(log, *(amount(v, unit) for v in each.values()))
            for log, each in seen["records"].items()]  # fmt: skip
    lines = [table((apart["what"], *seen["rms"]), rows)]
    for log, found in apart["refitted"].items():
        said = ", ".join(f"{n} {number(v['before'], None, '')} becomes"
                         f" {number(v['value'], v['std'], '')}"
                         for n, v in found["values"].items())  # fmt: skip
        lines.append(f"Fitted to {log}, all else held: {said}; {amount(found['rms'], unit)}"
                     " is left.\n")  # fmt: skip
    return lines


def _again(name: str, kept: dict[str, Any]) -> list[str]:
    """Other splits, and the nulls."""
    lines = []
    for ending in ("_split_2", "_null", "_split_2_null"):
        other = kept.get(name + ending)
        if other is None:
            continue
        if ending.endswith("null"):
            of = "" if "records" not in other else " with {} fitted and {} that confirm".format(
                *other["records"])  # fmt: skip
            lines.append(f"Nulls{of} (the best model with its own residual resampled in blocks):"
                         f" {other['with_a_name']} of {other['count']} get a name.\n")  # fmt: skip
        elif "refused" in other:
            lines.append(f"Split otherwise it is refused: {other['refused']}\n")
        else:
            named = [f"{e['name']}, {e['where']} ({_sizes(e)})"
                     for e in other["discovery"]["effects"]]  # fmt: skip
            said = "; ".join(named) or other["discovery"]["verdict"]
            lines.append(f"Split otherwise (fitted: {'; '.join(other['fit'])}): {said}.\n")
    return lines
