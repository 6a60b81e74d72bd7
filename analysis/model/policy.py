"""What a policy file grants (rules S3, S5)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rosprivacy.analysis.model.diagnostic import Diagnostic, Place
    from rosprivacy.analysis.model.protection import Protection


class Profile(NamedTuple):
    """A node's entry in an enclave, ``<profile ns node>``.

    Attributes
    ----------
    participant
        Name of the element outside ROS that it is of: whose endpoints were seen and are of no node (rules S9, S16).
    """

    enclave: str
    node: str
    place: Place
    participant: str = ""


class Seen(NamedTuple):
    """When a grant was seen in use, and by which doors to the running system (rule S16).

    Attributes
    ----------
    first, last
        Such as ``2026-11-22T10:00:00Z``.
    """

    by: tuple[str, ...]
    first: str
    last: str


class Grant(NamedTuple):
    """What one policy line allows or denies to one profile.

    Attributes
    ----------
    allow
        False for DENY.
    role
        As written: ``publish``, ``subscribe``, ``reply``, ``request``, ``call`` or ``execute``.
    kind
        Of the channel as written: ``topic``, ``service`` or ``action``; ``dds`` of a DDS topic, as permissions name it.
    name
        Fully qualified; of a DDS topic with its prefix, such as ``rt/scan``.
    policy
        The policy file that was read, whatever it includes: a DENY counts in its own policy only (rule S5).
    dead
        Whether the line stands after the first ``<profiles>`` of the first ``<enclave>`` of its path: sros2 does not
        read it there. An ALLOW is taken all the same, a DENY takes nothing away (rule S5).
    absolute
        Whether the policy writes the name so: then it stays as it is under a namespace that is pushed (rule S1).
    observation
        When it was seen in use, of an observed policy (rule S16).
    rank
        Of permissions, the place of its rule, from 1: the first rule that matches decides, so a DENY takes away only
        from what comes after it. 0 in a policy, where DENY wins wherever it stands (rule S5).
    basis
        How source code fixes the name, of a scanned policy: ``literal``, ``default``, ``launch`` and others; the place
        is then the line of the code (rule S16).
    """

    allow: bool
    role: str
    kind: str
    name: str
    enclave: str
    node: str
    place: Place
    policy: str = ""
    dead: bool = False
    absolute: bool = False
    observation: Seen | None = None
    rank: int = 0
    basis: str = ""

    def __hash__(self) -> int:
        """Of what tells nearly all apart: a file that many profiles include has the same lines in each."""
        return hash((self.node, self.name, self.role, self.place.line))


SourceRoot = tuple[tuple[str, ...], str]  # folders of sources, and the launch file that was named, if any


@dataclass(frozen=True, slots=True)
class Policy:
    """What one policy file grants, with everything that it includes.

    Attributes
    ----------
    sources
        (file, SHA-256) of the policy and of all that it includes, sorted.
    saved
        Whether it was read from a saved graph: then its files are names that anybody may have written.
    protections
        Of permissions with a governance beside them: what holds in each domain that they are about.
    checkout
        The sources that it was made of; None for others.
    """

    file: str
    sources: tuple[tuple[str, str], ...]
    profiles: tuple[Profile, ...]
    grants: tuple[Grant, ...]
    diagnostics: tuple[Diagnostic, ...] = ()
    saved: bool = field(default=False, compare=False)
    protections: tuple[Protection, ...] = ()
    checkout: SourceRoot | None = None
