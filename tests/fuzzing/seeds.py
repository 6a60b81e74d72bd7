"""The kept seeds: bytes behind choices, as hexadecimal lines, one file for each target.

They come from our grammars alone: no file of anybody else is in them.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

FOLDER = Path(__file__).resolve().parent / "seeds"
MOST = 60  # of a target


def kept(target: str) -> list[bytes]:
    """The seeds of a target."""
    file = FOLDER / f"{target}.hex"
    return [bytes.fromhex(line) for line in file.read_text("ascii").split()] if file.is_file() else []


def unpack(corpus: Path, targets: Iterable[str]) -> None:
    """Lay the seeds where libFuzzer looks for them."""
    for target in targets:
        folder = corpus / target
        folder.mkdir(parents=True, exist_ok=True)
        for seed in kept(target):
            (folder / hashlib.sha1(seed, usedforsecurity=False).hexdigest()).write_bytes(seed)


def keep(corpus: Path, targets: Iterable[str]) -> None:
    """Take what a run has found into the repository: the shortest of each target."""
    FOLDER.mkdir(exist_ok=True)
    for target in targets:
        found = {file.read_bytes() for file in (corpus / target).iterdir()} - {b""}
        chosen = sorted(found, key=lambda data: (len(data), data))[:MOST]
        (FOLDER / f"{target}.hex").write_text("".join(f"{data.hex()}\n" for data in chosen), "ascii")
