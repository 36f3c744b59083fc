"""The handle's body, as it is drawn and as cables can touch it; ASSUMED, like the geometry."""

from __future__ import annotations

GRIP = ((0.0, 0.0, -0.02), (0.0, 0.0, -0.11))  # ends of the grip's axis in P [m]
GRIP_RADIUS = 0.015  # [m]
ARM_RADIUS = 0.005  # of the arms from the centre to the connectors [m]
