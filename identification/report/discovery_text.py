"""A discovery as text for a terminal: the verdict first, then what supports it."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

from identification.discovery.effect_results import Gap
from identification.discovery.findings.finding import Finding
from identification.discovery.result import Discovery
from identification.prediction.result import RecordsDiscovery
from identification.quantities import held
from identification.report.discovery_errors import errors_of, times_noise
from identification.report.discovery_tables import parameters_section
from identification.report.discovery_verdict import discovery_verdict
from identification.report.effect_words import describe_effect, describe_gains, describe_rejected
from identification.report.error_words import error_words
from identification.report.failed_words import FAILED, failed_lines
from identification.report.finding_words import describe_finding
from identification.report.fitted_values import shown_values, unknown_shares
from identification.report.named_words import diff_line
from identification.report.parameter_words import words_of
from identification.report.record_gaps import record_lines
from identification.report.records_text import records_text, search_time
from identification.report.records_values import text_table
from identification.report.shown_words import shown_lines

SHOWN = 0.005  # an explanation with a smaller confidence gets no line


def discovery_text(found: Discovery | RecordsDiscovery) -> str:
    """Returns the whole outcome, in paragraphs."""
    if isinstance(found, RecordsDiscovery):
        return records_text(found)
    (title, lines), failed = describe_rejected(found), failed_lines(found)
    parts = [
        "\n".join(discovery_verdict(found)),
        "\n".join(_diff(found)),
        "\n".join(_gap(found)),
        "\n".join(record_lines(found)),
        "\n".join(_values(found)),
        _list("where the nominal model fails", found.located),
        _list("where the final model still fails", found.findings),
        "\n".join([f"{title}:", *(f"  {line}" for line in lines)]) if lines else "",
        "\n".join([f"{FAILED}:", *(f"  {line}" for line in failed)]) if failed else "",
        "\n".join(shown_lines(found.detectable)),
        search_time(found.seconds),
    ]
    return "\n\n".join(part for part in parts if part)


def _list(title: str, findings: Sequence[Finding]) -> str:
    lines = (f"  {describe_finding(finding)}" for finding in findings)
    return "\n".join([f"{title}:", *lines]) if findings else ""


def _diff(found: Discovery) -> list[str]:
    lines, words = [], words_of(found)
    for named in found.named:
        lines += [diff_line(named), f"    law: {named.candidate.effect.law}"]
        lines.append(f"    {describe_gains(named)}")
        for rival in named.rivals:
            said = f"{describe_effect(rival.candidate)}, confidence {100 * rival.confidence:.0f} %"
            lines.append(f"    rival: {said}")
        if (other := named.retuned).confidence >= SHOWN:
            lines.append(
                f"    no effect, but {words[other.parameter]} {other.distance:+z.2g} std from what"
                f" was known: confidence {100 * other.confidence:.0f} %"
            )
    return lines


def _gap(found: Discovery) -> list[str]:
    before, after = error_words([errors_of(gap, found) for gap in (found.before, found.after)])

    def line(what: str, size: str, gap: Gap) -> str:
        ratio = times_noise(gap, found)
        times = f", {held(ratio)} times the noise" if isfinite(ratio) else ""
        return f"  {what:<7}{size}{times}"

    if not found.named:
        return [f"error on unseen data:{line('', before, found.before)[8:]}"]
    told = [line("before", before, found.before), line("after", after, found.after)]
    return ["error on unseen data:", *told]


def _values(found: Discovery) -> list[str]:
    """Returns lines on each parameter as the model had it and as fitted; few of single parts."""
    found_table = parameters_section(found).table
    if found_table is None or not found_table.rows:
        return []
    rows = [[str(cell) for cell in row] for row in found_table.rows]
    words = words_of(found)
    shares = {words[name]: share for name, share in unknown_shares(found.final).items()}
    shown, rest = shown_values(rows, shares)
    return [
        "fitted values:",
        *text_table(found_table.columns, shown),
        *([f"  {rest}"] if rest else []),
    ]
