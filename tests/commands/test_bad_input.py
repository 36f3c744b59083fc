"""Bad input: one clear sentence on stderr, exit code 2, nothing written."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from identification import InputError, write_log
from inca_mj.cli import main
from inca_mj.twin.logs import read_inca_log

LOG = Path(__file__).parents[2] / "examples" / "log.csv"


@pytest.fixture(autouse=True)
def _drawing(monkeypatch):
    """`python -m identification`, run here by another test, switches drawing off."""
    monkeypatch.delenv("MUJOCO_GL", raising=False)


def refused(capsys, *arguments):
    """Run a command that must be refused; returns its sentence."""
    code = main([str(a) for a in arguments])
    said = capsys.readouterr()
    assert code == 2
    assert said.out == ""
    assert said.err.startswith("inca: ")
    assert said.err.count("\n") == 1, said.err
    return said.err


def rows(n=100):
    return LOG.read_text().splitlines()[: n + 1]


def scaled(lines, group, factor):
    head = lines[0].split(",")
    out = [lines[0]]
    for line in lines[1:]:
        cells = line.split(",")
        out.append(",".join(repr(float(c) * factor) if head[i].startswith(group) else c
                            for i, c in enumerate(cells)))  # fmt: skip
    return out


def retimed(lines):
    return [f"{0.01 * k!r},{line.partition(',')[2]}" for k, line in enumerate(lines)]


BAD = {  # what a reader of any log refuses is in tests/logs/test_bad_logs.py
    "missing column": (lambda r: [x.rsplit(",", 1)[0] for x in r], "angle_8"),
    "degrees": (lambda r: scaled(r, "angle", 57.3), "deg"),
    "milliamperes": (lambda r: scaled(r, "current", 1e3), "mA"),
    "a start in motion": (lambda r: [r[0], *retimed(r[60:])], "begins"),
}  # fmt: skip


@pytest.mark.parametrize("kind", BAD)
def test_bad_logs(kind, tmp_path, capsys):
    change, names = BAD[kind]
    path = tmp_path / "bad.csv"
    path.write_text("\n".join(change(rows())) + "\n")
    assert names in refused(capsys, "compare", path, "--out", tmp_path / "out")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bad.csv"]


def test_a_model_that_diverges(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # cables a hundred times stiffer need a step ten times smaller than the twin's
    assert "diverged" in refused(
        capsys, "simulate", "--param", "lambda=5e6", "b=0", "--out", tmp_path / "out"
    )
    assert list(tmp_path.iterdir()) == []  # no folder, no MUJOCO_LOG.TXT


@pytest.mark.parametrize(
    ("change", "names"),
    [(lambda A, B: (1e3 * A, B), "not mm"), (lambda A, B: (A, 0 * B), "one line")],
)
def test_bad_geometries(change, names, tmp_path, capsys):
    from inca_mj.robot.geometry import INCA

    exits, connectors = change(INCA.A, INCA.B)
    path = tmp_path / "geometry.toml"
    path.write_text(f"exits = {exits.tolist()}\nconnectors = {connectors.tolist()}\n")
    assert names in refused(capsys, "compare", LOG, "--geometry", path)


def written(path, **changes):
    short = read_inca_log(LOG).between(0.0, 1.0)
    write_log(replace(short, extras={}, units={}, splits={}, **changes), path)
    return path


def test_a_log_in_which_nothing_moves(tmp_path):
    still = np.zeros((100, 8))
    with pytest.raises(InputError, match="nothing moves in"):
        read_inca_log(written(tmp_path / "still.csv", outputs=still))
