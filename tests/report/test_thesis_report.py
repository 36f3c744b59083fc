"""The thesis' tables and figures: each once, with the numbers that the thesis prints."""

import re
from pathlib import Path

import numpy as np
import pytest
from page_text import text_of

from identification.estimation.estimation import Options
from identification.report.page.page import write_report
from inca_mj.robot.parameters import parameter_set
from inca_mj.thesis.prints import FITS, TABLES
from inca_mj.thesis.report import thesis_sections, thesis_verdict
from inca_mj.thesis.results import repeat_thesis
from inca_mj.workflows.identification import STEP_1, STEP_2

TEXT = Path(__file__).parents[3] / "shared" / "000_2b9c4e89379102f7.txt"
EVERY = [
    *(f"Table {n}" for n in ("2.1", *(f"3.{k}" for k in range(1, 9)))),
    *(f"Figure {n}" for n in ("2.16", *(f"3.{k}" for k in range(2, 14)))),
]
NAMES = {"λ": "lambda", "β": "beta"}
STAND_IN = 0.4  # [s], for 10 s


@pytest.fixture(scope="module")
def found():
    """Short data and searches that are cut short: the report is the same, its estimates worse."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("inca_mj.thesis.trials.DURATION", 0.3)
        patch.setattr("inca_mj.thesis.results.STAND_IN", STAND_IN)
        return repeat_thesis(options=Options(horizons=(1.0,), max_evaluations=1))


@pytest.fixture(scope="module")
def page(found, tmp_path_factory):
    path = tmp_path_factory.mktemp("thesis") / "report.html"
    write_report(path, "The thesis", thesis_verdict(found), thesis_sections(found))
    return text_of(path.read_text(encoding="utf-8"))


def test_each_table_and_figure_has_one_heading(found, page):
    assert sorted(s.title.partition(":")[0] for s in thesis_sections(found)) == sorted(EVERY)
    headings = re.findall(r"<h2>(Table|Figure) (\d\.\d+):", page)
    assert sorted(" ".join(h) for h in headings) == sorted(EVERY)


def test_every_printed_number_is_in_the_report(page):
    cells = set(re.findall(r"<td[^>]*>(.*?)</td>", page))
    for table in TABLES.values():
        for row in table.rows:
            assert {cell.replace("'", "&#39;") for cell in row} <= cells, table.number
    for fits in FITS.values():
        assert {f"{fit:g} %" for fit in (*fits.fits, fits.mean)} <= cells, fits.number


def test_the_steps_free_and_fix_what_the_tables_say(found):
    printed = {number: rows(number) for number in ("3.7", "3.8")}
    names = [n for n in printed["3.7"] if not n.startswith("[")]
    assert {n: float(printed["3.7"][n][0]) for n in names} == {n: STEP_1[n] for n in names}
    assert [STEP_1[n] for n in "xyz"] == [0, 0, 1.47]
    assert {n for n in printed["3.8"] if printed["3.8"][n][1] != "fix"} == set(STEP_2)

    first, second = (fit.estimate for fit in found.procedure.fits)
    assert first.space.names == tuple(STEP_1)
    assert second.space.names == STEP_2
    nominal = parameter_set("trial").values()
    begun = dict(zip(second.space.names, second.start, strict=True))
    for name in STEP_2:  # R and K_t begin at 0.0175 and 0.08, as Table 3.8 prints
        right = nominal[name] if name in ("R", "K_t") else first.values[name]
        assert begun[name] == pytest.approx(right, rel=1e-12)
    held = second.predictor.plant.parameters
    assert held["b"].value == pytest.approx(first.values["b"])
    assert {n: held[n].value for n in ("R_s", "k_s", "x", "y", "z")} == {
        n: nominal[n] for n in ("R_s", "k_s", "x", "y", "z")
    }


def test_the_procedure_sees_the_first_half_and_is_shown_on_the_whole(found):
    log = found.procedure.fits[0].estimate.predictor.log
    assert log.duration == pytest.approx(STAND_IN / 2, abs=0.011)
    whole = found.validation(found.procedure.fits[1])
    assert whole.log.duration == pytest.approx(STAND_IN)
    np.testing.assert_array_equal(whole.log.outputs, found.stand_in.outputs)


@pytest.mark.parametrize(("number", "name"), [("2.1", "simulation"), ("3.2", "trial")])
def test_the_parameter_sets_are_the_printed_tables(number, name):
    values = parameter_set(name).values()
    for row in TABLES[number].rows:
        symbol, printed = NAMES.get(row[1], row[1]), row[2]
        if symbol == "I":
            assert [values[n] for n in ("I_x", "I_y", "I_z")] == [0.8e-4, 1.5e-4, 1.8e-4]
        elif symbol == "[x, y, z]":
            assert [values[n] for n in "xyz"] == numbers(printed)
        elif not symbol.startswith("["):
            unit = 1e-3 if "(mm)" in row[0] else 1.0
            assert values[symbol] == pytest.approx(float(printed) * unit, rel=1e-12)


def rows(number):
    """Cells of a printed table by parameter."""
    return {NAMES.get(row[0], row[0]): row[1:] for row in TABLES[number].rows}


def numbers(text):
    return [float(x) for x in text.strip("[]").split(", ")]


# ---- against the text of the thesis, where it lies beside this checkout

needs_text = pytest.mark.skipif(not TEXT.is_file(), reason="no thesis beside this checkout")


def plain(text):
    """A cell of the text as it is written here: powers of ten by e, no formula signs."""
    text = re.sub(r"\$?\[x, y, z\]_\{t=0\}\$?( \(m\))?", "[x, y, z]", text)
    text = re.sub(r" ?\\cdot 10\^\{(-?\d+)\}", r"e\1", text.replace("$beta$", "β"))
    return text.replace("$", "").strip()


def text_rows(number):
    """Rows above the caption of a table."""
    lines = TEXT.read_text(encoding="utf-8").splitlines()
    (end,) = (k for k, line in enumerate(lines) if line.startswith(f"Table {number}:"))
    start = max(k for k in range(end) if lines[k].startswith("Parameter\t"))
    return [[plain(cell) for cell in line.split("\t")] for line in lines[start + 1 : end] if line]


@needs_text
@pytest.mark.parametrize("number", ["2.1", "3.2", *(f"3.{k}" for k in range(3, 9))])
def test_the_tables_are_those_of_the_text(number):
    theirs, ours = text_rows(number), TABLES[number].rows
    assert len(theirs) == len(ours)
    for row, printed in zip(theirs, ours, strict=True):
        value = 2 if number in ("2.1", "3.2") else 1
        for there, here in zip(row[value:], printed[value:], strict=True):
            if "matrix" not in there and "Computed" not in there:
                assert there == here, (number, row)
        if value == 1:
            assert re.sub(r" \(.*\)", "", row[0]) == printed[0]


@needs_text
def test_the_fits_are_those_of_the_text():
    text = TEXT.read_text(encoding="utf-8")
    tables = re.findall(r"Output\tFitting.*?\n(.*?)(?:\n\n|\(a\)|\Z)", text, flags=re.S)
    assert len(tables) == len(FITS)
    for block, fits in zip(tables, FITS.values(), strict=True):
        found = re.findall(r"^(?:Angle of motor \d|Summary)\t([\d.]+)", block, flags=re.M)
        assert tuple(map(float, found)) == (*fits.fits, fits.mean), fits.number
        told = re.findall(r"\t\$?([\d.]+)(?: \\cdot 10\^\{(-\d+)\})?\$?(?: ?[²³⁴-⁹])?$",
                          block[block.index("Loss") :], flags=re.M)  # fmt: skip
        losses = [float(f"{number}e{power or 0}") for number, power in told]
        assert losses == [x for x in (fits.matlab_loss, fits.loss) if x is not None], fits.number
