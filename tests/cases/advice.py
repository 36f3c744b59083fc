"""The TOML that a message tells a user to write beside his log, and what it makes of the log."""

import re

_LINE = r'(?:"[^"]*"|[\w-]+) = (?:"[^"]*"|-?\d+(?:\.\d+)?(?:e-\d+)?)'
_LINES = rf"write ({_LINE}(?:(?:, | and ){_LINE})*)"


def advised(message: str) -> str:
    """The tables of the TOML in a message, its lines as they stand there."""
    found = [
        (table, lines)
        for lines, table in re.findall(
            rf"{_LINES}(?: \(a line each\))? under \[(units|factors|zeros)\]", message
        )
    ]
    found += [
        (table, lines)
        for table, lines in re.findall(rf"under \[(columns)\] of the log's TOML: {_LINES}", message)
    ]
    return "\n".join("\n".join([f"[{table}]", *re.findall(_LINE, lines)]) for table, lines in found)
