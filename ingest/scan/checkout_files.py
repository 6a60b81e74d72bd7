"""A checkout -> the files in it that belong to what is built: by their path from its root.

In: a folder. Out: files, folders that are left out, and gaps. Left out are hidden folders, code that is not built, code
of others, and tests. A link that leads out of the checkout is a gap, and never followed.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import reason, shown
from rosprivacy.ingest.code.source_files import IGNORED, OF_OTHERS
from rosprivacy.ingest.reading.bounded_file import leaves
from rosprivacy.ingest.reading.path_kinds import exists, is_file
from rosprivacy.ingest.scan.scan_facts import CodePlace, Gap

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

TESTS = frozenset(["test", "tests"])


class CheckoutFiles(NamedTuple):
    """What a checkout holds.

    Attributes
    ----------
    files
        Sorted.
    left_out
        Folders, sorted.
    parts
        Of several folders that are read as one, their paths from the root.
    """

    root: str
    files: tuple[str, ...]
    left_out: tuple[str, ...] = ()
    gaps: tuple[Gap, ...] = ()
    parts: tuple[str, ...] = ("",)


def checkout_files(root: str | Path) -> CheckoutFiles:
    """Look through a checkout."""
    top = os.path.realpath(root)
    files, left_out, gaps = [], [], []
    waiting = [""]
    while waiting:
        folder = waiting.pop()
        try:
            entries = sorted(os.scandir(Path(top, folder)), key=lambda entry: entry.name)
        except OSError as error:
            gaps.append(Gap(CodePlace(folder, 0), "file", f"a folder that cannot be read: {reason(error)}"))
            continue
        if any(entry.name in IGNORED for entry in entries) and folder:
            left_out.append(folder)
            continue
        for entry in entries:
            path = f"{folder}/{entry.name}" if folder else entry.name
            if entry.is_symlink():
                if leaves(entry.path, top):
                    gaps.append(
                        Gap(
                            CodePlace(path, 0),
                            "file",
                            f"a link that leads out: {shown(str(Path(entry.path).readlink()))}",
                        )
                    )
                elif is_file(entry.path):
                    files.append(path)  # a folder is read where it stands
                elif not exists(entry.path):
                    gaps.append(Gap(CodePlace(path, 0), "file", "a link that leads nowhere"))
            elif entry.is_file():
                files.append(path)
            elif entry.is_dir() and not entry.name.startswith("."):
                passed = entry.name in OF_OTHERS or entry.name in TESTS
                (left_out if passed else waiting).append(path)
    return CheckoutFiles(top, tuple(sorted(files)), tuple(sorted(left_out)), tuple(sorted(gaps)))


def joined_files(folders: Sequence[str]) -> CheckoutFiles:
    """Look through several folders as through one checkout: its root is the folder above all of them."""
    tops = sorted({os.path.realpath(folder) for folder in folders})
    tops = [top for top in tops if not any(top != other and Path(top).is_relative_to(other) for other in tops)]
    if len(tops) == 1:
        return checkout_files(tops[0])
    root = os.path.commonpath(tops)
    found = [(os.path.relpath(top, root).replace(os.sep, "/"), checkout_files(top)) for top in tops]

    def placed(listed: str) -> Iterator[str]:
        return (f"{part}/{path}" for part, one in found for path in getattr(one, listed))

    gaps = (
        gap._replace(place=gap.place._replace(file=f"{part}/{gap.place.file}"))
        for part, one in found
        for gap in one.gaps
    )
    parts = tuple(part for part, _ in found)
    return CheckoutFiles(
        root, tuple(sorted(placed("files"))), tuple(sorted(placed("left_out"))), tuple(sorted(gaps)), parts
    )
