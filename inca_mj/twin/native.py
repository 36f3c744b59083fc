"""The law of `inca_mj.twin.callbacks`, compiled and installed in this process.

Callbacks are global in MuJoCo. With `identification.native.installer` the laws of several sets of
effects work side by side; callbacks of other libraries are not displaced, and models of other
robots are left unchanged.
"""

from __future__ import annotations

from functools import cache

from identification.native import installer
from identification.native.element import Term
from identification.native.hook_checks import refuse_unfit_functions
from inca_mj.effects.hooks import DRIVE, PLATFORM
from inca_mj.effects.layout import Layout
from inca_mj.twin.callbacks import callbacks
from inca_mj.twin.fields import FIELDS
from inca_mj.twin.owners import owners


def install(layout: Layout | None = None) -> None:
    """Install the law in this process; does nothing when it is installed already.

    Args:
        layout: the candidate effects to compile into it; none when None.

    Raises:
        InputError: another library has installed MuJoCo callbacks of its own, or a function of an
            effect is not what its hook takes.
        RuntimeError: MuJoCo's structs are not laid out as declared.
    """
    layout = layout or Layout()
    installer.install(_law(layout.key, layout.on_drives, layout.on_platform))


def uninstall() -> None:
    """Release MuJoCo's callbacks, to compare a step with the law and without it."""
    installer.uninstall()


@cache
def _law(key: float, on_drives: tuple[Term, ...], on_platform: tuple[Term, ...]) -> installer.Law:
    """Returns the law of the drives with a set of effects."""

    def check() -> None:
        refuse_unfit_functions(DRIVE, on_drives)
        refuse_unfit_functions(PLATFORM, on_platform)

    return installer.Law(
        name="drives",
        key=key,
        functions=callbacks(key, on_drives, on_platform),
        fields=FIELDS,
        check=check,
        owners=lambda model: owners(model, key),
    )
