"""The gear of a joint, and the friction in it, as elements of effects; see `native.gear`."""

from __future__ import annotations

from collections import namedtuple
from typing import Any

from identification.native.element import Element, Hook

# What an effect with states sees of a joint: its inertia as its drive feels it [kg m² or kg]
Gear: Any = namedtuple("Gear", "inertia")

GEAR = Element(
    "gear",
    Gear,
    (
        Hook(
            "series",
            (
                "compliance [rad/(N m)] or [m/N]", "half the gap [rad] or [m]",
                "inertia of the motor [kg m²] or [kg]", "damping ratio",
                "1 where the encoder sits on the motor's side, 0 on the link's",
            ),
        ),
        Hook("slip", ("compliance of the friction that holds [rad/(N m)] or [m/N]",)),
    ),
)  # fmt: skip
