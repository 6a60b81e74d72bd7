"""Paths that a user names -> the bags there: each by itself, and of a folder all that lie in it, whatever their depth.

In: paths. Out: ``Bag`` of each, or every problem of what was named. Links to folders are followed, each folder is
entered once. A bag that lies in a folder and cannot be read is one of which nothing is known: it stays in the answer
(S11).
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import BagError, InputError, InputErrors, reason
from rosprivacy.analysis.model.recording import Bag
from rosprivacy.ingest.bags.bag_metadata import NAME
from rosprivacy.ingest.bags.bag_reader import is_recording, read_bag

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence


def read_bags(
    paths: Iterable[str], progress: Callable[[Sequence[str]], Iterable[str]] = lambda files: files
) -> tuple[Bag, ...]:
    """Read the bags at some paths, sorted by where they are.

    Parameters
    ----------
    progress
        Wraps the list of bags, to show how far it is.

    Raises
    ------
    InputErrors
        With every problem of what is named.
    """
    problems: list[InputError] = []
    named = {path: path for path in paths if not Path(path).is_dir() or Path(path, NAME).is_file()}
    found: dict[str, str] = dict.fromkeys(named, "")
    for folder in paths:
        if folder not in named:
            inside = list(_inside(folder, problems))
            found |= {path: why for path, why in inside if path not in found}
            if not inside and not problems:
                problems.append(BagError(folder, 0, "a folder without a bag", "name a bag: .mcap, .db3, or its folder"))
    bags = []
    for path in progress(sorted(found)):
        try:
            bags.append(Bag(path, gaps=(found[path],)) if found[path] else read_bag(path))
        except InputError as error:
            if path in named:
                problems.append(error)
            else:
                bags.append(Bag(path, gaps=(f"{error.problem}; {error.hint}",)))
    if problems:
        raise InputErrors(problems)
    return tuple(bags)


def _inside(top: str, problems: list[InputError]) -> Iterator[tuple[str, str]]:
    """The bags below a folder, and what is wrong with one that cannot be opened."""
    waiting = [top]
    links: list[str] = []
    entered: set[str] = set()
    while waiting or links:
        folder = waiting.pop() if waiting else links.pop(0)  # what only a link leads to, last
        real = os.path.realpath(folder)
        if real in entered:
            continue
        entered.add(real)
        try:
            entries = sorted(os.listdir(folder))
        except OSError as error:
            problems.append(BagError(folder, 0, f"cannot be read: {reason(error)}", "check its permissions"))
            continue
        whole = NAME in entries
        if whole:
            yield folder, ""
        for entry in entries:
            path = str(Path(folder, entry))
            if Path(path).is_dir():
                (links if Path(path).is_symlink() else waiting).append(path)
            elif not whole and is_recording(entry):
                dangling = Path(path).is_symlink() and not Path(path).exists()
                yield path, "a link to nothing; correct the link, or remove it" if dangling else ""
