"""Posted forms of trials: fields from a browser go in, out comes what is tried, or one plain sentence.

All is chosen from closed lists: elements and flows by ids, policy lines by ids, kinds of data by names of the
vocabulary, proposals by their number.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.mitigation.limits import FILTER, REVIEW
from rosprivacy.analysis.mitigation.proposals import ProposedStep
from rosprivacy.explorer.scenarios import WhatIf
from rosprivacy.explorer.web.forms import EVERY, FormError
from rosprivacy.explorer.web.titles import title_of
from rosprivacy.explorer.web.trials.trial_offers import between, cleans, lines_of
from rosprivacy.explorer.web.whose import ROBOT, WHOSE, robots_told
from rosprivacy.report.document.analysis import label_key
from rosprivacy.report.naming import name
from rosprivacy.report.page.closing import change_told
from rosprivacy.report.page.index import Index

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from rosprivacy.analysis.model import Element
    from rosprivacy.explorer.web.forms import Form
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.report.catalogs.words import Words

TOGETHER = "together"  # of two trials that are kept
ALL_STEPS = ""  # in the place of one change of a proposal
COUNTRY = re.compile(r"[A-Z]{2}")
LONGEST_DAYS = 5  # digits


class Tried(NamedTuple):
    """What is tried, and what a person is told of it."""

    what: WhatIf
    says: tuple[str, ...]


def tried_in(form: Form, standing: Standing, words: Words) -> Tried:
    """Return what a form tries.

    Raises
    ------
    FormError
        If it tries nothing that can be tried.
    """
    found = _KINDS[form.choice("what", _KINDS)](form, standing, words)
    robots = found.what.robots
    if standing.session.of_one_robot:
        return found
    if not robots:
        raise FormError("It belongs to no robot: what the fleet file states is changed there.")
    return found._replace(says=(*found.says, robots_told(standing.session, robots, words)))


def _robots(form: Form, standing: Standing, *elements: Element) -> tuple[str, ...]:
    """Of a fleet, on which robots it is tried: those of the model of the first element on a robot, or that one."""
    alone = form.choice("whose", WHOSE) == ROBOT
    of = (standing.session.robots_like(element.robot, only_this_robot=alone) for element in elements)
    return next(filter(None, of), ())


def _filter(form: Form, standing: Standing, words: Words) -> Tried:
    """One of a policy: it has a channel of its own, and what wildcards take past it gets past it."""
    ends = between(standing, form.one("flow"))
    if not ends:
        raise FormError("There is no such step any more; choose another one.")
    kinds, data = _kinds(form, standing, words)
    source, target = (shown(end.full_name) for end in ends[0])
    step = ProposedStep(FILTER, 0, kinds or _all(standing), between=ends)
    what = WhatIf(steps=(step,), robots=_robots(form, standing, *ends[0]))
    return Tried(what, (words("z.filter", source=source, target=target, data=data),))


def _cut(form: Form, standing: Standing, words: Words) -> Tried:
    lines = lines_of(standing)
    place = lines[form.choice("line", lines)]
    element = standing.elements.get(form.one("element"))
    robots = _robots(form, standing, element) if element else ()
    what = WhatIf(cut=((place.file, place.line),), robots=robots)
    return Tried(what, (words("x.try.says.cut", line=shown(str(place))),))


def _storage(form: Form, standing: Standing, words: Words) -> Tried:
    element = _element(form, standing)
    called = words("x.try.storage.name")
    said = {"kind": "storage", **_facts(form)}
    robots = _robots(form, standing, element)
    what = WhatIf(elements={called: said}, flows=((_end(element), called),), robots=robots)
    facts = [words.pair(words("c.retention"), words.duration(said["retention"]))] if "retention" in said else []
    facts += [words.pair(words("c.place"), said["country"])] if "country" in said else []
    return Tried(what, (words("x.try.says.storage", element=shown(element.full_name)), *facts))


def _facts(form: Form) -> dict[str, str]:
    """What is stated of the storage; what is not said is not known."""
    days, country = form.one("days"), form.one("country").upper()
    if days and not (days.isascii() and days.isdigit() and len(days) <= LONGEST_DAYS and int(days)):
        raise FormError("Say for how many days it keeps data, in digits, or leave it empty.")
    if country and not COUNTRY.fullmatch(country):
        raise FormError("Name the country by its two letters, such as DE, or leave it empty.")
    said = {"retention": f"P{int(days)}D" if days else "", "country": country}
    return {key: value for key, value in said.items() if value}


def _end(element: Element) -> str | Mapping[str, str]:
    """An end of a flow, as label files write it."""
    written = label_key(element)["name"]
    return {element.kind: written} if element.is_node or element.is_channel else written


def _doubt(form: Form, standing: Standing, words: Words) -> Tried:
    element = _element(form, standing)
    if not cleans(standing, form.one("element")):
        raise FormError("It is not said to clean anything.")
    kinds, data = _kinds(form, standing, words)
    robots = _robots(form, standing, element)
    what = WhatIf(doubted=((element.kind, element.name, kinds),), robots=robots)
    return Tried(what, (words("x.try.says.doubt", element=shown(element.full_name), data=data),))


def _proposal(form: Form, standing: Standing, words: Words) -> Tried:
    """A proposal of ``mitigate``, whole or one change of it."""
    found = standing.mitigation if standing.session.of_one_robot else None
    proposals = found.proposals if found else ()
    number = form.number("proposal")
    if found is None or number >= len(proposals) or not proposals[number].steps:
        raise FormError("There is no such proposal any more; ask again what closes it.")
    steps = proposals[number].steps
    rows = found.document()["proposals"][number]["steps"]
    if form.one("step") != ALL_STEPS:
        one = form.number("step")
        if one >= len(steps):
            raise FormError("There is no such change any more; ask again what closes it.")
        steps, rows = steps[one : one + 1], rows[one : one + 1]
    index = Index(standing.document, words)
    return Tried(WhatIf(steps=steps), tuple(_told(row, index) for row in rows))


def _told(step: Mapping[str, Any], index: Index) -> str:
    """A change with its policy lines, in one sentence; of a review, what it is taken to find."""
    if step["kind"] == REVIEW:
        data = index.all_data(step["categories"])
        return index.words("x.try.says.review", channel=name(step["channel"]), data=data)
    change = change_told(step, index)
    return f"{change.text} ({', '.join(change.lines)})" if change.lines else change.text


def _element(form: Form, standing: Standing) -> Element:
    chosen = form.one("element")
    if chosen not in standing.elements:
        raise FormError("There is no such element any more; choose another one.")
    return standing.elements[chosen]


def _kinds(form: Form, standing: Standing, words: Words) -> tuple[tuple[str, ...], str]:
    """Kinds of data that it is about, none for every kind; and what they are called."""
    kind = form.choice("data", [EVERY, *standing.vocabulary.categories])
    chosen = "" if kind == EVERY else kind
    return ((chosen,) if chosen else ()), title_of(chosen, standing.vocabulary, words)


def _all(standing: Standing) -> tuple[str, ...]:
    """The kinds of data that have no broader one: together, all."""
    vocabulary = standing.vocabulary
    return tuple(sorted(name for name in vocabulary.categories if not vocabulary.hierarchy.broader(name)))


_KINDS: dict[str, Callable[[Form, Standing, Words], Tried]] = {
    "filter": _filter, "cut": _cut, "storage": _storage, "doubt": _doubt, "proposal": _proposal,
}  # fmt: skip
