"""What the page shows beside the system: the finding in hand, the trial that is looked at, what can be tried here.

In: how it stands or would stand, how it stands now, the page, the trials. Out: ``Beside``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.explorer.web.finding_pane import finding_pane
from rosprivacy.explorer.web.trials.trial_offers import offers_at
from rosprivacy.explorer.web.trials.trial_pane import kept_trials, trial_pane

if TYPE_CHECKING:
    from rosprivacy.explorer.web.finding_pane import FindingPane
    from rosprivacy.explorer.web.page import Page
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.explorer.web.trials.kept_trials import Trials
    from rosprivacy.explorer.web.trials.trial_offers import Offers
    from rosprivacy.explorer.web.trials.trial_pane import Kept, TrialPane
    from rosprivacy.report.catalogs.words import Words


class Beside(NamedTuple):
    """What stands beside; None for what does not.

    Attributes
    ----------
    offers
        What can be tried at the element in hand; nothing within a trial.
    kept
        All trials.
    """

    finding: FindingPane | None
    trial: TrialPane | None
    offers: Offers | None
    kept: tuple[Kept, ...]


def beside(standing: Standing, now: Standing, page: Page, trials: Trials, words: Words) -> Beside:
    """Return what a window shows beside the system.

    Parameters
    ----------
    standing
        What the page is about.
    now
        How it stands; the same where no trial is looked at.
    """
    view = page.view
    finding = standing.findings.get(view.finding)
    can_try = now.session.can_try and not finding and not view.trial
    at = standing.elements.get(page.pane.id) if page.pane and can_try else None
    return Beside(
        finding_pane(standing, finding, view, words) if finding else None,
        trial_pane(now, trials, view, words) if view.trial else None,
        offers_at(standing, at, words) if at else None,
        kept_trials(trials, view, words),
    )
