"""The law of `inca_mj.twin.callbacks`, compiled and installed in this process.

Callbacks are global in MuJoCo: `install` refuses to displace somebody else's, and models that are
not ours pass through ours untouched.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import mujoco

from identification.errors import InputError
from identification.native import structs
from identification.native.cache import compile_once
from identification.native.installer import carries, carry
from inca_mj.effects.layout import Layout
from inca_mj.twin.callbacks import SIGNATURES, callbacks
from inca_mj.twin.fields import FIELDS

_PROBE = """<mujoco>
  <size nuser_actuator="1" nuser_tendon="1" nuser_sensor="1" nuser_body="1"/>
  <worldbody><site name="a"/><body pos="1 0 0"><joint name="j"/><geom size="1"/><site name="b"/>
  </body></worldbody>
  <tendon><spatial name="t"><site site="a"/><site site="b"/></spatial></tendon>
  <actuator><general name="u" joint="j" dyntype="integrator" actdim="1"/></actuator>
  <sensor><user name="s" objtype="actuator" objname="u" dim="1"/></sensor>
</mujoco>"""


def _check_structs() -> None:
    """Every field the callbacks touch lies where they look for it.

    Raises:
        RuntimeError: it does not, or live objects do not show it.
    """
    model = mujoco.MjModel.from_xml_string(_PROBE)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    seen = structs.check(model, data)
    unseen = FIELDS - seen
    if unseen:
        raise RuntimeError(
            f"MuJoCo {mujoco.__version__} does not show {', '.join(sorted(unseen))};"
            " install the mujoco version of the lock file"
        )


@cache
def _compiled(layout: Layout) -> dict[str, Any]:
    """The callbacks of a set of effects, for this process."""
    _check_structs()
    return {
        name: _keep(name, compile_once(function, SIGNATURES[name]))
        for name, function in callbacks(layout).items()
    }


_OURS: list[Any] = []  # every callback ever compiled here; MuJoCo holds bare pointers to them


def _keep(name: str, callback: Any) -> Any:
    _OURS.append(callback)
    return carry(callback) if name == "passive" else callback


def install(layout: Layout | None = None) -> None:
    """Install the law in this process; does nothing when it is installed already.

    Args:
        layout: the candidate effects to compile into it; none when None.

    Raises:
        InputError: another library has installed MuJoCo callbacks of its own.
        RuntimeError: MuJoCo's structs are not laid out as declared.
    """
    compiled = _compiled(layout or Layout())
    for name in compiled:
        present = getattr(mujoco, f"get_mjcb_{name}")()
        known = any(present is own for own in _OURS) or carries(present)
        if present is not None and not known:
            raise InputError(
                f"another library has installed mjcb_{name}, and MuJoCo holds one a process;"
                f" release it with mujoco.set_mjcb_{name}(None), or use a process of its own"
            )
    for name, callback in compiled.items():
        getattr(mujoco, f"set_mjcb_{name}")(callback)


def uninstall() -> None:
    """Release MuJoCo's callbacks, to compare a step with the law and without it."""
    for name in SIGNATURES:
        getattr(mujoco, f"set_mjcb_{name}")(None)
