"""What the governance leaves to everybody: grants of the enforced view (rule S6).

In: a rule of a governance, and the enclaves. Out: a ``Policy`` in which each of them may write and read the DDS topics
for which permissions are not asked. A rule that comes first and does ask takes its topics out, as a DENY would.

Source: DDS-Security 1.1, 9.4.1.2.4.7: the first topic rule that matches decides.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Grant, Policy
from rosprivacy.ingest.keystore.protections import protection
from rosprivacy.ingest.policies.names import DDS

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rosprivacy.analysis.model import Profile
    from rosprivacy.ingest.keystore.governance_file import DomainRule, TopicRule


def open_topics(
    file: str, rule: DomainRule, profiles: Sequence[Profile], sources: tuple[tuple[str, str], ...]
) -> Policy:
    """Return what a rule of a governance file leaves open to some enclaves; nothing where it asks of all topics.

    Parameters
    ----------
    sources
        (file, SHA-256) of the governance, and of the permissions that state the enclaves.
    """
    name = f"{file}:{rule.place.line}"  # of each rule its own: what one takes out, another may leave open
    grants = [
        Grant(not asked, direction, DDS, topic.expression, profile.enclave, profile.node, topic.place, name,
              absolute=True, rank=rank)
        for direction in ("publish", "subscribe")
        for rank, topic, asked in _in_order(rule.in_force(), direction)
        for profile in profiles
    ]  # fmt: skip
    return Policy(name, sources, tuple(profiles) if grants else (), tuple(grants), protections=(protection(rule),))


def _in_order(topics: Sequence[TopicRule], direction: str) -> Iterator[tuple[int, TopicRule, bool]]:
    """The rules up to the last that asks nobody, with their places from 1, and whether permissions are asked."""
    asked = [topic.writing if direction == "publish" else topic.reading for topic in topics]
    last = max((at for at, is_asked in enumerate(asked, 1) if not is_asked), default=0)
    yield from zip(range(1, last + 1), topics, asked, strict=False)
