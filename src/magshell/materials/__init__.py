"""Material laws, one per file."""

from magshell.materials.law import Material, laws
from magshell.materials.mooney_rivlin import MicropolarMooneyRivlin
from magshell.materials.neo_hookean import MicropolarNeoHookean

__all__ = ["Material", "MicropolarMooneyRivlin", "MicropolarNeoHookean", "laws"]
