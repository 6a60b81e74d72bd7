"""What permissions decide of one DDS topic in one domain: the first rule that matches, else the default.

This is the plain form of what the flow graph says of all topics at once.

Source: DDS-Security 1.1, 9.4.1.3.2.3.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.ingest.deployed.permissions import is_about_ros
from rosprivacy.ingest.policies.names import covers

if TYPE_CHECKING:
    from rosprivacy.ingest.deployed.permissions import SubjectGrant


def may(grant: SubjectGrant, domain: int, direction: str, dds: str) -> bool:
    """Return whether a subject may ``publish`` or ``subscribe`` a DDS topic, to some middleware.

    Linear in the topics of the grant.
    """
    for rule in grant.rules:
        about = domain in rule.domains if rule.allow else rule.domains.surely(domain)
        if about and any(
            covers(expression, dds)
            for criterion in rule.criteria
            if criterion.direction == direction and (rule.allow or is_about_ros(criterion))
            for expression, _ in criterion.topics
        ):
            return rule.allow
    return grant.allow
