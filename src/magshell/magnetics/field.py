"""The external magnetic field."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.errors import InputError


@dataclass(frozen=True, eq=False)
class UniformField:
    """External flux density, the same everywhere, growing in proportion to the load factor.

    Parameters
    ----------
    flux_density : array_like, shape (3,)
        At load factor 1, T.
    stops : sequence of float
        Magnitudes of flux density, T, that the load path must hit; the end is always hit.

    Raises
    ------
    InputError
        Components that are not three finite numbers; stops outside the path or out of order.
    """

    flux_density: ArrayLike
    stops: ArrayLike = ()
    vector: FloatArray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        try:
            vector = np.array(self.flux_density, dtype=float)
            stops = np.array(self.stops, dtype=float).reshape(-1)
        except (TypeError, ValueError) as error:
            raise InputError(f"field: flux_density and stops are numbers (T): {error}") from None
        if vector.shape != (3,) or not np.all(np.isfinite(vector)):
            raise InputError(f"field: flux_density is {self.flux_density!r}; it needs 3 finite components (T)")
        magnitude = float(np.linalg.norm(vector))
        if not np.all(np.isfinite(stops)) or np.any(np.diff(stops) <= 0.0) or np.any(stops <= 0.0):
            raise InputError(f"field: stops are {stops.tolist()} T; they must be positive and increasing")
        if stops.size and stops[-1] > magnitude * (1.0 + 1e-12):
            raise InputError(
                f"field: the stop {stops[-1]:g} T is beyond the field's magnitude {magnitude:g} T at load factor 1"
            )
        vector.flags.writeable = False
        object.__setattr__(self, "vector", vector)
        object.__setattr__(self, "stops", tuple(float(stop) for stop in stops))

    @property
    def magnitude(self) -> float:
        """|B| at load factor 1, T."""
        return float(np.linalg.norm(self.vector))

    @property
    def stop_factors(self) -> list[float]:
        """Load factors that the path must hit, the end included."""
        inner = [stop / self.magnitude for stop in np.asarray(self.stops, dtype=float)]
        return [factor for factor in inner if factor < 1.0 - 1e-12] + [1.0]
