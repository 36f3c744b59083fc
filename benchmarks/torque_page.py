"""The section of docs/benchmarks.md on torques, from its rows.

python benchmarks/torque_page.py
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rows import Row, rows_of, write_part
from torque_arms import LISTED, UNLISTED, UNTOLD

from identification.sweep.statistics import median, rate, said

HERE = Path(__file__).resolve().parent
BEGIN, END = "<!-- torques: begin -->\n", "<!-- torques: end -->\n"
LOADS = ("payload", "load")


def _cells(rows: Sequence[Row]) -> list[str]:
    """A column of the table of arms with as many joints."""
    loaded, empty = ([r for r in rows if bool(r["load"]) is of] for of in (True, False))
    weighed = [r for r in loaded if r["mass"] is not None]
    errors = [abs(r["mass"] / r["load"] - 1) for r in weighed]
    stds = [r["std"] / r["load"] for r in weighed]
    return [
        said(rate(loaded, lambda r: (r["first"] or "").partition(",")[0] in LOADS)),
        said(
            rate(loaded, lambda r: r["mass"] is not None and abs(r["mass"] / r["load"] - 1) < 0.05)
        ),
        f"{100 * (median(errors) or 0):.1f} %, {100 * max(errors, default=0):.0f} %",
        f"{100 * (median(stds) or 0):.1f} %",
        said(rate(weighed, lambda r: abs(r["mass"] - r["load"]) < 2 * r["std"])),
        said(rate(empty, lambda r: not r["named"])),
        f"{median([r['seconds'] for r in rows]) or 0:.1f} s",
    ]


def section(rows: Sequence[Row]) -> str:
    """The section, Markdown."""
    every = [r for r in rows if "hides" in r and r["commit"] == rows[-1]["commit"]]
    arms = [r for r in every if r["hides"] in ("payload", "nothing")]
    kinds = sorted({r["joints"] for r in arms})
    columns = [_cells([r for r in arms if r["joints"] == k]) for k in kinds]
    words = (
        "a load is first", "its mass within 5 %", "error of the mass: median, largest",
        "std of the mass, median", "mass within 2 std",
        "no name where nothing is missing, goal 95 %", "processor time, median",
    )  # fmt: skip
    lines = [
        "## Torques of arms",
        "",
        "Arms of geared joints that follow two references of five harmonics, 0.1 to 0.5 Hz, for",
        "20 s each; positions at 100 Hz with 50 µrad of noise, which the controller sees, torques",
        "with 1 %.",
        "Masses, armatures and frictions are drawn 10, 15 and 30 % about the model's; masses and",
        "armatures are free with these priors, and friction always is. A load of 10 to 20 % of the",
        "arm's mass is at the end of half of them.",
        "",
        "    python benchmarks/torques.py --first 900 --hides payload nothing --joints 2 6",
        "",
        "| | " + " | ".join(f"{k} joints" for k in kinds) + " |",
        "|---" * (len(kinds) + 1) + "|",
        *(f"| {w} | " + " | ".join(c[k] for c in columns) + " |" for k, w in enumerate(words)),
        "",
        f"{len(arms)} arms, commit {arms[-1]['commit'] if arms else '-'}. Slow motion of two joints"
        " tells little of masses: the std says so.",
        *_effects([r for r in every if r["hides"] in (*LISTED, *UNTOLD, *UNLISTED)]),
    ]
    for row in [r for r in rows if r.get("robot") == "ur10e"][-2:]:
        lines += _measured(row)
    for row in [r for r in rows if r.get("robot") == "emps"][-1:]:
        lines += _axis(row)
    return "\n".join(lines) + "\n"


def _effects(rows: Sequence[Row]) -> list[str]:
    """The table of effects that act at one joint."""
    if not rows:
        return []
    listed = [r for r in rows if r["hides"] in LISTED]
    unlisted = [r for r in rows if r["hides"] in UNLISTED]
    untold = [r for r in rows if r["hides"] in UNTOLD]
    lines = [
        "",
        "An effect at one joint of such an arm, or at its drive, of 5 to 20 % of the rms of the",
        "drive's torque (`torque_arms.py` has the equations):",
        "",
        "    python benchmarks/torques.py --joints 6 --first 900 --seeds 6 --hides cogging ...",
        "",
        "| effect | arms | right first | right among those that predict as well | nothing named |"
        " another law first | a curve first, of the same joint |",
        "|---|---|---|---|---|---|---|",
    ]
    kinds = dict.fromkeys(r["hides"] for r in (*listed, *unlisted, *untold))
    for name in kinds:
        mine = [r for r in rows if r["hides"] == name]
        lines.append(f"| {name.replace('_', ' ')} | {len(mine)} | {_counts(mine)} |")
    return [
        *lines,
        "",
        f"Of listed effects {said(rate(listed, _is_right))} are right first, and"
        f" {said(rate(listed, _is_among))} are first or predict as well as what is first;"
        f" {said(rate(listed, lambda r: not r['named']))} are not found. A bump along the position,"
        " a soft stop and a brake from a speed on are in no catalogue:"
        f" {said(rate(unlisted, _is_law))} get a law's name first, and of"
        f" {said(rate(unlisted, _has_curve))} the curve is first or predicts as well. The"
        " brake is a Stribeck peak beside viscous and Coulomb friction, but for 1 to 3 % of its"
        " power.",
        "",
        "The last three kinds have sizes that such records do not tell. Cogging of 3 to 12 periods"
        " in a turn mostly has less than two within the travel, so that it is not seen to repeat,"
        " and is no candidate: the curve is the answer. The gain of a joint that carries no weight"
        " is that of its inertia, which a free armature imitates. A delay of 0.5 to 2 ms has a std"
        " of 0.6 to 9 ms. At 3 rad/s, the fastest motion, it changes the torque by 0.6 % or less,"
        " which has noise of 1 %, and armature and friction imitate most of it.",
    ]  # fmt: skip


def _counts(rows: Sequence[Row]) -> str:
    """The cells of one effect."""
    each = (
        _is_right, lambda r: _is_among(r) and not _is_right(r), lambda r: not r["named"],
        lambda r: _is_law(r) and not _is_among(r), _is_drawn,
    )  # fmt: skip
    return " | ".join(str(sum(map(of, rows))) for of in each)


def _is_right(r: Row) -> bool:
    return bool(r["first"] == _truth(r))


def _is_among(r: Row) -> bool:
    return _truth(r) in (r["first"], *r["rivals"])


def _truth(r: Row) -> str:
    return f"{UNTOLD.get(r['hides'], r['hides'])}, {r['where']}"


def _is_law(r: Row) -> bool:
    return bool(r["named"]) and not r["first"].startswith("curve")


def _is_drawn(r: Row) -> bool:
    return bool(r["named"]) and _is_curve_of(r["first"], r)


def _has_curve(r: Row) -> bool:
    return bool(r["named"]) and any(_is_curve_of(t, r) for t in (r["first"], *r["rivals"]))


def _is_curve_of(title: str, r: Row) -> bool:
    return bool(title.startswith("curve") and title.endswith(f", joint {r['where'][-2:]}"))


def _measured(row: Row) -> list[str]:
    """The table of a measured arm, by one split of its records."""
    models: dict[str, Any] = {
        "torque": "torque", "authors": "the authors' parameters", "model": "the model, fitted",
        "base_fit": "all inertial numbers free", "final": "with what was found",
    }  # fmt: skip
    return [
        "",
        f"UR10e, fitted to {' and '.join(row['fitted'])}, {row['seconds']:.0f} s of processor time,"
        f" commit {row['commit']}: {'; '.join(row['named'])}. Rms of the two other records [N m]:",
        "",
        "| | " + " | ".join(j.replace("_", " ") for j in row["joints"]) + " |",
        "|---" * (len(row["joints"]) + 1) + "|",
        *(f"| {w} | " + " | ".join(f"{x:.2f}" for x in row[k]) + " |" for k, w in models.items()),
    ]


def _axis(row: Row) -> list[str]:
    """The table of EMPS."""
    cells = [
        f"| {name} | {value:.1f} ± {std:.1f} | {published} |"
        for (name, (value, std)), published in zip(
            row["values"].items(), row["published"], strict=False
        )
    ]
    return [
        "",
        f"EMPS, {row['seconds']:.1f} s of processor time, commit {row['commit']}:"
        f" {'; '.join(row['named'])} (published: -36.85 N s/m). Residual force of unseen records"
        f" {row['model'][0]:.2f} N, with what was found {row['final'][0]:.2f} N.",
        "",
        "| | by torques | published |",
        "|---|---|---|",
        *cells,
    ]


def main() -> None:
    """Write the section."""
    rows = rows_of(HERE / "results" / "torques.jsonl")
    write_part(HERE.parent / "docs" / "benchmarks.md", BEGIN, END, section(rows))


if __name__ == "__main__":
    main()
