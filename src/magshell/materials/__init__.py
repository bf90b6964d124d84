"""Material laws, one per file."""

from magshell.materials.law import Material, laws
from magshell.materials.mooney_rivlin import MicropolarMooneyRivlin
from magshell.materials.neo_hookean import MicropolarNeoHookean
from magshell.materials.st_venant_kirchhoff import MicropolarStVenantKirchhoff

__all__ = ["Material", "MicropolarMooneyRivlin", "MicropolarNeoHookean", "MicropolarStVenantKirchhoff", "laws"]
