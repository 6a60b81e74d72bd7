"""Configurations of Zenoh -> policies: what each process may send and receive, and what lists leave to everybody.

In: their paths. Out: ``Policy`` facts, with what a reader has to know of them.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, shown
from rosprivacy.analysis.model import ACCESS_GAP, Diagnostic, Severity
from rosprivacy.analysis.modes import View
from rosprivacy.ingest.zenoh_access.access_file import read_access
from rosprivacy.ingest.zenoh_access.access_grants import keys_of, policy_of, process_of
from rosprivacy.ingest.zenoh_access.open_sessions import open_remarks, open_sessions
from rosprivacy.ingest.zenoh_access.ros_keys import namespaces_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import Place, Policy
    from rosprivacy.ingest.zenoh_access.access_file import AccessFile
    from rosprivacy.ingest.zenoh_access.ros_keys import Keys


def read_zenoh(files: Iterable[str], domain: int | None, *, view: str = View.declared) -> tuple[Policy, ...]:
    """Read configurations of Zenoh.

    Parameters
    ----------
    domain
        That of the robot; None where it does not matter, since all keys are of the same one.
    view
        The enforced view has also what sessions may do that no list tells apart (rule S6).

    Raises
    ------
    InputErrors
        With every problem, one line each.
    """
    read: list[AccessFile] = []
    problems: list[InputError] = []
    for file in files:
        try:
            read.append(read_access(file))
        except InputErrors as error:
            problems += error.errors
    spaces = {access.namespace: access.place for access in read if access.namespace} | _written_for(read)
    keys: dict[AccessFile, Keys] = {}
    for access in read:
        try:
            keys[access] = keys_of(access, domain, spaces)
        except InputErrors as error:
            problems += error.errors
    if problems:
        raise InputErrors(problems)
    said = (*open_remarks(keys), *_joined(spaces), *_one_name(read))
    policies = [_with(policy_of(access, of_it), said) for access, of_it in keys.items()]
    sources = tuple(sorted({source for policy in policies for source in policy.sources}))
    if View(view) is View.enforced and (left := open_sessions(keys, sources)).grants:
        policies.append(left)
    return tuple(policies)


def _with(policy: Policy, said: Iterable[Diagnostic]) -> Policy:
    """A policy with what is said of its file too: a saved graph keeps it there."""
    own = (one for one in said if one.place.file == policy.file)
    return replace(policy, diagnostics=(*policy.diagnostics, *own))


def _written_for(read: Iterable[AccessFile]) -> dict[str, Place]:
    """The namespaces that keys of sessions without one are written for, each with a line."""
    said = (one for access in read if not access.namespace for rule in access.rules for one in rule.key_expressions)
    return {namespace: place for key, place in said for namespace in namespaces_of([key])}


def _joined(spaces: Mapping[str, Place]) -> Iterator[Diagnostic]:
    """A warning where keys stand behind several namespaces, of which only the names are read."""
    if len(spaces) > 1:
        last = max(spaces)
        named = ", ".join(repr(shown(one)) for one in sorted(spaces))
        message = f"keys behind namespaces {named}: Zenoh keeps them apart, here a name is one channel in all of them"
        yield Diagnostic(spaces[last], Severity.WARNING, message)


def _one_name(read: Iterable[AccessFile]) -> Iterator[Diagnostic]:
    """A gap where two files make one process: what goes from one of them to the other is no flow then (rule S11)."""
    first: dict[str, AccessFile] = {}
    for access in read:
        if (other := first.setdefault(process_of(access), access)) is not access:
            message = f"the process is called as that of {shown(other.file)}: both are one element here, and what goes "
            message += "from one to the other is not seen; give the files different names"
            yield Diagnostic(access.place, Severity.WARNING, message, ACCESS_GAP)
