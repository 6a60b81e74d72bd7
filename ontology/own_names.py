"""Names of users' kinds that are taken: a name means one kind, or a label would mean what the alphabet decides.

In: the kinds of a file, and what was there before. Out: problems.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rdflib import URIRef

from rosprivacy.analysis.errors import shown
from rosprivacy.ontology.known import Problem

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import Category
    from rosprivacy.ontology.known import Known


def taken_names(categories: Iterable[Category], known: Known) -> Iterator[Problem]:
    """Yield each name that another kind has: of any sort and language, in upper or lower case.

    Parameters
    ----------
    categories
        Of the user's file, sorted by IRI.
    known
        What was there before, with the places of these categories too.
    """
    categories = list(categories)
    kinds = {category.iri for category in (*known.categories, *categories)}
    used = {name.casefold(): c.iri for c in known.categories for name in (*c.names, *c.same_as)}
    for category in categories:
        matches = [iri for iri in category.same_as if iri not in kinds]  # a kind is no match: own_hierarchy.py
        for name in {name.casefold(): name for name in (*matches, *reversed(category.names))}.values():
            other = used.setdefault(name.casefold(), category.iri)
            if other != category.iri:
                what, hint = _taken(name, is_match=name in matches)
                yield Problem(URIRef(category.iri), f"{what}, and so has <{shown(other)}>{known.whence(other)}", hint)


def _taken(name: str, *, is_match: bool) -> tuple[str, str]:
    if is_match:
        return f"has the exact match <{shown(name)}>", "write skos:broader with the other kind, or take it away"
    return f"has the name {shown(name)!r}", "take another name"
