"""What data may reveal where they are brought in: contexts of sources make the law of a kind more exact (Article 9(1)).

In: categories with what the ontology states of contexts, and the contexts of a finding's source. Out: what its data may
reveal there, with the provision that says so. A context never weakens what is stated of a kind; it is no verdict.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from rosprivacy.analysis.model import (
    ARTICLE_9_VERDICTS,
    GDPR_APPLIES,
    GDPR_DENIED,
    GDPR_OPEN,
    MAY_REVEAL,
    SPECIAL,
    Surroundings,
)

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Bound, Category, FlowGraph, Legal, Statement

UNSTATED_PLACE = Surroundings()
At = TypeVar("At")
_WEAKER = ARTICLE_9_VERDICTS[ARTICLE_9_VERDICTS.index(MAY_REVEAL) :]


def surrounded(categories: Mapping[str, Category], hierarchy: Hierarchy) -> dict[str, Category]:
    """Return the categories with what contexts and pointers say of broader ones, which holds of narrower ones too.

    What a context says of a kind can hold of a broader one too, since data of that may be of the narrower kind (rule
    S7); a pointer to law cannot.

    >>> from rosprivacy.analysis.example import CATEGORIES
    >>> from rosprivacy.analysis.hierarchy import Hierarchy
    >>> both = surrounded(CATEGORIES, Hierarchy.of(CATEGORIES.values()))
    >>> both["FaceTemplate"].in_context == CATEGORIES["FaceTemplate"].in_context
    True
    """
    near: dict[str, dict[str, None]] = {name: {} for name in categories}
    for name in categories:
        for above in hierarchy.ancestors[name]:
            near[name][above] = None
            near[above][name] = None
    stated = {name: [*_stated(category)] for name, category in categories.items()}
    return {
        name: category._replace(
            in_context=_each_once(said for other in sorted(near[name]) for said in stated[other]),
            look_at=tuple(sorted({at for above in hierarchy.ancestors[name] for at in categories[above].look_at})),
        )
        for name, category in categories.items()
    }


def _stated(category: Category) -> Iterator[Legal]:
    """What is stated of a category itself."""
    for legal in category.in_context:
        if legal.stated_of in ("", category.name):  # else it came from a kind near it
            yield legal._replace(stated_of=category.name)


def _each_once(statements: Iterable[Legal]) -> tuple[Legal, ...]:
    """Each statement once, with the first category of which it is made."""
    found: dict[tuple[str, str, str], Legal] = {}
    for legal in statements:
        found.setdefault((legal.context, legal.name, legal.condition), legal)
    return tuple(found[key] for key in sorted(found))


def revealed(category: Category, contexts: Collection[str]) -> tuple[Legal, ...]:
    """Return what data of a category may reveal in some contexts, beyond what is stated of the category anywhere.

    >>> from rosprivacy.analysis.example import CATEGORIES, LAW
    >>> at_care = LAW._replace(verdict=MAY_REVEAL, context="care")
    >>> video = CATEGORIES["Video"]._replace(in_context=(at_care,))
    >>> revealed(video, ["care"]) == (at_care,), revealed(video, ["school"])
    (True, ())
    """
    known = {legal.name for legal in category.law if legal.verdict in SPECIAL}
    return tuple(legal for legal in category.in_context if legal.context in contexts and legal.name not in known)


def article9_in(category: Category, contexts: Collection[str]) -> str:
    """Return the verdict under Article 9(1) that holds in some contexts: that of the category, or a stronger one.

    >>> from rosprivacy.analysis.example import CATEGORIES
    >>> article9_in(CATEGORIES["Video"], ())
    'no'
    """
    if category.article9 in _WEAKER and any(legal.special for legal in revealed(category, contexts)):
        return MAY_REVEAL
    return category.article9


def _scopes(graph: FlowGraph, bound: Bound, *, together: bool) -> dict[tuple[str, str, str], str]:
    """Return whether the GDPR applies at each source where that is not plain; of one name in a fleet, the plainest."""
    if not any(where.abroad for where in bound.surroundings.values()):
        return {}
    plainest = (GDPR_APPLIES, GDPR_OPEN, GDPR_DENIED)
    own = {
        graph.elements[vertex].identity: scope
        for vertex, scope in scopes_of_sources(bound.elements, bound.surroundings)
    }
    of_name = {name: {*scopes} for name, scopes in bound.scopes.items()}
    for (_, *name), scope in own.items() if together else ():
        of_name.setdefault((name[0], name[1]), set()).add(scope)
    scopes = {at: min({scope, *of_name.get(at[1:], ())}, key=plainest.index) for at, scope in own.items()}
    return {at: scope for at, scope in scopes.items() if scope != GDPR_APPLIES}


def scopes_of_sources(
    stated: Mapping[At, Iterable[Statement]], surroundings: Mapping[At, Surroundings]
) -> Iterator[tuple[At, str]]:
    """Yield whether the GDPR applies where each source works, as far as it is stated (Article 3).

    >>> from rosprivacy.analysis.example import factory
    >>> _, bound = factory()[:2]
    >>> {scope for _, scope in scopes_of_sources(bound.elements, bound.surroundings)}
    {'applies'}
    """
    for at, statements in stated.items():
        if any(statement.role == "source" for statement in statements):
            yield at, surroundings.get(at, UNSTATED_PLACE).gdpr


class Contexts(NamedTuple):
    """The contexts of a system's sources.

    Attributes
    ----------
    by_source
        (robot, kind, name) -> contexts.
    everywhere
        Those of all sources.
    gdpr
        (robot, kind, name) of a source -> whether the GDPR applies (Article 3), where that is not plain.
    """

    by_source: Mapping[tuple[str, str, str], frozenset[str]]
    categories: Mapping[str, Category]
    everywhere: frozenset[str] = frozenset()
    gdpr: Mapping[tuple[str, str, str], str] = MappingProxyType({})

    @classmethod
    def of(
        cls, graph: FlowGraph, bound: Bound, categories: Mapping[str, Category], *, together: bool = False
    ) -> Contexts:
        """Take what labels state.

        Parameters
        ----------
        together
            Where several robots have an element of one name, its contexts are those of all: a finding of a fleet
            stands for all of them.

        Examples
        --------
        >>> from rosprivacy.analysis.example import CATEGORIES, factory
        >>> Contexts.of(*factory()[:2], CATEGORIES).everywhere
        frozenset()
        """
        own = {graph.elements[vertex].identity: where.contexts for vertex, where in bound.surroundings.items()}
        of_name: dict[tuple[str, ...], frozenset[str]] = {}
        for (robot, *name), contexts in own.items():
            key = ("" if together else robot, *name)
            of_name[key] = of_name.get(key, frozenset()).union(contexts)
        for of_kind, more in bound.elsewhere.items() if together else ():
            everywhere = ("", *of_kind)
            of_name[everywhere] = of_name.get(everywhere, frozenset()).union(more)
        elements = (element.identity for element in graph.elements if not element.is_channel) if of_name else ()
        keys = {one: of_name.get(("" if together else one[0], *one[1:]), frozenset()) for one in elements}
        return cls(
            keys, categories, frozenset[str]().union(*of_name.values()), _scopes(graph, bound, together=together)
        )

    def revealed(self, finding: Finding) -> tuple[Legal, ...]:
        """Return what the data of a finding may reveal where they are brought in, beside what holds everywhere.

        >>> from rosprivacy.analysis.example import CATEGORIES, factory
        >>> from rosprivacy.analysis.findings.findings import analyse
        >>> faces, *_ = analyse(*factory()).findings
        >>> len(Contexts({}, CATEGORIES).revealed(faces))
        0
        """
        return revealed(self.categories[finding.category], self._at(finding))

    def scope(self, finding: Finding) -> str:
        """Return whether the GDPR applies where the data of a finding are brought in, as far as it is stated.

        >>> from rosprivacy.analysis.example import CATEGORIES, factory
        >>> from rosprivacy.analysis.findings.findings import analyse
        >>> faces, *_ = analyse(*factory()).findings
        >>> Contexts({}, CATEGORIES).scope(faces)
        'applies'
        """
        return self.gdpr.get(finding.source.identity, GDPR_APPLIES)

    def article9(self, finding: Finding) -> str:
        """Return the strongest verdict under Article 9(1) on the data of a finding, where they are brought in.

        >>> from rosprivacy.analysis.example import CATEGORIES, factory
        >>> from rosprivacy.analysis.findings.findings import analyse
        >>> faces, *_ = analyse(*factory()).findings
        >>> Contexts({}, CATEGORIES).article9(faces)
        'conditional'
        """
        return article9_in(self.categories[finding.category], self._at(finding))

    def _at(self, finding: Finding) -> frozenset[str]:
        return self.by_source.get(finding.source.identity, frozenset())
