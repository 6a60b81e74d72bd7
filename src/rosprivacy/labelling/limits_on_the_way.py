"""What labels take away of the data that a newly accepted label brings: they were said when nobody knew of that.

In: the labels that were accepted; the answers before and after, or, where no policies are named, the label files alone.
Out: remarks, one line each. No label is refused by it and no verdict changes: a person has said both. But who accepted
a ``never`` when there was no source was told of no finding, and who accepts the source has to hear of the ``never``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.ingest.suggestions.accepting import LIMITING
from rosprivacy.ingest.suggestions.choosing import overlap

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.findings.ledger import TakenAway
    from rosprivacy.analysis.model import Statement
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.ingest.suggestions.accepting import NewLabel
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.result import Result

    What = tuple[object, ...]  # what one row takes away of one kind, whatever the line is that says so

BRINGING = ("source", "derives", "leak")
HINT = "see whether it is still so"
LOOK = "name the policies as well, and what of it is on the way is told"


def brings(labels: Iterable[NewLabel]) -> tuple[NewLabel, ...]:
    """Return the labels by which there are data, or an end of data, that were not there."""
    return tuple(one for one in labels if any(role in BRINGING for role in one.said))


def limits_on_the_way(before: Result, after: Result) -> Iterator[str]:
    """Yield what labels take away after that they did not take away before, one line each."""
    old = {what for row in before.taken_away for what, _ in _whats(row)}
    for row in after.taken_away:
        kinds = [kind for what, kind in _whats(row) if what not in old]
        if kinds and row.by in LIMITING and row.element:
            to = f" -> {shown(row.to.name)}" if row.to else ""
            end = f"; behind it lies the leak {shown(row.leak.name)}" if row.leak else ""
            where = f"{row.element.kind} {shown(row.element.name)}{to}"
            at = ", ".join(map(str, row.places))
            yield f"{at}: {row.by} of {where} takes {', '.join(kinds)} away, which is accepted now{end}; {HINT}"


def limits_said(accepted: Sequence[NewLabel], files: Iterable[Labels], vocabulary: Vocabulary) -> Iterator[str]:
    """Yield what label files take away of data that accepted labels are about: where, nobody knows without policies."""
    for file in files:
        said = [(one, shown(entry.name)) for entry in file.entries for one in entry.statements]
        said += [
            (one, f"{shown(flow.source)} -> {shown(flow.target)}") for flow in file.flows for one in flow.statements
        ]
        there = [
            f"{one.role} of {name} (line {one.place.line})"
            for one, name in said
            if one.role in LIMITING and any(_limits(one, label, vocabulary) for label in accepted)
        ]
        if there:
            what = ", ".join(dict.fromkeys(kind for label in accepted for kind in _kinds(label)))
            yield f"{file.file}: {what} is accepted, and such data may be taken away by {', '.join(there)}; {LOOK}"


def _limits(said: Statement, label: NewLabel, vocabulary: Vocabulary) -> bool:
    """Whether a statement may take away data that a label is about."""
    if said.role == "only":
        kinds = [vocabulary.find(kind) for kind in _kinds(label)]
        through = set(said.categories)
        return any(not kind or not through & set(vocabulary.hierarchy.ancestors[kind.name]) for kind in kinds)
    return not said.categories or overlap(list(said.categories), _kinds(label), vocabulary)


def _kinds(label: NewLabel) -> list[str]:
    """What there is more of: of a derivation what it makes."""
    ((_, value),) = label.said.items()
    return [str(one["to"] if isinstance(one, dict) else one) for one in value]


def _whats(row: TakenAway) -> Iterator[tuple[What, str]]:
    for kind in row.categories:
        yield (row.by, row.element, row.to, kind, row.leak), kind
