"""What a node could do beyond its own profile, as entries of a report: what only the enforced view has (rule S6).

In: an ``Index``. Out: ``BeyondEntry``, with what makes each possible and what takes it away, in words.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import fit
from rosprivacy.report.naming import line, name
from rosprivacy.report.page.finding_entries import SHOWN_AT_MOST, hops_of, sentence_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.report.page.finding_entries import Hop
    from rosprivacy.report.page.index import Index

BOUND = 200  # that are told one by one
NAMED_OPEN = 12  # elements in the sentence of what is open


@dataclass(frozen=True, slots=True)
class BeyondEntry:
    """A finding that only the enforced view has.

    Attributes
    ----------
    hops
        Its path; with each whether the step that leaves it is beyond the profile of its node.
    why
        What makes it possible, and where.
    remedies
        What takes it away, splitting first.
    """

    id: str
    source: str
    leak: str
    sentence: str
    article9: str
    hops: tuple[tuple[Hop, bool], ...]
    why: tuple[str, ...]
    remedies: tuple[str, ...]

    @property
    def brief(self) -> str:
        """The path in one line."""
        return " → ".join(hop.name for hop, _ in self.hops)


def beyond_entries(index: Index) -> tuple[BeyondEntry, ...]:
    """Return what the enforced view adds, as many as are told one by one; nothing where nobody asked."""
    return tuple(_entry(added, index) for added in _added(index)[:BOUND])


def beyond_said(index: Index) -> tuple[str, ...]:
    """Return what is to be known of all of it: how much there is, and how many are not told one by one."""
    words, number = index.words, len(_added(index))
    left = number - BOUND
    elements = [name(element) for element in index.document.get("enforced", {}).get("open", ())]
    names = words.row(words.first(elements, NAMED_OPEN))
    return (
        words.count(number, "beyond.number"),
        *([words.count(left, "beyond.left")] if left > 0 else []),
        *([words.count(len(elements), "beyond.unreviewed", names=names)] if elements else []),
    )


def _added(index: Index) -> list[Mapping[str, Any]]:
    return list(index.document.get("enforced", {}).get("added", ()))


def _entry(added: Mapping[str, Any], index: Index) -> BeyondEntry:
    finding, beyond = added["finding"], set(added.get("beyond", ()))
    return BeyondEntry(
        id=finding["id"],
        source=name(finding["source"]),
        leak=name(finding["leak"]),
        sentence=sentence_of(finding, index),
        article9=finding["article9"],
        hops=tuple((hop, number in beyond) for number, hop in enumerate(hops_of(finding, index))),
        why=tuple(_why(added, index)),
        remedies=tuple(_remedies(added, index)),
    )


def _why(added: Mapping[str, Any], index: Index) -> Iterator[str]:
    words = index.words
    if added["finding"]["accepted"]:
        yield words.pair(words("entry.filter.state"), words("state.accepted"))
    if added.get("plain"):
        yield words("beyond.plain")
    if added.get("beyond") == []:
        yield words("beyond.types")
    if added["enclaves"]:
        yield words("beyond.shared", enclaves=_row(added["enclaves"], index))
    if opened := added.get("opened_by"):
        yield words("beyond.opened", lines=words.row(map(line, opened)))
    if robots := added.get("robots"):
        named = f" ({_row(robots, index)})" if len(robots) <= SHOWN_AT_MOST else ""
        yield words("beyond.robots", n=len(robots), all=words.count(len(index.robots()), "of_robots"), names=named)


def _remedies(added: Mapping[str, Any], index: Index) -> Iterator[str]:
    words = index.words
    if added["split"]:
        yield words("beyond.split", enclaves=_row(added["split"], index))
    elif added["enclaves"]:
        yield words("beyond.split.none")
    if move := added.get("move"):
        yield words("beyond.move", profile=fit(move["profile"]), enclave=fit(move["enclave"]))
    if added.get("deny"):
        lines = (
            words("beyond.line", role=one["role"], channel=name(one["channel"]), enclave=fit(one["enclave"]),
                  file=fit(one["file"]))
            for one in added["deny"]
        )  # fmt: skip
        lost = (
            words("beyond.right", node=name(one["node"]), role=one["role"], channel=name(one["channel"]))
            for one in added["loses"]
        )
        yield words("beyond.deny", lines=words.row(lines), rights=words.row(lost))


def _row(names: Iterable[str], index: Index) -> str:
    return index.words.row(map(fit, names))
