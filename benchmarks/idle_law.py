"""Callbacks that compute less than the law: what a step with callbacks takes at least.

idle            every callback returns at once
exponentials    and the passive force takes the one exponential of each drive's friction
"""

from __future__ import annotations

from math import exp
from typing import Any

import mujoco

from identification.native import structs
from identification.native.cache import compile_once
from identification.native.memory import load_double, store_double
from identification.native.table import SIGNATURES
from inca_mj.robot import law
from inca_mj.twin.drives import FIELDS, D, M, double, drive, integer, word

KINDS = ("passive", "act_dyn", "act_bias")


def _idle(m, d):  # type: ignore[no-untyped-def]
    return


def _zero(m, d, i):  # type: ignore[no-untyped-def]
    return 0.0


def _exponentials(m, d):  # type: ignore[no-untyped-def]
    for i in range(word(m, M.nactuator)):
        at = integer(m, M.jnt_dofadr, integer(m, M.actuator_trnid, 2 * i))
        x = exp(2.0 * drive(m, i, law.BETA) * double(d, D.qvel, at))
        force = word(d, D.qfrc_passive) + 8 * at
        store_double(force, load_double(force) + 0.0 * x)


def compiled(exponentials: bool) -> dict[str, Any]:
    """The callbacks by their kind, compiled."""
    structs.require(FIELDS)
    passive = _exponentials if exponentials else _idle
    functions = {"passive": passive, "act_dyn": _zero, "act_bias": _zero}
    return {kind: compile_once(functions[kind], SIGNATURES[kind]) for kind in KINDS}


def held() -> dict[str, Any]:
    """The callbacks that MuJoCo holds now."""
    return {kind: getattr(mujoco, f"get_mjcb_{kind}")() for kind in KINDS}


def hold(callbacks: dict[str, Any]) -> None:
    """Let MuJoCo hold callbacks, None for none."""
    for kind in KINDS:
        getattr(mujoco, f"set_mjcb_{kind}")(callbacks[kind])
