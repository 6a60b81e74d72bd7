"""What is wrong with how a policy is written, whatever data it lets flow."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rosprivacy.analysis.model.diagnostic import Place, Severity


@dataclass(frozen=True, slots=True)
class LintRule:
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


@dataclass(frozen=True, slots=True)
class Breach:
    """A rule that is broken at a line."""

    rule: LintRule
    place: Place
    message: str
