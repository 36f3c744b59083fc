"""A discovery as text for a terminal: the verdict first, then what supports it."""

from __future__ import annotations

from math import isfinite
from typing import Any

from identification.discovery.result import Discovery, Gap
from identification.quantities import alike, quantity
from identification.report.discovery_verdict import (
    diff_line,
    discovery_verdict,
    floor_rms,
    split_detectable,
)
from identification.report.discovery_words import not_believed, phrase

SHOWN = 0.005  # chance of an explanation that is worth a line


def discovery_text(found: Discovery) -> str:
    """All of it, in paragraphs."""
    title, lines = not_believed(found)
    parts = [
        "\n".join(discovery_verdict(found)),
        "\n".join(_diff(found)),
        "\n".join(_gap(found)),
        "\n".join(["where the nominal model fails:", *(f"  {s}" for s in found.located)])
        if found.located
        else "",
        "\n".join(["where the final model still fails:", *(f"  {s}" for s in found.left)])
        if found.left
        else "",
        "\n".join([f"{title}:", *(f"  {line}" for line in lines)]) if lines else "",
        "\n".join(_detectable(found)),
        f"{sum(found.seconds.values()):.1f} s",
    ]
    return "\n\n".join(part for part in parts if part)


def _diff(found: Discovery) -> list[str]:
    lines = []
    for named in found.named:
        lines += [diff_line(named), f"    law: {named.candidate.effect.law}"]
        gains = f"    gain {named.gain:.4g} on fitted samples, {named.proof.gain:.4g} on unseen"
        lines.append(f"{gains} (t = {named.proof.t:.1f})")
        lines += [f"    rival: {phrase(r.candidate)}, confidence {100 * r.confidence:.0f} %"
                  for r in named.rivals]  # fmt: skip
        if (other := named.retuned).confidence >= SHOWN:
            lines.append(
                f"    no effect, but {other.parameter} {other.distance:+.2g} std from what was"
                f" known: confidence {100 * other.confidence:.0f} %"
            )
    return lines


def _gap(found: Discovery) -> list[str]:
    unit, floor = found.log.output_unit, floor_rms(found)

    before, after = alike([found.before.rms, found.after.rms], unit)

    def line(what: str, size: str, gap: Gap) -> str:
        times = f", {gap.rms / floor:.3g} times the noise" if floor > 0 else ""
        return f"  {what:<7}{size} rms{times}"

    out = ["error on unseen data:", line("before", before, found.before)]
    return [*out, line("after", after, found.after)] if found.named else out


def _detectable(found: Discovery) -> list[str]:
    seen, blind = split_detectable(found.detectable)
    if not found.detectable:
        return []
    lines = ["what this log would have shown in 9 cases of 10, and what not:"]
    width = max(len(d.candidate.effect.name) for d in found.detectable)
    for d in seen:
        lines.append(f"  {d.candidate.effect.name:<{width}}  {d.size} >="
                     f" {quantity(d.smallest, unit=d.unit)}")  # fmt: skip
    lines += [f"  {d.candidate.effect.name:<{width}}  {d.size}: not at any plausible size"
              for d in blind]  # fmt: skip
    return lines


def finite(value: Any) -> Any:
    """Plain values with None for every number that is not finite."""
    if isinstance(value, dict):
        return {k: finite(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [finite(v) for v in value]
    return None if isinstance(value, float) and not isfinite(value) else value
