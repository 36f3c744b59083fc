"""A callback from the cache is the compiled one; what cannot be trusted is compiled anew."""

import hashlib
import os
import pickle
import stat
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from cache_cases import SIGNATURE, power
from numba.extending import register_jitable

from identification.native import cache
from identification.native.cache import compile_once, decode, encode


def half(q, v):
    return 0.5 * q * v


def test_what_is_loaded_is_what_was_compiled(folder, compiler, same_as_python):
    compiled = same_as_python(compile_once(power, SIGNATURE))
    loaded = same_as_python(compile_once(power, SIGNATURE))
    np.testing.assert_array_equal(compiled, loaded)
    assert compiler.count == 1
    assert len(list(folder.iterdir())) == 1


def test_what_many_need_at_once_is_compiled_once(folder, compiler, same_as_python):
    with ThreadPoolExecutor(8) as pool:
        asked = [pool.submit(compile_once, power, SIGNATURE) for _ in range(8)]
    for callback in asked:
        same_as_python(callback.result())
    assert compiler.count == 1
    assert [e.suffix for e in folder.iterdir()] == [""]  # and no lock is left


def test_who_may_not_compile_lets_the_next_one_in(folder, compiler, same_as_python, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(cache, "compile_callback", interrupted)
        with pytest.raises(KeyboardInterrupt):
            compile_once(power, SIGNATURE)
    same_as_python(compile_once(power, SIGNATURE))
    assert compiler.count == 1


def interrupted(function, signature):
    raise KeyboardInterrupt


def content(change):
    """Writes other bytes into an entry."""

    def spoil(entry):
        entry.write_bytes(change(entry.read_bytes()))

    return spoil


def flipped(at):
    """Changes one bit of an entry."""
    return content(lambda old: old[:at] + bytes([old[at] ^ 1]) + old[at:][1:])


def other_key(entry):
    """The entry of another callback, under this one's name."""
    code = decode(entry.name, entry.read_bytes())
    entry.write_bytes(encode("0" * 64, code))


def other_needs(entry):
    """Code for a process that has more than this one."""
    code = decode(entry.name, entry.read_bytes())
    needs = (*code.needs, "no_such_symbol")
    entry.write_bytes(encode(entry.name, cache.MachineCode(code.symbol, needs, b"")))


def other_layout(*lines):
    """An entry with the right key and digest, of which the rest is laid out otherwise."""

    def spoil(entry):
        rest = b"\n".join(lines)
        digest = hashlib.sha256(entry.name.encode() + b"\n" + rest).hexdigest().encode()
        form = entry.read_bytes().split(b"\n", 1)[0]
        entry.write_bytes(b"\n".join((form, entry.name.encode(), digest, rest)))

    return spoil


def mode(bits):
    def spoil(entry):
        entry.chmod(bits)

    return spoil


def linked(entry):
    elsewhere = entry.with_name("elsewhere")
    entry.rename(elsewhere)
    entry.symlink_to(elsewhere)


def hard_linked(entry):
    os.link(entry, entry.with_name("elsewhere"))


def pipe(entry):
    entry.unlink()
    os.mkfifo(entry, 0o600)
    return os.fdopen(os.open(entry, os.O_RDWR), "wb")  # whoever reads it waits


SPOILED = {
    "truncated": content(lambda old: old[:-1]),
    "emptied": content(lambda old: b""),
    "other format": flipped(0),
    "other digest": flipped(100),
    "other symbol": flipped(160),
    "other code": flipped(-20),
    "other key": other_key,
    "other needs": other_needs,
    "too few lines": other_layout(b"symbol", b"code"),
    "no text": other_layout(b"symbol", b"\x7fELF\xb8", b"code"),
    "writable by all": mode(0o602),
    "writable by the group": mode(0o620),
    "linked": linked,
    "hard linked": hard_linked,
    "pipe": pipe,
}


@pytest.mark.parametrize("spoil", SPOILED.values(), ids=SPOILED)
def test_a_spoiled_entry_is_compiled_anew_and_replaced(entry, spoil, compiler, same_as_python):
    good = entry.read_bytes()
    held = spoil(entry)
    same_as_python(compile_once(power, SIGNATURE))
    if held is not None:
        held.close()
    assert compiler.count == 1
    state = entry.lstat()
    assert stat.S_ISREG(state.st_mode)
    assert stat.S_IMODE(state.st_mode) == 0o600
    assert decode(entry.name, entry.read_bytes()).needs == decode(entry.name, good).needs
    same_as_python(compile_once(power, SIGNATURE))
    assert compiler.count == 1


def test_an_entry_of_another_user_is_replaced(entry, compiler, same_as_python, monkeypatch):
    fstat, before = os.fstat, entry.stat().st_ino

    def foreign(file):
        state = list(fstat(file))
        if stat.S_ISREG(state[stat.ST_MODE]):
            state[stat.ST_UID] += 1
        return os.stat_result(state)

    with monkeypatch.context() as patch:
        patch.setattr(os, "fstat", foreign)
        same_as_python(compile_once(power, SIGNATURE))
    assert compiler.count == 1
    assert entry.stat().st_ino != before
    same_as_python(compile_once(power, SIGNATURE))
    assert compiler.count == 1


def as_another_user(folder, monkeypatch):
    owner = os.getuid()
    monkeypatch.setattr(os, "getuid", lambda: owner + 1)


def open_to_all(folder, monkeypatch):
    folder.chmod(0o777)


def linked_folder(folder, monkeypatch):
    folder.rename(folder.with_name("elsewhere"))
    folder.symlink_to(folder.with_name("elsewhere"))


def file_in_its_place(folder, monkeypatch):
    for entry in folder.iterdir():
        entry.unlink()
    folder.rmdir()
    folder.touch()


def homeless(folder, monkeypatch):
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setattr(os.path, "expanduser", lambda path: path)


UNSAFE = [as_another_user, open_to_all, linked_folder, file_in_its_place, homeless]


@pytest.mark.parametrize("spoil", UNSAFE)
def test_an_unsafe_folder_is_left_alone(entry, spoil, compiler, same_as_python, monkeypatch):
    folder = entry.parent
    spoil(folder, monkeypatch)
    before = contents(folder)
    for _ in range(2):
        same_as_python(compile_once(power, SIGNATURE))
    assert compiler.count == 2
    assert contents(folder) == before


def contents(folder):
    return {e: e.read_bytes() for e in folder.iterdir()} if folder.is_dir() else folder.exists()


def test_a_folder_that_is_only_read(entry, compiler, same_as_python, monkeypatch):
    opened = os.open

    def read_only(path, flags, *args, **kwargs):
        if flags & os.O_CREAT:
            raise PermissionError(13, "Permission denied", path)
        return opened(path, flags, *args, **kwargs)

    monkeypatch.setattr(os, "open", read_only)
    same_as_python(compile_once(power, SIGNATURE))
    assert compiler.count == 0
    for _ in range(2):
        same_as_python(compile_once(half, SIGNATURE), half)
    assert compiler.count == 2
    assert list(entry.parent.iterdir()) == [entry]


def test_the_environment_switches_it_off(entry, compiler, same_as_python, monkeypatch):
    monkeypatch.setenv(cache.VARIABLE, "off")
    same_as_python(compile_once(power, SIGNATURE))
    same_as_python(compile_once(half, SIGNATURE), half)
    assert compiler.count == 2
    assert list(entry.parent.iterdir()) == [entry]


def test_nothing_is_unpickled(entry, compiler, same_as_python, monkeypatch):
    def refuse(*args, **kwargs):
        raise AssertionError("unpickled")

    for name in ("load", "loads", "Unpickler"):
        monkeypatch.setattr(pickle, name, refuse)
    written = entry.read_bytes()
    same_as_python(compile_once(power, SIGNATURE))
    assert compiler.count == 0
    *header, object_file = written.split(b"\n", 5)
    assert object_file[:4] in (b"\x7fELF", b"\xcf\xfa\xed\xfe")
    assert header[:2] == [b"inca_mj machine code 1", entry.name.encode()]


@register_jitable
def plain(x):
    return 2.0 * x


def calls_plain(q, v):
    return plain(q)


def test_what_numba_may_exchange_for_other_code_is_compiled_in_memory(
    folder, compiler, same_as_python
):
    for _ in range(2):
        same_as_python(compile_once(calls_plain, SIGNATURE), calls_plain)
    assert compiler.count == 2
    assert not folder.exists()
