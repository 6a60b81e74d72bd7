"""How reports for people call things: elements, lines, texts of the ontology; nothing unprintable, nothing endless.

In: parts of the JSON document. Out: short plain texts, not yet escaped for any format.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import fit, printable
from rosprivacy.report.catalogs.words import spaced

if TYPE_CHECKING:
    from collections.abc import Mapping

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
