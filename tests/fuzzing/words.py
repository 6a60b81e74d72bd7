"""Names and values that the grammars choose from, and what is wrong on purpose."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tests.fuzzing.choices import Choices

NODES = ("/n0", "/n1", "/n2", "/robot/arm", "/robot/eye")
TOPICS = ("/a", "/b", "/c/image", "/parameter_events", "/rosout", "/a/*")
SERVICES = ("/s", "/n0/get_parameters")
ACTIONS = ("/spin",)
CHANNELS = (*TOPICS, *SERVICES, *ACTIONS)
GLOBS = ("/*", "/n*", "/robot/*", "/[a-c]*", "/?", "*", "*a*", "/[!x]*")
KINDS = (
    "Video", "Voice", "Location", "FaceTemplate", "Health", "Biometric", "PersonalData", "HomeMap", "Household",
    "video", "face embedding",
)  # fmt: skip
DURATIONS = ("P30D", "P1Y", "P1M", "PT12H", "P1Y6M", "P2W", "P999Y", "PT0S", "P0.5D", "P1Y2M3DT4H5M6S")
COUNTRIES = ("DE", "US", "CA", "FR", "CH", "IE", "CN")
ODD_TEXT = (
    "", " ", "=", "=/*", "~", "/", "*", "[", "[!]]", "é", "\u202e", "\x85", "\u2028", "\ufeff", "\U0001f600", "a" * 300,
    "</script>", "=cmd|' /C calc'!A0", "::error::x", "P", "P-1D", "../secret.xml", "on", "1e999", "0x10", "\ud800",
    "rosprivacy:standard", "all", "none", "[" * 40, "*a" * 12, "${jndi:x}", "\x1b[31m", "\x00", "\r", "file:///x",
)  # fmt: skip
ODD: tuple[Any, ...] = (
    None, True, False, 0, -1, 1, 2**63, 10**400, 1e308, 0.5, [], {}, [[]], [None], {"": None}, ["Video", "Video"],
    {"Video": "drop"}, {"from": "/n0"}, *ODD_TEXT,
)  # fmt: skip


def with_fault(choices: Choices, value: Any, odd: tuple[Any, ...] = ODD) -> Any:
    """The value, of which one place is odd, or missing, or there once more under another key."""
    if not isinstance(value, dict | list) or not value or choices.once_in(6):
        return choices.pick(odd)
    if isinstance(value, list):
        at = choices.below(min(len(value), 256))
        return [*value[:at], with_fault(choices, value[at], odd), *value[at + 1 :]]
    key = choices.pick(list(value))
    how = choices.below(12)
    if how == 0:
        return {name: item for name, item in value.items() if name != key}
    if how == 1:
        return {**value, choices.pick(ODD_TEXT): value[key]}
    return {**value, key: with_fault(choices, value[key], odd)}
