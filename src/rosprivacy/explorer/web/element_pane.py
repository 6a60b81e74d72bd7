"""What the page shows of the element in hand: the path by which data gets there, what can be said of it, what could be.

In: a session as it stands, an element, a view. Out: a ``Pane``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.evidence import written
from rosprivacy.explorer.element_ids import element_id
from rosprivacy.explorer.web import forms
from rosprivacy.explorer.web.titles import title_of
from rosprivacy.explorer.web.whose import ROBOT, Whose, stands_for, whose
from rosprivacy.ingest.suggestions.accepting import LIMITING, could_close

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.analysis.answer import Step
    from rosprivacy.analysis.findings.witness import Witness
    from rosprivacy.analysis.model import Element, Grant
    from rosprivacy.analysis.suggesting.evidence import Proposal
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.explorer.web.view import View
    from rosprivacy.report.words.words import Words

REASONS = 2  # of a suggestion
FINDINGS = 3  # that a suggestion could close
LINES = 3  # of the policy lines that allow a step
KEYS = {
    forms.SOURCE: "s", forms.LEAK: "l", forms.SANITIZER: "z", forms.CONDUIT: "c", forms.DERIVES: "d",
    forms.ABSENT: "n", forms.MUNDANE: "m", forms.SENSITIVE: "v", forms.NOTHING: "x",
}  # fmt: skip


class Line(NamedTuple):
    """Where a policy line stands: file and number, and with the folders of the file."""

    short: str
    whole: str


class Hop(NamedTuple):
    """An element of a path, and the step that leads on from it, with the policy lines that allow it.

    Attributes
    ----------
    of, role
        Kind of the element and role of the step, as the model names them.
    """

    name: str
    kind: str
    address: str
    of: str
    role: str = ""
    verb: str = ""
    lines: tuple[Line, ...] = ()
    more: int = 0
    data: str = ""


class Way(NamedTuple):
    """How a kind of data gets to the element."""

    kind: str
    title: str
    hops: tuple[Hop, ...]


class About(NamedTuple):
    """A kind of data that an answer can be about."""

    name: str
    title: str
    chosen: bool


class Offer(NamedTuple):
    """What could be said of the element, with reasons; the fields are those of the form.

    Attributes
    ----------
    takes
        Whether it takes data away.
    closes
        The known findings that it could close: then nobody takes it by one key.
    sure
        Whether it is more than perhaps a source: then it is not folded.
    """

    told: str
    reasons: tuple[str, ...]
    fields: tuple[tuple[str, str], ...]
    takes: bool
    closes: tuple[str, ...]
    sure: bool


class Pane(NamedTuple):
    """The element in hand.

    Attributes
    ----------
    said
        What labels say of it, in words.
    is_open
        Whether nobody has said what it does with some kind of data.
    roles
        (role, key) of what can be said of it.
    kinds
        (name, title) of every kind of data.
    brings
        The kind that is chosen first where it is said to bring data in.
    labelled
        Whether the label file says something of it.
    robots
        For how many robots it stands.
    whose
        The label files of a fleet that an answer can go to.
    """

    id: str
    name: str
    kind: str
    enclaves: tuple[str, ...]
    said: tuple[str, ...]
    is_open: bool
    asked: str
    ways: tuple[Way, ...]
    about: tuple[About, ...]
    offers: tuple[Offer, ...]
    roles: tuple[tuple[str, str], ...]
    kinds: tuple[tuple[str, str], ...]
    brings: str
    labelled: bool
    robots: str
    whose: tuple[Whose, ...]


def pane_of(standing: Standing, element: Element, view: View, words: Words) -> Pane:
    """Return what the page shows of an element."""
    at = element_id(element.identity)
    is_open = standing.open_kinds.get(at, ())
    carried = sorted({*standing.carried.get(at, ()), *is_open})  # a broader kind is open beside a narrower one
    here = [kind for kind in carried if kind not in view.hidden]
    asked = [kind for kind in is_open if kind not in view.hidden]
    offers = standing.suggestions.of(element.identity)
    chosen = whose(standing.session, element, words)
    alone = any(one.chosen and one.value == ROBOT for one in chosen)
    labelled = standing.entry(element, only_this_robot=alone) is not None
    roles = [role for role in forms.roles_of(element) if role != forms.NOTHING or labelled]
    return Pane(
        id=at,
        name=shown(element.full_name),
        kind=words.known(f"kind.{element.kind}", element.kind),
        enclaves=_enclaves(standing, element),
        said=tuple(_said(standing, at, words)),
        is_open=bool(is_open),
        asked=words.row(title_of(kind, standing.vocabulary, words) for kind in asked or here),
        ways=tuple(_ways(standing, element, asked or here, view, words)),
        about=_about(standing, carried, asked or [kind for kind in here if not _ends(standing, at, kind)], words),
        offers=tuple(_offer(one, standing, words) for one in offers if _whole(one)),
        roles=tuple((role, KEYS[role]) for role in roles),
        kinds=_all_kinds(standing, words),
        brings=next((one.label.kind for one in offers if one.label.role == forms.SOURCE), "PersonalData"),
        labelled=labelled,
        robots=stands_for(standing, element, words),
        whose=chosen,
    )


def _enclaves(standing: Standing, element: Element) -> tuple[str, ...]:
    if not element.is_node:
        return ()
    found = {one.enclave for one in standing.analysis.graph.profiles if one.node == element.name}
    return tuple(shown(one) for one in sorted(found))


def _said(standing: Standing, at: str, words: Words) -> Iterable[str]:
    """What labels say that it does, kind by kind."""
    for kind, roles in sorted(standing.roles.get(at, {}).items()):
        title = title_of(kind, standing.vocabulary, words)
        for role in roles:
            if role in forms.OF_CHANNELS:  # in the words of a review
                yield words.pair(words(f"rv.said.{'never' if role == forms.MUNDANE else role}"), title)
            else:
                yield words(f"role.{role}", data=title)


def _about(standing: Standing, carried: Sequence[str], chosen: Sequence[str], words: Words) -> tuple[About, ...]:
    offered = carried or standing.analysis.emitted
    return tuple(About(kind, title_of(kind, standing.vocabulary, words), kind in chosen) for kind in offered)


def _ends(standing: Standing, at: str, kind: str) -> bool:
    """Whether a label says that a kind comes in or goes out there: a person who takes that away chooses the kind."""
    return not {forms.SOURCE, forms.LEAK}.isdisjoint(standing.roles.get(at, {}).get(kind, ()))


def _all_kinds(standing: Standing, words: Words) -> tuple[tuple[str, str], ...]:
    kinds = ((name, title_of(name, standing.vocabulary, words)) for name in standing.vocabulary.categories)
    return tuple(sorted(kinds, key=lambda one: (one[1].casefold(), one[0])))


def _whole(one: Proposal) -> bool:
    """Whether an answer can be made of it: how something is cleaned is never guessed."""
    return one.label.role != forms.SANITIZER or one.label.method is not None


def is_likely_source(one: Proposal) -> bool:
    """Return whether it is more than perhaps so that an element brings data in."""
    return one.label.role == forms.SOURCE and one.confidence is not Confidence.MAY


def _offer(one: Proposal, standing: Standing, words: Words) -> Offer:
    """What could be said, as the form says it."""
    label = one.label
    role = {"derivation": forms.DERIVES, "never": forms.MUNDANE}.get(label.role, label.role)
    to = title_of(label.to, standing.vocabulary, words) if label.to else ""
    told = words(f"x.offer.{role}", data=title_of(label.kind, standing.vocabulary, words), to=to)
    fields = [("role", role), ("about" if role != forms.SOURCE else "brings", label.kind or forms.EVERY)]
    fields += [("method", str(label.method.value))] if label.method else []
    fields += [("makes", label.to)] if label.to else []
    reasons = words.first([shown(reason.reason) for reason in one.evidence], REASONS)
    said = written(label).said
    closes = could_close(said, _findings(standing, words), standing.vocabulary)
    takes = not LIMITING.isdisjoint(said)
    return Offer(told, reasons, tuple(fields), takes, words.first(closes, FINDINGS), is_likely_source(one))


def _findings(standing: Standing, words: Words) -> Iterable[tuple[str, str]]:
    """All findings, whatever a page shows of them: (kind, what to tell of it)."""
    for one in standing.result.analysis.findings:
        data = title_of(one.category, standing.vocabulary, words)
        way = f"{shown(one.source.full_name)} → {shown(one.leak.full_name)}"
        yield one.category, words.pair(data, way)


def _ways(standing: Standing, element: Element, kinds: Iterable[str], view: View, words: Words) -> Iterable[Way]:
    """One shortest path for each kind; the same path of several kinds once."""
    told: dict[tuple[Element, ...], str] = {}
    for kind in kinds:
        paths = [path for part in standing.parts(element.identity) if (path := standing.why.path(part, kind))]
        if paths:
            path = min(paths, key=lambda one: len(one.steps))
            if path.elements not in told:
                told[path.elements] = kind
                yield Way(kind, title_of(kind, standing.vocabulary, words), tuple(_hops(path, standing, view, words)))


def _hops(path: Witness, standing: Standing, view: View, words: Words) -> Iterable[Hop]:
    before = ""
    for number, element in enumerate(path.elements):
        kind = words.known(f"kind.{element.kind}", element.kind)
        kind = words.row([kind, words(f"leg.{element.leg}")]) if element.leg else kind
        address = view.to(element_id(element.identity)).address
        hop = Hop(shown(element.full_name), kind, address, element.kind)
        if number < len(path.steps):
            step = path.steps[number]
            data = _data(step, standing, words)
            lines = tuple(dict.fromkeys(_line(grant) for grant in step.grants))
            hop = hop._replace(
                role=step.role, verb=words(f"verb.{step.role}"), lines=lines[:LINES], more=len(lines[LINES:]),
                data="" if data == before else data,
            )  # fmt: skip
            before = data
        yield hop


def _line(grant: Grant) -> Line:
    whole = shown(str(grant.place))
    return Line(whole.replace("\\", "/").rpartition("/")[2], whole)


def _data(step: Step, standing: Standing, words: Words) -> str:
    title = title_of(step.category, standing.vocabulary, words)
    return words("f.data", data=title) if step.pseudonymised else title
