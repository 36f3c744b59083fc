"""All judgement constants of the checks of a log's wiring.

A log is refused where another reading of it is far nearer to the twin. How near a right log is was
measured on simulated robots as built, most with an effect (their worlds are named here); how much
nearer is far is judgement. γ is the share of motion that the twin does not explain
(`inca_mj.refusals.currents`), κ the one that belongs to no pose of the platform
(`inca_mj.refusals.agreement`), ε the γ of a single angle. Of 210 right logs (worlds 32000 to 32289)
none was refused for its currents, and of 90 (33000 to 33089) none for the order of its drives; of
14 in reverse or cycled order (33007 to 33087) all were.
"""

# What a right log may be.
RIGHT = 0.2  # ε; right logs are below: 61 of 65 were (worlds 20000 to 20124), all were below 0.4
ALIKE = 0.4  # ε; beyond it the shape is not the twin's, and a unit alone is not to blame
# γ; from here on a log is looked at: it is √(2γ), a fifth of its motion, off the twin. Of robots as
# built γ was 0.04 at most (worlds 31000 to 31057).
ASTRAY = 0.02
# Of the median range of all currents; a current with a smaller range stands still, for a dead
# sensor gives its noise, or one value.
CONSTANT = 0.01

# How much nearer another reading must be.
# Of γ, where γ is the only witness. Of right logs, no other reading left less than 0.63, and of
# constant currents 0.36; where a current was logged as zero, the right reading left 0.026 in the
# middle of 30 (worlds 31000 to 31057, 32200 to 32289).
NEARER = 0.1
NEARER_RENAMED = 1 / 3  # of γ, with another order of the drives: the cables are a second witness
# Of κ, with another order of the drives or a factor of an angle. Right logs had κ up to 0.0012, and
# the same angles in reverse order 0.003 or more (worlds 33000 to 33089).
CLOSER = 0.1

# What is as near as the best.
NEARLY = 3.0  # of the least γ; a reading that leaves less is as likely, and often the mirror image
AS_NEAR = 3.0  # of κ; with less, angles fit as well: the frame is symmetric, the start nearly so

# Scales.
# Factor of a column of another scale. A motor of the next winding is at 1.25; a gear that was
# forgotten is at 2 or more, and revolutions are at 6.3.
BEYOND = 1.6
# Of the motion of the other angles beside the twin's; farther is another unit. Degrees are at 57;
# beside what a robot as built does they were at 44 to 69.
FAR = 10.0
# Of the twin's motion; where all angles move less, they are in another unit. Revolutions are at
# 0.16; beside what a robot as built does they were at 0.12 to 0.19.
LITTLE = 0.2

# How much may be wrong at once.
MAX_DEAD = 2  # currents that were not logged: six other drives still tell all six motions
MAX_ANGLES = 2  # angles beside a current; more free ones come near by chance
# Orders of the drives with least κ near the pose at rest, of which κ itself is computed: of 30
# right logs, none was behind place 720 (worlds 33000 to 33089).
MAX_ORDERS = 1000
MAX_SIMULATED = 16  # orders: twice the eight that the symmetry of the frame makes alike
