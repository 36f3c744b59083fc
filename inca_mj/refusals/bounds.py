"""All judgement constants of the checks of a log's wiring in one record.

A log is refused where another reading of it is far nearer to the twin. How near a right log is was
measured on simulated robots as built, most with an effect; how much nearer is far is judgement.
"""

from __future__ import annotations

from dataclasses import dataclass

from identification.kalman.options import option


@dataclass(frozen=True, kw_only=True)
class WiringBounds:
    """Bounds beyond which a log's angles and currents are believed to be others than it says.

    Every field has its unit, reason and source in its metadata (`dataclasses.fields`). γ is the
    share of motion that the twin does not explain (`inca_mj.refusals.currents`), κ the one
    that belongs to no pose of the platform (`inca_mj.refusals.agreement`), ε_k the γ of angle k.
    """

    # What a right log may be.
    right: float = option(
        0.2, "ε of an angle",
        "A right log is below: 61 of 65 robots as built were, and all below 0.4.",
        "worlds 20000 to 20124", most=1.0,
    )  # fmt: skip
    alike: float = option(
        0.4, "ε of an angle",
        "Beyond it, an angle has not the shape of the twin's, and its unit alone is not to blame.",
        "65 right logs of worlds 20000 to 20124, of which all are below", most=1.0,
    )  # fmt: skip
    astray: float = option(
        0.02, "γ",
        "From here on a log is looked at: it is √(2γ), a fifth of its motion, off the twin. Of"
        " robots as built γ was 0.04 at most.",
        "worlds 31000 to 31057",
    )  # fmt: skip
    constant: float = option(
        0.01, "of the median range of all currents",
        "A current with a smaller range stands still. A dead sensor gives its noise, or one value.",
        "judgement", most=1.0,
    )  # fmt: skip

    # How much nearer another reading must be.
    nearer: float = option(
        0.1, "of γ",
        "Another reading must leave less where γ is the only witness. Of right logs, no other"
        " reading left less than 0.63, and of constant currents 0.36; where a current was logged as"
        " zero, the right reading left 0.026 in the middle of 30.",
        "worlds 31000 to 31057, 32200 to 32289", most=1.0,
    )  # fmt: skip
    nearer_renamed: float = option(
        1 / 3, "of γ",
        "Another order of the drives must leave less. γ may fall less here, because the cables are"
        " a second witness.",
        "judgement", most=1.0,
    )  # fmt: skip
    closer: float = option(
        0.1, "of κ",
        "Another order of the drives, or a factor of an angle, must leave less. Right logs had κ up"
        " to 0.0012, and the same angles in reverse order 0.003 or more.",
        "worlds 33000 to 33089", most=1.0,
    )  # fmt: skip

    # What is as near as the best.
    nearly: float = option(
        3.0, "of the least γ",
        "A reading that leaves less than this is as likely; it is often the mirror image.",
        "judgement", least=1.0,
    )  # fmt: skip
    as_near: float = option(
        3.0, "of κ",
        "Another reading of the angles with less than this fits the cables as well: the frame is"
        " symmetric, and the start nearly so.",
        "judgement", least=1.0,
    )  # fmt: skip

    # Scales.
    beyond: float = option(
        1.6, "factor",
        "A column is of another scale beyond it. A motor of the next winding is at 1.25; a gear"
        " that was forgotten is at 2 or more, and revolutions are at 6.3.",
        "judgement", least=1.0,
    )  # fmt: skip
    far: float = option(
        10.0, "of the motion of the other angles",
        "An angle that moves this much farther beside the twin's is in another unit. Degrees are at"
        " 57; beside what a robot as built does they were at 44 to 69.",
        "judgement", least=1.0,
    )  # fmt: skip
    little: float = option(
        0.2, "of the twin's motion",
        "Angles that all move less are in another unit. Revolutions are at 0.16; beside what a"
        " robot as built does they were at 0.12 to 0.19.",
        "judgement", most=1.0,
    )  # fmt: skip

    # How much may be wrong at once.
    max_dead: int = option(
        2, "currents",
        "So many may not have been logged; the angles of the other drives judge, and six of them"
        " still tell all motions of the platform.",
        "degrees of freedom: eight cables, six motions", least=1,
    )  # fmt: skip
    max_angles: int = option(
        2, "angles",
        "So many may be wrong beside a current; more free ones come near by chance.",
        "judgement", least=1,
    )  # fmt: skip
    max_orders: int = option(
        1000, "orders of the drives",
        "Of so many, those with least κ near the pose at rest, κ itself is computed. Of 30 right"
        " logs, none was behind place 720.",
        "worlds 33000 to 33089", least=1,
    )  # fmt: skip
    max_simulated: int = option(
        16, "orders of the drives",
        "So many are simulated: twice the eight that the symmetry of the frame makes alike.",
        "symmetry of the frame", least=8,
    )  # fmt: skip


BOUNDS = WiringBounds()
