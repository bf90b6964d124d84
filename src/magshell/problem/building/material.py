"""The material of a problem, and what is said where its file leaves something out."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from functools import cache
from typing import Any

from magshell.materials import DEFAULTS, Material, Multiple, law_named, own_keys
from magshell.problem import schema

logger = logging.getLogger(__name__)

EARLIER = {"coupling_modulus": Multiple("1/10"), "length_scale": Multiple("1/10")}
"""What was taken where the file does not say it, while checkpoints had version 1."""
WRITTEN = {"coupling_modulus": "0.1 mu", "length_scale": "0.1 h"}
"""The same as a problem file says it."""
_NOW = {"coupling_modulus": "mu", "length_scale": "h/100"}


def build_material(table: schema.MaterialTable) -> Material:
    """The material that a table describes; what is left out, and multiples, are left to the shell."""
    law: Any = law_named(table.law)
    mu, lam = table.lame
    return law(
        shear_modulus=mu,
        lame_lambda=lam,
        **{key: getattr(table, key) for key in (*DEFAULTS, *own_keys(law))},
    )


def by_default(file: schema.ProblemFile) -> str | None:
    """Which parameters the file leaves to the defaults, and how to have the earlier ones; None: it leaves none."""
    absent = [key for key in EARLIER if any(getattr(table, key) is None for table in _materials(file))]
    if not absent or not file.shell.micro_rotation:
        return None
    taken = " and ".join(f"{key} is {_NOW[key]}" for key in absent)
    former = ", ".join(f'{key} = "{WRITTEN[key]}"' for key in absent)
    return f"by default {taken}, where earlier versions took a tenth; write [material] {former} for the earlier results"


def _materials(file: schema.ProblemFile) -> Iterator[schema.MaterialTable]:
    """Of the shell, its layers and its regions."""
    tables = [file.material, *(layer.material for layer in file.shell.layers)]
    for region in file.regions:
        tables += [region.material, *(layer.material for layer in region.layers)]
    return (table for table in tables if table is not None)


@cache
def tell_once(text: str) -> None:
    """Log something, the first time only."""
    logger.warning("%s", text)
