"""What a trial does, in sentences and counts: in come how it stands and how it would, out a ``TrialPane``.

Nothing of a trial is saved, and the pane is no verdict on the system: it says what would follow if it were so.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.explorer.effects import CLOSED, OPENED, PLAINER
from rosprivacy.report.page.finding_entries import sentence_of
from rosprivacy.report.page.index import Index

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.explorer.effects import Difference
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.explorer.web.trials.kept_trials import Trials
    from rosprivacy.explorer.web.view import View
    from rosprivacy.report.catalogs.words import Words

MOST = 40  # sentences of one list
NAMED = 3  # robots


class Told(NamedTuple):
    """A finding that the trial opens or closes; one that it closes is to be found only where it stands.

    Attributes
    ----------
    robots
        What else to know, in words: that it is no longer pseudonymised; of a fleet, on which robots it is so.
    """

    sentence: str
    address: str
    robots: str = ""


class TrialPane(NamedTuple):
    """What a trial does.

    Attributes
    ----------
    says
        What is tried.
    verdicts
        How it stands now, and how it would stand: keys of words.
    counts
        What opens and closes, in numbers.
    closed, opened
        The first findings; ``more`` tells how many others there are of each.
    leads
        Where the trial is left.
    others
        Other trials, each of which can be tried together with this one.
    """

    name: str
    says: tuple[str, ...]
    verdicts: tuple[str, str]
    counts: tuple[str, ...]
    closed: tuple[Told, ...]
    opened: tuple[Told, ...]
    more: tuple[int, int]
    remarks: tuple[str, ...]
    address: str
    leads: str
    others: tuple[str, ...]


class Kept(NamedTuple):
    """A trial in the list."""

    name: str
    told: str
    address: str
    current: bool


def trial_pane(now: Standing, trials: Trials, view: View, words: Words) -> TrialPane:
    """Return what the trial of a view does.

    Raises
    ------
    InputErrors
        If what is tried is not there any more.
    """
    name = view.trial
    there, difference = trials.standing(name), trials.scenario(name).difference
    out = view.to("")._replace(trial="", find="")
    left = sum(finding.stands for finding in there.analysis.findings)
    counts = [
        words.count(len(difference.closed), "x.trial.closes"),
        words.count(len(difference.opened), "x.trial.opens"),
        *([words.count(len(difference.plainer), "x.trial.plainer")] if difference.plainer else []),
        words.count(left, "x.trial.left"),
        *([words.count(difference.fewer, "x.trial.fewer")] if difference.fewer else []),
        *([words.count(difference.more, "x.trial.more")] if difference.more else []),
    ]
    return TrialPane(
        name=name,
        says=trials.says(name),
        verdicts=(f"code.{difference.before}", f"code.{difference.verdict}"),
        counts=tuple(counts),
        closed=tuple(_told(difference, CLOSED, now, out, words)),
        opened=tuple(
            told
            for what in (OPENED, PLAINER)
            for told in _told(difference, what, there, view.to("")._replace(find=""), words)
        ),
        more=(len(difference.closed[MOST:]), len(difference.opened[MOST:])),
        remarks=tuple(map(shown, trials.scenario(name).remarks)),
        address=view.to("")._replace(find="").address,
        leads=out.address,
        others=tuple(trials.beside(name)),
    )


def kept_trials(trials: Trials, view: View, words: Words) -> tuple[Kept, ...]:
    """Return the list of trials."""
    there = view.to("")._replace(find="")
    kept = []
    for name in trials.names:
        says = words.first([one.rstrip(".") for one in trials.says(name)], 1)  # sentences, as parts of a row
        kept.append(Kept(name, words.row(says), there._replace(trial=name).address, name == view.trial))
    return tuple(kept)


def _told(difference: Difference, what: str, standing: Standing, view: View, words: Words) -> Iterable[Told]:
    index = Index(standing.document, words)
    told = words("x.trial.plainly") if what == PLAINER else ""
    for one in _ids(difference, what)[:MOST]:
        robots = difference.robots.get((what, one), ())
        names = words.row(words.first(list(map(shown, robots)), NAMED))
        on = words("x.trial.robots", robots=words.count(len(robots), "robot"), names=names) if robots else ""
        yield Told(
            sentence_of(index.by_id[one], index), view._replace(finding=one).address, " ".join(filter(None, [told, on]))
        )


def _ids(difference: Difference, what: str) -> tuple[str, ...]:
    return {OPENED: difference.opened, CLOSED: difference.closed, PLAINER: difference.plainer}[what]
