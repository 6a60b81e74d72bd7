"""A policy and what is deployed -> the document ``rosprivacy.check/1``: what only one of them says.

In: names of files and keystores. Out: the document.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import ACCESS_GAP, UNREAD_FILE
from rosprivacy.analysis.model.reason import NOT_ENCRYPTED, STRANGERS
from rosprivacy.ingest.keystore.deployed_rights import differences
from rosprivacy.ingest.keystore.generator_losses import generator_losses
from rosprivacy.reading.granted import ZENOH, read_granted
from rosprivacy.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model import Diagnostic, Grant, Place, Policy
    from rosprivacy.ingest.keystore.deployed_rights import Difference
    from rosprivacy.ingest.keystore.generator_losses import Loss
    from rosprivacy.report.contract.policies import CheckDocument, DifferenceEntry
    from rosprivacy.settings import Settings

FORMAT = "rosprivacy.check/1"


def check_document(policy: str, deployed: tuple[str, ...], settings: Settings) -> CheckDocument:
    """Compare a policy with what is deployed.

    A file of Zenoh is the view of one process, and its name that of a node: it is compared with what the policy grants
    to the nodes of that name, and what the known generator loses is told as such. All else is compared by enclave.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    stated, said = read_granted([policy], replace(settings, permissions_ca=()))  # what is meant; nobody signs it
    zenoh = [name for name in deployed if name.endswith(ZENOH)]
    others = [name for name in deployed if not name.endswith(ZENOH)]
    found: list[Difference] = []
    losses: tuple[Loss, ...] = ()
    read: list[Policy] = [*stated]
    for names, who in ((others, _enclave), (zenoh, _base_name)):
        if names:
            there, more = read_granted(names, settings)
            new = differences(stated, there, who)
            found += new
            losses = generator_losses(stated, there, new, who) if names is zenoh else losses
            read += there
            said += more
    told = [*(one for one_read in read for one in one_read.diagnostics), *said]
    return {
        "format": FORMAT,
        "differences": [_entry(difference) for difference in sorted(found)],
        "losses": [
            {"loss": one.fault, "message": one.message, "file": one.place.file, "line": one.place.line}
            for one in losses
        ],
        "exposed": [
            {"cause": cause, "dds": dds, "file": place.file, "line": place.line}
            for cause, dds, place in sorted({one for policy in read for one in _exposed(policy)})
        ],
        "undetermined": any(one.code in (ACCESS_GAP, UNREAD_FILE) for one in told),
        "diagnostics": list(_diagnostics(told)),
        "policies": [
            {"file": file, "sha256": digest} for file, digest in sorted({one for some in read for one in some.sources})
        ],
        "rosprivacy": __version__,
    }


def _enclave(grant: Grant) -> str:
    return grant.enclave


def _base_name(grant: Grant) -> str:
    return f"/{grant.node.rpartition('/')[2]}"


def _exposed(policy: Policy) -> Iterable[tuple[str, str, Place]]:
    """What a governance leaves in the open: (cause, expression of DDS topics, line)."""
    for protection in policy.protections:
        if protection.strangers:
            yield STRANGERS, "*", protection.strangers
        yield from ((NOT_ENCRYPTED, one.expression, one.place) for one in protection.topics if not one.encrypted)


def _entry(difference: Difference) -> DifferenceEntry:
    return {
        "enclave": difference.enclave,
        "only_in": "policy" if difference.stated else "deployed",
        "right": "write" if difference.writes else "read",
        "kind": difference.kind,
        "name": difference.name,
        "leg": difference.leg,
        "dds": difference.dds,
        "file": difference.place.file,
        "line": difference.place.line,
    }


def _diagnostics(said: Iterable[Diagnostic]) -> Iterable[dict[str, object]]:
    for one in dict.fromkeys(said):
        yield {"severity": str(one.severity), "message": one.message, "file": one.place.file, "line": one.place.line}
