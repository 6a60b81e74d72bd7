"""What a document says of a fleet."""

from __future__ import annotations

from typing import TYPE_CHECKING, NotRequired, TypedDict

if TYPE_CHECKING:
    from rosprivacy.report.contract.records import ElementEntry


class AlikeEntry(TypedDict):
    """Robots that differ in nothing but their names."""

    robot: str
    model: str
    robots: list[str]


class FormEntry(TypedDict):
    """Robots of a pattern, and how their finding stands."""

    robots: list[str]
    dismissed: bool
    accepted: bool
    pseudonymised: bool


class PatternEntry(TypedDict):
    """Findings that differ only in the robot."""

    id: str
    finding: str
    across: bool
    findings: int
    dismissed: int
    pseudonymised: int
    accepted: int
    robots: list[str]
    forms: NotRequired[list[FormEntry]]


class ShareEntry(TypedDict):
    """What a robot has of a pattern."""

    pattern: str
    ends: bool
    dismissed: bool
    pseudonymised: bool
    accepted: bool


class DeviantEntry(TypedDict):
    """Robots whose result is not that of most robots of their model."""

    robots: list[str]
    model: str
    more: list[ShareEntry]
    fewer: list[ShareEntry]
    more_open: list[ElementEntry]
    fewer_open: list[ElementEntry]


class FleetEntry(TypedDict):
    """What is said of a fleet."""

    robots: int
    models: dict[str, int]
    alike: list[AlikeEntry]
    patterns: list[PatternEntry]
    deviants: list[DeviantEntry]
