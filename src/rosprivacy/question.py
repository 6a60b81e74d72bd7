"""What is asked of a system: about which categories, how many paths, under which decisions, on which day.

In: what a user names. Out: ``Question``, for ``answering``.
"""

from __future__ import annotations

import os
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.contexts import article9_in
from rosprivacy.analysis.errors import InputErrors, OntologyError, shown
from rosprivacy.analysis.model import ARTICLE_9_VERDICTS, ARTICLE_10, MAY_REVEAL
from rosprivacy.clock import judged_on
from rosprivacy.decided import decisions_of
from rosprivacy.ingest.types import TABLE
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator

    from rosprivacy.analysis.decisions import Decisions
    from rosprivacy.analysis.kernel.type_limits import TypeLimits
    from rosprivacy.analysis.model import Category
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.settings import Settings


class Question(NamedTuple):
    """What is asked.

    Attributes
    ----------
    settings
        As a user named it, with how to read what it is asked of.
    vocabulary
        The words in which it is asked and answered.
    asked_bits
        Emitted categories that the answer is about; None for all.
    decisions
        What people decided; None where nobody decided anything.
    today
        Day on which adequacy decisions hold or have ended, ``YYYY-MM-DD``.
    type_limits
        What message types cannot carry, as a table that is read when it is asked for; None where each is taken to
        carry everything.
    types
        What message types are made for, as a table that is read when it is asked for: also where none limits anything.
    every
        Make every finding of a fleet, not one of each pattern.
    most_across
        As of ``Groups``, where nobody decided anything.
    contexts
        Where the system works that is asked, as far as it matters for what is asked.
    """

    settings: Settings
    vocabulary: Vocabulary
    categories_asked: frozenset[str] | None
    decisions: Decisions | None
    today: str
    every: bool = False
    most_across: int | None = None
    contexts: frozenset[str] = frozenset()
    type_limits: Callable[[], TypeLimits] | None = None
    types: Callable[[], TypeLimits] | None = None

    @property
    def every_finding(self) -> bool:
        """Whether one finding of each pattern is not enough: decisions are about single robots, too."""
        return self.every or self.decisions is not None


def question_of(settings: Settings) -> Question:
    """Return what a user asks, with the ontologies and the decisions that are named.

    Raises
    ------
    InputErrors
        With every problem of the ontologies or of the decisions, or if a category or a kind of data is not known.
    """
    vocabulary = load(ontologies=settings.ontologies)
    asked = asked_for(vocabulary, settings)
    decisions = decisions_of(settings, vocabulary)
    types = _limits(settings, vocabulary)
    limits = types if settings.type_limits else None
    today = settings.today or judged_on(os.environ)
    return Question(settings, vocabulary, asked, decisions, today, type_limits=limits, types=types)


def _limits(settings: Settings, vocabulary: Vocabulary) -> Callable[[], TypeLimits]:
    """The limits of a table: a user's is read at once, with its errors; ours only where types are known."""

    @cache
    def read() -> TypeLimits:
        from rosprivacy.ingest.types.type_table import read_table  # noqa: PLC0415 - light start

        return read_table(settings.type_limits or TABLE, vocabulary, settings.bounds).limits

    if settings.type_limits not in (TABLE, None):
        read()
    return read


def in_contexts(question: Question, contexts: Collection[str]) -> Question:
    """Return the question with the categories that fall under Article 9 only where the system works.

    A filter for Article 9 keeps a kind as soon as one source's context makes it one that may reveal (S11).
    """
    if question.categories_asked is None or not question.settings.article9 or not contexts:
        return question
    asked = asked_for(question.vocabulary, question.settings, contexts)
    return question._replace(categories_asked=asked, contexts=frozenset(contexts))


def asked_for(vocabulary: Vocabulary, settings: Settings, contexts: Collection[str] = ()) -> frozenset[str] | None:
    """Return the categories that the answer is about; None for all.

    These are what the filters name, narrower kinds, and what is broader than one of them (so all kinds that overlap
    what is asked for): data of these may be of the kind asked for (S7, S11).
    """
    named = _categories_named(vocabulary, settings, contexts)
    if named is None:
        return None
    return frozenset(named).union(*(vocabulary.hierarchy.broader(name) for name in named))


def may_be(
    vocabulary: Vocabulary, settings: Settings, emitted: Iterable[str], contexts: Collection[str] = ()
) -> dict[str, list[str]]:
    """Return the emitted categories that the answer is about only since they may be what is asked for -> what of it."""
    named = _categories_named(vocabulary, settings, contexts)
    if named is None:
        return {}
    above = {name: vocabulary.hierarchy.ancestors[name] for name in named}
    first = {name for name in named if not set(above[name]) & named - {name}}
    common = {name: [up for up in above.values() if name in up] for name in sorted(set(emitted) - named)}
    found = {name: sorted(kind for kind in first if any(kind in up for up in both)) for name, both in common.items()}
    return {name: kinds for name, kinds in found.items() if kinds}


def _categories_named(vocabulary: Vocabulary, settings: Settings, contexts: Collection[str]) -> set[str] | None:
    """What the filters name, with narrower kinds; None where there is no filter."""
    if not (settings.categories or settings.article9 or settings.data_types or settings.identity_factors):
        return None
    asked = set(vocabulary.categories)
    problems = []
    if settings.categories:
        asked = set()
        for name in settings.categories:
            category = vocabulary.find(name)
            if category is None:
                what = f"unknown category {shown(name)!r}"
                problems.append(OntologyError("--categories", 0, what, vocabulary.hint(name)))
            else:
                asked |= vocabulary.with_narrower(category.name)
    kinds = vocabulary.categories.values()
    types = {name for kind in kinds for name in kind.data_types}
    factors = {name for kind in kinds for name in kind.identity_factors}
    problems += _unknown(settings.data_types, types, "--data-type", "data type")
    problems += _unknown(settings.identity_factors, factors, "--identity-factor", "identity factor")
    if problems:
        raise InputErrors(problems)
    return {name for name in asked if _chosen(vocabulary.categories[name], settings, contexts)}


def _unknown(filters: Iterable[str], names: set[str], option: str, noun: str) -> Iterator[OntologyError]:
    """What a filter names that no category has."""
    for name in filters:
        if name not in names:
            hint = f"it is one of: {', '.join(sorted(names))}"
            yield OntologyError(option, 0, f"unknown {noun} {shown(name)!r}", hint)


def _chosen(category: Category, settings: Settings, contexts: Collection[str]) -> bool:
    """Whether the filters keep a category; what is not known of it is kept, since silence would look like an answer."""
    return (
        _meets(category.data_types, settings.data_types)
        and _meets(category.identity_factors, settings.identity_factors)
        and (not settings.article9 or _is_sensitive(category, settings, contexts))
    )


def _is_sensitive(category: Category, settings: Settings, contexts: Collection[str]) -> bool:
    """Whether a category falls under Article 9(1) or 10 as far as it is asked for, or that is not known."""
    article10 = {legal.verdict for legal in category.law if legal.name == ARTICLE_10}
    return not {article9_in(category, contexts), *article10}.isdisjoint(_levels(settings))


def _meets(stated: tuple[str, ...], filters: tuple[str, ...]) -> bool:
    return not filters or not stated or not set(stated).isdisjoint(filters)


def _levels(settings: Settings) -> tuple[str, ...]:
    """What of Article 9 is asked for: up to the level, and what is not known."""
    widest = settings.article9_level or MAY_REVEAL
    return (*ARTICLE_9_VERDICTS[: ARTICLE_9_VERDICTS.index(widest) + 1], "unknown")
