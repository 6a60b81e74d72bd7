"""What can be tried at an element, posted forms of trials, and trials that are kept by name, with what each does.

All is chosen from closed lists: elements by ids, a flow by the ids of its ends, a policy line by an id of its own,
kinds of data by names of the vocabulary, proposals by their number. Nothing that a browser sends is the name of a file.
Nothing of a trial is saved, and none is a verdict; it is made anew once the session has changed, so that it is always
compared with how it stands now.
"""

from __future__ import annotations

import re
from hashlib import sha256
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.kernel.vertices import by_identity
from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.mitigation.limits import FILTER, REVIEW
from rosprivacy.analysis.mitigation.proposals import ProposedStep
from rosprivacy.analysis.text import fit
from rosprivacy.explorer.edits import DIGITS, element_id
from rosprivacy.explorer.effects import CLOSED, OPENED, PLAINER
from rosprivacy.explorer.scenarios import WhatIf, summary_of, together
from rosprivacy.explorer.web.forms import EVERY, FormError, element_in
from rosprivacy.explorer.web.panes import MODEL, ROBOT, ROBOT_OR_MODEL, Pane, robots_in_words, title_of
from rosprivacy.explorer.web.standing import Standing
from rosprivacy.report.document.analysis import label_key
from rosprivacy.report.naming import name
from rosprivacy.report.page.closing import change_told
from rosprivacy.report.page.finding_entries import sentence_of
from rosprivacy.report.page.index import Index

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from rosprivacy.analysis.model import Element, Flow, Place
    from rosprivacy.explorer.effects import Difference
    from rosprivacy.explorer.scenarios import Scenario
    from rosprivacy.explorer.session import Session
    from rosprivacy.explorer.web.forms import EditForm
    from rosprivacy.explorer.web.view import PageView
    from rosprivacy.labelling.suggesting_on_demand import Suggester
    from rosprivacy.report.catalogs.words import Words

BOUND = 60  # of one list; a line or a flow further away has an element nearer to it
TOGETHER = "together"  # of two trials that are kept
ALL_STEPS = ""  # in the place of one change of a proposal
COUNTRY = re.compile(r"[A-Z]{2}")
LONGEST_DAYS = 5  # digits
MOST_KEPT = 20  # trials: each keeps a whole answer
SENTENCES = 40  # of one list
SHOWN_AT_MOST = 3  # robots


# --- what can be tried ------------------------------------------------------------------------------------------


def offers_at(standing: Standing, element: Element, words: Words) -> Pane:
    """Return what can be tried at an element: filters beside it, policy lines, a storage, a doubt of its cleaning."""
    at = element_id(element.identity)
    ends = ((flow, _id(flow.source, standing), _id(flow.target, standing)) for flow in _flows(standing, element))
    flows = [flow for flow, source, target in ends if {source, target} <= standing.carried.keys()]
    kinds = standing.carried.get(at, ())
    whose = tuple(_robots_of_choice(standing.session, element, words))
    shared = standing.session.is_fleet and not whose  # what is on no robot is changed in the fleet file
    places = dict.fromkeys(grant.place for flow in flows for grant in flow.grants)
    if standing.result.fleet:  # a line of the fleet file is none of a policy
        places = {place: None for place in places if line_id(place) in lines_of(standing)}
    return Pane(
        element=at,
        flows=tuple(_between(flows, standing))[:BOUND],
        lines=() if shared else tuple(_offer(line_id(place), fit(str(place))) for place in places)[:BOUND],
        kinds=tuple(_offer(kind, title_of(kind, standing.vocabulary, words)) for kind in kinds),
        cleans=_cleans(standing, at) and not shared,
        whose=whose,
        shared=shared,
    )


def _offer(value: str, text: str) -> Pane:
    """A value of a form, and what a person reads."""
    return Pane(value=value, told=text)


def _robots_of_choice(session: Session, element: Element, words: Words) -> Iterator[Pane]:
    """All robots of the model, and this one only; once where these are the same."""
    model, alone = (session.robots_like(element.robot, only_this_robot=alone) for alone in (False, True))
    if model != alone:
        yield _offer(MODEL, robots_in_words(session, model, words))
    if alone:
        yield _offer(ROBOT, robots_in_words(session, alone, words))


def _between(flows: Iterable[Flow], standing: Standing) -> Iterator[Pane]:
    elements = standing.analysis.graph.elements
    seen: set[str] = set()
    for flow in flows:
        source, target = elements[flow.source], elements[flow.target]
        value = flow_id(source, target)
        if value not in seen:
            seen.add(value)
            yield _offer(value, f"{shown(source.full_name)} → {shown(target.full_name)}")


