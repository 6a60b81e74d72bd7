"""In which order a person decides about findings, in every report (users.md, B2).

In: findings of a JSON document. Out: the same, what stands first: neither dismissed nor accepted, data as it is before
pseudonymised data, what can fall under Article 9 before other data.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import ARTICLE_9_VERDICTS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping


def in_order(findings: Iterable[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Return findings in the order in which a person decides; else as they are."""
    urgent = ARTICLE_9_VERDICTS
    return sorted(
        findings,
        key=lambda f: (f["dismissed"], bool(f.get("accepted")), f["pseudonymised"], urgent.index(f["article9"])),
    )
