"""The option `--set` of the commands that read one problem."""

from __future__ import annotations

import argparse


def add_settings(parser: argparse.ArgumentParser) -> None:
    """Other values for keys of the problem file."""
    parser.add_argument(
        "--set", metavar="KEY=VALUE", action="append", default=[], help="another value for a key (repeatable)"
    )