def flow_id(source: Element, target: Element) -> str:
    """Return what names the flows between two elements.

    >>> from rosprivacy.analysis.model import Element
    >>> flow_id(Element("node", "/camera"), Element("topic", "/video"))
    'e367b8bde1c84db46.ee42e87f26bf77176'
    """
    return f"{element_id(source.identity)}.{element_id(target.identity)}"


def line_id(place: Place) -> str:
    """Return what names a line of a policy; it is no name of a file."""
    return f"l{sha256(f'{place.file}{chr(0)}{place.line}'.encode('utf-8', 'surrogatepass')).hexdigest()[:DIGITS]}"


def lines_of(standing: Standing) -> Mapping[str, Place]:
    """Return the lines that allow something, by their ids."""
    grants = (grant for policy in standing.result.policies for grant in policy.grants if grant.allow)
    return {line_id(place): place for place in dict.fromkeys(grant.place for grant in grants)}


def _cleans(standing: Standing, at: str) -> bool:
    """Whether labels say that an element ends some kind of data."""
    return any("sanitizer" in roles for roles in standing.roles.get(at, {}).values())


def _ends_of(standing: Standing, flow: str) -> tuple[tuple[Element, Element], ...]:
    """The ends of the flows that an id names: the legs of services are flows of their own."""
    first, _, second = flow.partition(".")
    elements = standing.elements
    if first not in elements or second not in elements:
        return ()
    wanted = elements[first].identity, elements[second].identity
    graph = standing.analysis.graph
    ends = ((graph.elements[each.source], graph.elements[each.target]) for each in _flows(standing, elements[first]))
    return tuple(dict.fromkeys((a, b) for a, b in ends if (a.identity, b.identity) == wanted))


def _flows(standing: Standing, element: Element) -> Iterator[Flow]:
    """The flows of an element from and to others; of meetings those only that it takes part in."""
    graph = standing.analysis.graph
    here = set(by_identity(standing.analysis.spread)[element.identity])
    stored, meetings = parted(graph.flows)
    yield from (flow for _, flow in stored if (flow.source in here) != (flow.target in here))
    for meeting in meetings:
        yield from (meeting.flow(a, b) for a in meeting.written if a in here for b in meeting.read if b not in here)
        yield from (meeting.flow(a, b) for b in meeting.read if b in here for a in meeting.written if a not in here)


def _id(vertex: int, standing: Standing) -> str:
    return element_id(standing.analysis.graph.elements[vertex].identity)


# --- forms ------------------------------------------------------------------------------------------------------


class ToldTrial(NamedTuple):
    """What is tried, and what a person is told of it."""

    trial: WhatIf
    says: tuple[str, ...]


def tried_in(form: EditForm, standing: Standing, words: Words) -> ToldTrial:
    """Return what a form tries."""
    tried = _KINDS[form.choice("what", _KINDS)](form, standing, words)
    if standing.session.can_mitigate:
        return tried
    if not tried.trial.robots:
        raise FormError("It belongs to no robot: what the fleet file states is changed there.")
    return tried._replace(says=(*tried.says, robots_in_words(standing.session, tried.trial.robots, words)))


def _robots(form: EditForm, standing: Standing, *elements: Element) -> tuple[str, ...]:
    """Of a fleet, on which robots it is tried: those of the model of the first element on a robot, or that one."""
    alone = form.choice("whose", ROBOT_OR_MODEL) == ROBOT
    robots = (standing.session.robots_like(element.robot, only_this_robot=alone) for element in elements)
    return next(filter(None, robots), ())


def _filter(form: EditForm, standing: Standing, words: Words) -> ToldTrial:
    """One of a policy: it has a channel of its own, and what wildcards take past it gets past it."""
    ends = _ends_of(standing, form.value("flow"))
    if not ends:
        raise FormError("There is no such step any more; choose another one.")
    kinds, data = _kinds(form, standing, words)
    source, target = (shown(end.full_name) for end in ends[0])
    step = ProposedStep(FILTER, 0, kinds or _all(standing), between=ends)
    trial = WhatIf(steps=(step,), robots=_robots(form, standing, *ends[0]))
    return ToldTrial(trial, (words("closing.filter", source=source, target=target, data=data),))


def _cut(form: EditForm, standing: Standing, words: Words) -> ToldTrial:
    lines = lines_of(standing)
    place = lines[form.choice("line", lines)]
    element = standing.elements.get(form.value("element"))
    robots = _robots(form, standing, element) if element else ()
    trial = WhatIf(cut=((place.file, place.line),), robots=robots)
    return ToldTrial(trial, (words("explorer.try.says.cut", line=shown(str(place))),))


