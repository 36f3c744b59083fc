"""Where effects may act, with the suffix of their parameters' names."""

from inca_mj.robot.geometry import DRIVES

_EACH = {f"drive {k}": f"@{k}" for k in range(1, DRIVES + 1)}

DRIVES_EACH = {"all drives": "", **_EACH}  # on all alike, or on one
ONE_DRIVE = _EACH  # on one only: common to all, it would be a base parameter
CABLES = {"all cables": ""}
PLATFORM = {"platform": ""}
