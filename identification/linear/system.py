"""A linear model about an operating point.

    δẋ = A δx + B δu,    δy = C δx + D δu                      continuous
    δx_{k+1} = A δx_k + B δu_k,  δy_k = C δx_k + D δu_k        discrete, u held over each sample

δx = x - x̄ and so on; at x̄ the state itself changes at the rate ẋ = f(x̄, ū), zero at rest. The
exact discretisation of an input that is held (zero-order hold) is one exponential:

    exp([A B; 0 0] h) = [A_h B_h; 0 I]
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from identification.errors import InputError
from identification.runtime.pool import one_blas_thread

FASTEST = 1e6  # [Hz]


@dataclass(frozen=True, kw_only=True)
class LinearSystem:
    """A, B, C, D with the names of states, inputs and outputs, and the operating point.

    Attributes:
        A: shape (nx, nx), in the units of the states per second; of a discrete system per sample.
        B: shape (nx, nu), likewise per unit of the inputs.
        C: shape (ny, nx), in the units of the outputs per unit of the states.
        D: shape (ny, nu), in the units of the outputs per unit of the inputs.
        states: names, nx of them.
        inputs: names, nu of them.
        outputs: names, ny of them.
        x: state at the operating point, shape (nx,), in the units of the states; the entries of a
            rotation that has no angle of its own are zero.
        u: inputs there, shape (nu,), in their units.
        y: outputs there, shape (ny,), in their units.
        rate: ẋ there, shape (nx,), in the units of the states per second; zero at rest.
        sampling_time: of a discrete system [s]; None of a continuous one.
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: np.ndarray
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    x: np.ndarray
    u: np.ndarray
    y: np.ndarray
    rate: np.ndarray
    sampling_time: float | None = None

    def discrete(self, rate: float) -> LinearSystem:
        """Returns the same system for inputs that are held between samples, exactly.

        Args:
            rate: of the samples [Hz].

        Raises:
            InputError: the rate is not above zero, or the system is discrete already.
        """
        if self.sampling_time is not None:
            raise InputError(
                f"the system is discrete already, with {self.sampling_time:g} s between samples;"
                " discretise the continuous one"
            )
        h = sampling_time_of(rate)
        with one_blas_thread():
            A, B = held_for(self.A, self.B, h)
        return replace(self, A=A, B=B, sampling_time=h)

    def ordered(self, states: Sequence[str]) -> LinearSystem:
        """Returns the same system with its states in another order.

        Args:
            states: the names of all states.

        Raises:
            InputError: they are not the system's states, each once.
        """
        if sorted(states) != sorted(self.states):
            raise InputError(
                f"an order of the states names each of {', '.join(self.states)} once; got"
                f" {', '.join(states)}"
            )
        k = [self.states.index(name) for name in states]
        return replace(
            self, A=self.A[np.ix_(k, k)], B=self.B[k], C=self.C[:, k], states=tuple(states),
            x=self.x[k], rate=self.rate[k],
        )  # fmt: skip

    def response(self, frequencies: np.ndarray) -> np.ndarray:
        """Returns the transfer function at some frequencies, in outputs per input.

        Args:
            frequencies: shape (n,) [Hz].

        Returns:
            C (s I - A)⁻¹ B + D, complex, shape (n, ny, nu), in the units of the outputs per unit of
            the inputs; s = i ω, or exp(i ω h) of a discrete system.
        """
        s = 2j * np.pi * np.asarray(frequencies, float)
        if self.sampling_time is not None:
            s = np.exp(s * self.sampling_time)
        matrices = s[:, None, None] * np.eye(len(self.A)) - self.A
        # Units of the states differ by many decades: solve with the states scaled alike.
        scale = balancing(self.A)
        matrices = matrices * scale / scale[:, None]
        B = np.broadcast_to(self.B / scale[:, None], (len(s), *self.B.shape)).astype(complex)
        return np.asarray((self.C * scale) @ np.linalg.solve(matrices, B) + self.D)

    def simulate(self, inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Simulates states and outputs of a discrete system that begins at its operating point.

        Args:
            inputs: at the samples, shape (N, nu), in their units.

        Returns:
            States, shape (N, nx), and outputs, shape (N, ny), in their units.

        Raises:
            InputError: the system is continuous, or the inputs have another shape.
        """
        if self.sampling_time is None:
            raise InputError("a continuous system has no samples; simulate discrete(rate)")
        δu = np.asarray(inputs, float)
        if δu.ndim != 2 or δu.shape[1] != len(self.u):
            raise InputError(f"inputs have shape {δu.shape}; the system takes (N, {len(self.u)})")
        δu = δu - self.u
        δx = np.zeros((len(δu), len(self.A)))
        for k in range(len(δu) - 1):
            δx[k + 1] = self.A @ δx[k] + self.B @ δu[k]
        return δx + self.x, δx @ self.C.T + δu @ self.D.T + self.y

    def to_scipy(self) -> Any:
        """Returns the system as a `scipy.signal.StateSpace`."""
        from scipy.signal import StateSpace

        dt = {} if self.sampling_time is None else {"dt": self.sampling_time}
        return StateSpace(self.A, self.B, self.C, self.D, **dt)

    def to_control(self) -> Any:
        """Returns the system as a `control.StateSpace`, with names of states, inputs and outputs.

        Raises:
            InputError: the package `control` is not installed.
        """
        try:
            import control
        except ImportError:
            raise InputError(
                "python-control is not installed; pip install 'inca-mj[linear]', or take to_scipy()"
            ) from None
        # A name with a dot would be split by python-control into a system and its signal.
        names = {
            key: [name.replace(".", "_") for name in getattr(self, key)]
            for key in ("states", "inputs", "outputs")
        }
        dt = 0 if self.sampling_time is None else self.sampling_time
        return control.ss(self.A, self.B, self.C, self.D, dt, **names)


def held_for(A: np.ndarray, B: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
    """Returns A_h and B_h of a continuous system whose inputs are held for h [s]."""
    from scipy.signal import cont2discrete

    A_h, B_h, *_ = cont2discrete((A, B, np.eye(len(A)), np.zeros_like(B)), h, method="zoh")
    return A_h, B_h


def sampling_time_of(rate: float) -> float:
    """Returns the time between samples [s] of a rate [Hz], or refuses the rate."""
    if not 0 < rate <= FASTEST:
        raise InputError(
            f"a rate of {rate:g} Hz is not between 0 and {FASTEST:g} Hz; give the rate at which the"
            " inputs are held, such as 100"
        )
    return 1 / rate


def balancing(A: np.ndarray) -> np.ndarray:
    """Returns scales of the states that make rows and columns of A of alike size, shape (nx,)."""
    from scipy.linalg import matrix_balance

    _, (scale, _) = matrix_balance(A, permute=False, separate=True)
    return np.asarray(scale)
