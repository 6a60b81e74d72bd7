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
    """What a policy says and what is deployed."""

    format: str
    differences: list[DifferenceEntry]
    losses: list[LossEntry]
    diagnostics: list[dict[str, object]]
    policies: list[dict[str, str]]
    rosprivacy: str
