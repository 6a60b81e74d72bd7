"""One entry of a log of decisions, as the history of a decision holds it."""

from typing import NamedTuple


class LoggedStep(NamedTuple):
    """One entry of a log about the target of a decision.

    Attributes
    ----------
    hash
        Of the entry.
    when
        When it was written, in UTC.
    account
        Who wrote it, as the system and git know them; the owner is who answers for it, as they stated.
    decision
        A ``Choice``, ``confirm`` or ``withdraw``.
    answers
        As of ``Decision``.
    """

    hash: str
    when: str
    account: str
    decision: str
    owner: str = ""
    reason: str = ""
    condition: str = ""
    expires: str = ""
    answers: tuple[tuple[str, str], ...] = ()
