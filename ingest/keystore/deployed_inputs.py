"""Permissions files and keystores -> policies: what is deployed, in the facts that a policy gives.

In: their paths. Out: ``Policy`` facts, with what a reader has to know of governance, signatures and dates.
"""

from __future__ import annotations

import hashlib
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, PolicyError
from rosprivacy.analysis.model import Diagnostic, Place, Severity
from rosprivacy.analysis.modes import View
from rosprivacy.ingest.keystore.governance_remarks import governance_remarks, rules_of
from rosprivacy.ingest.keystore.grants import expired, policy_of
from rosprivacy.ingest.keystore.keystore_folder import read_keystore
from rosprivacy.ingest.keystore.open_topics import open_topics
from rosprivacy.ingest.keystore.permissions_file import read_permissions
from rosprivacy.ingest.keystore.protections import protection
from rosprivacy.ingest.keystore.signed_file import read_signed
from rosprivacy.ingest.keystore.told_apart import is_keystore

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import Policy

Read = tuple[tuple["Policy", ...], tuple["Diagnostic", ...]]


def read_deployed(
    arguments: Iterable[str],
    domain: int | None,
    today: str,
    *,
    allow_unsigned: bool = False,
    view: str = View.declared,
) -> Read:
    """Read permissions files and keystores.

    Parameters
    ----------
    domain
        That of the robot; None where it does not matter, since all rules are about the same ones.
    today
        ISO date on which grants and certificates are valid or not.
    allow_unsigned
        Whether what is not signed, or badly, is read too. A file that is named by itself has no keystore that says who
        may sign it, so it is read in this way only.
    view
        The enforced view has also what the governance leaves to everybody (rule S6).

    Raises
    ------
    InputErrors
        With every problem, one line each.
    """
    policies: list[Policy] = []
    said: list[Diagnostic] = []
    problems: list[InputError] = []
    for argument in arguments:
        try:
            read, more = _read(argument, domain, today, allow_unsigned=allow_unsigned, view=view)
        except PolicyError as error:
            problems.append(error)
        except InputErrors as error:
            problems += error.errors
        else:
            policies += read
            said += more
    if problems:
        raise InputErrors(problems)
    return tuple(policies), tuple(dict.fromkeys(said))


def _read(
    argument: str, domain: int | None, today: str, *, allow_unsigned: bool, view: str
) -> tuple[list[Policy], list[Diagnostic]]:
    if is_keystore(argument):
        enclaves, told = read_keystore(argument, today, allow_unsigned=allow_unsigned)
        said = list(told)
        policies = []
        for enclave in enclaves:
            granted = policy_of(enclave.permissions, domain, enclave.sources)
            rules = rules_of(enclave.governance, enclave.permissions, domain)
            remarks = tuple(governance_remarks(enclave.governance, enclave.permissions, domain))
            granted = replace(
                granted,
                diagnostics=(*granted.diagnostics, *remarks),
                protections=tuple(map(protection, rules)),
            )
            policies.append(granted)
            if View(view) is View.enforced:
                policies += (open_topics(enclave.governance.file, rule, granted.profiles) for rule in rules)
        said += expired((enclave.permissions for enclave in enclaves), today)
        return policies, said
    signed = read_signed(argument, None)
    if not allow_unsigned:
        what = "permissions by themselves: nothing says who may sign them"
        raise PolicyError(argument, 0, what, "name the keystore, or read them all the same with --allow-unsigned")
    permissions = read_permissions(signed.data, argument, signed.before)
    sources = ((argument, hashlib.sha256(signed.data).hexdigest()),)
    what = "no governance is read with it, so whether what is sent is encrypted is not known; name the keystore"
    said = [Diagnostic(Place(argument, 0), Severity.WARNING, what), *expired([permissions], today)]
    return [policy_of(permissions, domain, sources)], said
