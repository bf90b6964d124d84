"""The coupling laws written independently of the package: an energy, or the forces of a law that has none."""

from __future__ import annotations

import numpy as np

from magshell.magnetics import DeformationGradientEnergy, MicropolarCouple, MicroRotationEnergy

ENERGIES = {
    DeformationGradientEnergy: lambda law, m, n, B: -(m @ B) / law.vacuum_permeability,
    MicroRotationEnergy: lambda law, m, n, B: -(n @ B) / law.vacuum_permeability,
}
"""Energy per unit reference volume of m = F B̃ and n = R̃ B̃, for arrays of jets; a new law needs its entry here or …"""

FORCES = {
    MicropolarCouple: lambda law, m, n, B: (0.0 * m, -np.cross(m, B) / law.vacuum_permeability),
}
"""… here, if it has no energy: f, which works on δm, and c, which works on the spin (minus the external couple)."""
