"""The surface of a field of margins, as triangles that can be drawn.

Each cell between eight points of the grid that are not all inside or all outside gets one vertex,
the mean of the points where its edges cross zero (linear between their ends). Each edge of the grid
that crosses zero gets the square of the four cells around it, as two triangles that look outwards.
(Gibson 1998, Constrained elastic surface nets, without the elastic part.)
"""

from __future__ import annotations

from itertools import product

import numpy as np

CLIP = 0.25  # margins far from the border do not move it: quantile of those inside


def surface(
    axes: tuple[np.ndarray, np.ndarray, np.ndarray], margin: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Returns vertices and triangles of the surface where a margin is zero.

    Args:
        axes: coordinates of the grid along x, y and z, evenly spaced [m].
        margin: at its points, positive inside, shape (X, Y, Z), any unit.

    Returns:
        Vertices, shape (V, 3) [m], and the vertices of each triangle, seen from outside against the
        clock, shape (F, 3) of whole numbers. Both are empty where no point is inside.
    """
    if not (margin > 0).any():
        return np.empty((0, 3)), np.empty((0, 3), int)
    most = float(np.quantile(margin[margin > 0], CLIP))
    field = np.pad(np.clip(margin, -most, most), 1, constant_values=-most)
    steps = np.array([a[1] - a[0] for a in axes])
    origin = np.array([a[0] for a in axes]) - steps
    inside = field > 0

    corners = list(product((0, 1), repeat=3))
    shape = tuple(n - 1 for n in field.shape)
    total, count = np.zeros((*shape, 3)), np.zeros(shape)
    for a, b in ((p, q) for p in corners for q in corners if sum(q) - sum(p) == 1 and p < q):
        if sum(abs(i - j) for i, j in zip(a, b, strict=True)) != 1:
            continue
        f, g = field[_shifted(a, shape)], field[_shifted(b, shape)]
        crossed = (f > 0) != (g > 0)
        t = np.divide(f, f - g, where=crossed, out=np.zeros_like(f))
        point = np.array(a) + t[..., None] * (np.array(b) - np.array(a))
        total += np.where(crossed[..., None], point, 0.0)
        count += crossed
    cells = np.argwhere(count > 0)
    number = np.full(shape, -1)
    number[tuple(cells.T)] = np.arange(len(cells))
    at = tuple(cells.T)
    vertices = origin + steps * (cells + total[at] / count[at][:, None])

    faces = []
    for axis in range(3):
        first = np.argwhere(np.diff(inside.astype(int), axis=axis) != 0)
        u, v = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
        around = [first - i * u - j * v for i, j in ((1, 1), (0, 1), (0, 0), (1, 0))]
        square = np.stack([number[tuple(cell.T)] for cell in around], axis=1)
        entering = ~inside[tuple(first.T)]  # from outside to inside: looks back
        square[entering] = square[entering][:, ::-1]
        faces += [square[:, [0, 1, 2]], square[:, [0, 2, 3]]]
    return vertices, np.concatenate(faces)


def _shifted(corner: tuple[int, ...], shape: tuple[int, ...]) -> tuple[slice, ...]:
    return tuple(slice(c, c + n) for c, n in zip(corner, shape, strict=True))
