"""Names as people write them in labels, flows and decisions: full names, globs, and ``=`` before what is no glob.

``"=/*"`` names the element ``/*`` and nothing else. Source: rule S7 and the label file of the design. Of a name that is
not there it is asked whether one that looks like it was meant.
"""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

LITERAL = "="
GLOB_SIGNS = frozenset("*?[")
LONGEST = 1_000  # signs of a name that is compared: the time grows with the square
FEW = 3  # names in a hint
LISTED = 10  # names in a message
MUCH, ALIKE, A_LITTLE = 0.8, 0.6, 0.5  # of 0 to 1, as ``difflib`` has it


def is_glob(written: str) -> bool:
    """Return whether a name stands for all that it matches.

    >>> is_glob("/cam*"), is_glob("=/cam*"), is_glob("/camera")
    (True, False, False)
    """
    return not written.startswith(LITERAL) and not GLOB_SIGNS.isdisjoint(written)


def bare_name(written: str) -> str:
    """Return the name, or the glob, that is meant: without the sign before it.

    >>> bare_name("=/cam*"), bare_name("/camera")
    ('/cam*', '/camera')
    """
    return written.removeprefix(LITERAL)


def literal(name: str) -> str:
    """Return how a person writes a name so that it means this one element.

    >>> literal("/cam*"), literal("/camera")
    ('=/cam*', '/camera')
    """
    return name if name.startswith("/") and GLOB_SIGNS.isdisjoint(name) else LITERAL + name


def listed(names: Sequence[str], at_most: int = LISTED) -> str:
    """Return some names for a message, the first of them.

    >>> listed(["a", "b"]), listed(["a"] * 12)[-10:], listed(["a", "b", "c"], 1)
    ('a, b', 'and 2 more', 'a and 2 more')
    """
    more = f" and {len(names) - at_most:,} more" if len(names) > at_most else ""
    return ", ".join(map(shown, names[:at_most])) + more


def nearest(name: str, candidates: Iterable[str], bound: int = 1, like: float = ALIKE) -> list[str]:
    """Return the names that look most like one, the likest first.

    Parameters
    ----------
    bound
        How many of them at most.
    like
        How much they look like it at least.

    Examples
    --------
    >>> nearest("/camra", ["/microphone", "/camera", "/cameras"], 2), nearest("/x", ["/microphone"])
    (['/camera', '/cameras'], [])
    """
    return get_close_matches(name[:LONGEST], [one for one in candidates if len(one) <= LONGEST], bound, like)


def did_you_mean(names: Collection[str], otherwise: str = "") -> str:
    """Return the hint of a message: whether one of some names was meant, or what else to do if there is none.

    >>> did_you_mean(["/camera", "/cameras"], "see the names"), did_you_mean([], "see the names")
    ('did you mean /camera or /cameras?', 'see the names')
    """
    return f"did you mean {' or '.join(map(shown, names))}?" if names else otherwise
