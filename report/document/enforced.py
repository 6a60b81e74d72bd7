"""What the enforced view adds to the declared one, in the JSON document (rule S6).

In: the document of the enforced view, and what is known of the findings that only it has. Out: an ``EnforcedEntry``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.report.contract.analysis import AnalysisDocument, EnforcedEntry


def enforced_document(
    enforced: AnalysisDocument, added: Mapping[str, tuple[tuple[str, ...], tuple[str, ...]]]
) -> EnforcedEntry:
    """Return what the enforced view adds.

    Parameters
    ----------
    added
        By id of a finding: the enclaves that make it possible, and those of which splitting ends it.
    """
    return {
        "verdict": enforced["verdict"],
        "added": [
            {"finding": entry, "enclaves": list(added[entry["id"]][0]), "split": list(added[entry["id"]][1])}
            for entry in enforced["findings"]
            if entry["id"] in added
        ],
    }
