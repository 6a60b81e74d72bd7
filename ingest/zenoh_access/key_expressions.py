"""Zenoh's key expressions: which keys an expression is about, and how two of them stand to each other.

In: expressions, as written. Out: whether one includes or intersects another. ``*`` is one chunk, ``**`` any number,
``$*`` any characters inside a chunk; a chunk that begins with ``@`` is matched only by itself.

Source: Zenoh's documentation of ``KeyExpr``; ``eclipse-zenoh`` 1.10.2 is the judge of the tests.
"""

from __future__ import annotations

import re
from itertools import pairwise
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

ONE, ANY, INSIDE = "*", "**", "$*"
VERBATIM = "@"
_PART = re.compile(r"\$\*|[^$]")  # what a chunk is made of


def problem_of(expression: str) -> tuple[str, str] | None:
    """Return what is wrong with a key expression, and what to do; None if Zenoh takes it.

    >>> problem_of("0/camera/**"), problem_of("camera/")
    (None, ('an empty chunk', 'write it without a slash at its ends, and with one between chunks'))
    """
    chunks = expression.split("/")
    if not all(chunks):
        return "an empty chunk", "write it without a slash at its ends, and with one between chunks"
    if re.search("[#?]", expression):
        return "'#' and '?' are forbidden", "remove them"
    if any(chunk not in (ONE, ANY) and re.search(r"(?<!\$)\*|\$(?!\*)|\$\*\$\*|^\$\*$", chunk) for chunk in chunks):
        return "'*' or '$' where it cannot be", "write *, ** as a whole chunk, or $* once inside one"
    if any(pair in ((ANY, ANY), (ANY, ONE)) for pair in pairwise(chunks)):
        return "not the canonical form", "write **/** as **, and **/* as */**"
    return None


def includes(wide: str, narrow: str) -> bool:
    """Return whether an expression is about all keys that another one is about.

    Chunks times chunks.

    >>> includes("0/camera/**", "0/camera/image/*"), includes("0/camera/*", "0/camera/**"), includes("**", "@a")
    (True, False, False)
    """
    return _aligned(wide.split("/"), narrow.split("/"), (ANY, None), _chunk_includes, _plain)


def intersects(one: str, other: str) -> bool:
    """Return whether there is a key that two expressions are about.

    Chunks times chunks.

    >>> intersects("0/*/image", "0/camera/**"), intersects("0/camera", "0/lidar")
    (True, False)
    """
    return _aligned(one.split("/"), other.split("/"), (ANY, ANY), _chunks_meet, _plain)


def _aligned(
    left: Sequence[str],
    right: Sequence[str],
    stars: tuple[str, str | None],
    pair: Callable[[str, str], bool],
    taken: Callable[[str], bool],
) -> bool:
    """Whether two rows of parts can be walked to their ends: part by part, or a star takes some of the other row's.

    Without recursion, since an input says how long they are.

    Parameters
    ----------
    stars
        Of the left and of the right row; None where a star of that row has to be taken itself.
    taken
        Which parts a star takes.
    """
    ends = len(left), len(right)
    reached = {(0, 0)}
    for i in range(ends[0] + 1):
        for j in range(ends[1] + 1):
            if (i, j) not in reached:
                continue
            one, other = left[i] if i < ends[0] else None, right[j] if j < ends[1] else None
            if one is not None and one == stars[0]:
                reached |= {(i + 1, j)} | ({(i, j + 1)} if other is not None and taken(other) else set())
            elif one is not None and other is not None and pair(one, other):
                reached.add((i + 1, j + 1))
            if other is not None and other == stars[1]:
                reached |= {(i, j + 1)} | ({(i + 1, j)} if one is not None and taken(one) else set())
    return ends in reached


def _plain(chunk: str) -> bool:
    return not chunk.startswith(VERBATIM)


def _every(_: str) -> bool:
    return True


def _chunk_includes(wide: str, narrow: str) -> bool:
    if narrow in (wide, ANY) or not (_plain(wide) and _plain(narrow)):
        return wide == narrow
    if ONE in (wide, narrow):
        return wide == ONE
    return _aligned(_PART.findall(wide), _PART.findall(narrow), (INSIDE, None), str.__eq__, _every)


def _chunks_meet(one: str, other: str) -> bool:
    if one == other or not (_plain(one) and _plain(other)):
        return one == other
    if ONE in (one, other):
        return True
    return _aligned(_PART.findall(one), _PART.findall(other), (INSIDE, INSIDE), str.__eq__, _every)
