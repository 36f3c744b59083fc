"""What the strokes of a winch at constant speed say: only means count there.

    i = i_0 + G m + s (c + μ G m) + d ω + i_c(q),       G = g r/K_t,   s the sign of ω
    i_c(q) = Σ a_n cos nq + b_n sin nq                  the drive's own current against cogging

All in amperes of the motor. i_0 is whatever does not depend on the mass: a hook, a current's zero.
The data are lifting/ and dynamic_torque/ of eliasoa/TTK4900_CDPR (NTNU).
Run it: python examples/winch_strokes.py FOLDER [FIGURE.png]
"""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.io import loadmat

K_T, RADIUS, G = 0.0551, 0.020, 9.81  # [N m/A], [m], [m/s^2]: what the authors compute with
TURN = 2 * np.pi
PERIODS = (14, 28, 12)  # in a turn: 7 pole pairs and 12 slots; they stand out of 1..60
# Where the speed is constant, the cable taut and no hand on it [s]. 5kg/*/Up1 and 1kg/Up25 are
# beginnings of Down1 and Down25, and not counted twice.
STROKES = (
    ("5kg/ODrive2/Up05", 6, 22), ("5kg/ODrive2/Down05", 8, 24), ("5kg/ODrive2/Down1", 13.5, 21.5),
    ("5kg/ODrive2/Down1", 36.5, 43.8), ("5kg/ODrive2/Down25", 7, 9.5),
    ("1kg/ODrive2/Up05", 5, 23.5), ("1kg/ODrive2/Down05", 6, 25), ("1kg/ODrive2/Up1", 3.5, 13),
    ("1kg/ODrive2/Down1", 3, 12), ("1kg/ODrive2/Down25", 6.3, 9.1),
    ("1kg/ODrive2/Down25", 11.5, 18.5), ("1kg/ODrive2/Down25", 25.3, 28.4),
    ("1kg/ODrive2/Down25", 42.8, 45.8), ("1kg/ODrive2/Up4", 37.8, 40.2),
    ("1kg/ODrive2/Down4", 6.3, 8.3), ("5kg/ODrive0/Down05", 7, 22), ("5kg/ODrive0/Down1", 4, 11),
    ("5kg/ODrive0/Down1", 23, 30.3), ("5kg/ODrive0/Down25", 10, 17),
    ("5kg/ODrive0/Down25", 25.6, 28.2), ("5kg/ODrive0/Up4", 7.6, 9.2),
)  # fmt: skip


@dataclass(frozen=True)
class Stroke:
    """At constant speed: mass [kg], motor, ω [rad/s], mean current, its std over turns, the waves
    of i_c, and the samples: angles [rad] and currents [A]."""

    mass: int
    motor: int
    w: float
    mean: float
    std: float
    wave: np.ndarray
    q: np.ndarray
    i: np.ndarray

    def explained(self, wave):
        """Share of the current's variance that waves fitted elsewhere explain."""
        return 1 - np.var(self.i - waves(self.q) @ wave) / np.var(self.i)


def read_winch(folder, record):
    """Time [s], angle [rad], rate [rad/s], current [A] as they arrived; lifting is positive."""
    _, motor = mass_and_motor(record)
    table = np.genfromtxt(folder / f"{record}.csv", delimiter=",", skip_header=1)
    t, q, w, i = table[:, [0, 1 + motor, 5 + motor, 9 + motor]].T
    return t, TURN * q, TURN * w, -i


def waves(q):
    """cos nq and sin nq, shape (len(q), 6)."""
    return np.stack([f(n * q) for n in PERIODS for f in (np.cos, np.sin)], axis=-1)


def stroke(folder, record, begin, end):
    """What a record tells between two times [s]."""
    t, q, w, i = read_winch(folder, record)
    row = (t > begin) & (t < end) & np.isfinite(q + w + i)
    q, w, i = q[row], w[row], i[row]
    mean, *wave = np.linalg.lstsq(np.column_stack([np.ones_like(q), waves(q)]), i, rcond=None)[0]
    left, turn = i - waves(q) @ wave, (np.abs(q - q[0]) / TURN).astype(int)
    by_turn = [left[turn == k].mean() for k in range(turn.max())]
    std = np.std(by_turn) / np.sqrt(len(by_turn))
    return Stroke(*mass_and_motor(record), w.mean(), mean, std, np.array(wave), q, i)


def mass_and_motor(record):
    """Of "5kg/ODrive2/Up05": 5 and 2."""
    mass, motor, _ = record.split("/")
    return int(mass[0]), int(motor[-1])


def law(mass, w, terms=5):
    """Columns of i = i_0 + G m + s (c + μ G m) + d ω, the first `terms` of them."""
    s = np.sign(w)
    return np.column_stack([np.ones_like(w), mass, s, s * mass, w])[:, :terms]


