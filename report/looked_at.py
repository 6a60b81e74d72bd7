"""Which provisions that a document points at a reader sees: law of the Union, and national law that is called for.

In: a JSON document and a language. Out: its rows of ``look_at``. National law is called for by the country of the
system, of a storage or recipient, or by the language in which a report is asked for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

OF_LANGUAGE = {"de": "DE", "fr": "FR"}


def looked_at(document: Mapping[str, Any], language: str = "en") -> list[Mapping[str, Any]]:
    """Return the provisions to look at.

    >>> rows = [{"provision": "BDSG § 22", "country": "DE"}, {"provision": "AI Act", "country": ""}]
    >>> [row["provision"] for row in looked_at({"look_at": rows, "outside": []})]
    ['AI Act']
    """
    countries = {row.get("country") for row in (*document["outside"], *document.get("surroundings", ()))}
    countries |= {"", OF_LANGUAGE.get(language)}
    return [row for row in document.get("look_at", ()) if row["country"] in countries]


def of_every_system(rows: list[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Return those that no kind of data and no context calls for, but every system.

    >>> of_every_system([{"provision": "AI Act", "categories": [], "contexts": []}])
    [{'provision': 'AI Act', 'categories': [], 'contexts': []}]
    """
    return [row for row in rows if not row["categories"] and not row["contexts"]]
