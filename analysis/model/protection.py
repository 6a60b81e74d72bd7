"""What a governance says of protection on the wire, and where it says so (DDS-Security 1.1, 9.4.1.2; rule S10)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rosprivacy.analysis.model.diagnostic import Place


class TopicProtection(NamedTuple):
    """Whether what is sent on the DDS topics of an expression is encrypted, and the line that says so."""

    expression: str
    encrypted: bool
    place: Place


class Protection(NamedTuple):
    """What holds in a domain.

    Attributes
    ----------
    topics
        In their order: the first that matches decides.
    strangers
        The line by which a participant without a certificate may join; None where none may.
    """

    topics: tuple[TopicProtection, ...] = ()
    strangers: Place | None = None


class Exposure(NamedTuple):
    """Why who is on the network can read what flows on a channel.

    Attributes
    ----------
    cause
        ``NOT_ENCRYPTED`` or ``STRANGERS``, of ``REASONS``.
    place
        The line of the governance.
    """

    cause: str
    place: Place
