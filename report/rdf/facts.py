"""What a finding tells beside its fields: where data change on the path, its law, its terms in other vocabularies.

In: a finding, the vocabulary, what its source brings in. Out: plain values.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element, Legal
    from rosprivacy.ontology.vocabulary import Vocabulary


@dataclass(frozen=True, slots=True)
class ChangeFact:
    """What an element of a witness makes of the data.

    Attributes
    ----------
    before, after
        (category, pseudonymised). Before has no category at a source that makes what it sends of what it brings in.
    """

    element: Element
    before: tuple[str, bool]
    after: tuple[str, bool]

    @property
    def derives(self) -> bool:
        """Whether the category that leaves is another than the one that comes in."""
        return self.before[0] != self.after[0]

    @property
    def pseudonymises(self) -> bool:
        """Whether it is here that the data become pseudonymised."""
        return self.after[1] and not self.before[1]


def label_of(finding: Finding) -> str:
    """Return what a finding is called: kind of data, from where, to where."""
    return shown(f"{finding.category}: {finding.source.name} -> {finding.leak.name}")


def kinds_along(finding: Finding) -> list[tuple[str, bool]]:
    """Return (category, pseudonymised) of what leaves each element of the witness; at the leak, of what gets out."""
    return [*((step.category, step.pseudonymised) for step in finding.steps), (finding.category, finding.pseudonymised)]


def changes(finding: Finding, emitted: Collection[str]) -> list[ChangeFact]:
    """Return where on the witness the data become another category or pseudonymised, source first.

    Parameters
    ----------
    emitted
        Categories that the source brings in; what else it sends it made of these.
    """
    kinds = kinds_along(finding)
    first = (kinds[0][0] if kinds[0][0] in emitted else "", False)
    rows = zip(finding.witness, [first, *kinds[:-1]], kinds, strict=True)
    found = [ChangeFact(element, before, after) for element, before, after in rows]
    return [change for change in found if change.derives or change.pseudonymises]


def legal_of(finding: Finding, vocabulary: Vocabulary) -> tuple[tuple[Legal, tuple[str, ...]], ...]:
    """Return the provisions of a finding's category, each with the categories that the ontology states it of."""
    return tuple((legal, tuple(legal.stated_of.split(", "))) for legal in vocabulary.categories[finding.category].law)


def foreign_terms(category: str, vocabulary: Vocabulary) -> tuple[str, ...]:
    """Return the IRIs of other vocabularies for a category: its own, or those of its nearest broader ones; sorted."""
    for level in _levels(category, vocabulary):
        categories = [vocabulary.categories[name] for name in level]
        found = {iri for known in categories for iri in (*known.same_as, *known.within)}
        if found:
            return tuple(sorted(found))
    return ()


def _levels(category: str, vocabulary: Vocabulary) -> Iterator[list[str]]:
    """A category, then its broader ones by distance."""
    distances = vocabulary.hierarchy.ancestors[category]
    for distance in sorted(set(distances.values())):
        yield sorted(name for name in distances if distances[name] == distance)
