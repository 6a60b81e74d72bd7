"""Policies, and labels if there are any -> the rules that are broken.

In: names of files. Out: ``Linted``, by file and line.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError
from rosprivacy.ingest.lint import OF_LABELS, RULES, enclave_breaches, grant_breaches, include_breaches, read_breaches
from rosprivacy.question import question_of
from rosprivacy.systems.robot_system import robot_system

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
    unseen
        Names of rules that were not looked at, since no labels are named.
    """

    breaches: tuple[Breach, ...]
    rules: tuple[LintRule, ...]
    files: tuple[tuple[str, str], ...]
    unseen: tuple[str, ...] = ()


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
    select, ignore = tuple(select), tuple(ignore)
    rules = chosen(select, ignore, labelled=bool(labels))
    system = robot_system(policies, labels, question_of(settings))
    read = system.policies
    breaches = {
        *read_breaches(system.diagnostics),
        *grant_breaches([grant for policy in read for grant in policy.grants], system.graph),
        *include_breaches((policy.file for policy in read), settings.include_root, settings.bounds),
        *enclave_breaches(read, system.graph, system.bound),
    }
    kept = sorted((breach for breach in breaches if breach.rule in rules), key=_order)
    files = tuple(sorted({source for policy in read for source in policy.sources}))
    unseen = () if labels or select else tuple(name for name in OF_LABELS if name not in ignore)
    return Linted(tuple(kept), rules, files, unseen)


def chosen(select: tuple[str, ...], ignore: tuple[str, ...], *, labelled: bool) -> tuple[LintRule, ...]:
    """Return the rules that are looked at, in their order; without labels some cannot be.

    Raises
    ------
    InputError
        If there is no such rule, or one is selected that needs labels, and there are none.
    """
    for name in (*select, *ignore):
        if name not in RULES:
            raise InputError(name, 0, "no such rule", f"choose of {', '.join(RULES)}")
        if name in select and name in OF_LABELS and not labelled:
            raise InputError(name, 0, "this rule needs labels", "name a label file with -l")
    looked_at = (name for name in RULES if labelled or name not in OF_LABELS)
    return tuple(RULES[name] for name in looked_at if name in (select or RULES) and name not in ignore)


def _order(breach: Breach) -> tuple[str, int, str, str]:
    return (breach.place.file, breach.place.line, breach.rule.name, breach.message)
