"""The pack for other programs: as the Neo4j Browser saves queries, and as a dashboard of NeoDash.

In: queries. Out: a ZIP file with a folder of ``.cypher`` files, titled by the first line, the same bytes for the same
queries; the JSON (version 2.4) of a dashboard with a page of tables for each sort of question. Sources: the Browser's
own reading of what is dropped on its page (``FileDrop`` and ``readZipFiles`` of neo4j-browser); NeoDash's own published
dashboards.
"""

from __future__ import annotations

import io
import json
import re
import zipfile
from typing import TYPE_CHECKING, Any

from rosprivacy.queries.library import PARAMETER, TEXT

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.queries.library import Query

FOLDER = "rosprivacy"
EARLIEST = (1980, 1, 1, 0, 0, 0)  # that a ZIP file can say
_TOKEN = re.compile(f"{TEXT.pattern}|{PARAMETER.pattern}", re.DOTALL)


def zipped(queries: Iterable[Query]) -> bytes:
    """Return the file that is dropped on the Browser's page."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_STORED) as archive:
        for query in queries:
            archive.writestr(zipfile.ZipInfo(f"{FOLDER}/{query.name}.cypher", EARLIEST), saved(query))
    return data.getvalue()


def saved(query: Query) -> str:
    r"""Return a query with a title, and with its defaults in the place of parameters, so that it runs as it is.

    What has no default stays a parameter; a line says how to set it.

    >>> from rosprivacy.queries.library import find
    >>> print(*saved(find("path-between")).splitlines()[:3], sep="\n")
    // path-between: Is there a path from one element to another along what the policies allow, whatever goes along it?
    // first: :param from => '…'  (name of the element where it starts)
    // first: :param to => '…'  (name of the element where it ends)
    """
    defaults = {field.name: field.default for field in query.parameters if field.default is not None}
    lines = [f"// {query.name}: {query.description}"]
    lines += [
        f"// first: :param {field.name} => '…'  ({field.meaning})"
        for field in query.parameters
        if field.name not in defaults
    ]
    lines += [
        f"// {json.dumps(field.default, ensure_ascii=False)} stands for {field.name}: {field.meaning}"
        for field in query.parameters
        if field.name in defaults
    ]
    texts = {name: json.dumps(value, ensure_ascii=False) for name, value in defaults.items()}
    return "\n".join([*lines, _with_texts(query, texts), ""])


def written_out(query: Query, values: Mapping[str, Any]) -> str:
    """Return the Cypher of a query alone, with some values in the place of parameters; others stay.

    >>> from rosprivacy.queries.library import find
    >>> print(written_out(find("findings"), {"robot": "r'1", "category": ""}).splitlines()[4])
    WHERE "r'1" = '' OR f.robot = "r'1" OR f.leak_robot = "r'1"
    """
    return _with_texts(query, {name: json.dumps(value) for name, value in values.items()})


def _with_texts(query: Query, texts: Mapping[str, str]) -> str:
    """The Cypher without its header, and with literals for some parameters."""

    def written(token: re.Match[str]) -> str:
        name = token.group(token.lastindex) if token.lastindex else ""
        return texts.get(name, token.group())

    body = [line for line in query.text.splitlines() if not line.startswith("//")]
    return _TOKEN.sub(written, "\n".join(body))


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
