"""An oracle is worth something only while it shares no physics with what it judges."""

import ast
from pathlib import Path

import inca_mj.reference

SHARED = {
    *("inca_mj.robot.geometry", "inca_mj.robot.parameters", "inca_mj.robot.spread"),
    "inca_mj.reference",
}


def imported(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module or "."


def test_the_reference_shares_only_the_numbers_of_the_robot_with_the_twin():
    folder = Path(inca_mj.reference.__file__).parent
    names = {name for path in folder.glob("*.py") for name in imported(path)}
    assert not any(name.split(".")[0] == "mujoco" for name in names)
    ours = {name for name in names if name.startswith("inca_mj")}
    assert {
        next((s for s in SHARED if f"{name}.".startswith(f"{s}.")), name) for name in ours
    } == SHARED
