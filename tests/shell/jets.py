"""Numbers that carry their exact first and second derivatives: the oracle that analytic tangents are tested against.

Arrays of jets are NumPy object arrays; `@`, `*`, `np.cross`, `np.sum` and the like work on them as they are.
"""

from __future__ import annotations

import math

import numpy as np


class Jet:
    """value + gradient · dx + dx · Hessian · dx / 2 of n variables; `value` may be any real number."""

    __slots__ = ("gradient", "hessian", "value")
    __array_ufunc__ = None  # NumPy scalars and arrays leave the operation to the methods below

    def __init__(self, value, gradient, hessian):
        self.value, self.gradient, self.hessian = value, gradient, hessian

    def through(self, value, first, second):
        """f(self), of the value and the first two derivatives of f there."""
        outer = np.outer(self.gradient, self.gradient)
        return Jet(value, first * self.gradient, first * self.hessian + second * outer)

    def __add__(self, other):
        if isinstance(other, np.ndarray):
            return _boxed(self) + other
        if isinstance(other, Jet):
            return Jet(self.value + other.value, self.gradient + other.gradient, self.hessian + other.hessian)
        return Jet(self.value + other, self.gradient, self.hessian)

    def __mul__(self, other):
        if isinstance(other, np.ndarray):
            return _boxed(self) * other
        if isinstance(other, Jet):
            a, b = self, other
            cross = np.outer(a.gradient, b.gradient)
            hessian = a.value * b.hessian + b.value * a.hessian + cross + cross.T
            return Jet(a.value * b.value, a.value * b.gradient + b.value * a.gradient, hessian)
        return Jet(self.value * other, self.gradient * other, self.hessian * other)

    def __pow__(self, power):
        v = self.value
        return self.through(v**power, power * v ** (power - 1), power * (power - 1) * v ** (power - 2))

    def __neg__(self):
        return self * -1.0

    def __sub__(self, other):
        return self + (-other)

    def __rsub__(self, other):
        return (-self) + other

    def __truediv__(self, other):
        return self * other**-1.0

    def __rtruediv__(self, other):
        return self**-1.0 * other

    __radd__ = __add__
    __rmul__ = __mul__


def _boxed(jet):
    box = np.empty((), dtype=object)
    box[()] = jet
    return box


def log(jet):
    """Natural logarithm."""
    return jet.through(math.log(jet.value), 1.0 / jet.value, -1.0 / jet.value**2)


def sqrt(jet):
    """Square root."""
    return jet**0.5


def variables(values):
    """The values (any shape) as independent variables, numbered in C order."""
    values = np.asarray(values, dtype=float)
    count = values.size
    jets = np.empty(count, dtype=object)
    for i, value in enumerate(values.ravel()):
        jets[i] = Jet(value, np.eye(count)[i], np.zeros((count, count)))
    return jets.reshape(values.shape)


def constants(values, count):
    """The values (any shape) as numbers that do not depend on any of `count` variables."""
    values = np.asarray(values, dtype=float)
    jets = np.empty(values.size, dtype=object)
    for i, value in enumerate(values.ravel()):
        jets[i] = Jet(value, np.zeros(count), np.zeros((count, count)))
    return jets.reshape(values.shape)


def _part(jets, name):
    jets = np.asarray(jets, dtype=object)
    parts = np.array([getattr(jet, name) for jet in jets.ravel()])
    return parts.reshape(jets.shape + parts.shape[1:])


def value(jets):
    """Values, the shape of the array."""
    return _part(jets, "value")


def gradient(jets):
    """First derivatives, one more axis."""
    return _part(jets, "gradient")


def hessian(jets):
    """Second derivatives, two more axes."""
    return _part(jets, "hessian")
