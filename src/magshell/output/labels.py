"""How outputs are labelled for people: letters and the units of pictures, from the registry's symbols and SI units."""

from __future__ import annotations

from magshell.evaluation.outputs import Output

_SHOWN_UNITS = {
    "m": ("mm", 1e3), "1/m": ("1/mm", 1e-3), "T": ("mT", 1e3), "J": ("µJ", 1e6), "Pa": ("kPa", 1e-3),
    "J/m³": ("kJ/m³", 1e-3), "N/m²": ("kN/m²", 1e-3), "N": ("mN", 1e3), "N m": ("mN mm", 1e6),
}  # fmt: skip
_TEX = {
    "h": "h/h_0", "phi": r"\varphi", "theta": r"\vartheta", "tau": r"\tau", "lambda": r"\lambda", "e": r"\varepsilon",
    "e_max": r"\varepsilon_\mathrm{max}", "s": r"\sigma", "s_p": r"\sigma", "s_vm": r"\sigma_\mathrm{vM}",
    "s_a": r"\sigma^\mathrm{axial}", "t_1": "t_1", "t_2": "t_2",
}  # fmt: skip
_PLAIN = {
    "h": "h/h₀", "phi": "φ", "theta": "ϑ", "tau": "τ", "lambda": "λ", "e": "ε", "e_max": "ε max", "s": "σ", "s_p": "σ",
    "s_vm": "σ v. Mises", "s_a": "σ axial ", "t_1": "t₁,", "t_2": "t₂,",
}  # fmt: skip
_SUBSCRIPTS = str.maketrans("123", "₁₂₃")


def shown_unit(output: Output) -> tuple[str, float]:
    """The unit that pictures show, and how many of it an SI unit is."""
    return in_pictures(output.unit)


def in_pictures(unit: str) -> tuple[str, float]:
    """The unit that pictures show for one of SI, and how many of it that is."""
    return _SHOWN_UNITS.get(unit, (unit, 1.0))


def tex(output: Output, component: int | None) -> str:
    """The output, or a component (from 1), as mathematics; a whole vector stands for its length."""
    symbol = _letter(output)
    letter = _TEX.get(symbol, symbol if len(symbol) == 1 else rf"\mathrm{{{symbol}}}")
    if component is not None:
        return f"${letter}_{{{output.suffixes[component - 1]}}}$"
    return f"$|{letter}|$" if output.components > 1 else f"${letter}$"


def plain(output: Output, component: int | None = None) -> str:
    """The same as text, with the face."""
    symbol = _letter(output)
    letter, face = _PLAIN.get(symbol, symbol), f" {output.face}" if output.face else ""
    if component is not None:
        return f"{letter}{output.suffixes[component - 1].translate(_SUBSCRIPTS)}{face}"
    return f"|{letter}|{face}" if output.components > 1 else f"{letter}{face}"


def _letter(output: Output) -> str:
    return output.symbol.removesuffix(f"_{output.face}") if output.face else output.symbol


def bar_title(output: Output, component: int | None) -> str:
    """What stands over a colour bar: letter and unit, as mathematics, and the face."""
    unit, _ = shown_unit(output)
    title = tex(output, component) + (f" ({unit})" if unit else "")
    return f"{title}\n{output.face}" if output.face else title
