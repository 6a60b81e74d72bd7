"""The explorer's page: a session as it stands and a view in, out comes a ``Pane`` of its list, and the page as HTML.

Jinja2 escapes every value.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.findings.witness import Witness
from rosprivacy.analysis.model import DISCLOSURE
from rosprivacy.explorer.edits import element_id
from rosprivacy.explorer.questions import GROUPS
from rosprivacy.explorer.web.element_pane import element_pane, is_likely_source, suggestion_in_words
from rosprivacy.explorer.web.forms import METHODS
from rosprivacy.explorer.web.panes import Pane, stands_for, title_of
from rosprivacy.explorer.web.view import ALL
from rosprivacy.report.finding_facts import place_of
from rosprivacy.report.page.html import in_html
from rosprivacy.report.page.spaced_templates import CompiledTemplates
from rosprivacy.report.pictures.live_svg import Links
from rosprivacy.report.verdict import doubt_phrases, verdict_meaning

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

    from jinja2 import Template

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element, Weight
    from rosprivacy.analysis.suggesting.evidence import LabelProposal
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.explorer.web.view import PageView
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.pictures.page_pictures import PagePicture, Pictures

FIRST_ROWS = 60  # of a group of the list; the others are found by name
MOST_FOUND = 40
NEXT_WAY = "o"  # the key of a finding
DIGITS = 9  # keys for kinds of data
SUGGESTED, FOUND, EXITS = "suggested", "found", "exits"  # groups of the list, beside those of questions
NO_KIND = "-"  # all are switched off; none named would mean all
ROOM = (540.0, 560.0)  # of the page's picture on a common screen, in pixels


class Message(NamedTuple):
    """What a person is told above the page.

    Attributes
    ----------
    kind
        ``done`` or ``problem``.
    notes
        Further lines in the reader's language.
    detail
        What readers of files and forms say, in English.
    diff
        What somebody else changed in the file.
    """

    kind: str
    text: str
    notes: tuple[str, ...] = ()
    detail: tuple[str, ...] = ()
    diff: str = ""


@cache
def template(name: str) -> Template:
    """Return a template of the pages."""
    return _templates().get_template(f"{name}.html.j2")


@cache
def _templates() -> Environment:
    loader = PackageLoader("rosprivacy.explorer.web")
    return Environment(
        loader=loader,
        bytecode_cache=CompiledTemplates(Path(__file__).parent / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def render_page(page: Pane, words: Words, picture: PagePicture, side: Pane, *, read_only: bool, **fields: Any) -> str:
    """Return the page as HTML.

    Parameters
    ----------
    side
        What stands beside the system: the finding in hand, trials, what can be tried.
    **fields
        What else the template names: ``message``; ``left`` and ``remarks`` of the session; ``inputs``, that files are
        not what was read; ``by``, who gave the last answer; ``asks``, whether there is a database that can be asked;
        ``filled``, fields of a form that is asked again.
    """
    view: PageView = page.view
    after = view.to("")._replace(find="", ask=view.ask).address  # after an answer, the next question is looked at
    kept = [("hide", kind) for kind in view.hidden]
    kept += [("draw", ALL)] if view.whole else []
    kept += [("trial", view.trial)] if view.trial else []
    return template("page").render(
        p=page, t=in_html(words), x=side, kept=kept, kept_query=after[1:],
        other_picture=view._replace(whole=not view.whole).address, methods=METHODS, picture=picture,
        svg=Markup(picture.svg),  # noqa: S704 - made by the program, names in it are escaped
        read_only=read_only, fixed=read_only or bool(view.trial), **fields,
    )  # fmt: skip


def draw_picture(pictures: Pictures, standing: Standing, page: Pane) -> PagePicture:
    """Return the picture of a page, seen from the element in hand; of a finding, with its own path."""
    at = standing.elements[page.pane.id].identity if page.pane else None
    kinds = [switch.name for switch in page.switches if switch.on] or [NO_KIND]
    view = page.view._replace(find="")
    links = Links(element_id, lambda key: view.to(element_id(key)).address)
    finding = standing.findings.get(view.finding)
    way = Witness(finding.witness, finding.steps) if finding else None
    return pictures.of(standing.analysis, at, kinds, links, ROOM, everything=view.whole, why=standing.why, way=way)


def page_of(standing: Standing, view: PageView, words: Words) -> Pane:
    """Return what a window shows: the head, the list, the element in hand."""
    groups = _groups(standing, view, words)
    at = view.at or ("" if view.trial else _first(groups))
    if view.finding:
        at = element_id(standing.findings[view.finding].leak.identity)
    history, element = standing.session.history, standing.elements.get(at)
    return Pane(
        version=standing.version,
        verdict=verdict_of(standing),
        doubts="; ".join(doubt_phrases(standing.result.verdict_facts(), words)),
        left=len(standing.questions),  # as decided and exits, also for kinds of data that are switched off
        decided=len(standing.carried.keys() - standing.open_kinds.keys()),
        exits=len({finding.leak.identity for finding in standing.analysis.findings if finding.stands}),
        switches=_switches(standing, view, words),
        groups=groups,
        pane=element_pane(standing, element, view, words) if element else None,
        view=view,
        ask=view.to("")._replace(find="", ask=True).address,
        unsaved=history.unsaved,
        can_undo=history.can_undo,
        can_redo=history.can_redo,
    )


def verdict_of(standing: Standing) -> str:
    """Return the verdict, or what it lacks, where nothing could have been found (rules S11, S12): a key of words."""
    return verdict_meaning(standing.result.verdict_facts())


def _switches(standing: Standing, view: PageView, words: Words) -> tuple[Pane, ...]:
    """The kinds of data that can be switched off in the list and the picture."""
    return tuple(
        Pane(
            name=kind,
            title=title_of(kind, standing.vocabulary, words),
            on=kind not in view.hidden,
            key=str(number) if number <= DIGITS and not view.ask else "",
            address=view.switched(kind).address,
        )
        for number, kind in enumerate(standing.analysis.emitted, 1)
    )


# --- the list ---------------------------------------------------------------------------------------------------


def _first(groups: Sequence[Pane]) -> str:
    """The element that a person looks at next: what was found, or the first question; else what is suggested."""
    rows = [(group.key == SUGGESTED, row.id) for group in groups for row in group.rows]
    return min(rows, key=lambda row: row[0], default=(False, ""))[1]


def _groups(standing: Standing, view: PageView, words: Words) -> tuple[Pane, ...]:
    groups = [_group(FOUND, _matches(standing, view, words))] if view.find else []
    groups.append(_suggested(standing, view, words))
    groups += [_questions(key, standing, view, words) for key in GROUPS]
    groups.append(_group(EXITS, _exits(standing, view, words)))
    return tuple(group for group in groups if group.rows)


def _group(key: str, rows: Sequence[Pane], remaining: int = 0, *, sure: bool = False) -> Pane:
    """Rows under a title; ``remaining`` are not shown, and what is sure is not folded."""
    return Pane(key=key, rows=rows, left=remaining, sure=sure)


def _questions(key: str, standing: Standing, view: PageView, words: Words) -> Pane:
    hidden = set(view.hidden)
    asked = [each for each in standing.questions if each.group == key and not hidden.issuperset(each.kinds)]
    rows = []
    for question in asked[:FIRST_ROWS]:
        titles = [title_of(kind, standing.vocabulary, words) for kind in question.kinds if kind not in hidden]
        text = words("explorer.steps", steps=words.count(question.steps, "step"), kinds=words.row(titles))
        rows.append(_row(question.element, text, standing, view, words))
    return _group(key, rows, len(asked[FIRST_ROWS:]))


def _suggested(standing: Standing, view: PageView, words: Words) -> Pane:
    """Sources that no label names: they are not followed at all. Leaks too, until data is there to be asked about.

    Then only those that a glob calls conduits: nobody is asked about them. A row says of its element what is surest.
    """
    wanted = ("source",) if standing.analysis.emitted else ("source", "leak")
    offers = standing.suggestions.of_role(*wanted)
    surest = [next(offer for offer in each if offer.label.role in wanted) for each in offers]
    surest += (offer for offer in standing.suggestions.although_a_glob() if _gets_data(offer, standing))
    rows: dict[tuple[str, str, str], Pane] = {}
    for offer in surest:
        text = suggestion_in_words(offer, standing, words)
        rows.setdefault(offer.label.element.identity, _row(offer.label.element, text, standing, view, words))
    return _group(SUGGESTED, tuple(rows.values()), sure=any(map(is_likely_source, surest)))


def _gets_data(offer: LabelProposal, standing: Standing) -> bool:
    """Whether data that it is thought to let out gets there."""
    carried = standing.carried.get(element_id(offer.label.element.identity), ())
    return any(standing.vocabulary.hierarchy.overlap(offer.label.kind, kind) is not None for kind in carried)


def _exits(standing: Standing, view: PageView, words: Words) -> tuple[Pane, ...]:
    """Where data gets to that it should not: each place once, with the kinds of data, what weighs most first."""

    def weight(finding: Finding) -> tuple[bool, Weight, int]:
        kind = standing.vocabulary.categories[finding.category]
        return finding.pseudonymised, kind.weight, place_of(finding.leak.kind)

    rows: dict[tuple[str, str, str], Pane] = {}
    for finding in sorted(standing.analysis.findings, key=weight):
        if finding.stands and finding.category not in view.hidden:
            leak = finding.leak
            row = rows.get(leak.identity) or _row(leak, "", standing, view, words)
            rows[leak.identity] = row
            source = shown(finding.source.full_name)
            text = words("explorer.exit", data=title_of(finding.category, standing.vocabulary, words), source=source)
            if finding.kind != DISCLOSURE:  # the same data can get to one place in several ways
                text = f"{text} · {words(f'finding.{finding.kind}')}"
            address = view.to(row.id)._replace(finding=finding.id).address
            row.ways += (Pane(told=text, address=address, current=finding.id == view.finding, key=""),)
    here = [way for row in rows.values() if row.id == view.at for way in row.ways]
    offered = here or [way for row in rows.values() for way in row.ways]
    after = next((n for n, way in enumerate(here, 1) if way.current), 0)
    if offered:
        offered[after % len(offered)].key = NEXT_WAY
    return tuple(rows.values())


def _matches(standing: Standing, view: PageView, words: Words) -> tuple[Pane, ...]:
    wanted = view.find.casefold()
    fitting = [
        element
        for element in standing.elements.values()
        if wanted in element.full_name.casefold() and element.robot not in standing.second
    ]
    fitting.sort(key=lambda element: element.full_name.casefold() != wanted)  # the very name first
    return tuple(_row(element, "", standing, view, words) for element in fitting[:MOST_FOUND])


def _row(element: Element, text: str, standing: Standing, view: PageView, words: Words) -> Pane:
    """An element to look at, with the findings there."""
    name = element_id(element.identity)
    kind = words.of_value(f"kind.{element.kind}", element.kind)
    text = " · ".join(part for part in (kind, text, stands_for(standing, element, words)) if part)
    return Pane(id=name, name=shown(element.full_name), told=text, address=view.to(name).address, ways=())
