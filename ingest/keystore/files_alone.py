"""Permissions and governance files that stand in no keystore, in any order, told apart by what is in them.

In: their paths. Out: permissions and governance, each with its SHA-256. Nothing says who may sign them, so they are
read only where that is allowed.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, PolicyError
from rosprivacy.ingest.keystore.governance_file import read_governance
from rosprivacy.ingest.keystore.permissions_file import read_permissions
from rosprivacy.ingest.keystore.security_xml import section_of
from rosprivacy.ingest.keystore.signed_file import read_signed

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.ingest.keystore.governance_file import Governance
    from rosprivacy.ingest.keystore.permissions_file import Permissions

GOVERNANCE = "domain_access_rules"
PERMISSIONS_ALONE = "permissions by themselves: nothing says who may sign them"
Hashed = tuple[str, str]
"""A file and its SHA-256."""


@dataclass(frozen=True, slots=True)
class FilesAlone:
    """What was read, by the names of the files."""

    permissions: list[tuple[Permissions, Hashed]] = field(default_factory=list)
    governances: list[tuple[Governance, Hashed]] = field(default_factory=list)


def read_alone(names: Iterable[str], *, allow_unsigned: bool) -> FilesAlone:
    """Read files of permissions and governance.

    Raises
    ------
    InputErrors
        With every problem, one line each; governance without permissions is one.
    """
    read = FilesAlone()
    problems: list[InputError] = []
    for name in sorted(names):
        try:
            _read(name, read, allow_unsigned=allow_unsigned)
        except PolicyError as error:
            problems.append(error)
        except InputErrors as error:
            problems += error.errors
    if not read.permissions and not problems:
        what = "governance without permissions: it does not say who may do what"
        hint = "name the permissions too; a keystore has a governance of its own"
        problems += (PolicyError(file, 0, what, hint) for _, (file, _) in read.governances)
    if problems:
        raise InputErrors(problems)
    return read


def _read(name: str, read: FilesAlone, *, allow_unsigned: bool) -> None:
    signed = read_signed(name, None)
    governs = section_of(signed.data, name) == GOVERNANCE
    if not allow_unsigned:
        what = "governance by itself: nothing says who may sign it" if governs else PERMISSIONS_ALONE
        raise PolicyError(name, 0, what, "name the keystore, or read them all the same with --allow-unsigned")
    hashed = name, signed.sha256
    if governs:
        read.governances.append((read_governance(signed.data, name, signed.before), hashed))
    else:
        read.permissions.append((read_permissions(signed.data, name, signed.before), hashed))
