"""What is granted against what was seen in use, for people: lines for the terminal, or Markdown.

In: a document ``rosprivacy.usage/1``. Out: text. Names come from anybody's files, so they are made printable.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import blanked, counted

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

WHY = {
    "no-profile": "the policies do not know the node",
    "not-granted": "no line grants it",
    "denied": "seen although denied",
}


def usage_lines(document: Mapping[str, Any]) -> Iterator[str]:
    """Return the document as lines for people."""
    yield from _lines(document, shown, lambda title: title, "  ")


def usage_markdown(document: Mapping[str, Any]) -> str:
    """Return the document as Markdown."""

    def code(text: str) -> str:
        return f"`` {blanked(shown(text)).replace('`', ' ')} ``"

    return "".join(f"{line}\n" for line in _lines(document, code, lambda title: f"\n**{title}**\n", "- "))


def _lines(
    document: Mapping[str, Any], show: Callable[[str], str], head: Callable[[str], str], mark: str
) -> Iterator[str]:
    running, unused = document["not_granted"], document["unused"]
    yield head(f"what runs and is not granted: {len(running):,}")
    for row in running:
        denied = "".join(f" by {show(_place(line))}" for line in row.get("denied_by", ())[:1])
        yield f"{mark}{show(_grant_text(row))}: {WHY[row['why']]}{denied}; last seen {row['seen']['last']}"
    yield head(f"what is granted to nodes that ran, and was never seen: {len(unused):,}")
    for row in unused:
        yield f"{mark}{show(_grant_text(row))}: {show(_place(row))}{_reason_not_in_patch(row, document)}"
    never = document["never_seen"]
    yield head(f"nodes with a profile that were never seen, of which nothing is proposed: {len(never):,}")
    for row in never:
        yield f"{mark}{show(row['node'])}: {counted(row['grants'], 'line')}"
    yield head("assumed")
    for said in (*document["observed"], *document["gaps"]):
        yield f"{mark}{said}"
    if document["patch"]:
        yield f"{mark}a patch sets what was never seen to DENY: --patch FILE; a robot may need it another day"
    elif document["why_no_patch"]:
        yield f"{mark}no patch: {document['why_no_patch']}"


def _reason_not_in_patch(row: Mapping[str, Any], document: Mapping[str, Any]) -> str:
    """Why a line is not in the patch."""
    if row.get("hidden"):
        return "; a text without `ros2 node info --include-hidden` has no hidden names: it is not in the patch"
    if row["in_patch"] or not document["patch"]:
        return ""
    return "; not in the patch: a DENY of it would meet other lines of its enclave"


def _grant_text(row: Mapping[str, Any]) -> str:
    return f"{row['node']} {row['role']} {row['name']}"


def _place(row: Mapping[str, Any]) -> str:
    return f"{row['file']}:{row['line']}"
