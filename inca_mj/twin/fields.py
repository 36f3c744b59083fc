"""MuJoCo's fields that the callbacks of the cable law touch, and the rows of a drive and a cable.

`M` and `D` hold the word offsets of the fields of mjModel and mjData. They are constants of the
compiled code; the installer checks them against live objects.
"""

from __future__ import annotations

from identification.native.access import double, integer, offsets, word
from identification.native.decorators import internal

__all__ = ["FIELDS", "D", "M", "cable", "double", "drive", "integer", "word"]

M = offsets(
    "mjModel",
    "nactuator nsensor nuser_actuator nuser_tendon nuser_sensor nuser_body"
    " actuator_user actuator_actadr actuator_trnid actuator_ctrladr actuator_ctrllimited"
    " actuator_ctrlrange actuator_gear body_user body_jntadr tendon_user tendon_adr wrap_objid"
    " ten_J_rownnz ten_J_rowadr ten_J_colind jnt_qposadr jnt_dofadr dof_damping site_bodyid"
    " site_pos sensor_type sensor_objtype sensor_objid sensor_adr sensor_user",
)
D = offsets(
    "mjData",
    "time qpos qvel act act_dot ctrl ten_length ten_velocity ten_J qfrc_passive sensordata"
    " site_xpos xpos xmat",
)
FIELDS = frozenset((*M._fields, *D._fields))  # everything the callbacks touch


@internal
def drive(m, i, column):  # type: ignore[no-untyped-def]
    """Returns a number of drive i: row i of `actuator_user`."""
    return double(m, M.actuator_user, word(m, M.nuser_actuator) * i + column)


@internal
def cable(m, k, column):  # type: ignore[no-untyped-def]
    """Returns a number of cable k: row k of `tendon_user`."""
    return double(m, M.tendon_user, word(m, M.nuser_tendon) * k + column)
