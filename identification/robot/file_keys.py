"""The keys that the TOML of a robot has, and the kind of value that each takes."""

from __future__ import annotations

from identification.robot.file_checks import Kinds

KEYS: Kinds = {
    "model": (str, "a path in quotes"),
    "outputs": (list, "a list of sensors"),
    "free": (list, "a list of parameters"),
    "own": (list, "a list of free parameters"),
    "horizon": ((int, float), "a number of seconds"),
    "every": (int, "a whole number of samples"),
    "trust": (list, "a list of words in quotes"),
    "start": (dict, "a table of numbers"),
    "log": (dict, "a table"),
    "columns": (dict, "a table"),
    "fixed": (dict, "a table of numbers"),
    "parameters": (dict, "a table of tables"),
    "own_values": (dict, "a table of tables, one for each log"),
    "spread": (dict, "a table of tables"),
    "effects": (dict, "a table"),
}
PARAMETER_KEYS: Kinds = {  # of [parameters.NAME]
    **dict.fromkeys(("path", "unit", "about"), (str, "text in quotes")),
    **dict.fromkeys(
        ("value", "prior", "known", "lower", "upper", "scale"), ((int, float), "a number")
    ),
}
EFFECTS_KEYS: Kinds = {  # of [effects]
    **dict.fromkeys(("joints", "only"), (list, "a list of names")),
    "turns": (list, "a list of numbers above zero"),
}
