"""Offset of the centre of mass: the platform is heavier on one side.

The platform's frame stays in its centre of mass, so the connectors move the other way: b_i - c.
"""

from identification.effects.effect import Effect, Size
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
    centre=True,
)
