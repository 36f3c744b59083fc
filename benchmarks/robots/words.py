"""Numbers and tables of the page of measured robots, in Markdown."""

from __future__ import annotations

from collections.abc import Sequence

from identification.quantities import plain_unit

PREFIXES = ((1e-6, "µ"), (1e-3, "m"), (1.0, ""))


def amount(value: float, unit: str) -> str:
    """A size of an error in a unit that suits it: 0.0132 rad is 13.2 mrad."""
    if unit not in ("m", "rad", "V"):
        return f"{value:.3g} {unit}".strip()
    factor, prefix = max(
        (p for p in PREFIXES if p[0] <= abs(value)), key=lambda p: p[0], default=PREFIXES[0]
    )
    return f"{value / factor:.3g} {prefix}{unit}"


def number(value: float | None, std: float | None, unit: str) -> str:
    """A value, its std where there is one, and its unit; empty where there is no value."""
    if value is None:
        return ""
    said = f"{value:.4g}" + (f" ± {std:.2g}" if std is not None else "")
    return f"{said} {plain_unit(unit)}".strip()


def percent(share: float) -> str:
    """A relative change."""
    return f"{100 * share:+.0f} %"


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table."""
    lines = [" | ".join(head), " | ".join(["---"] * len(head)), *(" | ".join(r) for r in rows)]
    return "\n".join(f"| {line} |" for line in lines) + "\n"
