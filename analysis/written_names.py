"""Names as people write them in labels, flows and decisions: full names, globs, and ``=`` before what is no glob.

``"=/*"`` names the element ``/*`` and nothing else. Source: rule S7 and the label file of the design.
"""

from __future__ import annotations

LITERAL = "="
GLOB_SIGNS = frozenset("*?[")


def is_glob(written: str) -> bool:
    """Return whether a name stands for all that it matches.

    >>> is_glob("/cam*"), is_glob("=/cam*"), is_glob("/camera")
    (True, False, False)
    """
    return not written.startswith(LITERAL) and not GLOB_SIGNS.isdisjoint(written)


def meant(written: str) -> str:
    """Return the name, or the glob, that is meant: without the sign before it.

    >>> meant("=/cam*"), meant("/camera")
    ('/cam*', '/camera')
    """
    return written.removeprefix(LITERAL)


def literal(name: str) -> str:
    """Return how a person writes a name so that it means this one element.

    >>> literal("/cam*"), literal("/camera")
    ('=/cam*', '/camera')
    """
    return name if name.startswith("/") and GLOB_SIGNS.isdisjoint(name) else LITERAL + name
