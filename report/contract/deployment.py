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


class CheckDocument(TypedDict):
    """What a policy says and what is deployed.

    Attributes
    ----------
    undetermined
        Whether more may be allowed than is compared: somewhere permissions are not asked, or any session is let in.
    """

    format: str
    differences: list[DifferenceEntry]
    losses: list[LossEntry]
    undetermined: bool
    diagnostics: list[dict[str, object]]
    policies: list[dict[str, str]]
    rosprivacy: str
