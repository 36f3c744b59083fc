"""Plots beside the film: drawn once by matplotlib; then only a cursor moves over them."""

from __future__ import annotations

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from identification.report.style import GREY, INK, MEASURED, SIMULATED
from inca_mj.robot.geometry import DRIVES

_INCHES = 4.8  # width, so that letters grow with the picture
_CURSOR = np.round(255 * np.array(to_rgb(INK))).astype(np.uint8)


class Panel:
    """Motor angles of the eight drives over time, as pixels."""

    def __init__(self, time: np.ndarray, simulated: np.ndarray, measured: np.ndarray | None,
                 size: tuple[int, int]) -> None:  # fmt: skip
        """Draw the plots.

        Args:
            time: sample times, shape (N,) [s].
            simulated: motor angles, shape (N, 8) [rad].
            measured: motor angles, shape (N, 8) [rad]; not drawn when None.
            size: width and height [px].
        """
        dpi = size[0] / _INCHES
        figure = Figure((_INCHES, size[1] / dpi), dpi=dpi)
        canvas = FigureCanvasAgg(figure)
        axes = figure.subplots(DRIVES // 2, 2, sharex=True)
        # Low drives on the left, high ones on the right, as 1 and 5 share an edge of the frame.
        for k, ax in enumerate(axes.T.flat):
            if measured is not None:
                ax.plot(time, measured[:, k], color=MEASURED, lw=2.2, alpha=0.55)
            ax.plot(time, simulated[:, k], color=SIMULATED, lw=0.9)
            ax.set_title(f"φ{chr(0x2081 + k)}", fontsize=8, color=INK, pad=1.5, loc="left")
            ax.tick_params(labelsize=6, color=GREY, labelcolor=INK, length=2, pad=1.5)
            ax.locator_params(axis="y", nbins=3)
            ax.spines[["top", "right"]].set_visible(False)
            ax.spines[["left", "bottom"]].set_color(GREY)
            ax.set_xlim(time[0], time[-1])
        inch = dpi / size[1]  # in parts of the height
        figure.suptitle("motor angles [rad] over time [s]", fontsize=8.5, color=INK, va="center",
                        x=0.03, ha="left", y=1 - 0.14 * inch)  # fmt: skip
        lines = [Line2D([], [], color=SIMULATED, lw=0.9)]
        if measured is not None:
            lines.append(Line2D([], [], color=MEASURED, lw=2.2, alpha=0.55))
        figure.legend(lines, ["simulated", "measured"][: len(lines)], fontsize=7, frameon=False,
                      loc="upper right", ncols=2, borderaxespad=0.1)  # fmt: skip
        figure.subplots_adjust(left=0.08, right=0.97, top=1 - 0.45 * inch, bottom=0.26 * inch,
                               hspace=0.5, wspace=0.18)  # fmt: skip
        canvas.draw()
        self._still = np.asarray(canvas.buffer_rgba())[..., :3].copy()
        self._time = float(time[0]), float(time[-1])
        # Pixel rows count from the top, matplotlib's from the bottom.
        boxes = [ax.get_window_extent().extents for ax in axes.flat]
        self._boxes = [(x0, size[1] - y1, x1, size[1] - y0) for x0, y0, x1, y1 in boxes]

    def at(self, time: float) -> np.ndarray:
        """Returns the plots with the cursor at a time [s], shape (height, width, 3) of bytes."""
        picture = self._still.copy()
        first, last = self._time
        part = (time - first) / (last - first)
        for x0, y0, x1, y1 in self._boxes:
            x = round(x0 + part * (x1 - x0))
            picture[int(y0) : int(y1), x : x + 1] = _CURSOR
        return picture
