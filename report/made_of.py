"""Where the data of a finding is made of other data on the way: of which, and by whom.

In: the witness of a finding and the kinds of data along it. Out: elements of the witness. That a source can bring in
what it never has would be false: so each sentence of a finding says where its data is made.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element as GraphElement
    from rosprivacy.report.catalogs.words import Words

Element = TypeVar("Element")


def makers(witness: Sequence[Element], kinds: Sequence[str]) -> list[Element]:
    """Return the elements that make another kind of data of what they get.

    Parameters
    ----------
    kinds
        What leaves each element of the witness, and last what arrives: as many as elements.

    >>> makers(["/scan", "/laser", "/slam", "/map"], ["LaserScan", "LaserScan", "HomeMap", "HomeMap"])
    ['/slam']
    """
    return [element for element, before, after in zip(witness[1:], kinds, kinds[1:], strict=False) if before != after]


def made_of(finding: Mapping[str, Any]) -> tuple[str, list[Mapping[str, Any]]]:
    """Return the kind that the source of a finding brings in, and who makes the finding's kind of it, step by step.

    Complexity: O(steps).

    >>> made_of({"category": "Video", "witness": [{"name": "/camera"}], "steps": []})
    ('Video', [])
    """
    kinds = [*(step["category"] for step in finding["steps"]), finding["category"]]
    return kinds[0], makers(finding["witness"], kinds)


def making(finding: Finding) -> tuple[str, list[GraphElement]]:
    """Return the same of a finding that is no document yet.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> faces, *_ = analyse(*factory()).findings
    >>> kind, by = making(faces)
    >>> kind, [element.name for element in by]
    ('Video', ['/face_id'])
    """
    kinds = [*(step.category for step in finding.steps), finding.category]
    return kinds[0], makers(finding.witness, kinds)


def data_made(
    finding: Mapping[str, Any],
    data: str,
    words: Words,
    title: Callable[[str], str],
    name: Callable[[Mapping[str, Any]], str],
) -> str:
    """Return a finding's data in words, with what they are made of and where, if they are.

    Parameters
    ----------
    data
        The same without.
    title, name
        What a kind of data, and an element, is called.
    """
    kind, by = made_of(finding)
    return words("entry.made", data=data, of=title(kind), makers=words.row(map(name, by))) if by else data
