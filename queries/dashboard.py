"""The pack as a dashboard of NeoDash, the free dashboard for Neo4j: a page of tables for each sort of question.

In: queries. Out: the JSON that is loaded there (version 2.4). Source: NeoDash's own published dashboards.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from rosprivacy.queries.saved import saved

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.queries.library import Query

TITLE = "What rosprivacy found"
ABOUT = (
    "These are answers of an analysis of what policies allow and labels state. They are no legal verdict. "
    "*no-leak-found* means that no path was found in what was read; **doubts** say what is not known."
)
PAGES = {
    "Robots": ("verdicts", "findings-by-robot", "findings-by-pattern", "robots-that-differ"),
    "Kinds of data": ("category-overview", "findings-under-article", "pseudonymised-at-leaks", "derivations"),
    "To review": ("review-next", "unstated-methods", "wildcards-on-leak-paths", "storages"),
    "Loads": ("loads", "changes"),
}
WIDTH, HEIGHT = 24, 5  # of the grid of a page, and of a table on it


def dashboard(queries: Mapping[str, Query]) -> str:
    """Return the dashboard, with the defaults of the queries in the place of parameters.

    >>> from rosprivacy.queries.library import pack
    >>> [page["title"] for page in json.loads(dashboard(pack()))["pages"]]
    ['Robots', 'Kinds of data', 'To review', 'Loads']
    """
    pages = [
        {"title": title, "reports": [_text(title), *(_table(queries[name], row) for row, name in enumerate(names))]}
        for title, names in PAGES.items()
    ]
    settings = {"pagenumber": 0, "editable": True, "fullscreenEnabled": True, "parameters": {}}
    whole = {"title": TITLE, "version": "2.4", "settings": settings, "pages": pages, "parameters": {}, "extensions": {}}
    return json.dumps(whole, indent=1, ensure_ascii=False) + "\n"


def _text(page: str) -> dict[str, Any]:
    return _report(f"about {page}", "", ABOUT, "text", 0, 2)


def _table(query: Query, row: int) -> dict[str, Any]:
    return _report(query.name, query.description, saved(query), "table", 2 + row * HEIGHT, HEIGHT)


def _report(name: str, title: str, query: str, kind: str, y: int, height: int) -> dict[str, Any]:
    place = {"x": 0, "y": y, "width": WIDTH, "height": height}
    return {"id": name, "title": title, "query": query, "type": kind, **place, "selection": {}, "settings": {}}
