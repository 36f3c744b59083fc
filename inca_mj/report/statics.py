"""What `inca statics` tells: sentences, the sections and figures of its report, and JSON."""

from __future__ import annotations

from typing import Any

from identification.quantities import plain, plain_fields, quantity
from identification.report.page.page import Section, Table
from inca_mj.report.statics_figures import (
    cable_mass_figure,
    frequency_figure,
    slices_figure,
    tension_figure,
)
from inca_mj.statics.interference import Interference
from inca_mj.statics.stiffness import Axes, Modes
from inca_mj.statics.workspace import NAMES, Kind
from inca_mj.workflows.statics import StaticAnalysis

MASS_COLUMNS = (
    "ρ [g/m]", "tension [N]", "length [µm]", "angle [mrad]", "force [mN]",
    "force, half weight [mN]", "stiffness lost [%]", "platform moves [mm]", "straight is enough",
)  # fmt: skip
CABLE_MODES = ("massless", "added", "coupled", "share", "cables", "in_plane")


def statics_verdict(found: StaticAnalysis) -> list[str]:
    """Returns what was found, in sentences."""
    held, rest, push = found.held, found.rest, found.push
    x, y, z = rest.pose[:3]
    lines = [
        f"The cables have rank {found.closure.rank} and closure: the best internal tension has a"
        f" smallest tension of {found.closure.margin:.2f} of the largest.",
        f"Tensions from {held.within.min():.2f} to {held.within.max():.2f} N hold the platform,"
        f" with currents from {held.current.min():z.2f} to {held.current.max():z.2f} A.",
        f"With the power off it rests at ({x:z.3f}, {y:z.3f}, {z:z.3f}) m,"
        f" {'stable' if rest.stable else 'NOT stable'}; Coulomb friction may hold it up to"
        f" {1e3 * rest.friction_band[:3].max():.0f} mm away from there.",
        f"With locked drums the softest direction is {push.words[0]}, {push.values[0] / 1e3:.1f}"
        f" N/mm, and the stiffest {push.words[-1]}, {push.values[-1] / 1e3:.1f} N/mm; the softest"
        f" turn is {found.twist.words[0]}, {found.twist.values[0]:.1f} N m/rad.",
        f"The slowest mode with locked drums has {found.modes.frequency[0]:.1f} Hz: the platform"
        f" {found.modes.words[0]}.",
    ]
    if found.workspace is not None:
        w = found.workspace
        lines.append(
            f"The {NAMES[w.kind]} workspace at this orientation has"
            f" {quantity(w.volume, w.std, 'm³')} (standard error of stratified sampling)."
        )
    lines += _near_words("At the pose", found.nearness)
    if found.nearness_along is not None:
        n = len(found.nearness_along.platform)
        lines += _near_words(f"Over {n} poses", found.nearness_along)
    return [*lines, *mass_verdict(found)]


def mass_verdict(found: StaticAnalysis) -> list[str]:
    """Returns for which cables the massless straight line is good enough, in sentences."""
    lines = []
    for rho in found.rho:
        rows = [e for e in found.line_errors if e.rho == rho]
        enough = [e.tension for e in rows if e.line_is_enough]
        where = f"from {min(enough):g} N on" if enough else "at none of the tensions"
        lines.append(
            f"Cables of {1e3 * rho:g} g/m are straight to the noise of a log {where}; their weight"
            f" moves a free platform by {1e3 * rows[0].moved:.1f} mm."
        )
    return lines


def _near_words(begin: str, found: Interference) -> list[str]:
    (i, j), _ = found.nearest_pair()
    cable, _ = found.nearest_to_platform()
    gap = found.platform.min()
    touch = f"clears it by {1e3 * gap:.0f} mm" if gap > 0 else "TOUCHES it"
    return [
        f"{begin} the nearest cables are {i} and {j}, {1e3 * found.between.min():.0f} mm apart;"
        f" cable {cable} is nearest to the platform and {touch}."
    ]


