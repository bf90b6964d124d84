"""Files damaged at random, as disks, editors, transfers and other programs damage them."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from hypothesis import strategies as st

Draw = Callable[[st.SearchStrategy[Any]], Any]

_NUMBER = re.compile(rb"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")
_NUMBERS = [
    b"0", b"1", b"-1", b"2", b"3", b"7", b"16", b"99", b"1e9", b"-0.0", b"1e308", b"1e999", b"nan", b"-inf", b"0x10",
    b"123456789", b"2147483648", b"-2147483649", b"9223372036854775807", b"9223372036854775808", b"1" * 400, b"1_0",
    b"1.5", b"x", b"", b'"1"',
]  # fmt: skip
_PIECES = [
    b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b"\n", b"\r", b"\r\n", b"\t", b" ", b",", b",,", b'"', b"'", b"$", b"*",
    b"#", b"\xc3\xa9", b"\xe2\x80\xa8", b"\xc3", b"$End\n", b"\n\n\n", b"%s", b"{}", b"<", b"1 2 3\n", b"a" * 300,
]  # fmt: skip
_KINDS = (
    "number", "number", "number", "swap numbers", "flip", "flip", "delete line", "repeat line", "swap lines", "move",
    "cut", "insert", "line ends", "empty line", "delete piece", "repeat piece",
)  # fmt: skip


@st.composite
def damaged(draw: Draw, content: bytes) -> bytes:
    """A file with one to four pieces damaged."""
    for _ in range(draw(st.sampled_from([1, 1, 1, 2, 4]))):
        content = _damaged_once(draw, content, draw(st.sampled_from(_KINDS)))
    return content


def _damaged_once(draw: Draw, content: bytes, kind: str) -> bytes:
    def place(size: int) -> int:
        return int(draw(st.integers(0, max(size - 1, 0))))

    lines = content.splitlines(keepends=True) or [b""]
    match kind:
        case "number" | "swap numbers":
            numbers = list(_NUMBER.finditer(content))
            if not numbers:
                return content
            one = numbers[place(len(numbers))]
            if kind == "number":
                return content[: one.start()] + draw(st.sampled_from(_NUMBERS)) + content[one.end() :]
            other = numbers[place(len(numbers))]
            first, second = sorted((one, other), key=lambda match: match.start())
            middle = content[first.end() : second.start()]
            if first is second or first.end() > second.start():
                return content
            return content[: first.start()] + second.group() + middle + first.group() + content[second.end() :]
        case "flip":
            at = place(len(content))
            bit = 1 << place(8)
            return content[:at] + bytes(byte ^ bit for byte in content[at : at + 1]) + content[at + 1 :]
        case "delete line":
            del lines[place(len(lines))]
        case "repeat line":
            lines.insert(place(len(lines)), lines[place(len(lines))])
        case "swap lines":
            i, j = place(len(lines)), place(len(lines))
            lines[i], lines[j] = lines[j], lines[i]
        case "move":
            lines.insert(place(len(lines)), lines.pop(place(len(lines))))
        case "empty line":
            lines[place(len(lines))] = b"\n"
        case "line ends":
            ending = draw(st.sampled_from([b"\r\n", b"\r", b" \n", b"\n\n", b""]))
            return content.replace(b"\n", ending)
        case "cut":
            return content[: place(len(content))]
        case "insert":
            at = place(len(content))
            return content[:at] + draw(st.sampled_from(_PIECES)) + content[at:]
        case "delete piece" | "repeat piece":
            start = place(len(content))
            end = start + place(60)
            if kind == "delete piece":
                return content[:start] + content[end:]
            return content[:end] + content[start:]
    return b"".join(lines)
