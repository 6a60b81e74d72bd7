"""What closes the paths to decide, and what a node could do beyond its own profile, with what ends that (rule S6).

In: an ``Index``, the entries of the report and a mitigation document, or why there is none. Out: ``ClosingEntry``: the
proposals of ``mitigate`` in words, each proven by a new analysis, with what it takes from whom; ``BeyondEntry``: what
only the enforced view has. Both are plain texts: a proposal is work for a person.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.mitigation.limits import DENY, FILTER, REVIEW
from rosprivacy.analysis.text import fit
from rosprivacy.report.catalogs.words import first_of
from rosprivacy.report.finding_facts import grouped
from rosprivacy.report.naming import line, name
from rosprivacy.report.page.finding_entries import LINES, SHOWN_AT_MOST, hops_of, sentence_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.report.page.finding_entries import Hop, PathEntry
    from rosprivacy.report.page.index import Index

NAMED_AT_MOST = 6  # elements that get less
SHOWN = 20  # steps; the others are told by their number


class Proposed(NamedTuple):
    """One change: what to do, at which policy lines, and what else to know of it."""

    text: str
    lines: tuple[str, ...]
    further_lines: int
    notes: tuple[str, ...]


class ClosingEntry(NamedTuple):
    """What closes paths.

    Attributes
    ----------
    sentences
        What the changes together do, or why none is proposed.
    changes
        The first of them; ``remainder`` tells how many others there are.
    instead
        What can be stated or arranged without a change of flows.
    stays
        Entries that no change removes.
    """

    sentences: tuple[str, ...]
    changes: tuple[Proposed, ...] = ()
    remainder: str = ""
    instead: tuple[str, ...] = ()
    stays: tuple[PathEntry, ...] = ()


def closing(index: Index, entries: Iterable[PathEntry], proposals: Mapping[str, Any] | str) -> ClosingEntry | None:
    """Return what closes the paths of a report; None if there is none to close.

    Parameters
    ----------
    proposals
        A mitigation document; or why there is none: ``fleet``, ``many`` or ``graph``.

    Complexity: O(steps + elements affected).
    """
    words = index.words
    if not index.to_assess:
        return None
    if isinstance(proposals, str):
        return ClosingEntry((words(f"closing.none.{proposals}"),))
    if not proposals["proposals"]:
        return ClosingEntry((words("closing.none.graph"),))
    last = proposals["proposals"][-1]  # of all kinds together
    stays = {row["finding"] for row in last["keeps"]}
    steps = last["steps"] if last["proven"] else []
    shown, left = first_of(steps, SHOWN)
    instead = {
        words(
            f"closing.state.{some[0]['kind']}",
            element=name(some[0]["element"]),
            data=index.all_data(dict.fromkeys(row["category"] for row in some)),
        )
        for some in grouped(last["statements"], lambda row: (row["kind"], name(row["element"])))
    }
    return ClosingEntry(
        sentences=tuple(proposal_told(last, steps, index)),
        changes=tuple(_changes(shown, index)),
        remainder=words("closing.more", n=left) if left else "",
        instead=tuple(sorted(instead)),
        stays=tuple(entry for entry in entries if stays.intersection((entry.id, *entry.alike))),
    )


def proposal_told(last: Mapping[str, Any], steps: list[Any], index: Index) -> Iterator[str]:
    """Yield what the changes of a proposal do together, and that they are proven."""
    words = index.words
    yield from _protect(last, index)
    if not steps:
        yield from () if last.get("protect") else (words("closing.nothing"),)
        return
    removed = words.count(len(last["removes"]), "way")
    yield words("closing.intro", changes=words.count(len(steps), "closing.change"), removed=removed)
    yield words("closing.proven", verdict=words(f"code.{last['verdict_then']}"))
    less = list(dict.fromkeys(name(row["element"]) for row in last["affected"]))
    if less:
        yield words("closing.less", names=words.row(words.first(less, NAMED_AT_MOST)))


def _protect(last: Mapping[str, Any], index: Index) -> Iterator[str]:
    """The lines of governances to change: no flow changes with them."""
    for row in last.get("protect", ()):
        channels = list(dict.fromkeys(map(name, row["channels"])))
        ended = index.words.count(len(row["findings"]), "way")
        named = index.words.row(index.words.first(channels, NAMED_AT_MOST))
        yield index.words(f"closing.protect.{row['cause']}", place=line(row), channels=named, removed=ended)


def _changes(steps: Iterable[Mapping[str, Any]], index: Index) -> Iterator[Proposed]:
    """The changes; what a filter has to do is said of the first."""
    explained = False
    for step in steps:
        change, is_filter = change_told(step, index), step["kind"] == FILTER
        again = is_filter and explained
        yield change._replace(text=_filter(step, index, "closing.filter.again")) if again else change
        explained = explained or is_filter


def change_told(step: Mapping[str, Any], index: Index) -> Proposed:
    """Return one change of a mitigation document in words."""
    places = [line(grant) for grant in step["policy"]]
    unique = tuple(dict.fromkeys(places))
    text = _TEXTS[step["kind"]](step, index)
    return Proposed(text, *first_of(unique, LINES), tuple(_notes(step, index)))


def _filter(step: Mapping[str, Any], index: Index, key: str = "closing.filter") -> str:
    ends = [index.words.row(dict.fromkeys(name(one[end]) for one in step["between"])) for end in ("from", "to")]
    return index.words(key, source=ends[0], target=ends[1], data=index.all_data(step["categories"]))


def _review(step: Mapping[str, Any], index: Index) -> str:
    return index.words("closing.review", channel=name(step["channel"]), data=index.all_data(step["categories"]))


def _deny(step: Mapping[str, Any], index: Index) -> str:
    enclaves = dict.fromkeys(fit(grant["enclave"]) for grant in step["policy"])
    return index.words("closing.deny", data=index.all_data(step["categories"]), enclaves=index.words.row(enclaves))


_TEXTS = {FILTER: _filter, REVIEW: _review, DENY: _deny}


def _notes(step: Mapping[str, Any], index: Index) -> Iterator[str]:
    if step["spares"]:
        yield index.words("closing.spares", names=index.words.row(dict.fromkeys(map(name, step["spares"]))))


BOUND = 200  # that are told one by one
NAMED_OPEN = 12  # elements in the sentence of what is open


class BeyondEntry(NamedTuple):
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
