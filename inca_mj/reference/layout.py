"""The place of each quantity: the 36 states in the thesis' order, and the packed numbers.

The right-hand side reads its constants from one flat array, so that a call from Python costs
two microseconds; `inca_mj.reference.numbers.pack` fills it. Compiled code has these indices
baked in: whoever changes one here changes `equations.py` too, which renews the disk cache.
"""

from __future__ import annotations

DRIVES = 8
STATES = 36

# State x: the platform first, then the drives (thesis chapter 2, in this order).
POSITION = slice(0, 3)  # p of P in the fixed frame O [m]
VELOCITY = slice(3, 6)  # v of P, along the BODY axes [m/s]
EULER = slice(6, 9)  # roll φ, pitch θ, yaw ψ [rad]
RATES = slice(9, 12)  # ω of the platform, along the body axes [rad/s]
ANGLES = slice(12, 20)  # motor angles φ_m, positive winds the cable in [rad]
SPEEDS = slice(20, 28)  # motor rates ω_m [rad/s]
NO_LOAD = slice(28, 36)  # no-load lengths d₀ of the free cables [m]

# Numbers q: a row for each drive, whose entries have this order, then what the drives share.
EACH_DRIVE = ("R", "R_s", "k_s", "lambda", "b", "J", "b_v", "b_c", "beta", "K_t")
R, R_S, K_S, LAMBDA, B, J, B_V, B_C, BETA, K_T = range(10)
ROW = 10
ROWS = slice(0, 80)
M = 80  # mass of the platform [kg]
INERTIA = slice(81, 84)  # I_x, I_y, I_z of the platform [kg m^2]
G_EARTH = 84  # g [m/s^2]
FORCE = slice(85, 88)  # external force G, in O [N]
FORCE_AT = slice(88, 91)  # its point b_G, in the platform frame [m]
EXITS = slice(91, 115)  # A_i in O, row by row [m]
CONNECTORS = slice(115, 139)  # B_i in the platform frame, row by row [m]
PRETENSION = slice(139, 147)  # T(0), which the drum springs balance at φ_m = 0 [N]
NUMBERS = 147
