"""Abaqus and CalculiX input files: nodes, elements, sets and surfaces of parts, of their instances and of the assembly.

meshio's reader is not used for them: it loses an element set that two blocks of elements share, the nodes of every
`*NODE` block but the last, sets written with `GENERATE` over several lines, and all that is said of instances and
coordinate systems.

`keywords` takes the text apart, `scope` is what a part, an instance or the assembly holds, `blocks` and `generators`
fill one, `deck` knows which keyword belongs to which scope, and `flattening` puts all into one mesh.
"""

from magshell.mesh.files.inp.deck import read_inp

__all__ = ["read_inp"]
