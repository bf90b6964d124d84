"""What can go wrong, in the user's terms: bad input, a bad mesh."""

from __future__ import annotations

import errno
import re
from collections.abc import Iterable

from magshell.nearest import nearest


class InputError(ValueError):
    """The problem as stated cannot be solved; the message says what, where, and what would be right."""


class NothingLoads(InputError):
    """Nothing acts on the shell: it stays undeformed."""


class MeshError(InputError):
    """The mesh cannot carry a shell; the message names elements or nodes."""


# What Python, its threads and the loader of libraries say.
_NO_MEMORY = (
    "failed to map segment",
    "cannot allocate memory",
    "can't start new thread",
    "cannot create shared object",
)


def lacks_memory(error: BaseException | None) -> bool:
    """Whether an error, or one that it comes from, is that there is not enough memory."""
    while error is not None:
        if isinstance(error, MemoryError) or (isinstance(error, OSError) and error.errno == errno.ENOMEM):
            return True
        if any(text in str(error).lower() for text in _NO_MEMORY):
            return True
        error = error.__cause__ or error.__context__
    return False


def suggest(name: object, valid: Iterable[str]) -> str:
    """Sentence that names the nearest valid name, or lists what there is."""
    names = sorted(valid)
    if not names:
        return "There is none."
    near = nearest(name, names) if isinstance(name, str) else None
    listed = ", ".join(names[:20]) + (", …" if len(names) > 20 else "")
    meant = " or ".join(f"'{one}'" for one in names if near and _is_named_after(one, near))
    return (f"Did you mean {meant}? " if meant else "") + f"There is: {listed}."


def _is_named_after(name: str, other: str) -> bool:
    """Whether it is the same name, or that which a group has whose name in a mesh file makes the same one."""
    return bool(re.fullmatch(rf"{re.escape(other)}(-(elements|edges|nodes)(-\d+)?)?", name))
