"""What a well-known package says of its nodes: facts of the catalogue (``ontology/packages``), or of a vendor's file.

A package speaks of its own nodes only, and of no channel: it does not know who else writes to one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rosprivacy.analysis.model import Confidence, Method, Place

USES = {  # what a node does with its interfaces, in the file -> (kind of channel, role of the grant)
    "publishes": ("topic", "publish"),
    "subscribes": ("topic", "subscribe"),
    "replies": ("service", "reply"),
    "requests": ("service", "request"),
    "executes": ("action", "execute"),
    "calls": ("action", "call"),
}
WHERE = ("network", "display", "file", "loudspeaker", "device", "domain")  # to which a node sends what leaves ROS


class Interface(NamedTuple):
    """A channel of a node, as its documentation writes it.

    Attributes
    ----------
    use
        One of ``USES``.
    name
        Relative, private (``~/x``) or absolute; ``*`` stands for one segment, or for a part of one.
    type
        Such as ``sensor_msgs/msg/Image``; empty if the node takes any.
    """

    use: str
    name: str
    type: str = ""


class Claim(NamedTuple):
    """What a package says that a node does with data of one kind.

    Attributes
    ----------
    role
        ``source``, ``leak``, ``derivation``, ``sanitizer`` or ``conduit``.
    kind
        Name of a category; empty of a conduit for all.
    confidence
        ``may`` where it depends on a setting or on what comes in, else ``likely``; never ``certain``.
    method
        Of a sanitizer.
    to
        Of a derivation: the category that comes out.
    where
        Of a leak: one of ``WHERE``.
    """

    role: str
    kind: str
    confidence: Confidence
    why: str
    place: Place
    method: Method | None = None
    to: str = ""
    where: str = ""


class PackageNode(NamedTuple):
    """A node of a package.

    Attributes
    ----------
    names
        Its default names, without namespace, and those of its executables; one may end in ``*``, where the package
        makes the end up.
    interfaces
        By which it is told from a node of the same name.
    """

    names: tuple[str, ...]
    interfaces: tuple[Interface, ...]
    claims: tuple[Claim, ...]


class Source(NamedTuple):
    """What an entry was read from.

    Attributes
    ----------
    at
        Address of a document or a repository.
    version, commit
        Of the package; one of the two is stated.
    read
        The day, as 2026-11-23.
    """

    at: str
    read: str
    version: str = ""
    commit: str = ""
    files: tuple[str, ...] = ()


class Package(NamedTuple):
    """What one file says of one package.

    Attributes
    ----------
    place, sha256
        Of the file.
    """

    name: str
    about: str
    sources: tuple[Source, ...]
    nodes: tuple[PackageNode, ...]
    place: Place
    sha256: str = ""

    @property
    def version(self) -> str:
        """The version of the first source, or the beginning of its commit."""
        return self.sources[0].version or self.sources[0].commit[:7]