def _storage(form: EditForm, standing: Standing, words: Words) -> ToldTrial:
    element = element_in(form, standing.elements)
    called = words("explorer.try.storage.name")
    facts = {"kind": "storage", **_facts(form)}
    robots = _robots(form, standing, element)
    trial = WhatIf(elements={called: facts}, flows=((_end(element), called),), robots=robots)
    says = [words("explorer.try.says.storage", element=shown(element.full_name))]
    says += [words.pair(words("column.retention"), words.duration(facts["retention"]))] if "retention" in facts else []
    says += [words.pair(words("column.place"), facts["country"])] if "country" in facts else []
    return ToldTrial(trial, tuple(says))


def _facts(form: EditForm) -> dict[str, str]:
    """What is stated of the storage; what is not said is not known."""
    days, country = form.value("days"), form.value("country").upper()
    if days and not (days.isascii() and days.isdigit() and len(days) <= LONGEST_DAYS and int(days)):
        raise FormError("Say for how many days it keeps data, in digits, or leave it empty.")
    if country and not COUNTRY.fullmatch(country):
        raise FormError("Name the country by its two letters, such as DE, or leave it empty.")
    facts = {"retention": f"P{int(days)}D" if days else "", "country": country}
    return {key: value for key, value in facts.items() if value}


def _end(element: Element) -> str | Mapping[str, str]:
    """An end of a flow, as label files write it."""
    written = label_key(element)["name"]
    return {element.kind: written} if element.is_node or element.is_channel else written


def _doubt(form: EditForm, standing: Standing, words: Words) -> ToldTrial:
    element = element_in(form, standing.elements)
    if not _cleans(standing, form.value("element")):
        raise FormError("It is not said to clean anything.")
    kinds, data = _kinds(form, standing, words)
    robots = _robots(form, standing, element)
    trial = WhatIf(doubted=((element.kind, element.name, kinds),), robots=robots)
    return ToldTrial(trial, (words("explorer.try.says.doubt", element=shown(element.full_name), data=data),))


def _proposal(form: EditForm, standing: Standing, words: Words) -> ToldTrial:
    """A proposal of ``mitigate``, whole or one change of it."""
    mitigation = standing.mitigation if standing.session.can_mitigate else None
    proposals = mitigation.proposals if mitigation else ()
    number = form.number("proposal")
    if mitigation is None or number >= len(proposals) or not proposals[number].steps:
        raise FormError("There is no such proposal any more; ask again what closes it.")
    steps = proposals[number].steps
    rows = mitigation.document()["proposals"][number]["steps"]
    if form.value("step") != ALL_STEPS:
        at = form.number("step")
        if at >= len(steps):
            raise FormError("There is no such change any more; ask again what closes it.")
        steps, rows = steps[at : at + 1], rows[at : at + 1]
    index = Index(standing.document, words)
    return ToldTrial(WhatIf(steps=steps), tuple(_change(row, index) for row in rows))


def _change(step: Mapping[str, Any], index: Index) -> str:
    """A change with its policy lines, in one sentence; of a review, what it is taken to find."""
    if step["kind"] == REVIEW:
        data = index.all_data(step["categories"])
        return index.words("explorer.try.says.review", channel=name(step["channel"]), data=data)
    change = change_told(step, index)
    return f"{change.text} ({', '.join(change.lines)})" if change.lines else change.text


def _kinds(form: EditForm, standing: Standing, words: Words) -> tuple[tuple[str, ...], str]:
    """Kinds of data that it is about, none for every kind; and what they are called."""
    kind = form.choice("data", [EVERY, *standing.vocabulary.categories])
    chosen = "" if kind == EVERY else kind
    return ((chosen,) if chosen else ()), title_of(chosen, standing.vocabulary, words)


def _all(standing: Standing) -> tuple[str, ...]:
    """The kinds of data that have no broader one: together, all."""
    vocabulary = standing.vocabulary
    return tuple(sorted(kind for kind in vocabulary.categories if not vocabulary.hierarchy.broader(kind)))


_KINDS: dict[str, Callable[[EditForm, Standing, Words], ToldTrial]] = {
    "filter": _filter, "cut": _cut, "storage": _storage, "doubt": _doubt, "proposal": _proposal,
}  # fmt: skip


