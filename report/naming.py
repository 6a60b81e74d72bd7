"""How reports for people call and count things: elements, lines, texts of the ontology; nothing endless.

In: parts of the JSON document, rows, elements, names. Out: short plain texts, not yet escaped for any format; how many
elements some rows are about, where a service or an action is one, whatever its legs. One place counts and calls, so
that all outputs agree.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted, fit, printable
from rosprivacy.report.catalogs.words import spaced

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping, Sequence

    from rosprivacy.analysis.model import Element
    from rosprivacy.report.catalogs.words import Words

    Key = tuple[str, str, str, str]

PROPOSED = "rosprivacy:infrastructure"


def name(element: Mapping[str, Any]) -> str:
    """Return an element's name, with its robot where there are several.

    >>> name({"robot": "r1", "kind": "node", "name": "/camera"})
    'r1:/camera'
    """
    return fit(_full_name(element))


def shown_name(element: Mapping[str, Any]) -> str:
    """Return the same as messages and the terminal show it."""
    return shown(_full_name(element))


def label_name(question: Mapping[str, Any]) -> str:
    """Return the name of an open element as a label file writes it, with its robot where there are several.

    >>> element = {"robot": "", "kind": "topic", "name": "/*", "pattern": True}
    >>> label_name({"element": element, "label": {"section": "topics", "name": "=/*"}})
    '=/*'
    """
    element = question["element"]
    written = question.get("label", element)["name"]  # documents of earlier versions do not say
    return shown(_full_name({**element, "name": written}))


def infrastructure_file(assumptions: Mapping[str, Any]) -> str:
    """Return the file that proposes more channels than the standard ones, if it was used; its channels count with them.

    >>> infrastructure_file({"labels": [{"file": "l.yaml"}, {"file": "rosprivacy:infrastructure"}]})
    'rosprivacy:infrastructure'
    """
    return next((file["file"] for file in assumptions.get("labels", ()) if file["file"] == PROPOSED), "")


def kind_of(element: Mapping[str, Any]) -> str:
    """Return what an element is, in the program's own words.

    >>> kind_of({"robot": "", "kind": "service", "name": "/add*", "leg": "request", "pattern": True})
    'service request wildcard'
    """
    parts = (element["kind"], element.get("leg", ""), "wildcard" if element.get("pattern") else "")
    return " ".join(part for part in parts if part)


def key(element: Mapping[str, Any]) -> Key:
    """Return what an element is told apart by, its leg included."""
    return (element["robot"], element["kind"], element["name"], element.get("leg", ""))


def without_leg(element: Mapping[str, Any]) -> Key:
    """Return the same without the leg: the service or action as a whole."""
    return (element["robot"], element["kind"], element["name"], "")


def line(grant: Mapping[str, Any]) -> str:
    """Return a policy line as ``file:line``."""
    return f"{fit(grant['file'])}:{grant['line']}"


def text(of: Mapping[str, Any], field: str, language: str) -> str:
    """Return a text of the ontology in a language, in English if there is no translation.

    >>> text({"title": "voice", "translations": {"de": {"title": "Stimme"}}}, "title", "de")
    'Stimme'
    """
    return spaced(printable(of.get("translations", {}).get(language, {}).get(field) or str(of[field])), language)


def _full_name(element: Mapping[str, Any]) -> str:
    return f"{element['robot']}:{element['name']}" if element["robot"] else str(element["name"])


class ElementCount(NamedTuple):
    """How many elements, and how many where the legs of services and actions are counted by themselves."""

    elements: int
    legs: int

    def __str__(self) -> str:
        """Return both, in words.

        >>> str(ElementCount(4, 6)), str(ElementCount(1, 1))
        ('4 elements (6 counting the legs of services and actions)', '1 element')
        """
        return f"{counted(self.elements, 'element')}{self.remark}"

    @property
    def remark(self) -> str:
        """What is said beside the number of elements; empty where no leg makes a difference."""
        return f" ({self.legs:,} counting the legs of services and actions)" if self.legs != self.elements else ""


def count_rows(rows: Iterable[Mapping[str, Any]]) -> ElementCount:
    """Count the elements of rows of a document."""
    keys = [without_leg(row["element"]) for row in rows]
    return ElementCount(len(set(keys)), len(keys))


def count_elements(elements: Iterable[Element]) -> ElementCount:
    """Count elements of an analysis."""
    keys = [element.identity for element in elements]
    return ElementCount(len(set(keys)), len(keys))


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


FEW_KINDS = 3  # kinds of data that are named one by one, though they are all


def all_kinds(kinds: Collection[str], everywhere: Collection[str], words: Words) -> str:
    """Return that some kinds of data are all that there are; empty where they are not all, or few.

    >>> from rosprivacy.report.catalogs.words import IN_ENGLISH
    >>> all_kinds(["Gait", "Gesture", "Video", "Voice"], ["Gait", "Gesture", "Video", "Voice"], IN_ENGLISH)
    'all 4 kinds of data'
    >>> all_kinds(["Gait", "Gesture", "Video"], ["Gait", "Gesture", "Video"], IN_ENGLISH)
    ''
    """
    whole = len(everywhere) > FEW_KINDS and set(everywhere) <= set(kinds)
    return words("exit.kinds.all", n=len(kinds)) if whole else ""


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
