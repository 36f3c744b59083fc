"""A few dropped samples cost the windows that touch them, and not the log."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from joint_cases import SLIDER
from pendulum_robot import TOML, make_folder, measured, plant
from records_cases import NOISE, record
from robot_cases import TOML as TOML_PUBLISHER
from robot_cases import simulated

from identification import InputError, Predictor, fit, read_robot, write_log
from identification.logs.stamps.decimation import decimate
from identification.report.page.figures import windows_figure
from identification.windows.windows import windows

pytestmark = pytest.mark.usefixtures("few_effects")

DROPPED = range(60, 76)  # while the drive turns the pendulum round


@pytest.fixture
def path(tmp_path):
    make_folder(tmp_path)
    write_log(measured(1, samples=600), tmp_path / "log.csv")
    lines = (tmp_path / "log.csv").read_text().splitlines(keepends=True)
    header = next(k for k, line in enumerate(lines) if line.startswith("time"))
    kept = [x for k, x in enumerate(lines) if k - header - 1 not in DROPPED]
    (tmp_path / "log.csv").write_text("".join(kept))
    return tmp_path / "robot.toml"


def test_over_a_horizon_the_fit_is_right_and_a_sentence_tells_the_gap(path):
    robot = read_robot(path, path.with_name("log.csv"))
    assert robot.log.gaps == (pytest.approx((0.59, 0.76)),)
    (said,) = (r for r in robot.remarks if "gap" in r)
    assert "1 gap is too wide to be bridged (no angle for 0.17 s from 0.59 s" in said
    found = fit(robot)
    for name, value in (("J", 2e-3), ("d", 0.02)):
        assert found.values[name] == pytest.approx(value, rel=0.01)
    # Half of 600 samples are fitted, in windows of 20; [0.4, 0.6) and [0.6, 0.8) touch the gap.
    (part,) = found.found.model.fit.problem.parts
    assert part.cut.starts.tolist() == [0, 20, *range(80, 300, 20)]
    assert windows_figure(robot.plant, robot.log, 0.2, {"J": {}})


def test_a_free_run_says_what_to_write(path, refusal):
    path.write_text(TOML.replace("horizon = 0.2", ""))
    said = refusal(read_robot, path, path.with_name("log.csv"))
    assert "has 1 gap that a free run cannot bridge; it is 0.17 s long, from 0.59 s" in said
    assert "horizon = 0.2" in said
    assert read_robot(path, path.with_name("log.csv"), trust=["gaps"]).log.gaps == ()


def test_rows_that_are_lost_regularly_do_not_turn_the_values(tmp_path, refusal):
    folder, log = make_folder(tmp_path), measured(2, samples=800)
    rng = np.random.default_rng(3)
    keep = np.arange(800) % 7 != 6
    stamps = log.time + 1e-3 * log.sampling_time * rng.random(800)
    columns = [stamps, *log.columns.values()]
    rows = [",".join(map(repr, row)) for row in np.column_stack(columns)[keep].tolist()]
    path = folder / "log.csv"
    path.write_text("\n".join([",".join(["time", *log.columns]), *rows]))
    robot = read_robot(folder / "robot.toml", path)
    assert len(robot.log.gaps) > 1
    found = fit(robot)
    for name, value in (("J", 2e-3), ("d", 0.02)):
        assert abs(found.values[name] - value) < 4 * found.std[name]
        assert found.values[name] == pytest.approx(value, rel=0.03)
    (folder / "robot.toml").write_text(TOML.replace("horizon = 0.2", ""))
    said = refusal(read_robot, folder / "robot.toml", path)
    assert f"{len(robot.log.gaps)} gaps that a free run cannot bridge" in said


@given(
    gaps=st.lists(st.tuples(st.floats(0, 5), st.floats(0, 0.4)), max_size=4),
    length=st.floats(0.1, 0.5),
    every=st.integers(1, 3),
)
def test_windows_are_those_of_a_whole_log_that_keep_clear_of_its_gaps(gaps, length, every):
    whole = decimate(record(3), every)
    log = replace(whole, gaps=tuple((a, a + b) for a, b in gaps)).between(0.3, 4.5)
    every_one, h = windows(whole.between(0.3, 4.5), length), log.sampling_time
    samples = every_one.outputs.shape[1]
    clear = [
        all(log.time[s] >= b + h or log.time[s + samples - 1] <= a - h for a, b in log.gaps)
        for s in every_one.starts
    ]
    if not any(clear):
        with pytest.raises(InputError, match="touches one of its"):
            windows(log, length)
        return
    found = windows(log, length)
    np.testing.assert_array_equal(found.starts, every_one.starts[clear])
    np.testing.assert_array_equal(found.outputs, every_one.outputs[clear])


def test_a_fit_of_a_thinned_log_is_unbiased(tmp_path):
    make_folder(tmp_path)
    (tmp_path / "robot.toml").write_text("every = 5\n" + TOML)
    rng, n = np.random.default_rng(5), 1600
    t = 0.005 * np.arange(n)
    u = 0.5 * np.sin(7 * t) + 0.3 * np.sin(31 * t + 1) + 0.05 * rng.standard_normal(n)
    log = replace(
        record(samples=n), time=t, inputs=u[:, None], outputs=np.zeros((n, 1)), hold="foh"
    )
    y = Predictor(plant(), log, ()).predict(np.empty((1, 0)))[0]
    write_log(replace(log, outputs=y + NOISE * rng.standard_normal((n, 1))), tmp_path / "log.csv")
    robot = read_robot(tmp_path / "robot.toml", tmp_path / "log.csv")
    assert (robot.log.hold, len(robot.log)) == ("foh", (n - 1) // 5 + 1)
    found = fit(robot)
    for name, value in (("J", 2e-3), ("d", 0.02)):
        assert found.values[name] == pytest.approx(value, rel=0.005)


@pytest.fixture
def path_publisher(tmp_path):
    (tmp_path / "slider.xml").write_text(SLIDER)
    (tmp_path / "robot.toml").write_text(TOML_PUBLISHER)
    write_log(simulated({}, start=1.4), tmp_path / "log.csv")
    return tmp_path / "log.csv"


def twice(path_publisher, other):
    """Write each row of a log twice, the second time with other cells."""
    header, *rows = path_publisher.read_text().splitlines()
    cells = [[float(cell) for cell in row.split(",")] for row in rows]
    second = [",".join(map(repr, other(*each))) for each in cells]
    both = [line for pair in zip(rows, second, strict=True) for line in pair]
    path_publisher.write_text("\n".join([header, *both]))


def test_rows_that_are_written_twice_count_once(path_publisher):
    robot = path_publisher.with_name("robot.toml")
    once = read_robot(robot, path_publisher)
    twice(path_publisher, lambda *row: row)
    both = read_robot(robot, path_publisher, trust=())
    np.testing.assert_array_equal(both.log.outputs, once.log.outputs)
    np.testing.assert_array_equal(both.log.inputs, once.log.inputs)
    (said,) = both.log.remarks
    assert said.startswith("1200 rows of log 'log' repeat the row before them")


@pytest.mark.parametrize(("other", "said"), [
    (lambda t, u, x: (t, -u, 2.8 - x), "they contradict each other"),
    (lambda t, u, x: (t, 0.0, x), "nothing says which of them the robot had"),
])  # fmt: skip
def test_rows_that_all_contradict_another_one_are_refused(path_publisher, other, said):
    twice(path_publisher, other)
    with pytest.raises(InputError, match="there are two rows with one stamp, ") as refusal:
        read_robot(path_publisher.with_name("robot.toml"), path_publisher)
    told = str(refusal.value)
    assert said in told
    assert "keep the rows of one publisher" in told
    assert "or write trust" in told
