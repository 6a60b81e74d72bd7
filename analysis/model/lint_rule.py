"""What is wrong with how a policy is written, whatever data it lets flow."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rosprivacy.analysis.model.diagnostic import Place, Severity


class LintRule(NamedTuple):
    """A rule of policies.

    Attributes
    ----------
    name
        Its id, such as ``wildcard``.
    about
        What breaks it, in a sentence.
    why
        What comes of it.
    """

    name: str
    severity: Severity
    about: str
    why: str


class Breach(NamedTuple):
    """A rule that is broken at a line."""

    rule: LintRule
    place: Place
    message: str
