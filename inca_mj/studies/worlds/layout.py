"""The place of each number of a world, beside those of `inca_mj.reference.layout`.

The state grows by what some effects remember. Every effect is a column that is zero (or infinite,
for a limit) where the effect is off, so that one compiled right-hand side serves every world.
"""

from __future__ import annotations

# State: the 36 of the reference, then
DRUM = slice(36, 44)  # ψ, angle of the drum behind the backlash [rad]
VISCOUS = slice(44, 52)  # ε_v, strain of the dashpot of the Maxwell branch
HEAT = slice(52, 60)  # ∫ i² dt of each motor [A^2 s]
STATES = 60

# Columns of D, a row per drive (and its cable)
# drum
RADIUS_ERROR, ECC_COS, ECC_SIN, LAYER, PLAY = 0, 1, 2, 3, 4
# friction
COULOMB_ERROR, STRIBECK, STRIBECK_SPEED, STRIBECK_POWER = 5, 6, 7, 8
ASYMMETRY, LOAD, QUADRATIC, QUADRATIC_POWER, ANGLE_COS, ANGLE_SIN = 9, 10, 11, 12, 13, 14
# motor
COG_COS, COG_SIN, COG_N = 15, 16, 17
GAIN_ERROR, DRIFT, DRIFT_TIME, HEAT_LOSS = 18, 19, 20, 21
LAG, CURRENT_LIMIT, CURRENT_SOFT = 22, 23, 24
RIPPLE, RIPPLE_RATE, RIPPLE_PHASE = 25, 26, 27
# spring
SPRING_HARD, SPRING_POWER, SPRING_LOSS = 28, 29, 30
# cable
CABLE_HARD, CABLE_POWER, MAXWELL, MAXWELL_TIME, LINE_WEIGHT, SAG = 31, 32, 33, 34, 35, 36
# geometry
PULLEY, PULLEY_SIDE, SHAKE_X, SHAKE_Y, SHAKE_Z, SHAKE_RATE, SHAKE_PHASE = 37, 38, 39, 40, 41, 42, 43
# a parameter that changes: its place in the reference's row, plus 1; 0 where none does
CHANGED, CHANGE_RATE, CHANGE_HEAT, JUMP, JUMP_TIME = 44, 45, 46, 47, 48
DRIVE_COLUMNS = 49

# Entries of P
DRAG, DRAG_POWER, DELAY = 0, 1, 2
PLATFORM_ENTRIES = 3