def statics_sections(found: StaticAnalysis) -> list[Section]:
    """Returns the sections, with their figures."""
    held = found.held
    stiffness = tuple(
        (f"{what}{words}", float(value), unit)
        for what, values, each, unit in (
            ("stiffness ", found.push.values, found.push.words, "N/m"),
            ("stiffness ", found.twist.values, found.twist.words, "N m/rad"),
            ("drums locked: ", found.modes.frequency, found.modes.words, "Hz"),
            ("drums free: ", found.modes_free.frequency, found.modes_free.words, "Hz"),
        )
        for value, words in zip(values, each, strict=True)
    )
    errors = tuple(
        (1e3 * e.rho, e.tension, 1e6 * e.length, 1e3 * e.angle, 1e3 * e.force, 1e3 * e.force_half,
         1e2 * e.stiffness_lost, 1e3 * e.moved, "yes" if e.line_is_enough else "no")
        for e in found.line_errors
    )  # fmt: skip
    sections = [
        Section(
            "Tensions at the pose",
            "Limits follow from the smallest and the largest current and the drum springs.",
            figures=(("Tensions of the cables", tension_figure(found)),),
            table=Table(
                ("cable", "low [N]", "high [N]", "minimum norm [N]", "nearest to 4 N [N]",
                 "within limits [N]", "current [A]"),
                tuple(
                    (k + 1, *(float(x[k]) for x in (held.low, held.high, held.minimum_norm,
                                                    held.nearest, held.within, held.current)))
                    for k in range(8)
                ),
            ),
        ),
        Section(
            "Stiffness and modes",
            "Stiffness against a force while the platform may turn, against a torque while it may"
            " move; drums locked. Modes have no damping here.",
            figures=(("Frequencies of platform and cables", frequency_figure(found)),),
            table=Table(("what", "value", "unit"), stiffness),
        ),
    ]  # fmt: skip
    if found.workspace is not None:
        kinds: tuple[Kind, ...] = tuple(dict.fromkeys(("closure", found.workspace.kind)))
        sections.append(
            Section(
                "Workspace",
                "Slices through the pose. Volume"
                f" {quantity(found.workspace.volume, found.workspace.std, 'm³')}.",
                figures=(("Slices of the workspace", slices_figure(found.robot, found, kinds)),),
            )
        )
    sections.append(
        Section(
            "Mass of the cables",
            "What a massless straight cable gets wrong at this pose, the worst of the eight.",
            figures=(("Error of the length of a straight line", cable_mass_figure(found)),),
            table=Table(MASS_COLUMNS, errors),
        )
    )
    return sections


def statics_json(found: StaticAnalysis) -> dict[str, Any]:
    """Returns the record; `docs/json.md` explains its keys."""
    along, inside = found.nearness_along, None
    if (w := found.workspace) is not None:
        inside = plain_fields(w, "kind", "orientation", "volume", "std")
        inside |= {"points": int(w.margin.size), "inside": int(w.inside.sum())}
    return {
        **plain_fields(found, "pose", "load"),
        "closure": plain_fields(found.closure, "rank", "condition", "closed", "margin"),
        "tension": plain_fields(
            found.held, "low", "high", "nearest", "minimum_norm", "current", within_limits="within"
        ),
        "rest": plain_fields(found.rest, "pose", "tension", "angle", "stable", "friction_band"),
        "stiffness": {
            **plain_fields(found, drums_locked="locked", drums_free="free"),
            "against_forces": _axes(found.push),
            "against_torques": _axes(found.twist),
        },
        "modes": {"drums_locked": _modes(found.modes), "drums_free": _modes(found.modes_free)},
        "workspace": inside,
        "interference": {
            "at_pose": _nearness(found.nearness),
            "along": None if along is None else _nearness(along),
        },
        "cable_mass": [
            plain_fields(
                e, "rho", "tension", "sag", "stiffness_lost", "moved", "moved_angle",
                "line_is_enough", "massless_is_enough", length_error="length", angle_error="angle",
                force_error="force", force_error_half_weight="force_half",
            )
            for e in found.line_errors
        ],
        "cable_modes": [
            {"rho": rho, **plain_fields(c, *CABLE_MODES)}
            for rho, c in zip(found.rho, found.cable_modes, strict=True)
        ],
    }  # fmt: skip


def _axes(axes: Axes) -> list[dict[str, Any]]:
    rows = zip(axes.values, axes.vectors, axes.words, strict=True)
    return [plain({"value": v, "vector": x, "words": words}) for v, x, words in rows]


def _modes(modes: Modes) -> list[dict[str, Any]]:
    rows = zip(modes.frequency, modes.words, strict=True)
    return [plain({"frequency": f, "words": words}) for f, words in rows]


def _nearness(found: Interference) -> dict[str, Any]:
    pair, at = found.nearest_pair()
    cable, near = found.nearest_to_platform()
    return {
        "poses": len(found.platform),
        "cables": {"pair": list(pair), "distance": float(found.between.min()), "pose": at},
        "platform": {"cable": cable, "clearance": float(found.platform.min()), "pose": near},
        "angle": float(found.angle.min()) if found.angle.size else None,
    }
