"""An MJCF model whose joints carry the numbers of their effects as user data, and their law.

    user data of a joint = (what the file gave it, T, what it reaches, parameters, key, TAG)

The row stands at the end, so that a model's own user data stay where they were; its layout is that
of `identification.native.joints.joint_callback`. Effects of inputs and sensors have no row: they
act before the model and behind it. Those of bodies change the bodies' own numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

import mujoco
import numpy as np

from identification.effects.axes import Axis
from identification.effects.effect import Effect
from identification.effects.laws.bodies import BODY
from identification.effects.laws.rotors import ROTOR
from identification.effects.moving_bodies import movable
from identification.effects.plant.joint_law import JointTerms, joint_terms, key_of_law
from identification.effects.values import (
    Values,
    changed_columns,
    key_of,
    refuse_misplaced,
    terms_of,
)
from identification.errors import InputError, unknown_name
from identification.logs.names import quoted
from identification.model.hostile import refuse_endless, refuse_hostile, refuse_numbers
from identification.model.looks import without_looks
from identification.model.missing_files import compile_without_missing
from identification.model.paths import Slot
from identification.native.element import Term, refuse_unfit_functions
from identification.native.input_filter import INPUT
from identification.native.installer import Law, install
from identification.native.joints.gear import FIELDS as STATE_FIELDS
from identification.native.joints.gear import GEAR
from identification.native.joints.joint_callback import (
    FIELDS,
    FIRST,
    JOINT,
    REACH,
    STOP,
    TAG,
    stopping_steps,
    width,
)
from identification.native.joints.joint_friction import callbacks
from identification.native.joints.joint_states import callbacks as state_callbacks
from identification.native.joints.joint_states import width as state_width
from identification.native.reading import SENSOR
from identification.storage.files import MODEL, read_bytes

_LONGEST = 200  # of MuJoCo's words in a message
_HELD = {int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)}


@dataclass(frozen=True)
class JointLayout:
    """The columns of a set of effects, and its law.

    Raises:
        InputError: two effects have one name, or one has a hook that is none of a joint, an input,
            a body or a sensor.
    """

    effects: tuple[Effect, ...]  # the set, in order
    has_states: bool = False  # whether joints have states of their own, whose numbers stand behind

    def __post_init__(self) -> None:
        refuse_misplaced(self.effects, (JOINT, ROTOR, INPUT, BODY, SENSOR, GEAR))

    @cached_property
    def terms(self) -> JointTerms:
        """The effects that act on joints, and the terms of their law."""
        return joint_terms(terms_of(self.effects, JOINT))

    @property
    def on_joints(self) -> tuple[Term, ...]:
        """The effects with parameters in a joint's row, columns counted from the first of them."""
        return self.terms.own

    @cached_property
    def key(self) -> float:
        """Tells the law of these joint effects from others."""
        of = "joints with states" if self.has_states else "joints"
        if self.terms.law is not self.terms.own:
            return key_of_law(self.terms.law, of)
        names = {term.effect for term in self.on_joints}
        return key_of([e for e in self.effects if e.name in names], of)

    @cached_property
    def entries(self) -> int:
        """Entries of a joint's row."""
        return (state_width if self.has_states else width)(self.terms.law)

    @property
    def has_bodies(self) -> bool:
        """Tells whether an effect acts on bodies."""
        hooks = {hook.name for hook in BODY.hooks}
        return any(hooks & effect.hooks.keys() for effect in self.effects)

    def install(self) -> None:
        """Install the law in this process; does nothing when it is installed already."""
        install(_law(self.key, self.terms.law, self.has_states))


@cache
def _law(key: float, terms: tuple[Term, ...], has_states: bool) -> Law:
    return Law(
        name="joints",
        key=key,
        functions=(state_callbacks if has_states else callbacks)(terms, key),
        fields=STATE_FIELDS if has_states else FIELDS,
        check=lambda: refuse_unfit_functions(JOINT, terms),
    )


def read_model(source: str | Path | mujoco.MjSpec) -> mujoco.MjSpec:
    """Returns an MJCF as a specification that MuJoCo can edit.

    Args:
        source: path of the file, or its text, which begins with "<"; or a model that is read
            already, which is copied.

    Raises:
        InputError: it cannot be read or compiled.
    """
    return source.copy() if isinstance(source, mujoco.MjSpec) else read_told_model(source)[0]


def read_told_model(source: str | Path) -> tuple[mujoco.MjSpec, str]:
    """Returns an MJCF as a specification, and one sentence on missing files that it needs not.

    Args:
        source: path of the file, or its text, which begins with "<".

    Returns:
        The specification and the sentence, which is "" where no file is missing.

    Raises:
        InputError: it cannot be read or compiled, or its motion depends on a missing file.
    """
    text = str(source)
    given = text.lstrip().startswith("<")
    where = "the model" if given else f"the model {text}"
    if given:
        amount = refuse_hostile(text, where)
    else:
        amount = refuse_hostile(read_bytes(Path(text), what=MODEL), where, Path(text).parent)
    if amount.much:
        refuse_endless(text if given else Path(text), where, amount)
    try:
        spec = mujoco.MjSpec.from_string(text) if given else mujoco.MjSpec.from_file(text)
        model, left_out = compile_without_missing(spec, where, is_asked=not amount.much)
    except InputError:
        raise
    except (ValueError, OSError, mujoco.FatalError, Warning) as error:
        reason = quoted(" ".join(str(error).split()), _LONGEST)  # MuJoCo writes several lines
        raise InputError(f"{where} cannot be read ({reason}); correct it there") from error
    refuse_numbers(model, where)
    return spec, left_out


def with_rows(spec: mujoco.MjSpec, axes: Sequence[Axis], layout: JointLayout) -> mujoco.MjModel:
    """Returns the compiled model with a row of effects on some joints, all their numbers zero."""
    whole = spec.copy()
    bare = whole.compile()
    spec = without_looks(whole, bare).copy()
    joints = {joint.name: joint for joint in spec.joints if int(joint.type) in _HELD}
    for axis in axes:
        if axis.joint not in joints:
            raise unknown_name("hinge or slide joint", axis.joint, joints)
        given = bare.jnt_user[bare.joint(axis.joint).id]
        row = np.zeros(layout.entries)
        row[STOP], row[-2], row[-1] = stopping_steps(bare.nv) * bare.opt.timestep, layout.key, TAG
        row[REACH:FIRST] = reached(axis)
        joints[axis.joint].userdata = np.concatenate([given, row])
    spec.nuser_jnt = bare.nuser_jnt + layout.entries
    return movable(spec) if layout.has_bodies else spec.compile()


def changed_rows(
    model: mujoco.MjModel, layout: JointLayout, joints: Sequence[str], names: Sequence[str],
    values: Values, n: int,
) -> list[tuple[Slot, np.ndarray]]:  # fmt: skip
    """Returns entries of joints' rows that some parameters of effects change, in n value sets."""
    first = int(model.nuser_jnt) - layout.entries + FIRST
    return [
        (Slot("jnt_user", (int(model.joint(joint).id),), first + column),
         np.broadcast_to(numbers, n))
        for joint in joints
        for column, numbers in changed_columns(
            layout.effects, layout.on_joints, joint, names, values
        )
    ]  # fmt: skip


def reached(axis: Axis) -> tuple[float, float, float, float, float]:
    """Returns what the records of a joint reach, as the fields of `Joint` behind its state."""
    return axis.middle, axis.travel / 2, axis.speed, axis.force, axis.duration or 1.0
