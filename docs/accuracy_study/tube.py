r"""The pump at small fields by linear thin-shell theory: Fourier series around, polynomials along.

Koiter–Sanders strains of a cylinder of radius R, with u along the axis, v around and w outward; primes are derivatives
along the axis, dots along the angle ψ:

    ε_x = u',  ε_ψ = (v· + w)/R,  γ = u·/R + v',
    κ_x = w'',  κ_ψ = (w·· - v·)/R²,  κ_xψ = (w'· - 3/4 v' + u·/(4R))/R.

The couple of the remanence, B̃ × B/μ0 per volume, is c0 sin ψ per area about the axis on the side X1 > 0 and its mirror
image on the other, c0 = h B̃ B/μ0. It works on the rotation β = (v - w·)/R of the normal. Only even harmonics n occur:

    c0 sin ψ sgn(cos ψ) = Σ b_n sin nψ,  b_n = (4 c0/π) (-1)^(n/2+1) n/(n² - 1).

With w = Σ W_n cos nψ, v = Σ V_n sin nψ, u = Σ U_n cos nψ the harmonics decouple. W, V, U are Legendre polynomials times
factors that vanish, with W', at the clamped ends. Couple stress adds ½ μ l² h |∇ω|² with the shell's own rotation

    ω = β e_x + w' e_ψ + ½ (u·/R - v') e_n.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial
from numpy.polynomial.legendre import Legendre, leggauss

Fields = tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Tube:
    """A tube clamped at both ends.

    Attributes
    ----------
    radius, half_length, thickness : float
        m.
    shear_modulus, lame_lambda, couple_modulus : float
        mu and lambda, Pa; mu l², N.
    couple : float
        B̃ B/μ0, Pa.
    """

    radius: float
    half_length: float
    thickness: float
    shear_modulus: float
    lame_lambda: float
    couple_modulus: float
    couple: float

    def side(self, harmonics: int = 24, terms: int = 24) -> float:
        """Displacement outward at ψ = 0 in the middle section, m."""
        points, weights = leggauss(3 * terms)
        fields, middle = self._fields(terms, points), self._fields(terms, np.zeros(1))[2][0][:, 0]
        return sum(float(self._harmonic(2 * k, fields, weights) @ middle) for k in range(1, harmonics + 1))

    def _harmonic(self, n: int, fields: Fields, weights: np.ndarray) -> np.ndarray:
        """Factors of the functions in the n-th harmonic."""
        mu, lam, R, h = self.shear_modulus, self.lame_lambda, self.radius, self.thickness
        young, poisson = mu * (3.0 * lam + 2.0 * mu) / (lam + mu), lam / (2.0 * (lam + mu))
        membrane = young * h / (1.0 - poisson**2)
        bending = membrane * h**2 / 12.0
        plane = np.array([[1.0, poisson, 0.0], [poisson, 1.0, 0.0], [0.0, 0.0, 0.5 * (1.0 - poisson)]])
        u, v, w = fields
        strain = np.stack([u[1], (n * v[0] + w[0]) / R, -n * u[0] / R + v[1]])
        curvature = np.stack(
            [w[2], -(n**2 * w[0] + n * v[0]) / R**2, 2.0 * (-n * w[1] - 0.75 * v[1] - 0.25 * n * u[0] / R) / R]
        )
        beta, beta_x = ((v[i] + n * w[i]) / R for i in (0, 1))
        turn, turn_x = (0.5 * (-n * u[i] / R - v[i + 1]) for i in (0, 1))
        wryness = np.stack([beta_x, w[2], turn_x, n * beta / R, (turn - n * w[1]) / R, (n * turn - w[1]) / R])
        stiffness = membrane * np.einsum("aip,ab,bjp,p->ij", strain, plane, strain, weights)
        stiffness += bending * np.einsum("aip,ab,bjp,p->ij", curvature, plane, curvature, weights)
        stiffness += self.couple_modulus * h * np.einsum("aip,ajp,p->ij", wryness, wryness, weights)
        b = 4.0 * self.couple * h / np.pi * (-1.0) ** (n // 2 + 1) * n / (n**2 - 1.0)
        scale = 1.0 / np.sqrt(np.diag(stiffness))
        return scale * np.linalg.solve(stiffness * np.outer(scale, scale), -b * scale * (beta @ weights))

    def _fields(self, terms: int, points: np.ndarray) -> Fields:
        """Of u, v, w: functions and their first two derivatives along the axis (3, functions, points)."""
        even, odd = range(0, 2 * terms, 2), range(1, 2 * terms, 2)
        every = []
        for place, (degrees, power) in enumerate(((odd, 1), (even, 1), (even, 2))):
            values = np.zeros((3, 3 * terms, len(points)))
            for row, degree in enumerate(degrees):
                function = Legendre.basis(degree) * Polynomial([1.0, 0.0, -1.0]).convert(kind=Legendre) ** power
                for order in range(3):
                    values[order, place * terms + row] = function.deriv(order)(points) / self.half_length**order
            every.append(values)
        return every[0], every[1], every[2]
