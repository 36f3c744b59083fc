"""The places of fields in MuJoCo's C structs, for compiled callbacks that get bare pointers.

Offsets come from the declarations shipped with MuJoCo (`mujoco.introspect.structs`), laid out
by ctypes with the platform's C rules, and are checked against live pointers before use.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterable
from functools import cache

import mujoco
import numpy as np
from mujoco.introspect import ast_nodes, structs

# A model whose live objects show every field that a callback may touch.
_PROBE = """<mujoco>
  <option integrator="RK4"/>
  <size nuser_jnt="1" nuser_actuator="1" nuser_tendon="1" nuser_sensor="1" nuser_body="1"/>
  <worldbody><site name="a"/><body pos="1 0 0"><joint name="j" frictionloss="1"/><geom size="1"/>
  <site name="b"/></body></worldbody>
  <tendon><spatial name="t"><site site="a"/><site site="b"/></spatial></tendon>
  <actuator>
    <general name="u" joint="j" dyntype="integrator" actdim="1" ctrlrange="-1 1"
             forcerange="-1 1"/>
  </actuator>
  <sensor><user name="s" objtype="actuator" objname="u" dim="1"/></sensor>
</mujoco>"""

_C_TYPES: dict[str, type] = {
    "int": ctypes.c_int,
    "unsigned int": ctypes.c_uint,
    "char": ctypes.c_char,
    "unsigned char": ctypes.c_ubyte,
    "float": ctypes.c_float,
    "double": ctypes.c_double,
    "size_t": ctypes.c_size_t,
    "uintptr_t": ctypes.c_size_t,
    "int64_t": ctypes.c_int64,
    "uint64_t": ctypes.c_uint64,
    "mjtNum": ctypes.c_double,
    "mjtSize": ctypes.c_int64,
    "mjtByte": ctypes.c_ubyte,
    "mjtBool": ctypes.c_bool,
}


def _c_type(declared: ast_nodes.ValueType) -> type:
    if isinstance(declared, ast_nodes.PointerType):
        return ctypes.c_void_p
    if isinstance(declared, ast_nodes.ArrayType):
        array = _c_type(declared.inner_type)
        for extent in reversed(declared.extents):
            array = array * extent
        return array
    if isinstance(declared, ast_nodes.AnonymousStructDecl):
        fields = [(f.name, _c_type(f.type)) for f in declared.fields]
        return type("anonymous", (ctypes.Structure,), {"_fields_": fields})
    name = declared.name.removeprefix("struct ").rstrip("_")
    if name in _C_TYPES:
        return _C_TYPES[name]
    if name in structs.STRUCTS:
        return layout(name)
    if name.startswith("mjt"):  # an enumeration
        return ctypes.c_int
    raise NotImplementedError(f"C type {name} of MuJoCo {mujoco.__version__}")


@cache
def layout(struct: str) -> type[ctypes.Structure]:
    """Returns the ctypes layout of a MuJoCo struct, e.g. "mjModel"."""
    fields = [(f.name, _c_type(f.type)) for f in structs.STRUCTS[struct].fields]
    return type(struct, (ctypes.Structure,), {"_fields_": fields})


def word(struct: str, field: str) -> int:
    """Returns the offset of a pointer or size field in 8-byte words."""
    offset = getattr(layout(struct), field).offset
    if offset % 8:
        raise NotImplementedError(f"{struct}.{field} is at byte {offset}, not on a word")
    return offset // 8


def byte(struct: str, field: str) -> int:
    """Returns the offset of a field in bytes, e.g. of a whole number of 32 bits."""
    return int(getattr(layout(struct), field).offset)


def option_byte(name: str) -> int:
    """Returns the offset in bytes of a field of mjModel's options, e.g. opt.integrator."""
    declared = next(f for f in structs.STRUCTS["mjModel"].fields if f.name == "opt").type
    inside = getattr(_c_type(declared), name).offset
    return int(layout("mjModel").opt.offset + inside)


def check(model: mujoco.MjModel, data: mujoco.MjData) -> set[str]:
    """Compare every offset that live objects show with the declared one.

    Returns:
        The names of the fields that agreed.
    """
    agreed: set[str] = set()
    for struct, live in (("mjModel", model), ("mjData", data)):
        for field in structs.STRUCTS[struct].fields:
            seen = getattr(live, field.name, None)
            at = live._address + getattr(layout(struct), field.name).offset
            if isinstance(seen, np.ndarray) and isinstance(field.type, ast_nodes.PointerType):
                pointer = ctypes.c_void_p.from_address(at).value
                if not seen.size or pointer is None:  # None: in the arena, not allocated yet
                    continue
                right = pointer == seen.ctypes.data
            elif isinstance(seen, (int, float)) and not isinstance(seen, bool):
                if not isinstance(field.type, ast_nodes.ValueType):
                    continue
                right = _c_type(field.type).from_address(at).value == seen  # type: ignore[attr-defined]
            else:
                continue
            if not right:
                raise RuntimeError(
                    f"{struct}.{field.name} of MuJoCo {mujoco.__version__} is not where its"
                    " declaration puts it; install the mujoco version of the lock file"
                )
            agreed.add(field.name)
    names = ("gravity", "integrator", "timestep")
    gravity, integrator, timestep = (model._address + option_byte(name) for name in names)
    if model.opt.gravity.ctypes.data == gravity:
        agreed.add("opt.gravity")
    if ctypes.c_int.from_address(integrator).value == model.opt.integrator != 0:
        agreed.add("opt.integrator")
    if ctypes.c_double.from_address(timestep).value == model.opt.timestep:
        agreed.add("opt.timestep")
    return agreed


@cache
def _shown() -> set[str]:
    """Returns the fields of a live model that lie where their declarations put them."""
    model = mujoco.MjModel.from_xml_string(_PROBE)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    return check(model, data)


def require(fields: Iterable[str]) -> None:
    """Make sure that every field that callbacks touch lies where they look for it."""
    unseen = set(fields) - _shown()
    if unseen:
        raise RuntimeError(
            f"MuJoCo {mujoco.__version__} does not show {', '.join(sorted(unseen))};"
            " install the mujoco version of the lock file"
        )
