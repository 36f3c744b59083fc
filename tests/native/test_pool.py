"""Work in parts gives what the same work gives in one piece, and waits for nothing of its own."""

import os
import threading
import time

import pytest

from identification.runtime import pool
from identification.runtime.pool import (
    OutOfTime,
    each_part,
    end_if_given_up,
    lift_limit,
    run_parts,
    split,
    threads,
    until,
)


def test_results_come_in_the_order_of_the_parts(monkeypatch):
    monkeypatch.setenv("INCA_MJ_THREADS", "2")
    assert run_parts(lambda part: part**2, range(20)) == [k**2 for k in range(20)]


def test_a_part_may_have_parts_of_its_own():
    """More of them than there are threads, each of which would wait for others."""

    def outer(k):
        return sum(run_parts(lambda part: k * part, range(8)))

    assert run_parts(outer, range(8)) == [28 * k for k in range(8)]


def test_an_error_of_a_part_is_that_of_the_work():
    def fail(part):
        if part == 3:
            raise ValueError("the third")
        return part

    with pytest.raises(ValueError, match="third"):
        run_parts(fail, range(6))


def test_a_part_has_one_thread_and_the_whole_has_all_of_them_again():
    if threads() < 2:
        pytest.skip("one processor has no pool")
    assert run_parts(lambda _: threads(), range(4)) == [1] * 4
    assert threads() > 1
    end_if_given_up()


def test_parts_end_where_the_work_is_given_up(monkeypatch):
    """Also those that a generator is not asked for any more; nobody waits for them."""
    monkeypatch.setattr(pool, "threads", lambda: 2)
    begun, ended = threading.Event(), threading.Event()

    def part(k):
        if k == 0:
            begun.wait(60)
            return k
        begun.set()
        try:
            while True:
                end_if_given_up()
                time.sleep(1e-3)
        finally:
            ended.set()

    parts = each_part(part, range(3))
    assert next(parts) == 0
    parts.close()
    assert ended.wait(60)


def test_work_ends_behind_its_time_in_every_thread_and_only_in_the_block():
    with pytest.raises(OutOfTime), until(time.monotonic() - 1):
        end_if_given_up()
    with pytest.raises(OutOfTime), until(time.monotonic() - 1):
        run_parts(lambda _: end_if_given_up(), range(4))
    with until(time.monotonic() + 60):
        end_if_given_up()
    with until(time.monotonic() - 1):
        lift_limit()
        end_if_given_up()
    end_if_given_up()
    run_parts(lambda _: end_if_given_up(), range(4))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_process_that_was_forked_off_has_a_pool_of_its_own():
    run_parts(abs, range(8))
    child = os.fork()
    if child == 0:
        os._exit(run_parts(abs, [-1, -2]) != [1, 2])
    assert os.waitpid(child, 0)[1] == 0


@pytest.mark.parametrize(("count", "most"), [(0, 5), (5, 5), (100, 9)])
def test_ranges_cover_all_things_once(count, most):
    parts = split(count, most)
    assert [k for part in parts for k in range(part.start, part.stop)] == list(range(count))
    sizes = {part.stop - part.start for part in parts}
    assert max(sizes) - min(sizes) <= 1
    assert max(sizes) <= most
    assert len(parts) == max(1, -(-count // most))
