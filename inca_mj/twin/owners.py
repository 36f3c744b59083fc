"""Which numbers of a model one drive alone reads, so that its share is all that they change."""

from __future__ import annotations

import mujoco

from identification.native.share import is_balanced_rotor
from inca_mj.effects.layout import KEY
from inca_mj.robot import law


def owners(model: mujoco.MjModel, key: float) -> dict[tuple[str, int], int]:
    """Returns which numbers of a model a drive of a law alone reads, by array and row.

    Args:
        model: any model; one that is no twin, or has another set of effects, has none of these.
        key: of the set.
    """
    out: dict[tuple[str, int], int] = {}
    if model.nuser_actuator < law.ACTUATOR_COLUMNS or model.nuser_tendon < law.TENDON_COLUMNS:
        return out
    cables = model.actuator_user[:, law.CABLE].tolist()
    if len({*model.wrap_objid.tolist()}) < model.nwrap or len({*cables}) < len(cables):
        return out  # two cables end at one point, or two drives pull at one cable
    for i, row in enumerate(model.actuator_user):
        if row[law.ACTUATOR_TAG] == law.TAG and (row[KEY] if len(row) > KEY else 0.0) == key:
            k, joint = int(row[law.CABLE]), model.actuator_trnid[i, 0]
            a, b = model.wrap_objid[model.tendon_adr[k] : model.tendon_adr[k] + 2]
            if model.body_weldid[model.site_bodyid[a]] or model.tendon_num[k] != 2:
                continue  # a share takes the cable from one point to the other, the first at rest
            out |= {
                ("actuator_user", i): i, ("actuator_gear", i): i, ("tendon_user", k): i,
                ("dof_damping", int(model.jnt_dofadr[joint])): i,
                ("site_pos", int(a)): i, ("site_pos", int(b)): i,
            }  # fmt: skip
            if is_balanced_rotor(model, joint):
                out["qpos", int(model.jnt_qposadr[joint])] = i
                out["qvel", int(model.jnt_dofadr[joint])] = i
    return out
