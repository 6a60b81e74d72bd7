"""Comments in code beside classes and calls -> what stands there in words about nodes and channels.

They are words of anybody: nothing is read out of them here. Which comment stands beside what: as for annotations.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.ingest.annotations.code_names import ROOT, CodeNames
from rosprivacy.ingest.annotations.source_code import NODE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.ingest.annotations.source_code import Code

    Named = tuple[str, str]  # kind and full name of an element


def code_comments(codes: Sequence[Code], namespace: str = ROOT) -> dict[Named, tuple[str, ...]]:
    """Return the comments beside each element whose name is a literal, by file and line.

    A comment beside calls about several elements is one of none.

    Parameters
    ----------
    namespace
        Of nodes that state none.

    Examples
    --------
    >>> from rosprivacy.ingest.annotations.source_code import Code, Comment, Lines, Site
    >>> call = Site("topic", "/faces", Lines(3, 3), Lines(3, 3), "", "publish")
    >>> said = (Comment(1, "of guests", True), Comment(2, "with names", True), Comment(9, "other", True))
    >>> code_comments([Code("a.py", "python", said, (), (call,))])
    {('topic', '/faces'): ('of guests', 'with names')}
    """
    names = CodeNames(codes, namespace)
    found: dict[Named, list[str]] = defaultdict(list)
    for code in codes:
        beside = _beside(code, names)
        for comment in code.comments:
            elements = beside.get(comment.line, set())
            if len(elements) == 1 and comment.text.strip():
                found[next(iter(elements))].append(comment.text.strip())
    return {element: tuple(dict.fromkeys(texts)) for element, texts in found.items()}


def _beside(code: Code, names: CodeNames) -> dict[int, set[Named]]:
    """By line the elements that a comment there is about."""
    above: dict[int, int] = {}  # line of code -> the first of the comment lines directly above it
    for line in sorted({comment.line for comment in code.comments if comment.alone}):
        above[line + 1] = above.get(line, line)
    beside: dict[int, set[Named]] = defaultdict(set)
    for site in code.sites:
        if site.kind == NODE and not names.is_node(code, site):
            continue
        if name := names.name(code, site):
            for line in range(above.get(site.statement.first, site.statement.first), site.statement.last + 1):
                beside[line].add((site.kind, name))
    return beside
