"""What the page shows, as facts: a session as it stands and a view in, out comes a ``Page`` for the templates.

All texts are plain; the templates escape them. Names of inputs are made printable here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import DISCLOSURE
from rosprivacy.explorer.element_ids import element_id
from rosprivacy.explorer.questions import GROUPS
from rosprivacy.explorer.web.element_pane import Pane, is_likely_source, pane_of
from rosprivacy.explorer.web.titles import title_of
from rosprivacy.explorer.web.whose import stands_for
from rosprivacy.report.document.analysis import verdict_facts
from rosprivacy.report.finding_order import place_of
from rosprivacy.report.verdict import doubt_phrases, verdict_meaning

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element, Weight
    from rosprivacy.analysis.suggesting.evidence import Proposal
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.explorer.web.view import View
    from rosprivacy.report.catalogs.words import Words

FIRST_ROWS = 60  # of a group of the list; the others are found by name
MOST_FOUND = 40
NEXT_WAY = "o"  # the key of a finding
DIGITS = 9  # keys for kinds of data
SUGGESTED, FOUND, EXITS = "suggested", "found", "exits"


class Row(NamedTuple):
    """One line of the list: an element to look at, and the findings there."""

    id: str
    name: str
    told: str
    address: str
    ways: tuple[Way, ...] = ()


class Way(NamedTuple):
    """A finding at the element of a line."""

    told: str
    address: str
    current: bool
    key: str = ""


class Group(NamedTuple):
    """Lines of the list under a title.

    Attributes
    ----------
    key
        A group of ``questions.py``, ``SUGGESTED``, ``FOUND`` or ``EXITS``.
    left
        How many more there are.
    sure
        Whether a source among them is more than perhaps one: such a list is not folded.
    """

    key: str
    rows: tuple[Row, ...]
    left: int = 0
    sure: bool = False


class Switch(NamedTuple):
    """A kind of data that can be switched off in the list and the picture."""

    name: str
    title: str
    on: bool
    key: str
    address: str


@dataclass(frozen=True, slots=True)
class Page:
    """What a window shows of a session.

    Attributes
    ----------
    verdict
        Of rule S12; ``nothing`` and others where it lacks grounds: a key of words.
    left, decided
        How many of the elements that data gets to are to decide, and how many are decided.
    exits
        How many places data gets out at; as ``left``, also for kinds of data that are switched off.
    pane
        Of the element in hand; None if there is none.
    """

    version: int
    verdict: str
    doubts: str
    left: int
    decided: int
    exits: int
    switches: tuple[Switch, ...]
    groups: tuple[Group, ...]
    pane: Pane | None
    view: View
    unsaved: int
    can_undo: bool
    can_redo: bool


def page_of(standing: Standing, view: View, words: Words) -> Page:
    """Return what a window shows."""
    groups = tuple(_groups(standing, view, words))
    at = view.at or ("" if view.trial else _first(groups))
    if view.finding:
        at = element_id(standing.findings[view.finding].leak.identity)
    session, element = standing.session, standing.elements.get(at)
    return Page(
        version=standing.version,
        verdict=verdict_of(standing),
        doubts="; ".join(doubt_phrases(verdict_facts(standing.result), words)),
        left=len(standing.questions),
        decided=len(standing.carried.keys() - standing.open_kinds.keys()),
        exits=len({finding.leak.identity for finding in standing.analysis.findings if finding.stands}),
        switches=_switches(standing, view, words),
        groups=groups,
        pane=pane_of(standing, element, view, words) if element else None,
        view=view,
        unsaved=session.unsaved,
        can_undo=session.can_undo,
        can_redo=session.can_redo,
    )


def verdict_of(standing: Standing) -> str:
    """Return the verdict, or what it lacks, where nothing could have been found (rules S11, S12)."""
    return verdict_meaning(verdict_facts(standing.result))


def _first(groups: Sequence[Group]) -> str:
    """The element that a person looks at next: what was found, or the first question; else what is suggested."""
    rows = [(group.key == SUGGESTED, row.id) for group in groups for row in group.rows]
    return min(rows, key=lambda row: row[0], default=(False, ""))[1]


def _groups(standing: Standing, view: View, words: Words) -> list[Group]:
    groups = [Group(FOUND, _found(standing, view, words))] if view.find else []
    suggested = [_suggested(standing, view, words)]
    asked = [_asked(key, standing, view, words) for key in GROUPS]
    exits = [Group(EXITS, _exits(standing, view, words))]
    groups += [*suggested, *asked, *exits]
    return [group for group in groups if group.rows]


def _asked(key: str, standing: Standing, view: View, words: Words) -> Group:
    hidden = set(view.hidden)
    asked = [one for one in standing.questions if one.group == key and not hidden.issuperset(one.kinds)]
    rows = []
    for question in asked[:FIRST_ROWS]:
        kinds = _kinds(question.kinds, standing, view, words)
        told = words("x.steps", steps=words.count(question.steps, "step"), kinds=kinds)
        rows.append(_row(question.element, told, standing, view, words))
    return Group(key, tuple(rows), len(asked[FIRST_ROWS:]))


def _suggested(standing: Standing, view: View, words: Words) -> Group:
    """Sources that no label names: they are not followed at all. Leaks too, until data is there to be asked about.

    Then only those that a glob calls conduits: nobody is asked about them. A row says of its element what is surest.
    """
    wanted = ("source",) if standing.analysis.emitted else ("source", "leak")
    surest = [next(one for one in some if one.label.role in wanted) for some in standing.suggestions.of_role(*wanted)]
    surest += (one for one in standing.suggestions.although_a_glob() if _gets_data(one, standing))
    rows: dict[tuple[str, str, str], Row] = {}
    for one in surest:
        title = title_of(one.label.kind, standing.vocabulary, words)
        told = words(f"x.perhaps.{one.label.role}", data=title)
        rows.setdefault(one.label.element.identity, _row(one.label.element, told, standing, view, words))
    return Group(SUGGESTED, tuple(rows.values()), sure=any(map(is_likely_source, surest)))


def _gets_data(one: Proposal, standing: Standing) -> bool:
    """Whether data that it is thought to let out are there."""
    there = standing.carried.get(element_id(one.label.element.identity), ())
    return any(standing.vocabulary.hierarchy.overlap(one.label.kind, kind) is not None for kind in there)


def _exits(standing: Standing, view: View, words: Words) -> tuple[Row, ...]:
    """Where data gets to that it should not: each place once, with the kinds of data, what weighs most first."""

    def weight(finding: Finding) -> tuple[bool, Weight, int]:
        kind = standing.vocabulary.categories[finding.category]
        return finding.pseudonymised, kind.weight, place_of(finding.leak.kind)

    found: dict[tuple[str, str, str], list[Way]] = {}
    elements: dict[tuple[str, str, str], Element] = {}
    for finding in sorted(standing.analysis.findings, key=weight):
        if finding.stands and finding.category not in view.hidden:
            elements[finding.leak.identity] = finding.leak
            source = shown(finding.source.full_name)
            told = words("x.exit", data=title_of(finding.category, standing.vocabulary, words), source=source)
            if finding.kind != DISCLOSURE:  # the same data can get to one place in several ways
                told = f"{told} · {words(f'finding.{finding.kind}')}"
            there = view.to(element_id(finding.leak.identity))._replace(finding=finding.id)
            way = Way(told, there.address, finding.id == view.finding)
            found.setdefault(finding.leak.identity, []).append(way)
    rows = [(_row(elements[at], "", standing, view, words), some) for at, some in found.items()]
    here = [one for row, some in rows if row.id == view.at for one in some]
    after = next((n for n, one in enumerate(here, 1) if one.current), 0)
    offered = here or [way for _, some in rows for way in some]
    next_one = offered[after % len(offered)] if offered else None
    return tuple(
        row._replace(ways=tuple(one._replace(key=NEXT_WAY) if one is next_one else one for one in some))
        for row, some in rows
    )


def _found(standing: Standing, view: View, words: Words) -> tuple[Row, ...]:
    wanted = view.find.casefold()
    there = [element for element in standing.elements.values() if wanted in element.full_name.casefold()]
    beside = standing.result.fleet.likeness.second if standing.result.fleet else ()
    there = [element for element in there if element.robot not in beside]
    there.sort(key=lambda element: element.full_name.casefold() != wanted)  # the very name first
    return tuple(_row(element, "", standing, view, words) for element in there[:MOST_FOUND])


def _row(element: Element, told: str, standing: Standing, view: View, words: Words) -> Row:
    name = element_id(element.identity)
    kind = words.known(f"kind.{element.kind}", element.kind)
    told = " · ".join(part for part in (kind, told, stands_for(standing, element, words)) if part)
    return Row(name, shown(element.full_name), told, view.to(name).address)


def _kinds(kinds: Sequence[str], standing: Standing, view: View, words: Words) -> str:
    """The kinds that are switched on, in words."""
    return words.row(title_of(kind, standing.vocabulary, words) for kind in kinds if kind not in view.hidden)


def _switches(standing: Standing, view: View, words: Words) -> tuple[Switch, ...]:
    return tuple(
        Switch(
            name=kind,
            title=title_of(kind, standing.vocabulary, words),
            on=kind not in view.hidden,
            key=str(number) if number <= DIGITS else "",
            address=view.switched(kind).address,
        )
        for number, kind in enumerate(standing.analysis.emitted, 1)
    )
