"""How reports for people call things: elements, lines, texts of the ontology; nothing unprintable, nothing endless.

In: parts of the JSON document. Out: short plain texts, not yet escaped for any format.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

    Key = tuple[str, str, str, str]

LONGEST = 160
TAIL = 40


def fit(text: str) -> str:
    r"""Return text for one line: what cannot be printed is escaped, the middle of what is too long is left out.

    >>> fit("/a" + chr(10) + chr(0x202E) + "b")
    '/a\\n\\u202eb'
    >>> len(fit("x" * 4000)) < 200
    True
    """
    line = printable(text)
    return line if len(line) <= LONGEST else f"{line[: LONGEST - TAIL]} […] {line[-TAIL:]}"


def printable(text: str) -> str:
    """Return the whole text, what cannot be printed escaped: bidirectional controls are of this kind."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def name(element: Mapping[str, Any]) -> str:
    """Return an element's name, with its robot where there are several.

    >>> name({"robot": "r1", "kind": "node", "name": "/camera"})
    'r1:/camera'
    """
    robot = f"{element['robot']}:" if element["robot"] else ""
    return fit(robot + element["name"])


def key(element: Mapping[str, Any]) -> Key:
    """Return what an element is told apart by, its leg included."""
    return (element["robot"], element["kind"], element["name"], element.get("leg", ""))


def whole(element: Mapping[str, Any]) -> Key:
    """Return the same without the leg: the service or action as a whole."""
    return (*key(element)[:3], "")


def line(grant: Mapping[str, Any]) -> str:
    """Return a policy line as ``file:line``."""
    return f"{fit(grant['file'])}:{grant['line']}"


def text(of: Mapping[str, Any], what: str, language: str) -> str:
    """Return a text of the ontology in a language, in English if there is no translation.

    >>> text({"title": "voice", "translations": {"de": {"title": "Stimme"}}}, "title", "de")
    'Stimme'
    """
    return printable(of.get("translations", {}).get(language, {}).get(what) or str(of[what]))
