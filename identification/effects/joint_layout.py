"""The places of the parameters of a set of effects in the model of a robot with joints.

Those of joints in the joints' user data, a row each (see `identification.native.joint_callback`);
those of inputs and sensors nowhere: they act before the model and behind it. Those of bodies change
the bodies' own numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

from identification.effects.body import BODY
from identification.effects.effect import Effect
from identification.effects.layout import key_of, refuse_misplaced, terms_of
from identification.native.element import Term
from identification.native.gear import FIELDS as STATE_FIELDS
from identification.native.gear_element import GEAR
from identification.native.hook_checks import refuse_unfit_functions
from identification.native.input_filter import INPUT
from identification.native.installer import Law, install
from identification.native.joint_callback import FIELDS, JOINT, width
from identification.native.joint_friction import callbacks
from identification.native.joint_states import callbacks as state_callbacks
from identification.native.joint_states import width as state_width
from identification.native.reading import SENSOR


@dataclass(frozen=True)
class JointLayout:
    """The columns of a set of effects, and its law.

    Attributes:
        effects: the set, in order.
        has_states: whether joints have states of their own, whose numbers stand behind.

    Raises:
        InputError: two effects have one name, or one has a hook that is none of a joint, an input,
            a body or a sensor.
    """

    effects: tuple[Effect, ...]
    has_states: bool = False

    def __post_init__(self) -> None:
        refuse_misplaced(self.effects, (JOINT, INPUT, BODY, SENSOR, GEAR))

    @cached_property
    def on_joints(self) -> tuple[Term, ...]:
        """The effects with parameters in a joint's row, columns counted from the first of them."""
        return terms_of(self.effects, JOINT)

    @cached_property
    def key(self) -> float:
        """Tells this set of joint effects from others."""
        names = {term.effect for term in self.on_joints}
        of = "joints with states" if self.has_states else "joints"
        return key_of([e for e in self.effects if e.name in names], of)

    @property
    def entries(self) -> int:
        """Entries of a joint's row."""
        return (state_width if self.has_states else width)(self.on_joints)

    @property
    def has_bodies(self) -> bool:
        """Whether an effect acts on bodies."""
        hooks = {hook.name for hook in BODY.hooks}
        return any(hooks & effect.hooks.keys() for effect in self.effects)

    def install(self) -> None:
        """Install the law in this process; does nothing when it is installed already.

        Raises:
            InputError: another library holds MuJoCo's callback, or a function of an effect is not
                what its hook takes.
            RuntimeError: MuJoCo's structs are not laid out as declared.
        """
        install(_law(self.key, self.on_joints, self.has_states))


@cache
def _law(key: float, terms: tuple[Term, ...], has_states: bool) -> Law:
    return Law(
        name="joints",
        key=key,
        functions=(state_callbacks if has_states else callbacks)(terms, key),
        fields=STATE_FIELDS if has_states else FIELDS,
        check=lambda: refuse_unfit_functions(JOINT, terms),
    )
