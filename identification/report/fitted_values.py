"""The fitted values as a terminal shows them: of many single parts only the worst known.

A parameter whose name has an @ and no dot is the deviation of one drive or the displacement of one
point. There are 96 of them where all drives and points of INCA may differ.

    s_i / s_i,prior        1: the log says nothing of parameter i; 0: it says all
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from identification.kalman.refit import Refit

FEW = 3  # single parts that are shown where there are more than MANY
MANY = 8


def unknown_shares(fit: Refit) -> dict[str, float]:
    """Returns the std of each single part's parameter over the std known before, by name."""
    names, left = fit.point.space.names, (fit.std * fit.prior).tolist()
    return {n: s for n, s in zip(names, left, strict=True) if "@" in n and "." not in n}


def shown_values(
    rows: Sequence[Sequence[str]], shares: Mapping[str, float]
) -> tuple[list[Sequence[str]], str]:
    """Returns the rows that matter, and a sentence on those that are left out.

    Args:
        rows: of a table of parameters; each begins with what the parameter is called.
        shares: see `unknown_shares`, by what the table calls them.

    Returns:
        All rows but those of single parts that are better known than the worst few, and "" where
        no row is left out.
    """
    if len(shares) <= MANY:
        return list(rows), ""
    worst = sorted(shares, key=lambda name: shares[name], reverse=True)[:FEW]
    shown = [row for row in rows if row[0] not in shares or row[0] in worst]
    return shown, (
        f"Of {len(shares)} deviations of single drives and displacements of single points only the"
        f" {FEW} worst known are shown; all of them stand in the report that --out keeps."
    )
