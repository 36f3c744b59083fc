"""Files as no program writes them: a right file with one to four changes, drawn by chance.

Half of the changes keep a text's grammar and replace one number, word or line by a hostile one, so
that they pass the parser and reach what stands behind it; the others change bytes.
"""

import io
import random
import re
from collections.abc import Callable

import numpy as np

_NUMBER = re.compile(rb"[-+]?\d[\w.+-]*")
_WORD = re.compile(rb"[A-Za-z_][\w.-]*")
_QUOTED = re.compile(rb'"[^"\n]*"')
HOSTILE = (
    b"nan", b"inf", b"-inf", b"0", b"-0.0", b"-1", b"1e308", b"1e-320", b"1e999", b"2147483648",
    b"9223372036854775808", b"9" * 400, b'""', b'"x"', b"true", b"[]", b"{}", b"null", b"''", b"",
    b"1 2", b"1,2", "\u0663".encode(), "\u00e9".encode(), b"\xff\xfe", b"\x00", b"$\\bad{$",
    b"<b>&amp;", b"../..", b"[[1]]", b"{a = 1}", b"1_000", b"0x10", b"1979-05-27",
    b"\\u0000", b"\\ud800", "\u00b2".encode(), 2000 * b"[", b"/dev/zero", b"/proc/self/mem", b"..",
)  # fmt: skip
ARRAYS: tuple[Callable[[np.ndarray], np.ndarray], ...] = (
    lambda a: a * np.nan if a.dtype.kind == "f" else a,
    lambda a: a * np.inf if a.dtype.kind == "f" else a,
    lambda a: a * 1e300 if a.dtype.kind == "f" else a,
    lambda a: -a if a.dtype.kind == "f" else a,
    lambda a: a[:0] if a.ndim else a,
    lambda a: a[:-1] if a.ndim else a,
    lambda a: a[None],
    lambda a: a.T,
    lambda a: a.ravel(),
    lambda a: a.astype(complex) if a.dtype.kind == "f" else a,
    lambda a: a.astype(str),
    lambda a: a.astype(np.int8) if a.dtype.kind == "f" else a,
    lambda a: a.astype(bool),
    lambda a: np.zeros((2, 2)),
    lambda a: np.array("x"),
)


def mutated(raw: bytes, chance: random.Random) -> bytes:
    """A file's bytes with one to four changes.

    Args:
        raw: a right file.
        chance: draws them.
    """
    changes = [*_BYTES, *_TEXT, *_TEXT] if _is_text(raw) else _BYTES
    if raw[:2] == b"PK" and chance.random() < 0.8:
        return _other_arrays(raw, chance)
    for _ in range(chance.choice((1, 1, 2, 4))):
        raw = chance.choice(changes)(raw, chance)
    return raw


def _is_text(raw: bytes) -> bool:
    return b"\x00" not in raw[:1024]


def _other_arrays(raw: bytes, chance: random.Random) -> bytes:
    """An .npz of which one or two arrays are others, missing, or renamed."""
    with np.load(io.BytesIO(raw)) as file:
        arrays = {name: file[name] for name in file}
    for name in chance.sample([*arrays], min(len(arrays), chance.choice((1, 1, 2)))):
        array, draw = arrays.pop(name), chance.random()
        if draw < 0.8:
            with np.errstate(all="ignore"):
                arrays[name] = chance.choice(ARRAYS)(array)
        elif draw < 0.9:
            arrays[name + "_"] = array
    out = io.BytesIO()
    np.savez(out, allow_pickle=False, **arrays)
    return out.getvalue()


def _cut(raw: bytes, chance: random.Random) -> tuple[bytes, bytes, bytes]:
    """The bytes before, in and behind a short piece."""
    first = chance.randrange(len(raw) + 1)
    last = min(len(raw), first + int(2 ** chance.uniform(0, 8)))
    return raw[:first], raw[first:last], raw[last:]


def _flip(raw: bytes, chance: random.Random) -> bytes:
    out = bytearray(raw)
    for _ in range(chance.choice((1, 2, 8))):
        if out:
            out[chance.randrange(len(out))] = chance.randrange(256)
    return bytes(out)


def _leave_out(raw: bytes, chance: random.Random) -> bytes:
    before, _, behind = _cut(raw, chance)
    return before + behind


def _double(raw: bytes, chance: random.Random) -> bytes:
    before, piece, behind = _cut(raw, chance)
    return before + chance.choice((2, 3, 1000)) * piece + behind


def _insert(raw: bytes, chance: random.Random) -> bytes:
    before, piece, behind = _cut(raw, chance)
    return before + chance.choice((chance.randbytes(8), *HOSTILE)) + piece + behind


def _end_early(raw: bytes, chance: random.Random) -> bytes:
    return raw[: chance.randrange(len(raw) + 1)]


def _replace(pattern: re.Pattern[bytes], raw: bytes, chance: random.Random) -> bytes:
    """One match of a pattern as a hostile one, or as another match."""
    found = [m.span() for m in pattern.finditer(raw)]
    if not found:
        return raw
    first, last = chance.choice(found)
    other = chance.choice(found)
    new = chance.choice(HOSTILE) if chance.random() < 0.7 else raw[slice(*other)]
    if chance.random() < 0.3 and raw[first:last].startswith(b'"'):
        new = b'"' + new.strip(b'"') + b'"'  # of another value, still a text
    return raw[:first] + new + raw[last:]


def _number(raw: bytes, chance: random.Random) -> bytes:
    return _replace(_NUMBER, raw, chance)


def _word(raw: bytes, chance: random.Random) -> bytes:
    return _replace(_WORD, raw, chance)


def _quoted(raw: bytes, chance: random.Random) -> bytes:
    return _replace(_QUOTED, raw, chance)


def _line(raw: bytes, chance: random.Random) -> bytes:
    """A line left out, doubled, or put elsewhere."""
    lines = raw.split(b"\n")
    taken = lines.pop(chance.randrange(len(lines)))
    for _ in range(chance.choice((0, 1, 2))):
        lines.insert(chance.randrange(len(lines) + 1), taken)
    return b"\n".join(lines)


_BYTES: tuple[Callable[[bytes, random.Random], bytes], ...] = (
    _flip, _leave_out, _double, _insert, _end_early,
)  # fmt: skip
_TEXT: tuple[Callable[[bytes, random.Random], bytes], ...] = (_number, _word, _quoted, _line)
