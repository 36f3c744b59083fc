"""The next experiment in sentences, and as plain values."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from identification.experiment.design import Design
from identification.experiment.limits import Margin
from identification.model.parameter import ParameterSet
from identification.quantities import alike, plain, plain_unit, quantity
from identification.report.words.errors import listed
from identification.shares import percent

FILE = "next_experiment.csv"  # in the folder of results
SAID = 4  # values that the verdict tells of, the worst-known first
SURE = 0.95  # expected probability of the right rival, below which they stay a set
BETTER = 1.05  # ratio of std, below which an experiment tells nothing of a value
UNITS = {"position": ("rad", "m"), "speed": ("rad/s", "m/s"), "input": ("", ""), "force": ("", "")}


def experiment_verdict(found: Design, at: ParameterSet) -> list[str]:
    """Returns what the experiment is, what it is expected to tell, and how near limits are."""
    log = found.best.played.log
    lasts = f"The next experiment lasts {log.duration:.4g} s"
    if found.stage.form == "inputs":
        what = f"{lasts}. Play the inputs {listed(log.input_names)} of the file unchanged."
    else:
        what = (
            f"{lasts} and is a motion for your controller to follow: the file has the positions as"
            " a reference, and the inputs that the model expects."
        )
    gain = _rivals(found) if len(found.hypotheses) > 1 else _values(found, at)
    return [
        what,
        *gain,
        *_margins(found),
        "These numbers hold for white noise that is as large as the error of the fit, and near the"
        " present values; nothing was measured yet.",
    ]


def experiment_to_json(found: Design, at: ParameterSet) -> dict[str, Any]:
    """Returns the design as plain values; see `experiment_verdict`."""
    log, first = found.best.played.log, found.hypotheses[0]
    values = first.values
    rows = zip(first.names, found.before, found.best.std, found.random.std, strict=True)
    rivals = len(found.hypotheses) > 1
    return {
        "verdict": experiment_verdict(found, at),
        "file": FILE,
        "form": found.stage.form,
        "duration": log.duration,
        "sampling_time": log.sampling_time,
        "values": {
            name: plain({"value": values[name], "unit": plain_unit(at[name].unit),
                         "before": before, "after": after, "random": random})
            for name, before, after, random in rows
        },
        "rivals": [
            plain({"name": h.name, "before": before, "after": float(after)})
            for h, before, after in zip(found.hypotheses, found.shares, found.shares_after,
                                        strict=True)
        ] if rivals else [],
        "log_odds": plain(0.5 * found.best.separations) if rivals else None,
        "random_log_odds": 0.5 * float(found.random.separations.min()) if rivals else None,
        "margins": [
            plain({"what": m.limit.what, "name": m.limit.name, "low": m.limit.low,
                   "high": m.limit.high, "least": m.least, "most": m.most, "share": m.share,
                   "of": m.limit.source})
            for m in found.best.played.margins
        ],
        "contacts": found.stage.limits.looks,
        "evaluations": found.evaluations,
        "seed": found.seed,
    }  # fmt: skip


def _rivals(found: Design) -> list[str]:
    """Returns what the experiment is expected to say of the rivals."""
    names = listed([h.name for h in found.hypotheses])
    now = listed([percent(s) for s in found.shares])
    least, λ = float(found.shares_after.min()), found.best.separations
    odds, random = 0.5 * float(λ.min()), 0.5 * float(found.random.separations.min())
    out = [
        f"It is designed to tell {names} apart, whose probabilities are {now} now. Whichever is"
        f" right, its probability is expected to be at least {percent(least)} afterwards. The log"
        f" odds between the two that are most alike are {odds:.2g}; a random experiment within the"
        f" same limits would give {random:.2g}."
    ]
    if least < SURE:
        out.append(
            "No experiment that was tried within these limits tells them apart: allow a wider range"
            " or a longer experiment, or measure something else."
        )
    return out


def _values(found: Design, at: ParameterSet) -> list[str]:
    """Returns what the experiment is expected to tell of the free values."""
    first = found.hypotheses[0]
    before, after = found.before, found.best.std
    size = np.abs(first.space.slope(first.fit.q[: len(first.names)]))
    order = np.argsort(-before / size, kind="stable")
    better = [k for k in order if before[k] > BETTER * after[k]]
    out = []
    if better:
        told = []
        for k in better[:SAID]:
            name = first.names[k]
            stds = alike([after[k], before[k]], plain_unit(at[name].unit), 2)
            told.append(f"{name} {' instead of '.join(stds)}")
        more = f" ({len(better) - SAID} more in the report)" if len(better) > SAID else ""
        gain = _mean(before[order] / after[order])
        random = _mean(found.random.std[order] / after[order])
        out.append(
            f"Expected std after it, the worst-known first: {listed(told)}{more}. On average the"
            f" std become {gain:.3g} times smaller; those of a random experiment within the same"
            f" limits would be {random:.3g} times as large."
        )
    same = [first.names[k] for k in order if k not in better]
    if same:
        it = "it" if len(same) == 1 else "them"
        out.append(
            f"It tells little more about {listed(same)}: no motion that was tried within these"
            f" limits shows {it} better than what is known already."
        )
    return out


def _mean(ratio: np.ndarray) -> float:
    """Returns the geometric mean of ratios."""
    return float(np.exp(np.mean(np.log(np.maximum(ratio, 1e-12)))))


def _margins(found: Design) -> list[str]:
    """Returns how near the simulated experiment comes to its limits."""
    out = []
    for m in found.best.played.margins[:1]:  # the nearest
        limit, unit = m.limit, limit_unit(m, found)
        end, bound = (m.least, limit.low) if m.least - limit.low <= m.left else (m.most, limit.high)
        whose = "the model's" if limit.source == "model" else "that of the logs"
        what = "the force of " if limit.what == "force" else f"the {limit.what} of "
        out.append(
            f"In the simulation it keeps all limits; the nearest is {what}{limit.name}, which"
            f" reaches {quantity(end, unit=unit)} of {quantity(bound, unit=unit)} ({whose})."
        )
    looked = "No bodies touch that do not touch at its beginning."
    none = "Contacts were not looked for, because the model has none."
    return [*out, looked if found.stage.limits.looks else none]


def limit_unit(m: Margin, found: Design) -> str:
    """Returns the unit of a limit; "" where it is not known."""
    if m.limit.what in ("input", "force"):
        return found.stage.like.units.get(m.limit.name, "") if m.limit.what == "input" else ""
    model, slide = found.stage.model, 2
    kinds = {model.joint(j).name: int(model.jnt_type[j]) for j in found.stage.limits.joints}
    return UNITS[m.limit.what][int(kinds.get(m.limit.name) == slide)]


def value_rows(found: Design, at: ParameterSet) -> Sequence[tuple[str, ...]]:
    """Returns each free value with its std before, after, and after a random experiment."""
    first = found.hypotheses[0]
    rows = zip(first.names, found.before, found.best.std, found.random.std, strict=True)
    return [
        (name, *alike([*each], plain_unit(at[name].unit), 2)) for name, *each in rows
    ]  # fmt: skip
