"""The rows of the register as the JSON document has them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.report.document.records import element_dict

if TYPE_CHECKING:
    from rosprivacy.analysis.model.register_row import RegisterRow
    from rosprivacy.report.schemas.register import RegisterEntry


def register_entry(row: RegisterRow) -> RegisterEntry:
    """Return a row of ``register``."""
    entry: RegisterEntry = {
        "id": row.id,
        "category": row.category,
        "places": [element_dict(element) for element in row.places],
        "pseudonymised": row.pseudonymised,
        "article9": row.article9,
        "sources": [element_dict(element) for element in row.sources],
        "derivations": [
            {"element": element_dict(one.element), "from": one.made_of, "to": one.target} for one in row.derivations
        ],
        "measures": [
            {
                "element": element_dict(one.element),
                "category": one.category,
                "method": one.method,
                "stated": one.stated,
                "everywhere": one.everywhere,
            }
            for one in row.measures
        ],
        "subjects": list(row.subjects),
        "contexts": list(row.contexts),
        "countries": list(row.countries),
        "purposes": list(row.purposes),
        "controllers": list(row.controllers),
        "officers": list(row.officers),
        "bases": list(row.bases),
        "special_bases": list(row.special_bases),
        "criminal_bases": list(row.criminal_bases),
        "safeguards": list(row.safeguards),
        "operator": row.operator,
        "recipient": row.recipient,
        "contract": row.contract,
        "country": row.country,
        "area": row.area,
        "transfer": row.transfer,
        "retention": [str(duration) for duration in row.retention],
        "backups": row.backups if isinstance(row.backups, bool | None) else str(row.backups),
        "encrypted": row.encrypted,
        "look_at": list(row.look_at),
        "findings": list(row.findings),
        "state": str(row.state),
        "to_complete": [str(cell) for cell in row.to_complete],
    }
    if row.fleet:
        pattern, robots, from_robots = row.fleet
        entry["fleet"] = {"pattern": pattern, "robots": list(robots), "from_robots": list(from_robots)}
    return entry
