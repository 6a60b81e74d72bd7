"""The document of a check -> lines for the terminal: by enclave, what only one of both sides says."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.report.schemas.policies import CheckDocument, DifferenceEntry

SAME, NOT_KNOWN = (
    "what is deployed is what the policy says",
    "undetermined: no right differs, but more may be allowed than is compared here; the warnings say where",
)
SIDE_TEXTS = {
    "deployment": {"policy": "only the policy says", "deployed": "only what is deployed says"},
    "description": {"policy": "only the description says", "deployed": "only the code does"},
}
TOTALS = {
    "deployment": "{} of the policy not deployed, {} deployed and not in the policy",
    "description": "{} described and not in the code, {} of the code not described",
}


def deployment_lines(document: CheckDocument) -> Iterator[str]:
    """Yield the lines of an answer."""
    found, compared = document["differences"], document.get("compared", "deployment")
    if not found:
        yield NOT_KNOWN if document["undetermined"] else SAME
    if exposed := document["exposed"]:
        rules = (
            "1 rule of the governance lets" if len(exposed) == 1 else f"{len(exposed):,} rules of the governance let"
        )
        yield f"exposed: {rules} who is on the network read what is sent; the warnings say where"
    for enclave, of_enclave in groupby(found, key=lambda entry: entry["enclave"]):
        yield f"enclave {shown(enclave)}"
        for side, entries in groupby(of_enclave, key=lambda entry: entry["only_in"]):
            yield f"   {SIDE_TEXTS[compared][side]}"
            yield from (f"      {_line(entry)}" for entry in entries)
    yield from (one["message"] for one in document["losses"])
    for said in document["diagnostics"]:
        place = f"{shown(str(said['file']))}:{said['line']}" if said["line"] else shown(str(said["file"]))
        yield f"{said['severity']}: {place}: {said['message']}"
    if found:
        sides = [entry["only_in"] for entry in found]
        yield ""
        missing, more = counted(sides.count("policy"), "right"), counted(sides.count("deployed"), "right")
        yield TOTALS[compared].format(missing, more)


def _line(entry: DifferenceEntry) -> str:
    leg = f" ({entry['leg']})" if entry["leg"] else ""
    return f"{entry['right']} {entry['kind']} {shown(entry['name'])}{leg}   {shown(entry['file'])}:{entry['line']}"