class KeptTrials:
    """The trials of one session.

    Parameters
    ----------
    suggester
        What suggestions are made by.
    """

    def __init__(self, session: Session, suggester: Suggester) -> None:
        self._session, self._suggester = session, suggester
        self._says: dict[str, tuple[str, ...]] = {}
        self._standing: Standing | None = None  # of the one that was looked at last

    @property
    def names(self) -> tuple[str, ...]:
        """Their names, in the order in which they were made."""
        return tuple(self._session.scenarios)

    def keep(self, name: str, tried: ToldTrial) -> None:
        """Try something, and keep it under a name; another of that name is replaced."""
        if name not in self.names and len(self.names) >= MOST_KEPT:
            raise FormError(f"There are {MOST_KEPT} trials already: forget one.")
        self._session.scenario(name, tried.trial)
        self._says[name] = tried.says

    def together(self, form: EditForm) -> ToldTrial:
        """Return what two trials that a form names try, as one, and what a person is told of it."""
        names = form.choice("first", self.names), form.choice("second", self.names)
        first, second = (self._session.scenarios[name].what_if for name in names)
        return ToldTrial(
            together(first, second), tuple(dict.fromkeys(line for name in names for line in self.says(name)))
        )

    def combinable(self, name: str) -> Iterator[str]:
        """Yield the others that can be tried together with one: on the same robots."""
        kept = self._session.scenarios
        yield from (
            other for other in kept if other != name and kept[other].what_if.robots == kept[name].what_if.robots
        )

    def drop(self, name: str) -> None:
        """Forget one."""
        self._session.drop_scenario(name)
        self._says.pop(name, None)

    def says(self, name: str) -> tuple[str, ...]:
        """Return what is tried, in sentences."""
        return self._says.get(name) or (summary_of(self._session.scenarios[name].what_if),)

    def scenario(self, name: str) -> Scenario:
        """Return what follows, compared with how it stands now."""
        scenario = self._session.scenarios[name]
        return scenario if scenario.version == self._session.version else self._session.scenario(name, scenario.what_if)

    def standing(self, name: str) -> Standing:
        """Return how the session would stand; errors as of ``scenario``."""
        scenario = self.scenario(name)
        if self._standing is None or self._standing.result is not scenario.result:
            self._standing = Standing(self._session, self._suggester, scenario.result)
        return self._standing


def trial_pane(now: Standing, trials: KeptTrials, view: PageView, words: Words) -> Pane:
    """Return what the trial of a view does; errors as of ``KeptTrials.scenario``."""
    name = view.trial
    then, scenario = trials.standing(name), trials.scenario(name)
    difference, within, out = scenario.difference, _within(view), _within(view)._replace(trial="")
    left = sum(finding.stands for finding in then.analysis.findings)
    counts = [
        (len(difference.closed), "closes", True),
        (len(difference.opened), "opens", True),
        (len(difference.plainer), "plainer", False),
        (left, "left", True),
        (difference.no_longer_open, "fewer", False),
        (difference.newly_open, "more", False),
    ]
    opened = [*_findings(difference, OPENED, then, within, words), *_findings(difference, PLAINER, then, within, words)]
    return Pane(
        name=name,
        says=trials.says(name),
        verdicts=(f"code.{difference.before}", f"code.{difference.verdict}"),  # now and then: keys of words
        counts=[words.count(number, f"explorer.trial.{what}") for number, what, always in counts if number or always],
        closed=tuple(_findings(difference, CLOSED, now, out, words)),  # to be found only where they stand
        opened=opened,
        more=(len(difference.closed[SENTENCES:]), len(difference.opened[SENTENCES:])),
        remarks=tuple(map(shown, scenario.remarks)),
        address=within.address,
        leads=out.address,  # where the trial is left
        others=tuple(trials.combinable(name)),  # that can be tried together with this one
    )


def kept_trials(trials: KeptTrials, view: PageView, words: Words) -> tuple[Pane, ...]:
    """Return the list of trials."""
    rows = []
    for trial in trials.names:
        says = words.first([sentence.rstrip(".") for sentence in trials.says(trial)], 1)  # sentences, as parts of a row
        address = _within(view)._replace(trial=trial).address
        rows.append(Pane(name=trial, told=words.row(says), address=address, current=trial == view.trial))
    return tuple(rows)


def _within(view: PageView) -> PageView:
    return view.to("")._replace(find="")


def _findings(difference: Difference, group: str, standing: Standing, view: PageView, words: Words) -> Iterable[Pane]:
    """Findings that a trial opens, closes or makes plain; of a fleet, on which robots it does."""
    index = Index(standing.document, words)
    ids = {OPENED: difference.opened, CLOSED: difference.closed, PLAINER: difference.plainer}[group]
    for finding in ids[:SENTENCES]:
        robots = difference.robots.get((group, finding), ())
        notes = [words("explorer.trial.plainly")] if group == PLAINER else []
        if robots:
            names = words.row(words.first(list(map(shown, robots)), SHOWN_AT_MOST))
            notes.append(words("explorer.trial.robots", robots=words.count(len(robots), "robot"), names=names))
        address = view._replace(finding=finding).address
        yield Pane(sentence=sentence_of(index.by_id[finding], index), address=address, robots=" ".join(notes))
