"""MuJoCo's structs from compiled callbacks: their fields at constant offsets.

`M` and `D` hold the word offsets of the fields of mjModel and mjData that the callbacks touch,
frozen into the compiled code; `native` checks them against live objects.
"""

from __future__ import annotations

from collections import namedtuple
from typing import Any

import numpy as np
from numba import njit

from inca_mj import structs
from inca_mj.memory import load_constant, load_int, load_word


def _offsets(struct: str, names: str) -> Any:
    fields = names.split()
    kind: Any = namedtuple(struct, fields)  # type: ignore[misc]
    return kind(*(structs.word(struct, n) for n in fields))


M = _offsets(
    "mjModel",
    "nactuator nsensor nuser_actuator nuser_tendon nuser_sensor nuser_body"
    " actuator_user actuator_actadr actuator_trnid actuator_ctrladr actuator_ctrllimited"
    " actuator_ctrlrange actuator_gear body_user body_jntadr tendon_user tendon_adr wrap_objid"
    " ten_J_rownnz ten_J_rowadr ten_J_colind jnt_qposadr jnt_dofadr site_bodyid"
    " sensor_type sensor_objtype sensor_objid sensor_adr sensor_user",
)
D = _offsets(
    "mjData",
    "time qpos qvel act act_dot ctrl ten_length ten_velocity ten_J qfrc_passive sensordata"
    " site_xpos xpos xmat",
)
FIELDS = {*M._fields, *D._fields}  # everything the callbacks touch


@njit
def word(struct, at):  # type: ignore[no-untyped-def]
    """A size, or the address of an array."""
    return load_word(struct + 8 * at)


@njit
def double(struct, at, i):  # type: ignore[no-untyped-def]
    """Entry i of an array of doubles that no callback writes."""
    return load_constant(load_word(struct + 8 * at) + 8 * i)


@njit
def integer(struct, at, i):  # type: ignore[no-untyped-def]
    """Entry i of an array of ints."""
    return np.int64(load_int(load_word(struct + 8 * at) + 4 * i))


@njit
def drive(m, i, column):  # type: ignore[no-untyped-def]
    """A number of drive i: row i of `actuator_user`."""
    return double(m, M.actuator_user, word(m, M.nuser_actuator) * i + column)


@njit
def cable(m, k, column):  # type: ignore[no-untyped-def]
    """A number of cable k: row k of `tendon_user`."""
    return double(m, M.tendon_user, word(m, M.nuser_tendon) * k + column)
