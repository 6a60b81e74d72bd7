"""Which provisions that a document points at a reader sees: law of the Union, and the national law that is called for.

In: a JSON document. Out: its rows of ``look_at``. National law is that of the country where the system works, as label
and fleet files state it (``country:``), whatever the language of the report; without one it is for a person to find.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

LANGUAGE_COUNTRIES = ("DE", "FR")  # countries of which the ontology knows some provisions


def countries_of_use(document: Mapping[str, Any]) -> list[str]:
    """Return the countries where the system works, as people state them."""
    return sorted({row["country"] for row in document.get("surroundings", ()) if row.get("country")})


def looked_at(document: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return the provisions to look at.

    >>> rows = [{"provision": "BDSG § 22", "country": "DE"}, {"provision": "AI Act", "country": ""}]
    >>> [row["provision"] for row in looked_at({"look_at": rows})]
    ['AI Act']
    """
    countries = {"", *countries_of_use(document)}
    return [row for row in document.get("look_at", ()) if row["country"] in countries]


def of_every_system(rows: list[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Return those that no kind of data and no context calls for, but every system.

    >>> of_every_system([{"provision": "AI Act", "categories": [], "contexts": []}])
    [{'provision': 'AI Act', 'categories': [], 'contexts': []}]
    """
    return [row for row in rows if not row["categories"] and not row["contexts"]]
