"""Random robots of one joint as they are logged: rests, stiction, encoders, commands at a limit."""

import numpy as np

from identification import Log


def joint_log(seed, samples=1500):
    """Returns a right log of a random joint: its drive's force, its position, perhaps its rate.

    A mass with viscous and dry friction, in half of the logs with a spring, in some with an end
    stop; the force is a multisine, steps, or a servo's, is cut at a limit, and rests for a while
    in half of the logs.
    """
    rng = np.random.default_rng(seed)
    h = float(rng.choice([0.002, 0.005, 0.01, 0.02]))
    t = h * np.arange(samples)
    slow = 10 ** rng.uniform(0.3, 1.2)  # periods in the log
    kind = rng.choice(["sines", "steps", "servo"])
    phase = rng.uniform(0, 7, 4)
    wave = sum(np.sin(2 * np.pi * slow * f * t / t[-1] + p) / f
               for f, p in zip((1.0, 1.7, 2.9, 5.3), phase, strict=True))  # fmt: skip
    hold = int(rng.integers(5, 120))
    steps = np.repeat(rng.uniform(-1, 1, samples // hold + 1), hold)[:samples]
    command = steps if kind == "steps" else wave
    if rng.random() < 0.5:  # the drive is off for a while
        first = int(rng.integers(0, samples - 300))
        command = np.where(
            (t >= t[first]) & (t < t[first + int(rng.integers(80, 300))]), 0, command
        )
    if rng.random() < 0.5:
        command = np.clip(command, -0.5, 0.5)
    damping, dry = rng.uniform(0.2, 3), rng.choice([0.0, 0.1, 0.4])
    spring = rng.choice([0.0, 20.0])
    stop = rng.choice([0.05, 100.0])
    x = v = 0.0
    force, place, rate = np.zeros(samples), np.zeros(samples), np.zeros(samples)
    for k in range(samples):
        place[k], rate[k] = x, v
        u = 60 * (0.3 * command[k] - x) - 8 * v if kind == "servo" else 4 * command[k]
        force[k] = u = float(np.clip(u, -5, 5))
        for _ in range(4):
            push = u - damping * v - spring * x
            free = v + h / 4 * push
            v = float(np.sign(free) * max(0.0, abs(free) - h / 4 * 4 * dry))
            x += h / 4 * v
            if abs(x) > stop:
                x, v = float(np.clip(x, -stop, stop)), 0.0
    width = np.ptp(place) or 1.0
    noise = width * rng.choice([0.0, 1e-5, 1e-3])
    encoder = width * rng.choice([0.0, 1e-4, 3e-3, 0.05])
    seen = place + noise * rng.standard_normal(samples)
    if encoder:
        seen = encoder * np.round(seen / encoder)
    outputs, names = [seen], ["q"]
    if rng.random() < 0.3:
        outputs.append(rate + 1e-3 * np.ptp(rate) * rng.standard_normal(samples))
        names.append("v")
    return Log(time=t, inputs=force[:, None], outputs=np.stack(outputs, axis=1),
               input_names=["u"], output_names=names, name=f"joint {seed}")  # fmt: skip


def stuck(log, seed, fewest=60, most=300):
    """Returns outputs of a log whose position is stuck for a while, and first and last sample."""
    rng = np.random.default_rng(seed)
    length = int(rng.integers(fewest, most))
    first = int(rng.integers(50, len(log) - length - 50))
    outputs = log.outputs.copy()
    outputs[first : first + length, 0] = outputs[first, 0]
    return outputs, first, first + length - 1
