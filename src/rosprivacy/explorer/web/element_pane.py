"""The pane of the element in hand: the path by which data gets there, what can be said of it, what could be.

In: a session as it stands, an element, a view. Out: a ``Pane``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.evidence import DERIVATION, HIDING, NEVER, written
from rosprivacy.analysis.suggesting.screens import is_ticked_beforehand
from rosprivacy.explorer.edits import element_id
from rosprivacy.explorer.suggestion_screens import SuggestionScreens
from rosprivacy.explorer.web import forms
from rosprivacy.explorer.web.panes import ROBOT, Pane, robot_or_model, stands_for, title_of
from rosprivacy.ingest.suggestion_rules.accepting import LIMITING, could_close

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.analysis.answer import Step
    from rosprivacy.analysis.findings.witness import Witness
    from rosprivacy.analysis.model import Element, Grant
    from rosprivacy.analysis.suggesting.evidence import LabelProposal
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.explorer.web.view import PageView
    from rosprivacy.report.catalogs.words import Words

REASONS = 2  # of a suggestion
FINDINGS = 3  # that a suggestion could close
LINES = 3  # of the policy lines that allow a step
KEYS = {
    forms.SOURCE: "s", forms.LEAK: "l", forms.SANITIZER: "z", forms.CONDUIT: "c", forms.DERIVES: "d",
    forms.ABSENT: "n", forms.MUNDANE: "m", forms.SENSITIVE: "v", forms.NOTHING: "x",
}  # fmt: skip


def element_pane(standing: Standing, element: Element, view: PageView, words: Words) -> Pane:
    """Return what the page shows of an element."""
    at = element_id(element.identity)
    open_kinds = standing.open_kinds.get(at, ())
    carried = sorted({*standing.carried.get(at, ()), *open_kinds})  # a broader kind is open beside a narrower one
    here = [kind for kind in carried if kind not in view.hidden]
    asked = [kind for kind in open_kinds if kind not in view.hidden]
    offers = standing.suggestions.of(element.identity)
    files = robot_or_model(standing.session, element, words)
    alone = any(file.chosen and file.value == ROBOT for file in files)
    labelled = standing.session.entry_for(element, only_this_robot=alone) is not None
    return Pane(
        id=at,
        name=shown(element.full_name),
        kind=words.of_value(f"kind.{element.kind}", element.kind),
        enclaves=_enclaves(standing, element),
        said=tuple(_roles(standing, at, words)),
        is_open=bool(open_kinds),
        asked=words.row(title_of(kind, standing.vocabulary, words) for kind in asked or here),
        ways=tuple(_ways(standing, element, asked or here, view, words)),
        about=_about(standing, carried, asked or [kind for kind in here if not _ends(standing, at, kind)], words),
        offers=tuple(_offer(offer, standing, words) for offer in offers if _is_whole(offer)),
        ticks=_ticks(offers, standing, words),
        roles=tuple((role, KEYS[role]) for role in forms.roles_of(element) if role != forms.NOTHING or labelled),
        kinds=_all_kinds(standing, words),
        brings=next((offer.label.kind for offer in offers if offer.label.role == forms.SOURCE), "PersonalData"),
        robots=stands_for(standing, element, words),
        whose=files,
    )


def _enclaves(standing: Standing, element: Element) -> tuple[str, ...]:
    if not element.is_node:
        return ()
    enclaves = {profile.enclave for profile in standing.analysis.graph.profiles if profile.node == element.name}
    return tuple(shown(enclave) for enclave in sorted(enclaves))


def _roles(standing: Standing, at: str, words: Words) -> Iterable[str]:
    """What labels say that it does, kind by kind."""
    for kind, roles in sorted(standing.roles.get(at, {}).items()):
        title = title_of(kind, standing.vocabulary, words)
        for role in roles:
            if role in forms.OF_CHANNELS:  # in the words of a review
                yield words.pair(words(f"review.said.{'never' if role == forms.MUNDANE else role}"), title)
            else:
                yield words(f"role.{role}", data=title)


def _about(standing: Standing, carried: Sequence[str], chosen: Sequence[str], words: Words) -> tuple[Pane, ...]:
    """The kinds of data that an answer can be about."""
    return tuple(
        Pane(name=kind, title=title_of(kind, standing.vocabulary, words), chosen=kind in chosen)
        for kind in carried or standing.analysis.emitted
    )


def _ends(standing: Standing, at: str, kind: str) -> bool:
    """Whether a label says that a kind comes in or goes out there: a person who takes that away chooses the kind."""
    return not {forms.SOURCE, forms.LEAK}.isdisjoint(standing.roles.get(at, {}).get(kind, ()))


def _all_kinds(standing: Standing, words: Words) -> tuple[tuple[str, str], ...]:
    kinds = ((name, title_of(name, standing.vocabulary, words)) for name in standing.vocabulary.categories)
    return tuple(sorted(kinds, key=lambda kind: (kind[1].casefold(), kind[0])))


# --- what could be said of it -----------------------------------------------------------------------------------


def _is_whole(offer: LabelProposal) -> bool:
    """Whether an answer can be made of it: how something is cleaned is never guessed."""
    return offer.label.role != forms.SANITIZER or offer.label.method is not None


def is_likely_source(offer: LabelProposal) -> bool:
    """Return whether it is more than perhaps so that an element brings data in."""
    return offer.label.role == forms.SOURCE and offer.confidence is not Confidence.MAY


def tickable(offers: Iterable[LabelProposal]) -> tuple[LabelProposal, ...]:
    """Return the offers that can be taken together, as on a screen of ``suggest --ask``: none can hide a leak."""
    return tuple(offer for offer in offers if offer.label.role not in HIDING)


def answer_of(offer: LabelProposal, element: Element) -> forms.FormAnswer:
    """Return the answer that takes an offer."""
    label = offer.label
    return forms.FormAnswer(element, form_role(label.role), (label.kind,) if label.kind else (), to=label.to)


def form_role(role: str) -> str:
    """Return what a form calls the role of a suggestion."""
    return {DERIVATION: forms.DERIVES, NEVER: forms.MUNDANE}.get(role, role)


def suggestion_in_words(offer: LabelProposal, standing: Standing, words: Words) -> str:
    """Return what a suggestion says, and how sure it is."""
    label = offer.label
    data = title_of(label.kind, standing.vocabulary, words)
    to = title_of(label.to, standing.vocabulary, words) if label.to else ""
    told = words(f"explorer.tick.{form_role(label.role)}", data=data, to=to)
    return confidence_beside(told, offer.confidence, words)


def confidence_beside(statement: str, confidence: Confidence | None, words: Words) -> str:
    """Return what is suggested, with how sure it is.

    >>> from rosprivacy.report.catalogs.words import IN_ENGLISH
    >>> confidence_beside("lets out voices", Confidence.LIKELY, IN_ENGLISH)
    'lets out voices (likely)'
    """
    sure = words(f"explorer.tick.{confidence}" if confidence else "explorer.tick.unsaid")
    return words("explorer.tick", told=statement, sure=sure)


def _ticks(offers: Iterable[LabelProposal], standing: Standing, words: Words) -> tuple[Pane, ...]:
    """Lines that are taken together; none where screens ask about elements."""
    if SuggestionScreens.fit(standing.session):
        return ()
    return tuple(_tick(number, offer, standing, words) for number, offer in enumerate(tickable(offers)))


def _tick(number: int, offer: LabelProposal, standing: Standing, words: Words) -> Pane:
    """A line that can be ticked; what is sure is."""
    ticked = is_ticked_beforehand(offer.label.role, offer.confidence)
    return Pane(number=number, told=suggestion_in_words(offer, standing, words), ticked=ticked)


def _offer(offer: LabelProposal, standing: Standing, words: Words) -> Pane:
    """What could be said, with reasons; the fields are those of the form."""
    label = offer.label
    role = form_role(label.role)
    fields = [("role", role), ("about" if role != forms.SOURCE else "brings", label.kind or forms.EVERY)]
    fields += [("method", str(label.method.value))] if label.method else []
    fields += [("makes", label.to)] if label.to else []
    entry = written(label).roles
    closes = could_close(entry, _findings(standing, words), standing.vocabulary)
    return Pane(
        told=suggestion_in_words(offer, standing, words),
        reasons=words.first([shown(reason.reason) for reason in offer.evidence], REASONS),
        fields=tuple(fields),
        takes=not LIMITING.isdisjoint(entry),  # data away
        closes=words.first(closes, FINDINGS),  # known findings: then nobody takes it by one key
        sure=is_likely_source(offer),  # then it is not folded
    )


def _findings(standing: Standing, words: Words) -> Iterable[tuple[str, str]]:
    """All findings, whatever a page shows of them: (kind, what to tell of it)."""
    for finding in standing.result.analysis.findings:
        data = title_of(finding.category, standing.vocabulary, words)
        way = f"{shown(finding.source.full_name)} → {shown(finding.leak.full_name)}"
        yield finding.category, words.pair(data, way)


# --- how data gets there ----------------------------------------------------------------------------------------


def _ways(standing: Standing, element: Element, kinds: Iterable[str], view: PageView, words: Words) -> Iterable[Pane]:
    """One shortest path for each kind; the same path of several kinds once."""
    seen = set()
    for kind in kinds:
        paths = [path for part in standing.parts(element.identity) if (path := standing.why.path(part, kind))]
        path = min(paths, key=lambda path: len(path.steps), default=None)
        if path and path.elements not in seen:
            seen.add(path.elements)
            title = title_of(kind, standing.vocabulary, words)
            yield Pane(title=title, hops=tuple(_hops(path, standing, view, words)))


def _hops(path: Witness, standing: Standing, view: PageView, words: Words) -> Iterable[Pane]:
    """The elements of a path, each with the step that leads on from it, and the policy lines that allow it."""
    before = ""
    for number, element in enumerate(path.elements):
        kind = words.of_value(f"kind.{element.kind}", element.kind)
        step = path.steps[number] if number < len(path.steps) else None
        data = _data(step, standing, words) if step else ""
        lines = tuple(dict.fromkeys(_line(grant) for grant in step.grants)) if step else ()
        yield Pane(
            name=shown(element.full_name),
            kind=words.row([kind, words(f"leg.{element.leg}")]) if element.leg else kind,
            address=view.to(element_id(element.identity)).address,
            of=element.kind,
            role=step.role if step else "",
            verb=words(f"verb.{step.role}") if step else "",
            lines=tuple(Pane(short=short, whole=whole) for short, whole in lines[:LINES]),
            more=len(lines[LINES:]),
            data="" if data == before else data,
        )
        before = data


def _line(grant: Grant) -> tuple[str, str]:
    """Where a policy line stands: file and number, and with the folders of the file."""
    whole = shown(str(grant.place))
    return whole.replace("\\", "/").rpartition("/")[2], whole


def _data(step: Step, standing: Standing, words: Words) -> str:
    title = title_of(step.category, standing.vocabulary, words)
    return words("entry.data", data=title) if step.pseudonymised else title
