"""Ctrl-C ends the program within two seconds with exit code 130, whatever it is doing."""

import os
import signal
import subprocess
import sys
import time

import pytest

from identification.commands.stopping import STOPPED, stoppable

WITHIN = 5.0  # [s]; two are promised, on a machine that does nothing else
BUSY = {
    "python": "while True: pass",
    "waiting": "time.sleep(60)",
    "a thread": "with ThreadPoolExecutor(1) as w: w.submit(time.sleep, 60); time.sleep(60)",
    "text that is code": "exec('time.sleep(60)')",  # as in each dataclass that is imported
    "a function that machine code calls": "ctypes.CFUNCTYPE(None)(lambda: time.sleep(1))();"
    " time.sleep(60)",
    "native": "hashlib.pbkdf2_hmac('sha256', b'', b'', 2**31 - 1)",  # takes minutes
}
PROGRAM = """
import ctypes, hashlib, sys, time
from concurrent.futures import ThreadPoolExecutor
from identification.commands.stopping import STOPPED, at_end, stoppable
try:
    with stoppable("robot"):
        print("ready", flush=True)
        {}
except KeyboardInterrupt:
    at_end()
    sys.exit(STOPPED)
"""


def started(busy, folder):
    (folder / "robot.py").write_text(PROGRAM.format(busy))
    process = subprocess.Popen([sys.executable, "-m", "robot"], cwd=folder,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)  # fmt: skip
    assert process.stdout.readline() == b"ready\n"
    return process


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize("busy", BUSY)
def test_it_says_so_and_ends(busy, tmp_path):
    process = started(BUSY[busy], tmp_path)
    time.sleep(0.1)
    begun = time.monotonic()
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=60)[1].decode()
    assert process.returncode == STOPPED
    assert time.monotonic() - begun < WITHIN
    assert said == "robot: stopping …\n"


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_a_second_one_ends_it_at_once(tmp_path):
    process = started(BUSY["native"], tmp_path)
    begun = time.monotonic()
    for _ in range(2):
        time.sleep(0.1)
        process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    assert process.returncode == STOPPED
    assert time.monotonic() - begun < WITHIN


def test_what_was_there_before_is_put_back():
    before = signal.getsignal(signal.SIGINT)
    with stoppable("robot"):
        assert signal.getsignal(signal.SIGINT) is not before
    assert signal.getsignal(signal.SIGINT) is before
    woken = signal.set_wakeup_fd(-1)
    signal.set_wakeup_fd(woken)
    with stoppable("robot"):
        pass
    assert signal.set_wakeup_fd(woken) == woken


def wrap():
    try:
        signal.raise_signal(signal.SIGINT)
    except KeyboardInterrupt as error:
        raise TypeError("argument") from error


def test_an_interrupt_that_a_library_made_another_error_of_is_one():
    with pytest.raises(KeyboardInterrupt), stoppable("robot"):
        wrap()
