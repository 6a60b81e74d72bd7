"""What shows only when permissions and governance files are seen together (rule S11).

In: what was read, and the domain of the robot if it is known. Out: warnings. What governance leaves open is not known
where none is named for a domain, so there the verdict is undetermined at best.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import ACCESS_GAP, Diagnostic, Place, Severity
from rosprivacy.ingest.keystore.domains import common, written
from rosprivacy.ingest.keystore.governing import differing, domains_of, governed, ungoverned

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rosprivacy.ingest.keystore.governance_file import Governance
    from rosprivacy.ingest.keystore.permissions_file import Permissions

NOT_KNOWN = "so whether permissions are asked there is not known, nor what is encrypted; name its governance"


def joint_remarks(
    governances: Sequence[Governance], permissions: Sequence[Permissions], domain: int | None
) -> Iterator[Diagnostic]:
    """Yield what is to be said of files that stand in no keystore."""
    about = [domains_of(one, domain) for one in permissions]
    for one, spans in zip(permissions, about, strict=True):
        if left := ungoverned(governances, spans):
            which = "no governance that is named is surely about it" if governances else "no governance is named"
            yield _warning(one.grants[0].place, f"domain {written(left)}: {which}, {NOT_KNOWN}", ACCESS_GAP)
    everywhere = tuple(span for spans in about for span in spans)
    for first, other, shared in differing(governances, everywhere):
        message = (
            f"domain {written(shared)}: {other.rule.place} says something else, and which of them holds is not known"
        )
        yield _warning(first.rule.place, f"{message}; what either leaves open counts; name the one that is deployed")
    for governance in governances:
        if not any(governed(governance, everywhere)):
            message = "governance of domains that no permissions named here are about: it is not used"
            yield _warning(Place(governance.file, 0), f"{message}; name their permissions, or leave it out")


def apart_remarks(permissions: Sequence[Permissions], domain: int | None) -> Iterator[Diagnostic]:
    """Yield a warning for permissions of domains of their own: nothing goes from one domain to another."""
    if domain is not None:
        return
    for one, other in pairwise(file for file in permissions if any(grant.rules for grant in file.grants)):
        first, second = (domains_of(file, None) for file in (one, other))
        if not common(first, second):
            message = f"permissions for domain {written(second)}, and in {one.file} for domain {written(first)}"
            hint = "they are read as if they were in one domain; say which with --domain N"
            yield _warning(other.grants[0].place, f"{message}: {hint}")


def _warning(place: Place, message: str, code: str = "") -> Diagnostic:
    return Diagnostic(place, Severity.WARNING, shown(message), code)
