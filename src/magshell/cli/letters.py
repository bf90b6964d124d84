"""Replaces letters that a terminal cannot show: é by e, ³ by ^3, µ by u, α by alpha."""

from __future__ import annotations

import codecs
import contextlib
import io
import sys
import unicodedata

NAME = "magshell-readable"
_SIGNS = {
    "²": "^2", "³": "^3", "\u00b5": "u", "\u03bc": "u", "°": " deg", "×": "x", "·": "*", "…": "...", "–": "-", "—": "-",
    "−": "-", "≤": "<=", "≥": ">=", "≈": "~", "→": "->", "√": "sqrt", "ß": "ss", "ø": "o", "Ø": "O", "æ": "ae",
    "“": '"', "”": '"', "„": '"', "‘": "'", "’": "'", "«": '"', "»": '"',
}  # fmt: skip


def write_readably() -> None:
    """From now on, neither output of this process fails on a letter that it cannot show."""
    codecs.register_error(NAME, _replaced)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            with contextlib.suppress(ValueError, OSError):  # closed, or taken away
                stream.reconfigure(errors=NAME)


def _replaced(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(readable, error.object[error.start : error.end])), error.end


def readable(letter: str) -> str:
    """A letter in ASCII; ? if there is nothing like it."""
    if letter in _SIGNS:
        return _SIGNS[letter]
    plain = unicodedata.normalize("NFKD", letter).encode("ascii", "ignore").decode()
    if plain or unicodedata.combining(letter):
        return plain
    if "\udc80" <= letter <= "\udcff":  # a byte of a file's name that is no text
        return f"\\x{ord(letter) - 0xDC00:02x}"
    name = unicodedata.name(letter, "").split()
    if name[:1] == ["GREEK"] and "LETTER" in name:
        return name[-1].capitalize() if "CAPITAL" in name else name[-1].lower()
    return "?"
