"""What is in a log as lines of text, and as plain values for JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from identification.inspection.answers import OF, Answer
from identification.inspection.inspected import Inspection
from identification.quantities import plain, plain_fields

HEAD = ("column", "role", "unit", "rate", "from", "to", "gaps", "widest", "empty")
HINT = (
    "Such a correlation is a hint and no proof: a joint that swings, or that others move, answers"
    " their inputs too, and late. fit and torques check which column is whose."
)


def rows(found: Inspection) -> list[tuple[str, ...]]:
    """Returns the rows of a table of columns, of which `HEAD` is the head."""
    return [
        (
            c.name, c.role and f"{c.role}?", c.unit and f"{c.unit}?", f"{c.rate:.4g} Hz",
            f"{c.least:.4g}", f"{c.most:.4g}", str(c.gaps), f"{c.widest:.3g} s", str(c.empty),
        )
        for c in found.columns
    ]  # fmt: skip


def sentences(found: Inspection) -> list[str]:
    """Returns what is said of a log beside the table of its columns."""
    named = f"column {found.time_column} in {found.time_unit}" if found.time_column else "declared"
    even = "even" if found.is_even else "uneven, so that the log will be put on a grid"
    out = [
        f"{found.path.name}: {len(found.time)} rows over {found.time[-1] - found.time[0]:.4g} s,"
        f" one every {found.step:.4g} s; time is the {named}, and its stamps are {even}.",
        *found.remarks,
    ]
    if found.left_out:
        out.append(f"Left out, because they hold words: {', '.join(found.left_out)}.")
    still = [c.name for c in found.columns if c.least == c.most]
    if still:
        out.append(f"Constant in all of the log: {', '.join(still)}.")
    out += answer_sentences(found.answers)
    silent = [c.name for c in found.columns if c.role == "output" and c.name not in still
              and c.name not in {a.output for a in found.answers}]  # fmt: skip
    if silent:
        out.append(f"No input of the log is clearly answered by {', '.join(silent)}.")
    return out


def answer_sentences(answers: Sequence[Answer]) -> list[str]:
    """Returns a sentence on each answer, and one on how much they tell."""
    told = [answer_sentence(answer) for answer in answers]
    return told if all(answer.is_setpoint for answer in answers) else [*told, HINT]


def answer_sentence(answer: Answer) -> str:
    """Returns which input a column answers, and what that makes of the input, in one sentence."""
    who = answer.output if answer.of == OF[0] else f"The {answer.of} of {answer.output}"
    against = " with the opposite sign" if answer.correlation < 0 else ""
    text = (
        f"{who} answers {answer.input}{against} (correlation {answer.correlation:.2f},"
        f" {1e3 * answer.lag:.0f} ms later)"
    )
    if answer.is_setpoint:
        return f"{text}, as it would answer the command of a position."
    return (
        f"{text}."
        if answer.of == OF[0] or answer.correlation < 0
        else f"{text}, as it would answer a torque, a force or a current."
    )


def inspection_to_json(found: Inspection) -> dict[str, Any]:
    """Returns what is in a log as plain values; `docs/json.md` explains the keys."""
    return {
        "file": found.path.name,
        "rows": len(found.time),
        "duration": plain(found.time[-1] - found.time[0]),
        "step": found.step,
        "time": {"column": found.time_column or None, "unit": found.time_unit,
                 "even": found.is_even},
        "columns": [
            {**plain_fields(c, "name", "rate", "least", "most", "gaps", "widest", "empty"),
             "role": c.role or None, "unit": c.unit or None}
            for c in found.columns
        ],
        "answers": [plain_fields(a, "output", "input", "correlation", "lag", "of")
                    for a in found.answers],
        "left_out": [*found.left_out],
        "remarks": [*found.remarks],
    }  # fmt: skip
