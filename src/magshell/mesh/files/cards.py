"""Cards of Nastran's bulk data: fields set apart by commas, of 8 columns or of 16, over any number of lines."""

from __future__ import annotations

import re
from typing import NamedTuple

from magshell.mesh.files.lines import Lines
from magshell.units import shortened

PER_LINE = 8
_REAL = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[ED]([+-]?\d+)|([+-]\d+))?")


class Card(NamedTuple):
    """A card and its fields, eight for each line of it (four where they are long)."""

    name: str
    fields: list[str]
    line: int

    def text(self, place: int) -> str:
        """A field, from 0; empty where it is left out."""
        return self.fields[place] if place < len(self.fields) else ""

    def whole(self, lines: Lines, place: int, what: str, default: int | None = None) -> int:
        """A field as whole number."""
        text = self.text(place)
        if not text and default is not None:
            return default
        if not re.fullmatch(r"[+-]?\d{1,15}", text):
            lines.fail(self.line, f"{self.name}: expected {what}, found '{shortened(text)}'")
        return int(text)

    def real(self, lines: Lines, place: int, what: str) -> float:
        """A field as number; 0 where it is left out. Nastran writes 1.5-3 for 1.5e-3."""
        text = self.text(place)
        match = _REAL.fullmatch(text.upper())
        value = float(f"{match[1]}e{match[2] or match[3] or 0}") if match else 0.0
        if (text and match is None) or abs(value) > 1e300:
            lines.fail(self.line, f"{self.name}: expected {what}, found '{shortened(text)}'")
        return value


def read_cards(lines: Lines) -> list[Card]:
    """All cards of the bulk data, up to ENDDATA."""
    texts = [line.decode("utf-8", "replace").partition("$")[0].expandtabs(8).rstrip() for line in lines.every]
    begins = [number for number, text in enumerate(texts) if re.match(r"\s*BEGIN\b", text, re.IGNORECASE)]
    if len(begins) > 1:
        lines.fail(begins[1], "a second BEGIN; a file may hold one part: export the parts one by one, or joined")
    cards: list[Card] = []
    for number in range(begins[0] + 1 if begins else 0, len(texts)):
        text = texts[number]
        if not text.strip():
            continue
        name, fields = _free(lines, number, text) if "," in text else _fixed(text)
        if name == "ENDDATA":
            break
        if name and name[0] in "=":
            lines.fail(number, "repeated cards (=) are not read; write them out")
        if name and name[0] not in "+*":
            cards.append(Card(name.rstrip("*"), fields, number))
        elif cards:
            cards[-1].fields.extend(fields)
        else:
            lines.fail(number, "a line that goes on with a card, but there is none before it")
    return cards


def _free(lines: Lines, number: int, text: str) -> tuple[str, list[str]]:
    name, *fields = (part.strip() for part in text.split(","))
    width = PER_LINE // 2 if "*" in name else PER_LINE
    if len(fields) > width and (len(fields) > width + 1 or (fields[width] and fields[width][0] not in "+*")):
        lines.fail(number, f"more than {width} fields on a line")
    return name.upper(), [*fields[:width], *[""] * (width - len(fields))]


def _fixed(text: str) -> tuple[str, list[str]]:
    name = text[:8].strip().upper()
    width = 16 if "*" in name else 8
    return name, [text[start : start + width].strip() for start in range(8, 72, width)]
