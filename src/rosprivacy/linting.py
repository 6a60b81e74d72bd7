"""Policies, and labels if there are any -> the rules that are broken.

In: names of files. Out: ``Linted``, by file and line.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError
from rosprivacy.ingest.lint.enclave_rules import enclave_breaches
from rosprivacy.ingest.lint.grant_rules import grant_breaches
from rosprivacy.ingest.lint.read_rules import read_breaches
from rosprivacy.ingest.lint.rule_table import RULES
from rosprivacy.question import question_of
from rosprivacy.robot_system import robot_system

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model import Breach, LintRule
    from rosprivacy.settings import Settings


@dataclass(frozen=True, slots=True)
class Linted:
    """What was found, by which rules, in which files.

    Attributes
    ----------
    breaches
        By file, line and rule; each once.
    rules
        Those that were looked at.
    files
        (file, SHA-256) of what was read, sorted.
    """

    breaches: tuple[Breach, ...]
    rules: tuple[LintRule, ...]
    files: tuple[tuple[str, str], ...]


def lint_policies(
    policies: tuple[str, ...],
    labels: tuple[str, ...],
    settings: Settings,
    select: Iterable[str] = (),
    ignore: Iterable[str] = (),
) -> Linted:
    """Look at policies by the rules of ``lint``.

    Parameters
    ----------
    select, ignore
        Names of rules: only these, all without these. Empty means all.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each; an ``InputError`` if there is no such rule.
    """
    rules = chosen(tuple(select), tuple(ignore))
    system = robot_system(policies, labels, question_of(settings))
    read = system.policies
    breaches = {
        *read_breaches(system.diagnostics),
        *grant_breaches([grant for policy in read for grant in policy.grants], system.graph),
        *enclave_breaches(read, system.graph, system.bound),
    }
    kept = sorted((breach for breach in breaches if breach.rule in rules), key=_order)
    return Linted(tuple(kept), rules, tuple(sorted({source for policy in read for source in policy.sources})))


def chosen(select: tuple[str, ...], ignore: tuple[str, ...]) -> tuple[LintRule, ...]:
    """Return the rules that are looked at, in their order.

    Raises
    ------
    InputError
        If there is no such rule.
    """
    for name in (*select, *ignore):
        if name not in RULES:
            raise InputError(name, 0, "no such rule", f"choose of {', '.join(RULES)}")
    return tuple(rule for name, rule in RULES.items() if name in (select or RULES) and name not in ignore)


def _order(breach: Breach) -> tuple[str, int, str, str]:
    return (breach.place.file, breach.place.line, breach.rule.name, breach.message)
