"""Offset of the centre of mass: the platform is heavier on one side."""

from identification.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import PLATFORM

COM_OFFSET = DriveEffect(
    Effect(
        "com_offset",
        "centre of mass moved by (x, y, z), body axes",
        (
            Size("x", "m", 0.02, 1e-3, about="offset of the centre of mass"),
            Size("y", "m", 0.02, 1e-3, about="offset of the centre of mass"),
            Size("z", "m", 0.02, 1e-3, about="offset of the centre of mass"),
        ),
        places=PLATFORM,
        phrase="platform: centre of mass is elsewhere",
        reference="thesis 2.36",
    ),
    entries=("ipos[0]", "ipos[1]", "ipos[2]"),
)
