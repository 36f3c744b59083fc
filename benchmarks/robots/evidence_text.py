"""What else the records of a robot show, in tables: one function for each kind of evidence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robots.words import number, table


def evidence_lines(name: str, evidence: dict[str, Any]) -> list[str]:
    """The lines of a robot's evidence; none where it has none."""
    if not evidence or name not in _KINDS:
        return []
    return ["### What else these records show\n", *_KINDS[name](evidence)]


def _free_runs(evidence: dict[str, Any], unit: str, tests: tuple[str, ...]) -> list[str]:
    """Free runs, beside those of others."""
    ours, others = evidence[f"free_run_{unit}"], evidence[f"published_{unit}"]
    rows = []
    for who, each in (("here", ours), ("published", others)):
        for model, value in each.items():
            cells = value if isinstance(value, list) else [value]
            rows.append((who, model, *(f"{v:.3g}" for v in cells)))
    return [table(("who", "model", *(f"{t} [{unit}]" for t in tests)), rows)]


def _emps(evidence: dict[str, Any]) -> list[str]:
    return [
        "Rms error of a free run of the record with pulses, 25 s, by the protocol of others: fitted"
        " to the free run of the other record.\n",
        *_free_runs(evidence, "mm", ("pulses",)),
    ]


def _silverbox(evidence: dict[str, Any]) -> list[str]:
    return [
        "Rms error of a free run of the official tests, the first 50 samples not counted.\n",
        *_free_runs(evidence, "mV", ("multisine", "arrow")),
    ]


def _pendulum(evidence: dict[str, Any]) -> list[str]:
    x, heavy, nominal = evidence["physics"], evidence["heavy"], evidence["nominal"]
    lines = [
        "Inverse dynamics of two records with trajectories of torque (ddp, direct_collocation),"
        " compared below 3 Hz, gives "
        + ", ".join(f"{n} {v:.3g}" for n, v in x.items())
        + f" (SI); 0.5 kg at 0.5 m alone would be J {nominal['J']:.3g}, m l {nominal['m l']:.3g}."
        f" With 1 kg: J {heavy['J']:.3g}, m l {heavy['m l']:.3g}, which is"
        f" {heavy['J'] / x['J']:.2f} and {heavy['m l'] / x['m l']:.2f} times as much.\n",
        "With these numbers, the torque [N m] of each record, what is left of it, and the shift of"
        " torque against motion with which least is left (positive: the motion is stamped late)."
        " A shift that grows with the frequency is a vibration of the arm, and no delay.\n",
    ]
    for band, records in evidence["records"].items():
        rows = [
            (name, *(f"{r[k]:.2f}" for k in ("torque", "left", "left_shifted")),
             f"{r['shift_ms']:.0f} ms")
            for name, r in records.items()
        ]  # fmt: skip
        head = (f"below {band}", "torque", "left", "left when shifted", "shift")
        lines.append(table(head, rows))
    return lines


def _double_pendulum(evidence: dict[str, Any]) -> list[str]:
    lines = [
        "Inverse dynamics with the authors' equations and numbers: rms torque that was measured at"
        " both joints, that the motion needs without friction (model 2.0), and that is left after"
        " their models with their friction [N m]. In"
        f" {' and '.join(evidence['unpowered'])} nothing is asked of motor 1.\n"
    ]
    for band, records in evidence["bands"].items():
        rows = []
        for name, r in records.items():
            for k in (0, 1):
                cells = (r["torque"][k], r["needed"][k], r["left"]["1.0"][k], r["left"]["2.0"][k])
                rows.append((name, str(k + 1), *(f"{v:.3f}" for v in cells)))
        head = (f"below {band}", "joint", "measured", "needed", "left by 1.0", "left by 2.0")
        lines.append(table(head, rows))
    return lines


def _ur10e(evidence: dict[str, Any]) -> list[str]:
    rows = []
    for name, r in evidence["records"].items():
        rows.append((name, "torque", *(f"{v:.2f}" for v in r["torque"])))
        rows += [("", m, *(f"{v:.2f}" for v in left)) for m, left in r["left"].items()]
    shares = [
        number(mu, std, "") if std else "carries none"
        for mu, std in zip(evidence["mu"], evidence["mu_std"], strict=True)
    ]
    return [
        f"Torque by inverse dynamics, compared below {evidence['band_hz']:g} Hz: rms of K i and of"
        " what is left of it, by joint [N m].\n",
        table(("record", "", *evidence["joints"]), rows),
        "Friction that grows with gravity's load, by least squares to the fitted records: "
        + ", ".join(f"{j} {s}" for j, s in zip(evidence["joints"], shares, strict=True))
        + ".\n",
    ]


def _xl330(evidence: dict[str, Any]) -> list[str]:
    models = evidence["mean_absolute_mrad"]
    first = next(iter(models.values()))
    rows = [(log, *(f"{each[log]:.1f}" for each in models.values())) for log in first]
    return [
        "The authors fitted free runs with the servo's own controller in the loop, which makes up"
        " for a wrong gain of the motor. Mean absolute error of their models by that protocol, on"
        " whole records [mrad]. The history of their repository has other versions of these numbers"
        " (June and July 2026); none of them predicts the windows above better.\n",
        table(("unseen record", *models), rows),
    ]


_KINDS: dict[str, Callable[[dict[str, Any]], list[str]]] = {
    "xl330": _xl330, "emps": _emps, "silverbox": _silverbox, "pendulum": _pendulum,
    "double_pendulum": _double_pendulum, "ur10e": _ur10e,
}  # fmt: skip
