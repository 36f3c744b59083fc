"""Shares and ratios in words: percent below one, times above; nothing that rounding alone makes so.

0.12 -> 12 %      0.9964 -> 99.6 %      0.9998 -> more than 99.9 %      0.002 -> less than 1 %

No number has a power of ten. All is said to be 100 % only where it is all, and nothing to be 0 %
only where it is nothing.
"""

from __future__ import annotations

from math import floor, isfinite, log10

WHOLE = 0  # digits: whole percents
HELD = 2  # digits of a ratio
_LEAST = 1e-3  # percent: smaller shares are less than it
_ALMOST = 0.9995  # larger shares, but for all, are more than 99.9 %
_MOST = 15  # decimals, beyond which a number of a computer has none


def percent(share: float, digits: int = WHOLE) -> str:
    """Returns a share in percent, such as "12 %" or "more than 99.9 %".

    Args:
        share: of one; it may be larger than one, or negative.
        digits: of the percentage, without leading zeros; 0 for whole percents.
    """
    if not isfinite(share):
        return "unknown"
    least = 1.0 if digits == WHOLE else _LEAST
    text = f"{100 * share:z.0f}" if digits == WHOLE else decimal(100 * share, digits)
    if share > 0 and (text == "0" or 100 * share < least / 2):
        return f"less than {decimal(least, 1)} %"
    if share < 1 and text == "100":
        return f"{100 * share:.1f} %" if share < _ALMOST else "more than 99.9 %"
    return f"{text} %"


def ratio_of(ratio: float, whole: str) -> str:
    """Returns a ratio to something in words: "80 % of their rms", "8 times their rms".

    Args:
        ratio: not negative.
        whole: what it is a ratio to.
    """
    if ratio < 0.995:
        return f"{percent(ratio, HELD)} of {whole}"
    return f"as much as {whole}" if ratio < 1.05 else f"{times(ratio)} {whole}"


def times(ratio: float) -> str:
    """Returns a ratio with two digits, such as "8.3 times"."""
    return f"{decimal(ratio, HELD)} times" if isfinite(ratio) else "infinitely many times"


def times_noise(ratio: float, noise: str = "the noise") -> str:
    """Returns the ratio of an error to noise in words: "3.4 times the noise".

    Where two digits say one, it is "as small as the noise".
    """
    return f"as small as {noise}" if 0.95 <= ratio < 1.05 else f"{times(ratio)} {noise}"


def times_estimated(ratio: float) -> str:
    """Returns the ratio of an error to the noise as a number: "1.02 times the estimated noise".

    It says nothing of whether the error is noise, of which something may be named.
    """
    return f"{decimal(ratio, 3)} times the estimated noise"


def change(rise: float) -> str:
    """Returns a relative change in words: "-12 %", "less by 99.6 %", "3 times as large"."""
    if not isfinite(rise):
        return "unknown"
    if rise >= 0.995:
        return f"{times(1 + rise)} as large"
    if -1 < rise <= -0.995:
        return f"less by {percent(-rise)}"
    return f"{100 * rise:+z.0f} %"


def fall_words(fall: float, digits: int = WHOLE) -> str:
    """Returns the relative change of a mean square in words: "falls by 12 %", "rises by 3 %".

    Args:
        fall: relative; negative where the mean square rises.
        digits: see `percent`.
    """
    if fall <= -0.995:
        return f"rises to {times(1 - fall)} what it was"
    if abs(fall) < (0.005 if digits == WHOLE else _LEAST / 200):
        return "stays the same"
    return f"{'falls' if fall > 0 else 'rises'} by {percent(abs(fall), digits)}"


def decimal(value: float, digits: int) -> str:
    """Returns a finite number with some digits, without a power of ten and without last zeros."""
    rounded = float(f"{value:.{digits}g}")
    if rounded == 0:
        return "0"
    places = min(max(0, digits - 1 - floor(log10(abs(rounded)))), _MOST)
    text = f"{rounded:z.{places}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text
