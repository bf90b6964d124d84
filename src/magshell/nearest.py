"""The valid name that somebody meant: by spelling, or by what else people call the same thing."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

# For each valid name, what people of other programs and books write for it.
_SYNONYMS = {
    # tables
    "remanence": "magnet magnets magnetization magnetisation magnetized magnetised magnetic br brem",
    "supports": "boundary boundaries boundary_conditions bc bcs constraint constraints fixtures fixed clamps",
    "loads": "force forces gravity pressure moment moments traction tractions neumann",
    "field": "magnetic b external_field applied_field flux",
    "mesh": "geometry part model surface domain grid",
    "stages": "step steps load_steps phase phases sequence",
    "results": "output outputs",
    "probes": "point points sensor sensors marker markers monitor monitors history_points",
    "material": "materials rubber elastomer",
    "solver": "settings numerics newton",
    # supports, ways to magnetise, laws, generators
    "clamp": "fixed fix fixed_support encastre clamped built_in fully_fixed cantilever",
    "simple": "pinned pin hinge hinged simply_supported simple_support",
    "symmetry": "mirror symmetric mirror_plane symmetry_plane",
    "prescribe": "displacement prescribed dirichlet roller value rotation",
    "constant": "uniform homogeneous",
    "profile": "sinusoidal sine linear",
    "gravity": "weight body_force acceleration",
    "force": "point_force line_force concentrated dead",
    "traction": "surface_force",
    "neo-hookean": "hyperelastic rubber elastic nh",
    "micropolar-neo-hookean": "hyperelastic rubber elastic nh",
    "st-venant-kirchhoff": "linear linear_elastic hooke hookean svk",
    "rectangle": "plate strip beam sheet square plane",
    "annulus": "ring disk disc washer",
    "cylinder": "tube pipe",
    "sphere-patch": "sphere spherical dome hemisphere",
    # keys
    "thickness": "h t height depth",
    "density": "rho mass_density",
    "youngs_modulus": "e young elastic_modulus modulus_of_elasticity",
    "poissons_ratio": "nu poisson v",
    "shear_modulus": "mu g shear",
    "lame_lambda": "lambda lame lame_constant first_lame",
    "bulk_modulus": "k kappa bulk compression_modulus",
    "coupling_modulus": "eta",
    "length_scale": "l internal_length characteristic_length",
    "kind": "type",
    "law": "type model kind",
    "generator": "type kind shape",
    "flux_density": "b field magnetic_field induction vector value",
    "magnitude": "amplitude strength value size",
    "direction": "axis vector",
    "vector": "value br brem remanence magnetization magnetisation flux_density",
    "group": "edge edges nodes node location on at region set name surface groups where",
    "groups": "group",
    "elements": "divisions divs n mesh_size resolution subdivisions",
    "size": "mesh_size element_size h",
    "total": "force value vector moment",
    "value": "displacement",
    "radius": "r",
    "length": "l",
    "file": "filename path",
    "unit": "units",
    "x1": "x",
    "x2": "y",
    "x3": "z",
    "sphere": "ball near distance",
    # units
    "mm": "millimeter millimeters millimetre millimetres",
    "um": "micron microns micrometer micrometers micrometre micrometres",
    "m": "meter meters metre metres",
    "cm": "centimeter centimeters centimetre centimetres",
    "deg": "degree degrees grad \u00b0",
    "rad": "radian radians",
    "T": "tesla",
    "mT": "millitesla",
    "Pa": "pascal n/m^2 n/m2",
    "N": "newton newtons",
    "mN": "millinewton",
}  # fmt: skip


def nearest(name: str, valid: Iterable[str]) -> str | None:
    """The valid name that is written almost like this one, or means the same; None: there is none.

    Spelling comes first: the same letters and digits, then one slip for every four letters (a letter that is wrong,
    missing or too many, two that are exchanged). Then another word for the same thing, then a name that has this
    one in it as a word, or is a word of it.
    """
    names, plain = sorted(valid), _plain(name)
    if not plain and not name:
        return None
    for one in names:
        if _plain(one) == plain and plain:
            return one
    spelt = {one: slips(name.casefold(), one.casefold()) for one in names}
    close = [one for one in names if spelt[one] <= max(1, len(name) // 4) and spelt[one] < min(len(name), len(one))]
    if close:
        return min(close, key=lambda one: spelt[one])
    for one in names:
        if name.casefold() in (said := _SYNONYMS.get(one, "").split()) or plain in map(_plain, said if plain else ()):
            return one
    inside = sorted((one for one in names if _has_word(one, name) or _has_word(name, one)), key=len)
    return inside[0] if inside and all(inside[0] in one for one in inside) else None


def slips(first: str, second: str) -> int:
    """Letters to change, add, remove or exchange with a neighbour (optimal string alignment) between two words."""
    before: Sequence[int] = ()
    row: Sequence[int] = range(len(second) + 1)
    for i, letter in enumerate(first):
        earlier, before = before, row
        row = [i + 1]
        for j, other in enumerate(second):
            best = min(before[j] + (letter != other), before[j + 1] + 1, row[j] + 1)
            if i and j and (first[i - 1], letter) == (other, second[j - 1]):
                best = min(best, earlier[j - 1] + 1)
            row.append(best)
    return row[-1]


def _plain(name: str) -> str:
    """Its letters and digits."""
    return re.sub(r"[\W_]+", "", name.casefold())


def _has_word(name: str, word: str) -> bool:
    """Whether successive words of a name begin with this."""
    words, sought = re.split(r"[\W_]+", name.casefold()), _plain(word)
    return len(sought) >= 3 and any("".join(words[i:]).startswith(sought) for i in range(len(words)))
