"""The section of the page on hidden joints, Markdown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from joint_sets import MISSED, sets_of
from joint_statistics import Row, summary

from identification.sweep.statistics import said

ROWS = (
    ("right_first", "the right name first, goal 93 %"),
    ("right_or_alike", "or in a set of two"),
    ("wrong_first", "a wrong name first"),
    ("right_refused", "the right law refused as the name of a neighbour"),
    ("further_names", "further names beside a right one"),
    ("place_right", "the right joint, when named right"),
    ("null_silent", "no name where nothing is hidden, goal 97 %"),
    ("worse_than_fit", "the other record predicted worse than by `fit`, goal none"),
    ("fit_worse_than_written", "`fit` predicts it worse than the values it began with"),
)


ABOUT_UNLISTED = (
    "Forces that are in no catalogue (`benchmarks/joint_worlds/laws.py`): a place where",
    "something catches (bump), a soft stop, a brake that acts from a speed on (fast), a torque",
    "that follows the position (beside) or the speed (drag) of a neighbouring joint, and a",
    "viscous friction that waves along the way (ripple), which no curve can draw.",
)
UNLISTED_ROWS = (
    ("law_named", "a law is named, which is wrong, goal 4 % at most"),
    ("law_refused", "a law refused as the name of a neighbour"),
    ("drawn", "drawn as a curve at the right joint, and no law is named"),
    ("drawn_over_cause", "and over what the force depends on, where a curve can draw it"),
    ("unknown", '"unknown effect"'),
    ("drawn_or_unknown", "one of both, goal 92 %"),
    ("missed", '"nothing missing"'),
    ("worse_than_fit", "the other record predicted worse than by `fit`"),
)


ABOUT_SEVERAL = (
    "Three effects of the catalogue at once, each of which alone would show 3 to 10 times what",
    "the true model errs by. An effect counts as named where its name, or the one that the",
    "records cannot tell from it, is said at the right place.",
)
SEVERAL_ROWS = (
    ("all_found", "all three are named, each where it acts, goal 60 %"),
    ("most_found", "two or three are, goal 85 %"),
    ("false_name", "a law is named that does not act"),
    ("all_said", "nothing is said to be left although something is, goal 10 % at most"),
    ("drawn", "a part is drawn as a curve"),
    ("worse_than_fit", "the other record predicted worse than by `fit`"),
)


def section(rows: Sequence[Row]) -> str:
    """The section of the page, Markdown."""
    found = summary(rows)
    robots = [n for n in ("pendulum", "cart", "two_link", "arm") if n in found]
    columns = [*robots, "all"]
    lines = [
        "## Hidden effects of other robots",
        "",
        "A pendulum, a cart on a rail, a two-link arm and an arm of six joints under control,",
        "12 to 20 s at 100 or 200 Hz, in simulators of their own (`benchmarks/joint_worlds`):",
        "parameters within 10 % of the nominal model, controllers with a wrong model,",
        "encoders that round, unlogged coloured torque of 0.2 to 1 % of the input. One effect",
        "is hidden, 3 to 10 times what the true model errs by over 0.2 s, counted by what no",
        "free parameter and no start of a window imitates. One record is fitted, another",
        "judges. A constant force that is smaller than the Coulomb level, and a level that",
        "differs by direction, are one force by two names",
        "(`identification/prediction/judging/trial.py`): either is right.",
        "",
        "    python benchmarks/hidden_joints.py",
        "",
    ]
    if not rows:
        return "\n".join([*lines, "No world has been answered by the present search."]) + "\n"
    lines += [
        "| | " + " | ".join(c.replace("_", " ") for c in columns) + " |",
        "|---" * (len(columns) + 1) + "|",
    ]
    for key, words in ROWS:
        lines.append(f"| {words} | " + " | ".join(said(found[c][key]) for c in columns) + " |")
    times = " | ".join(
        "-" if found[c]["longest"] is None
        else f"{found[c]['processor_seconds']:.0f} s, {found[c]['longest']:.0f} s"
        for c in columns
    )  # fmt: skip
    lines += [
        f"| processor time of fit and discovery: median, longest | {times} |",
        "",
        f"{found['worlds']} worlds of the search of {rows[-1].get('commit')}, with records of"
        f" {_durations(rows)};"
        f" {found['failed']} more met an error, and {found['unseen']} could not be made because no"
        " size shows enough.",
        "",
        "| hidden | first name or verdict |",
        "|---|---|",
    ]
    for true, counts in found["confusion"].items():
        lines.append(f"| {true} | " + ", ".join(f"{n} {k}" for k, n in counts.items()) + " |")
    lines += ["", "| confidence of the first name | right |", "|---|---|"]
    lines += [f"| {band} | {said(share)} |" for band, share in found["reliability"].items()]
    lines += _of_sets(sets_of([r for r in rows if "verdict" in r]))
    if found["unlisted"]["all"]["law_named"]["of"]:
        lines += _lines(ABOUT_UNLISTED, UNLISTED_ROWS, found["unlisted"])
    if found["several"]["all"]["all_found"]["of"]:
        lines += _lines(ABOUT_SEVERAL, SEVERAL_ROWS, found["several"])
    return "\n".join(lines) + "\n"


def _durations(rows: Sequence[Row]) -> str:
    """Returns how many worlds have records of which duration, in words."""
    counts = Counter(r["duration"] for r in rows if "verdict" in r)
    return " and ".join(f"{d:g} s ({n})" for d, n in sorted(counts.items()))


def _lines(
    about: Sequence[str], rows: Sequence[tuple[str, str]], found: Mapping[str, Any]
) -> list[str]:
    """Returns a part of the section: what it is about, and a table of rates by robot."""
    first = rows[0][0]
    columns = [n for n in found if found[n][first]["of"]]
    return [
        "", *about, "",
        "| | " + " | ".join(c.replace("_", " ") for c in columns) + " |",
        "|---" * (len(columns) + 1) + "|",
        *(f"| {words} | " + " | ".join(said(found[c][key]) for c in columns) + " |"
          for key, words in rows),
    ]  # fmt: skip


def _of_sets(found: Mapping[str, Any]) -> list[str]:
    """Returns what sets of names hold; nothing where no law is named."""
    if found["coverage"] is None:
        return []
    low, high = (100 * found[end] for end in ("low", "high"))
    return [
        "",
        f"Where one effect acts and a law is named, the true name is among the names in"
        f" {said(found['compared'])} worlds. A set of all names with a share of the odds of at"
        f" least {found['threshold']:.2f} holds it with a probability of {1 - MISSED:.0%}"
        f" (`benchmarks/joint_sets.py`): with the threshold from one half of the worlds, the sets"
        f" of the other half hold {found['size']:.2f} names, and the true one in"
        f" {found['coverage']:.0%} of worlds, on average over halvings, of which nine of ten give"
        f" {low:.0f} to {high:.0f} %.",
    ]
