"""What calibrations and discoveries of robots as they are built come to: rates, errors, a page."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from as_built_calibrations import (
    Row,
    calibration_lines,
    commits_of,
    median_time,
    rate_of,
    records_of,
)

from identification.sweep.discovery_findings import in_set, right, size_errors
from inca_mj.studies.worlds import ALL_EFFECTS, UNLISTED

USUAL = 20.0  # length of a world's log where nothing is said [s]
ABSORBED = {"spring_hysteresis"}  # to first order, friction and stiffness do the same
UNCHECKED = (range(8510), range(9000, 9617))  # worlds made before this was looked at
RATIO = 20.0  # of most worlds
CLOSE = 0.15  # relative error of a size that is called right
HEAD = """# Robots as they are built

No drive of a real robot is like another, and no exit point is where the drawing has it. This page
is made by `python benchmarks/as_built.py` from the rows in `benchmarks/results/as_built`; it is not
written by hand. The logs are of an independent simulator: 20 s at 100 Hz, encoders of 4000 counts
with 0.5 mrad of noise, an unlogged error of the currents of 0.5 mA. Each drive has parameters of
its own (uniformly within λ 5 %, b 20 %, J 5 %, b_v 15 %, b_c 15 %, K_t 2 %, R 0.5 %, R_s 1 %,
k_s 3 % of a common value), anchors are off by 3 mm and connectors by 0.5 mm (std of each
coordinate), inertias by up to 10 %. What is known of this before a fit is
`models/inca6d_spread.toml`.
"""


def page(
    calibrations: Sequence[Row],
    discoveries: Sequence[Row],
    worlds: Sequence[Row] = (),
    times: Sequence[Row] = (),
) -> str:
    """The page, from all rows: those of labelled robots, and those of sweeps over worlds."""
    parts = (
        calibration_lines(calibrations), _discoveries(discoveries), _worlds(worlds), _times(times),
    )  # fmt: skip
    return "\n".join([HEAD, *(line for part in parts for line in part)])


def _times(rows: Sequence[Row]) -> list[str]:
    """Times of whole searches on a machine that did nothing else."""
    if not rows:
        return []
    lines = [
        f"## Time on two quiet cores ({commits_of(rows)})", "",
        "    python benchmarks/as_built.py time --robot robot_00 [--records abc]", "",
        "| robot | records | truth | whole search | processor time | nominal fit | sensitivities"
        " | refits |",
        "|---|---|---|---|---|---|---|---|",
    ]  # fmt: skip
    for row in rows:
        s = row["stages"]
        lines.append(
            f"| {row['robot']} | {records_of(row)[0]} |"
            f" {' + '.join(row['truth']['effects']) or 'nothing'} | {row['seconds']:.0f} s |"
            f" {row['processor_seconds']:.0f} s | {s['nominal fit']:.0f} s |"
            f" {s['sensitivities']:.0f} s | {s['refits']:.0f} s |"
        )
    return [*lines, ""]


def _discoveries(rows: Sequence[Row]) -> list[str]:
    done = [row for row in rows if "verdict" in row]
    lines = ["## Discovery", "", "    inca discover LOG... --spread usual", ""]
    if not done:
        lines += ["No robot has been answered by the present search.", ""]
    for key in sorted({(*records_of(row), row["key"].split("/")[3]) for row in done}):
        mine = [row for row in done if (*records_of(row), row["key"].split("/")[3]) == key]
        fitted, confirm, spread = key
        what = f"records {fitted}" + (f", {confirm} confirms" if confirm else "")
        lines += [f"### {what}, spread {spread} ({len(mine)} robots, {commits_of(mine)})", ""]
        for kind, title in _KINDS.items():
            some = [row for row in mine if row["truth"]["kind"] == kind]
            if some:
                lines.append(f"- {title}: {'; '.join(_rates(kind, some))}.")
        lines += ["", f"{median_time(mine)}", "", "| robot | truth | answer | best score |",
                  "|---|---|---|---|"]  # fmt: skip
        lines += [_line(row) for row in sorted(mine, key=lambda row: row["robot"])] + [""]
    failed = [f"{row['key']}: {row['error']}" for row in rows if "error" in row]
    return [*lines, *(f"- failed: {line}" for line in failed)]


def _worlds(rows: Sequence[Row]) -> list[str]:
    done = [row for row in rows if "answer" in row]
    if not done:
        return []
    lines = [
        "## Worlds of our own, as built", "",
        "    inca sweep benchmarks/sweeps/as_built.toml        (and rules_and_sensors.toml)", "",
        "Robots, inputs and effects are drawn by chance; one in six has nothing hidden, and one"
        " in six an effect that no catalogue lists. With `effects = 3` three are hidden, and"
        " `records = 3` makes three logs of one robot. Sizes are such that 20 times the noise, or"
        " what a line says, is left when base parameters and start are tuned again and parts"
        " deviate as parts do, each at the price of its usual std. Older rows count base"
        " parameters and start only: their effects are smaller, and some are within the spread."
        " Some rows are of effects larger than robots usually have them, such as a cable of 90"
        " g/m: no smaller one leaves so much, and worlds have another effect in their place since"
        " then. Worlds up to 8216, and from 9000 to 9408, count the common radius, spring constant"
        " and slope of the friction as known. A hysteresis of the drum springs in worlds up to"
        " 8509, and from 9000 to 9616, is friction and stiffness to first order (r₁ < r/10,"
        " `inca_mj/studies/worlds/ratio.py`): nobody can tell it from them, and worlds have"
        " another effect in its place since then. A scale of 5 % of one encoder leaves a third of"
        " the noise in 10 s (worlds 5 and 6), because other parameters of its drive do the"
        " same: nobody can tell it, and no world has it.", "",
    ]  # fmt: skip
    one = {"the right name first": right, "right or in the set": in_set,
           "a wrong name": lambda r: bool(r["answer"]["named"]) and not in_set(r)}  # fmt: skip
    tests: dict[str, dict[str, Any]] = {
        **dict.fromkeys(("single", "rule", "sensor"), one),
        "null": {'"nothing missing"': lambda r: r["answer"]["verdict"] == "nothing missing",
                 "a false name": lambda r: bool(r["answer"]["named"])},
        "triple": {"two or three right": lambda r: len(_found(r)) >= 2,
                   "all three right": lambda r: len(_found(r)) == 3,
                   "a wrong name": lambda r: len(_found(r)) < len(r["answer"]["named"]),
                   '"nothing left" said wrongly': lambda r: len(_found(r)) < 3
                   and r["answer"]["verdict"] != "unknown effect"
                   and not r["answer"]["unexplained"]},
        "unknown": {'"unknown effect"': lambda r: r["answer"]["verdict"] == "unknown effect",
                    "a name": lambda r: bool(r["answer"]["named"])},
    }  # fmt: skip
    for group in sorted({_group(row) for row in done}):
        for kind, title in {**_KINDS, "unknown": "an unlisted effect"}.items():
            some = [r for r in done if _group(r) == group and r["truth"]["kind"] == kind]
            if some and kind in tests:
                rates = (f"{what} {rate_of(some, test)}" for what, test in tests[kind].items())
                newest = _of_newest(some, *next(iter(tests[kind].items())))
                lines.append(f"- {_words(group)}, {title}: {'; '.join(rates)}.{newest}")
    close = [error <= CLOSE for error in size_errors(done)]
    if close:
        lines.append(f"- sizes of right names within {CLOSE:.0%}: {sum(close)} of {len(close)}.")
    told = [row for row in done if row["truth"]["effects"] or row["answer"]["named"]]
    if told:
        lines += ["", "| world | records | truth | answer |", "|---|---|---|---|"]
    for row in sorted(told, key=lambda row: row["key"]):
        truth = " + ".join(e["name"] for e in row["truth"]["effects"]) or "nothing"
        answer = row["answer"]
        names = "; ".join(f"{n['name']}, {n['where']}" for n in answer["named"])
        world, what = row["key"].split("/")[1], _words(_group(row))
        lines.append(f"| {world} | {what} | {truth} | {names or answer['verdict']} |")
    return [*lines, ""]


def _of_newest(rows: Sequence[Row], what: str, test: Callable[[Row], bool]) -> str:
    """The same of the rows that the newest code made, where older code made others."""
    code = rows[-1].get("code")
    mine = [row for row in rows if row.get("code") == code]
    if not code or len(mine) == len(rows):
        return ""
    return f" Of the newest rows ({code.rpartition(' ')[2]}) {what} {rate_of(mine, test)}."


class Group(NamedTuple):
    """What worlds have in common whose answers are counted together."""

    count: int  # logs of a world
    seconds: float  # length of a log [s]
    beside: bool  # whether what parts can absorb is no part of the effects' sizes
    possible: bool  # whether a robot may have such sizes
    listed: bool  # whether the catalogue lists all effects
    distinct: bool  # whether no other parameters do the same to first order
    ratio: float  # what an effect leaves over the noise


def _group(row: Row) -> Group:
    """The group of a world."""
    truth, names = row["truth"], {e["name"] for e in row["truth"]["effects"]}
    number = int(row["key"].split("/")[1])
    return Group(
        truth.get("records", 1),
        truth.get("duration", USUAL),
        beside=not names or "beside the spread" in row["key"],
        possible=all(_is_possible(effect) for effect in truth["effects"]),
        listed=truth["kind"] == "unknown" or not names & {*UNLISTED},
        distinct=not (names & ABSORBED and any(number in made for made in UNCHECKED)),
        ratio=truth["ratio"] or RATIO,
    )


def _is_possible(effect: Mapping[str, Any]) -> bool:
    """Whether a robot may have an effect of the usual law with such sizes, to 2 %."""
    kind = ALL_EFFECTS[effect["name"]]()
    usual = math.hypot(*(getattr(kind, size) for size in kind.sizes))
    return math.hypot(*effect["sizes"].values()) <= 1.02 * kind.most * usual


def _words(group: Group) -> str:
    """A group of worlds in words."""
    logs = f"logs of {group.seconds:g} s"
    if group.count > 1:
        logs = f"{group.count} records of {group.seconds:g} s"
    logs += "" if group.ratio == RATIO else f", {group.ratio:g} times the noise"
    logs += "" if group.possible else ", larger than usual"
    logs += "" if group.listed else ", one of them in no catalogue"
    logs += "" if group.distinct else ", with a hysteresis that is friction"
    return logs + ("" if group.beside else ", older sizes")


def _found(row: Row) -> set[str]:
    """Hidden effects that are named."""
    return {n["name"] for n in row["answer"]["named"]} & {
        e["name"] for e in row["truth"]["effects"]
    }


_KINDS = {
    "null": "nothing hidden", "single": "one effect", "triple": "three effects",
    "sensor": "a sensor's fault", "rule": "an effect by rule",
}  # fmt: skip


def _rates(kind: str, rows: Sequence[Row]) -> list[str]:
    tests: dict[str, Any] = {
        "the right name first": lambda r: bool(r["named"]) and _names(r)[0] in _truth(r),
        "right or in the set": _is_in_set,
        "the right score first": lambda r: r["scores"][0][0] in _truth(r),
        "a wrong name": lambda r: any(n not in _truth(r) for n in _names(r)) and not _is_in_set(r),
    }
    if kind == "null":
        tests = {
            '"nothing missing"': lambda r: r["verdict"] == "nothing missing",
            "a false name": lambda r: bool(r["named"]),
        }
    if kind == "triple":
        tests = {
            "two or three right": lambda r: len(_right(r)) >= 2,
            "a wrong name": lambda r: len(_right(r)) < len(r["named"]),
        }
    return [f"{what} {rate_of(rows, test)}" for what, test in tests.items()]


def _truth(row: Row) -> set[str]:
    return set(row["truth"]["effects"])


def _names(row: Row) -> list[str]:
    return [named["name"] for named in row["named"]]


def _right(row: Row) -> set[str]:
    return set(_names(row)) & _truth(row)


def _is_in_set(row: Row) -> bool:
    return any(
        {named["name"], *(named["rivals"] if named["one_of"] else [])} & _truth(row)
        for named in row["named"]
    )


def _line(row: Row) -> str:
    truth = " + ".join(row["truth"]["effects"]) or "nothing"
    where = row["truth"]["where"]
    truth += f", drive {where}" if where else ""
    answer = "; ".join(
        f"{n['name']}, {n['where']} ({100 * n['confidence']:.0f} %"
        + (f", or {n['rivals'][0]}" if n["one_of"] else "") + ")"
        for n in row["named"]
    )  # fmt: skip
    answer = f"{answer or row['verdict']}{', something left' if row['unexplained'] else ''}"
    best = row["scores"][0]
    return f"| {row['robot']} | {truth} | {answer} | {best[0]}, {best[1]} |"
