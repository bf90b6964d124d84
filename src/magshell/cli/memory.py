"""What commands say of the memory that a solve needs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from magshell.cli.console import say

if TYPE_CHECKING:
    from rich.console import Console

    from magshell.model import Model

# With fewer elements a solve needs well below a gigabyte.
FEW_ELEMENTS = 500
# From so many bytes on, or from this share of the free memory, a run says it.
MUCH, SHARE = 1e9, 0.25


def memory_line(needed: float, free: float | None) -> str:
    """What a solve needs, and what there is."""
    return f"about {_shown(needed)}" + (f"; {_shown(free)} are free" if free is not None else "")


def say_memory(on: Console, model: Model) -> None:
    """The need of a large solve; a warning where it will not fit."""
    from magshell.solver.memory import memory_free, memory_needed

    if len(model.shell.mesh.elements) < FEW_ELEMENTS:
        return
    needed, free = memory_needed(model), memory_free()
    line = f"memory: {memory_line(needed, free)}"
    if free is not None and needed > free:
        say(on, f"warning: {line}: the solve may be killed; take fewer elements or a larger machine", style="yellow")
    elif needed > MUCH or (free is not None and needed > SHARE * free):
        say(on, line)


def _shown(size: float) -> str:
    return f"{size / 1e9:.2g} GB" if size < 10e9 else f"{size / 1e9:.0f} GB"
