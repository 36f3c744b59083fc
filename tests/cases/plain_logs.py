"""A log by its columns alone."""

import numpy as np

from identification import Log


def log_of(u, y, inputs, outputs, step=0.01, **more):
    """A log from t = 0 on; its names stand in one text, with blanks between them, or in a tuple."""
    names = [text.split() if isinstance(text, str) else text for text in (inputs, outputs)]
    more = {"time": step * np.arange(len(u)), **more}
    return Log(inputs=u, outputs=y, input_names=names[0], output_names=names[1], **more)