def balance(strokes):
    """What the strokes of motor 2 say, and its slow ones of all others; i_0, G, c, μ G, d [A]."""
    print("strokes: motor, mass, speed of the drum (lifting is positive), mean current ± its std"
          " over turns, how far K_t i is above m g r")  # fmt: skip
    for s in sorted(strokes, key=lambda s: (s.motor, s.mass, s.w)):
        share = 100 * (s.mean * K_T / (s.mass * G * RADIUS) - 1)
        print(f"motor {s.motor}, {s.mass} kg, {s.w / TURN:+.2f} rev/s:"
              f" {s.mean:6.2f} ± {s.std:.2f} A, {share:+.1f} % of m g r")  # fmt: skip
    mass, motor, w, i = np.array([(s.mass, s.motor, s.w, s.mean) for s in strokes]).T
    slow = (motor == 2) & (np.abs(w) < 1.5 * TURN)
    print("fitted: i_0 torque without a mass, r radius at which the mass pulls, c Coulomb friction,"
          " μ its growth in shares of the load, d viscous friction; ± std")  # fmt: skip
    for rows, words in ((slow, "0.5 and 1 rev/s"), (motor == 2, "all strokes")):
        x, std = fitted(law(mass, w)[rows], i[rows])
        scale = np.array([1e3, 1e3 / G, 1e3, 100 / (K_T * x[1]), 1e3]) * K_T
        parts = zip(("i_0", "r", "c", "μ", "d"), scale * x, scale * std,
                    ("mN m", "mm", "mN m", "%", "mN m s/rad"), strict=True)  # fmt: skip
        print(f"motor 2, {words}:", ", ".join(f"{n} {v:.2f} ± {e:.2f} {u}" for n, v, e, u in parts))
    for rows, words in (((motor == 2) & ~slow, "faster strokes"), (motor == 0, "motor 0")):
        for terms, more in ((3, "Coulomb"), (4, "and load share"), (5, "and viscous")):
            A = law(mass, w, terms)
            e = K_T * (i - A @ fitted(A[slow], i[slow])[0])[rows]
            print(f"  {words}, not fitted, {more}: rms {1e3 * np.sqrt(np.mean(e**2)):.1f} mN m")
    return fitted(law(mass, w)[slow], i[slow])[0]


def fitted(A, b):
    """Least squares, and its std."""
    x = np.linalg.lstsq(A, b, rcond=None)[0]
    s2 = np.sum((b - A @ x) ** 2) / (len(A) - A.shape[1])
    return x, np.sqrt(s2 * np.diag(np.linalg.inv(A.T @ A)))


def without_load(folder):
    """What keeps the bare motors running, as the torque is lowered: c + d ω [N m], by motor."""
    log = loadmat(folder / "dynamic_torque" / "DynamicalTorque.mat")
    for motor, (torque, speed) in enumerate(zip(log["TorqueLog"], log["VelLog"], strict=True)):
        runs = (speed > 1) & (speed < 9)  # neither stuck nor at the limit of 10 rev/s
        A = np.column_stack([np.ones(runs.sum()), TURN * speed[runs]])
        (c, d), std = fitted(A, 1e3 * torque[runs])  # [mN m], [mN m s/rad]
        print(f"motor {motor} without load: c {c:.1f} ± {std[0]:.1f} mN m,"
              f" d {d:.3f} ± {std[1]:.3f} mN m s/rad")  # fmt: skip


def ripple(strokes, motor):
    """Waves of i_c from the first stroke of a motor, tried on its others."""
    first, *others = (s for s in strokes if s.motor == motor)
    sizes = (1e3 * K_T * np.hypot(first.wave[::2], first.wave[1::2])).round(1).tolist()
    print(f"motor {motor}: {sizes} mN m, {PERIODS} times in a turn; fitted on one stroke, of others"
          " explained:", ", ".join(f"{s.w / TURN:+.1f} rev/s {100 * s.explained(first.wave):.0f} %"
                                   for s in others))  # fmt: skip
    return first.wave


def draw(strokes, wave, amperes, path):
    """Current over a turn, and mean current over speed, with what was fitted elsewhere."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
    for k, words in ((1, "5 kg down"), (5, "1 kg up"), (6, "1 kg down")):
        s = strokes[k]
        left.plot(s.q % TURN / TURN, s.i - s.mean, ".", ms=2, label=f"{words}, 0.5 rev/s")
    turn = np.linspace(0, TURN, 600)
    left.plot(turn / TURN, waves(turn) @ wave, "k", lw=1, label="fitted on 5 kg up")
    left.set(xlabel="turn", ylabel="current - mean [A]", xlim=(0, 0.5), ylim=(-2.4, 3.6))
    left.legend(fontsize=7, ncols=2)
    for motor, mark in ((2, "o"), (0, "x")):
        rows = [(s.w / TURN, s.mean) for s in strokes if s.motor == motor]
        right.plot(*np.transpose(rows), mark, label=f"motor {motor}")
    for mass in (1, 5):
        for w in (np.linspace(-26, -2, 9), np.linspace(2, 26, 9)):
            right.plot(w / TURN, law(np.full(9, mass), w) @ amperes, "k", lw=0.8)
        right.axhline(mass * G * RADIUS / K_T, color="grey", ls=":", lw=0.8)
    right.set(xlabel="drum [rev/s], lifting positive", ylabel="mean current [A]")
    right.legend(fontsize=7)
    figure.savefig(path, dpi=110)


def main(folder, figure=None):
    """The balance, the bare motors, and the ripple of the current."""
    strokes = [stroke(folder / "lifting", *s) for s in STROKES]
    amperes = balance(strokes)
    without_load(folder)
    wave = {motor: ripple(strokes, motor) for motor in (2, 0)}
    if figure:
        draw(strokes, wave[2], amperes, figure)


if __name__ == "__main__":
    where = Path(sys.argv[1] if len(sys.argv) > 1 else "data/ttk4900")
    if (where / "lifting").exists() and (where / "dynamic_torque").exists():
        main(where, *sys.argv[2:3])
    else:
        print(f"{where} lacks lifting or dynamic_torque: see github.com/eliasoa/TTK4900_CDPR")
