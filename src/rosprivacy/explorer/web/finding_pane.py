"""The pane of a finding: its path in sentences with policy lines, what the law says of its data, what closes it.

In: a session as it stands, a finding, a view. Out: a ``Pane``; its texts are those of the report. On a fleet, also
about which robots a person can decide.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.decisions import Choice
from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import ARTICLE_10
from rosprivacy.explorer.edits import element_id
from rosprivacy.explorer.web.panes import Pane, robots_in_words
from rosprivacy.explorer.web.row_pane import row_pane
from rosprivacy.explorer.web.trial_forms import flow_id, line_id, lines_of
from rosprivacy.ingest.decisions.decision_log import CONFIRM, is_log
from rosprivacy.report.naming import name
from rosprivacy.report.page.closing import change_told, proposal_told
from rosprivacy.report.page.finding_entries import finding_entries
from rosprivacy.report.page.index import Index

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from typing import Any

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.mitigation.proposals import ProposedStep
    from rosprivacy.explorer.deciding import Scope
    from rosprivacy.explorer.session import Session
    from rosprivacy.explorer.web.forms import EditForm
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.explorer.web.view import PageView
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.page.finding_entries import PathEntry

SHOWN_AT_MOST = 100  # robots whose names are told
OFFERED = 40  # choices on a page
ALONE = ":one"  # behind the id of a finding: of its robot only


def finding_pane(standing: Standing, finding: Finding, view: PageView, words: Words) -> Pane:
    """Return what the page shows of a finding; within a trial, and of a database, nothing can be tried or decided."""
    document, session = standing.document, standing.session
    row = next(row for row in document["findings"] if row["id"] == finding.id)
    index = Index({**document, "findings": [row]}, words)
    (entry,) = finding_entries(index)
    can_try = not session.is_stored and not view.trial
    can_close = session.can_mitigate and not view.trial
    return Pane(
        id=finding.id,
        entry=entry,  # as the report tells it
        law=tuple(_law(row, index)),
        row=row_pane(document, row, words),
        hops=tuple(_hops(finding, entry, standing, view)),
        closes=_closes(standing, finding, index) if view.closes and can_close else None,
        ask=view._replace(closes=not view.closes).address,
        choices=(*([CONFIRM] if is_log(session.decisions_file or "") and _is_conditional(row) else ()), *Choice),
        file=session.decisions_file or "",
        element=view.to(element_id(finding.leak.identity)).address,
        can_try=can_try,
        can_close=can_close,
        can_decide=can_try,
        robots=_choices(session, finding, words) if can_try else Pane(offered=(), more=0),
    )


def _is_conditional(row: Mapping[str, Any]) -> bool:
    return (row.get("decision") or {}).get("choice") == Choice.CONDITIONAL


def _law(row: Mapping[str, Any], index: Index) -> Iterable[str]:
    """What Articles 9 and 10 have to do with such data: a remark, no verdict."""
    words = index.words
    yield words.pair(words("column.article9"), words(f"article9.{row['article9']}"))
    for law in row["law"]:
        if law["provision"] == ARTICLE_10:
            provision = index.provision(row["category"], law["provision"])
            yield words.pair(provision, words.of_value(f"law.{law['verdict']}", law["verdict"]))


def _hops(finding: Finding, entry: PathEntry, standing: Standing, view: PageView) -> Iterable[Pane]:
    """The elements of the path, as the report tells them, and what can be tried behind each."""
    session, known = standing.session, lines_of(standing)
    after = [*finding.witness[1:], None]
    for number, (element, target, hop) in enumerate(zip(finding.witness, after, entry.hops, strict=True)):
        grants = finding.steps[number].grants if target else ()
        on_robot = [end for end in (element, target) if end and session.robots_like(end.robot)]
        lines = [line_id(grant.place) for grant, _ in zip(grants, hop.lines, strict=False)]
        yield Pane(
            told=hop,
            address=view.to(element_id(element.identity)).address,
            flow=flow_id(element, target) if target else "",  # of a filter between it and the next one
            lines=tuple(line if line in known else "" for line in lines),  # what cuts each; nothing for no policy's
            at=element_id((on_robot or [element])[0].identity),  # whose lines they are
        )


# --- what would close it ----------------------------------------------------------------------------------------


def _closes(standing: Standing, finding: Finding, index: Index) -> Pane:
    """The proposals of ``mitigate`` that remove it, each proven by a new analysis; or why there are none."""
    words, mitigation = index.words, standing.mitigation
    if not finding.stands:
        return Pane(why=words("explorer.closes.stands"), offered=(), instead=())
    if mitigation is None:
        return Pane(why=words("closing.none.many"), offered=(), instead=())
    rows = mitigation.document()["proposals"]
    offered: dict[tuple[ProposedStep, ...], Pane] = {}
    for number, (proposal, row) in enumerate(zip(mitigation.proposals, rows, strict=True)):
        ends = [one.id for one in proposal.removed] + [one.id for line in proposal.protect for one in line.findings]
        if finding.id in ends and (proposal.proven or proposal.protect):
            changes = tuple(change_told(step, index) for step in row["steps"])
            sentences = tuple(proposal_told(row, row["steps"], index))
            offered.setdefault(proposal.steps, Pane(number=number, said=sentences, changes=changes))
    why = "" if offered else words("explorer.closes.none")
    return Pane(why=why, offered=tuple(offered.values()), instead=tuple(dict.fromkeys(_instead(rows, finding, index))))


def _instead(rows: list[Any], finding: Finding, index: Index) -> Iterator[str]:
    """What a label file can state of the place, if it is so."""
    for row in (row for proposal in rows for row in proposal["statements"]):
        element = row["element"]
        at_leak = (element["robot"], element["kind"], element["name"]) == finding.leak.identity
        if at_leak and (row["kind"], row["category"]) == (finding.kind, finding.category):
            yield index.words(f"closing.state.{row['kind']}", element=name(element), data=index.data(row["category"]))


# --- about which robots of a fleet it can be decided --------------------------------------------------------------


def _choices(session: Session, finding: Finding, words: Words) -> Pane:
    """What can be chosen, what is not decided yet first; none where a finding is on no robot of a fleet."""
    values = sorted(_values(session, finding).items(), key=lambda item: _decided(session, item[1], words) != "")
    offered = tuple(
        Pane(
            value=value,
            told=" – ".join([scope_in_words(session, scope, words), *_further(session, finding, scope, words)]),
            names="; ".join(_names(robots, words) for robots in (scope.robots, scope.to_robots) if len(robots) > 1),
            chosen=number == 0,
        )
        for number, (value, scope) in enumerate(values[:OFFERED])
    )
    return Pane(offered=offered, more=len(values) - len(offered))


def scope_in(form: EditForm, session: Session, finding: Finding) -> Scope:
    """Return the robots that a form names; where there are some, it has to name them."""
    values = _values(session, finding)
    return values[form.choice("whose", values)] if values else session.scopes(finding)[0]


def scope_in_words(session: Session, scope: Scope, words: Words) -> str:
    """Return in words about which robots something is decided; empty for none."""
    if scope.to_robots:
        begins, ends = (_end(session, robots, words) for robots in (scope.robots, scope.to_robots))
        return words("explorer.decide.across", source=begins, leak=ends)
    return robots_in_words(session, scope.robots, words) if scope.robots else ""


def _end(session: Session, robots: Sequence[str], words: Words) -> str:
    if len(robots) == 1:
        return shown(robots[0])
    model = session.model_of(robots[0])
    return words("explorer.whose.robots", n=len(robots)) + (f" ({shown(model)})" if model else "")


def _values(session: Session, finding: Finding) -> Mapping[str, Scope]:
    """What a form can say."""
    values: dict[str, Scope] = {}
    for scope in session.scopes(finding):
        if scope.robots:
            values[scope.finding.id] = scope
            if scope.alone != scope:
                values[scope.finding.id + ALONE] = scope.alone
    return values


def _decided(session: Session, scope: Scope, words: Words) -> str:
    decided = session.uncounted.decided
    valid = decided.valid(scope.finding) if decided else None
    return words(f"decision.{valid.choice}") if valid else ""


def _further(session: Session, finding: Finding, scope: Scope, words: Words) -> Iterator[str]:
    """What a person has to know of the robots of a choice, besides how many they are."""
    if decided := _decided(session, scope, words):
        yield decided
    other = scope.finding
    if other.pseudonymised != finding.pseudonymised:
        yield words(f"explorer.finding.form.{'reduced' if other.pseudonymised else 'plain'}")
    path = [element.name for element in other.witness]
    if path != [element.name for element in finding.witness]:
        yield words("explorer.decide.other", path=" → ".join(map(shown, path)))


def _names(robots: Sequence[str], words: Words) -> str:
    return words.row(words.first([shown(robot) for robot in robots], SHOWN_AT_MOST))
