"""How outputs are labelled for people: letters and the units of pictures, from the registry's symbols and SI units."""

from __future__ import annotations

from magshell.evaluation.outputs import Output

_SHOWN_UNITS = {
    "m": ("mm", 1e3),
    "1/m": ("1/mm", 1e-3),
    "T": ("mT", 1e3),
    "J": ("µJ", 1e6),
    "N": ("mN", 1e3),
    "N m": ("mN mm", 1e6),
}
_TEX = {"h": "h/h_0", "phi": r"\varphi", "theta": r"\vartheta"}
_PLAIN = {"h": "h/h₀", "phi": "φ", "theta": "ϑ"}


def shown_unit(output: Output) -> tuple[str, float]:
    """The unit that pictures show, and how many of it an SI unit is."""
    return in_pictures(output.unit)


def in_pictures(unit: str) -> tuple[str, float]:
    """The unit that pictures show for one of SI, and how many of it that is."""
    return _SHOWN_UNITS.get(unit, (unit, 1.0))


def tex(output: Output, component: int | None) -> str:
    """The output, or a component (1 to 3), as mathematics; a whole vector stands for its length."""
    letter = _TEX.get(output.symbol, output.symbol if len(output.symbol) == 1 else rf"\mathrm{{{output.symbol}}}")
    if component is not None:
        return f"${letter}_{component}$"
    return f"$|{letter}|$" if output.components == 3 else f"${letter}$"


def plain(output: Output) -> str:
    """The symbol as text."""
    return _PLAIN.get(output.symbol, output.symbol)


def bar_title(output: Output, component: int | None) -> str:
    """What stands over a colour bar: letter and unit, as mathematics."""
    unit, _ = shown_unit(output)
    return tex(output, component) + (f" ({unit})" if unit else "")
