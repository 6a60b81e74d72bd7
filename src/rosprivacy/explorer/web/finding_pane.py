"""The pane of a finding: its path in sentences with policy lines, what the law says of its data, what is decided.

In: a session as it stands, the id of a finding, a view. Out: a ``FindingPane``. The texts are those of the report.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.decisions import Choice
from rosprivacy.analysis.model import ARTICLE_10
from rosprivacy.explorer.element_ids import element_id
from rosprivacy.explorer.web.closes_pane import Closes, closes_pane
from rosprivacy.explorer.web.decided_robots import Choices, choices
from rosprivacy.explorer.web.trials.trial_offers import flow_id, line_id, lines_of
from rosprivacy.report.page.finding_entries import finding_entries
from rosprivacy.report.page.index import Index

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from typing import Any

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.explorer.web.view import View
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.page.finding_entries import Entry
    from rosprivacy.report.page.finding_entries import Hop as Told


class Hop(NamedTuple):
    """An element of the path, as the report tells it, and what can be tried behind it.

    Attributes
    ----------
    flow
        Of a filter between it and the next one; empty at the end.
    lines
        Of the lines that are told, what cuts each; empty for a line of no policy.
    at
        Id of the element whose lines they are: of the two, the one that is on a robot.
    """

    told: Told
    address: str
    flow: str
    lines: tuple[str, ...]
    at: str


class FindingPane(NamedTuple):
    """A finding.

    Attributes
    ----------
    entry
        As the report tells it.
    law
        Remarks: what can apply to its data.
    closes
        What would close it; None where that was not asked.
    ask
        Where it is told what would close it, and no more once it is.
    file
        The decisions file; empty where the program was started without one.
    can_try
        Whether something can be tried: not within a trial.
    can_close
        Whether it can be asked what closes it: of one robot.
    can_decide
        Whether it can be decided: not within a trial, and not of a database.
    robots
        Of a fleet: those about which it can be decided.
    element
        Where its place of exit is in hand.
    """

    id: str
    entry: Entry
    law: tuple[str, ...]
    hops: tuple[Hop, ...]
    closes: Closes | None
    ask: str
    choices: tuple[str, ...]
    file: str
    element: str
    can_try: bool
    can_close: bool
    can_decide: bool
    robots: Choices


def finding_pane(standing: Standing, finding: Finding, view: View, words: Words) -> FindingPane:
    """Return what the page shows of a finding."""
    document = standing.document
    said = next(one for one in document["findings"] if one["id"] == finding.id)
    index = Index({**document, "findings": [said]}, words)
    (entry,) = finding_entries(index)
    session = standing.session
    can_try = session.can_try and not view.trial
    can_close = session.of_one_robot and not view.trial
    return FindingPane(
        id=finding.id,
        entry=entry,
        law=tuple(_law(said, index)),
        hops=tuple(_hops(finding, entry, standing, view)),
        closes=closes_pane(standing, finding, index) if view.closes and can_close else None,
        ask=view._replace(closes=not view.closes).address,
        choices=tuple(choice.value for choice in Choice),
        file=session.decisions_file or "",
        element=view.to(element_id(finding.leak.identity)).address,
        can_try=can_try,
        can_close=can_close,
        can_decide=can_try,
        robots=choices(session, finding, words) if can_try else Choices(),
    )


def _law(said: Mapping[str, Any], index: Index) -> Iterable[str]:
    """What Articles 9 and 10 have to do with such data: a remark, no verdict."""
    words = index.words
    yield words.pair(words("c.article9"), words(f"article9.{said['article9']}"))
    for row in said["law"]:
        if row["provision"] == ARTICLE_10:
            provision = index.provision(said["category"], row["provision"])
            yield words.pair(provision, words.known(f"law.{row['verdict']}", row["verdict"]))


def _hops(finding: Finding, entry: Entry, standing: Standing, view: View) -> Iterable[Hop]:
    """The hops of the report, with their elements."""
    session, known = standing.session, lines_of(standing)
    after = [*finding.witness[1:], None]
    for number, (element, target, told) in enumerate(zip(finding.witness, after, entry.hops, strict=True)):
        grants = finding.steps[number].grants if target else ()
        on_robot = [one for one in (element, target) if one and session.robots_like(one.robot)]
        lines = [line_id(grant.place) for grant, _ in zip(grants, told.lines, strict=False)]
        yield Hop(
            told,
            view.to(element_id(element.identity)).address,
            flow_id(element, target) if target else "",
            tuple(one if one in known else "" for one in lines),
            element_id((on_robot or [element])[0].identity),
        )
