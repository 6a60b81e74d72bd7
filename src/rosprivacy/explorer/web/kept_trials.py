"""Trials on the page, kept by name, and the panes of what each does; nothing of them is saved, and none is a verdict.

In: a session, names and what is tried. Out: a ``Standing`` of each, and what follows in sentences and counts. A trial
is made anew once the session has changed, so that it is always compared with how it stands now.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.explorer.effects import CLOSED, OPENED, PLAINER
from rosprivacy.explorer.scenarios import summary_of, together
from rosprivacy.explorer.web.forms import FormError
from rosprivacy.explorer.web.panes import Pane
from rosprivacy.explorer.web.standing import Standing
from rosprivacy.explorer.web.trial_forms import Tried
from rosprivacy.report.page.finding_entries import sentence_of
from rosprivacy.report.page.index import Index

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.explorer.effects import Difference
    from rosprivacy.explorer.scenarios import Scenario
    from rosprivacy.explorer.session import Session
    from rosprivacy.explorer.web.forms import EditForm
    from rosprivacy.explorer.web.view import PageView
    from rosprivacy.labelling.suggesting_on_demand import Suggester
    from rosprivacy.report.catalogs.words import Words

BOUND = 20  # trials: each keeps a whole answer
SENTENCES = 40  # of one list
SHOWN_AT_MOST = 3  # robots


class Trials:
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

    def keep(self, name: str, tried: Tried) -> None:
        """Try something, and keep it under a name; another of that name is replaced."""
        if name not in self.names and len(self.names) >= BOUND:
            raise FormError(f"There are {BOUND} trials already: forget one.")
        self._session.scenario(name, tried.trial)
        self._says[name] = tried.says

    def together(self, form: EditForm) -> Tried:
        """Return what two trials that a form names try, as one, and what a person is told of it."""
        names = form.choice("first", self.names), form.choice("second", self.names)
        first, second = (self._session.scenarios[name].what_if for name in names)
        return Tried(together(first, second), tuple(dict.fromkeys(line for name in names for line in self.says(name))))

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


def trial_pane(now: Standing, trials: Trials, view: PageView, words: Words) -> Pane:
    """Return what the trial of a view does; errors as of ``Trials.scenario``."""
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


def kept_trials(trials: Trials, view: PageView, words: Words) -> tuple[Pane, ...]:
    """Return the list of trials."""
    rows = []
    for name in trials.names:
        says = words.first([sentence.rstrip(".") for sentence in trials.says(name)], 1)  # sentences, as parts of a row
        address = _within(view)._replace(trial=name).address
        rows.append(Pane(name=name, told=words.row(says), address=address, current=name == view.trial))
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
