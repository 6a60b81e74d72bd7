"""English in a text of another language: words that German and French have not, and sentences of the English table."""

from __future__ import annotations

import re
from functools import cache, partial
from typing import TYPE_CHECKING, Any

from rosprivacy.report.catalogs.words import plain, table
from tests.helpers.graphs import care_home, factory, hospital

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping

    from rosprivacy.result import Result

OTHERS = ("de", "fr")
SYSTEMS: dict[str, Callable[[], Result]] = {  # whose outputs are read in each language
    "care-home": care_home,
    "hospital": hospital,
    "run1": partial(factory, 1),
    "run3": partial(factory, 3),
}
_FUNCTION_WORDS = re.compile(
    r"(?<![\w/.-])(the|of|is|are|which|and|with|for|from|by|not|that|this|be|been|kept|to|it|its|has|as|who|what|"
    r"GDPR|no basis|can|gets|reaches|without|review(?:ed)?|find(?:s|ings?)|path)(?![\w/-])",
    re.IGNORECASE,
)
_PLACE = re.compile(r"\{\w+\}")
LONG = 10  # letters of a part of a sentence that can be told from chance
OURS = ("Data Privacy Vocabulary", "Code of conduct", "no-leak-found", "the law")  # names and codes


@cache
def _english(language: str) -> frozenset[str]:
    """Parts of sentences of the English table that the other language has nowhere."""
    others = plain("\n".join(table(language).values()))
    parts = {part.strip(" .,;:'") for text in table("en").values() for part in _PLACE.split(text)}
    return frozenset(part for part in parts if len(part) > LONG and " " in part and part not in others)


def english_in(text: str, language: str, names: Collection[str] = ()) -> list[str]:
    """Return what is English in a text.

    Parameters
    ----------
    names
        Texts of users, which stay as they are.
    """
    left = " ".join(plain(text).split())
    for name in sorted(names, key=len, reverse=True):
        left = left.replace(" ".join(name.split()), "…")
    for name in OURS:
        left = left.replace(name, "…")
    words = [left[max(0, found.start() - 30) : found.end() + 30] for found in _FUNCTION_WORDS.finditer(left)]
    return [*words, *(part for part in _english(language) if part in left)]


PEOPLES = {  # keys of a document under which texts of users stand
    "subjects", "reason", "owner", "ticket", "why", "operator", "name", "note", "model", "dpo", "officers",
    "controller", "controllers", "contract", "contracts", "purpose", "purposes", "author",
}  # fmt: skip


def names_in(result: Result) -> list[str]:
    """Return what users wrote of a system: names, files, groups of persons."""
    elements = {element.name for element in result.analysis.graph.elements}
    groups = {group for groups in result.bound.subjects.values() for group in groups}
    files = {entry["file"] for kind in ("policies", "labels", "fleet") for entry in result.assumptions.get(kind) or ()}
    return [*elements, *groups, *files, *result.vocabulary.categories]


def users_texts(document: Mapping[str, Any]) -> list[str]:
    """Return what users wrote: groups of persons, decisions, purposes, notes, operators; and names."""
    return [text for text in _said({key: document[key] for key in document if key != "categories"}) if text]


def _said(value: Any) -> Iterator[str]:
    if isinstance(value, list):
        for one in value:
            yield from _said(one)
    elif isinstance(value, dict):
        ours = "reason" if "choice" not in value else ""  # of a finding, not of a decision
        for key, one in value.items():
            yield from _strings(one) if key in PEOPLES - {ours} else _said(one)


def _strings(value: Any) -> Iterator[str]:
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    yield from [value] if isinstance(value, str) else (text for one in inner for text in _strings(one))
