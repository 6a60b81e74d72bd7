"""What several parts of the report for the terminal count and call alike, in the words of a language.

In: rows, elements, names. Out: parts of lines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.element_counts import ElementCount

SHOWN_AT_MOST = 5  # names in a row


def legs(count: ElementCount, words: Words) -> str:
    """Return what is said beside a number of elements; empty where no leg makes a difference."""
    return words("terminal.legs", n=count.legs) if count.legs != count.elements else ""


def kind_in(element: Mapping[str, Any], words: Words) -> str:
    """Return what an element is; in English in the program's own words."""
    parts = [words.of_value(f"terminal.kind.of.{element['kind']}", element["kind"])]
    parts += [words.of_value(f"terminal.leg.{element['leg']}", element["leg"])] if element.get("leg") else []
    parts += [words("wildcard")] if element.get("pattern") else []
    return " ".join(parts)


def names_shown(names: Iterable[str], words: Words) -> str:
    """Return some names, and how many more there are.

    >>> from rosprivacy.report.catalogs.words import IN_ENGLISH
    >>> names_shown(["a", "b", "c", "d", "e", "f"], IN_ENGLISH)
    'a, b, c, d, e and 1 more'
    """
    everything = list(names)
    more = words("terminal.more", n=len(everything) - SHOWN_AT_MOST) if len(everything) > SHOWN_AT_MOST else ""
    return shown(", ".join(everything[:SHOWN_AT_MOST])) + more


def joined_by_and(parts: Sequence[str], words: Words) -> str:
    """Return parts joined by 'and'."""
    return words("terminal.and").join(parts)


def opening_text(opening: Mapping[str, Any], ends: str, words: Words) -> str:
    """Return a finding that there would be if a statement were wrong.

    Parameters
    ----------
    ends
        Which data, from where to where.
    """
    more = [] if opening["kind"] == "disclosure" else [words(f"finding.{opening['kind']}")]
    more += [words("reliance.dismissed")] if opening["dismissed"] else []
    more += [] if opening["new"] else [words("reliance.worse")]
    return f"{ends} ({words.row(more)})" if more else ends
