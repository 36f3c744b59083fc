"""The same records to the bit, wherever tasks run, in whatever order, and whoever dies."""

import json
import os
import random

import dask
import pytest
from sweep_cases import read, run, write

from identification.sweep.backend import Processes
from identification.sweep.clusters import Chunk, Dask, Submitit
from identification.sweep.config import read_sweep
from identification.sweep.run import backend_of
from identification.sweep.work import work

quiet = pytest.mark.filterwarnings("default")  # of Dask and submitit, which are not ours


class Shuffled:
    """In another order than that of the tasks."""

    def outcomes(self, work, tasks):
        tasks = [*tasks]
        random.Random(1).shuffle(tasks)
        return map(work, tasks)


@pytest.fixture(scope="module")
def serial(tmp_path_factory):
    path = write(tmp_path_factory.mktemp("serial"))
    return path, run(path, path.parent / "out")


SLOW = [pytest.param(kind, marks=pytest.mark.long) for kind in ("dask", "submitit")]


@quiet
@pytest.mark.parametrize("kind", ["shuffled", "2 processes", *SLOW])
def test_records_are_the_same_to_the_bit(serial, tmp_path, kind, monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "2")
    path, expected = serial
    backend = {
        "shuffled": Shuffled(),
        "2 processes": Processes(2),
        "dask": Dask(None, 2),
        "submitit": Submitit("local", 2, tmp_path / "jobs", {"tasks_per_job": "4"}),
    }[kind]
    assert run(path, tmp_path / "out", backend) == expected
    assert read(tmp_path / "out") == expected
    assert json.loads(expected[0])["threads"] == "1"
    assert os.environ["OMP_NUM_THREADS"] == "2"


def test_a_process_that_dies_ends_the_sweep_and_costs_no_record(tmp_path, refusal):
    text = f"[study.grid]\nmarker = ['{tmp_path / 'died'}']\n"
    path = write(tmp_path, text, 4)
    sentence = refusal(run, path, tmp_path / "out", Processes(1))
    assert "a worker process died" in sentence
    assert "--resume" in sentence
    assert run(path, tmp_path / "out", Processes(1), resume=True) == run(path, tmp_path / "whole")


@pytest.mark.long
@quiet
def test_a_worker_of_a_running_scheduler_that_a_task_kills_is_replaced(tmp_path):
    from distributed import LocalCluster

    path = write(tmp_path, f"[study.grid]\nmarker = ['{tmp_path / 'died'}']\n", 4)
    with LocalCluster(
        n_workers=1, threads_per_worker=1, host="127.0.0.1", dashboard_address="127.0.0.1:0"
    ) as cluster:
        records = run(path, tmp_path / "out", Dask(cluster.scheduler_address, 1))
    assert (tmp_path / "died").exists()
    assert records == run(path, tmp_path / "whole")


@pytest.mark.long
@quiet
def test_a_task_that_dask_gives_up_ends_the_sweep_and_costs_no_record(tmp_path, refusal):
    path = write(tmp_path, f"[study.grid]\nmarker = ['{tmp_path / 'died'}']\n", 4)
    with dask.config.set({"distributed.scheduler.allowed-failures": 0}):
        sentence = refusal(run, path, tmp_path / "out", Dask(None, 1))
    assert "Dask gave a task up" in sentence
    assert "--resume" in sentence
    assert run(path, tmp_path / "out", resume=True) == run(path, tmp_path / "whole")


def test_a_stopped_job_goes_on_where_it_was(serial):
    path, _ = serial
    sweep = read_sweep(path, {})
    tasks = [sweep.task(n) for n in range(4)]
    chunk, seen = Chunk(work, tasks), []

    class Preempted(Exception):
        pass

    def stop(task):
        if task.number == 2:
            raise Preempted
        seen.append(task.number)
        return work(task)

    chunk.work = stop
    with pytest.raises(Preempted):
        chunk()
    again = chunk.checkpoint().function
    again.work = work
    assert [outcome.number for outcome in again()] == [0, 1, 2, 3]
    assert seen == [0, 1]


@pytest.mark.parametrize(
    ("word", "jobs", "options", "words"),
    [
        ("dusk", None, {}, "unknown backend 'dusk'; did you mean 'dask'"),
        ("processes", 0, {}, "--jobs 0: give 1 or more"),
        ("submitit-local", 1, {"tasks_per_job": "0"}, "give a whole number, 1 or more"),
        ("dask://127.0.0.1:1", 1, {}, "no Dask scheduler with a worker answers at tcp://127"),
    ],
)
@quiet
def test_what_a_backend_refuses(serial, tmp_path, refusal, monkeypatch, word, jobs, options, words):
    monkeypatch.setattr("identification.sweep.clusters.WAIT", 1)
    monkeypatch.setenv("PATH", str(tmp_path))  # no Slurm
    path, _ = serial

    def call():
        return run(path, tmp_path / "out", backend_of(word, jobs, tmp_path, options))

    assert words in refusal(call)
