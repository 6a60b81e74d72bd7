"""The document ``rosprivacy.check/1``."""

from __future__ import annotations

from typing import TypedDict


class DifferenceEntry(TypedDict):
    """A right that one side has and the other has not."""

    enclave: str
    only_in: str
    right: str
    kind: str
    name: str
    leg: str
    dds: str
    file: str
    line: int


class LossEntry(TypedDict):
    """A line that does not hold, as the known generator of Zenoh lists loses it."""

    loss: str
    message: str
    file: str
    line: int


class ExposedEntry(TypedDict):
    """A rule of a governance by which others than the robot's own nodes can read.

    Attributes
    ----------
    cause
        ``not-encrypted`` or ``strangers``: a participant without a certificate may join.
    dds
        Expression of DDS topics; ``*`` where it is about all.
    """

    cause: str
    dds: str
    file: str
    line: int


class CheckDocument(TypedDict):
    """What a policy says and what is deployed.

    Attributes
    ----------
    undetermined
        Whether more may be allowed than is compared: somewhere permissions are not asked, or any session is let in.
    exposed
        What the deployed governance leaves in the open. It is no difference, since a policy says nothing of it.
    """

    format: str
    exposed: list[ExposedEntry]
    differences: list[DifferenceEntry]
    losses: list[LossEntry]
    undetermined: bool
    diagnostics: list[dict[str, object]]
    policies: list[dict[str, str]]
    rosprivacy: str
