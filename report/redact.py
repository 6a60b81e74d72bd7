"""Copies of documents that can be shown to others: names of elements, files, enclaves, robots and persons replaced.

In: one document or several. Out: copies; a name is replaced by the same one in all of them. Only what is known to name
nobody is kept: kinds of data and what the law says of them, lines, methods, countries, hashes, ids. Free text, and
whatever is not known here, is left out. Ids are those of the full report, so who guesses a name can make sure of it.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

LEFT_OUT = "[…]"
OURS = "rosprivacy:"  # files that come with the program
PATHS = ("node", "topic", "service", "action")
AS_IT_IS = ("categories", "contexts", "look_at")  # of the ontology: kinds of data and the law
SAFE_KEYS = {
    "bases", "because", "area", "article9", "backups", "beside", "by", "carries", "cause", "categories",
    "categories_asked", "category", "condition", "context", "contexts", "countries", "countries_as_of", "country",
    "criminal_bases", "data_types_asked", "decision", "doubt", "expires",
    "finding", "findings", "format", "from", "holds", "id", "identity_factors_asked", "kind", "law_as_of", "leaves",
    "leaves_pseudonymised", "legal_bases", "legal_basis", "look_at", "method", "missing", "paths", "pattern",
    "provision", "pseudonymised", "rank", "recipient", "retention", "role", "roles", "rosprivacy", "safeguards",
    "severity", "sha256", "special_bases", "special_basis", "state", "taken_as", "taken_by_kind", "to", "to_complete",
    "transfer", "unlabelled_channel", "unknown", "unlabelled_node", "verdict", "verdict_then", "view", "what",
    "without_limit",
}  # fmt: skip
MAPS = ("because", "legal_bases", "purposes", "retention", "taken_away_by", "taken_by_kind")  # keys are no names
FILES = ("file", "joining_file")  # also among the values of a reason
NAME_KEYS = {
    "robot": "robot", "robots": "robot", "from_robots": "robot", "model": "model", "file": "file",
    "joining_file": "file", "enclave": "enclave",
    "enclaves": "enclave", "split": "enclave",
    "operator": "operator", "controller": "controller", "controllers": "controller", "dpo": "officer",
    "officers": "officer", "profile": "node", "nodes": "node",
}  # fmt: skip


def redacted(documents: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return copies of documents without names. Complexity: O(their size)."""
    names = replacements(documents)
    return [_document(document, names.replaced) for document in documents]


def replacements(documents: Sequence[Mapping[str, Any]]) -> Replacements:
    """Return what stands for each name of documents."""
    names = Replacements()
    for document in documents:
        _document(document, names.see)
    names.settle()
    return names


class Replacements:
    """What stands for names, numbered in their order; those that are seen later, after those that are settled."""

    def __init__(self) -> None:
        self._replaced: dict[str, set[str]] = defaultdict(set)
        self._numbers: dict[tuple[str, str], int] = {}

    def see(self, kind: str, name: str) -> str:
        """Take note of a name."""
        self._replaced[kind].add(name)
        return name

    def settle(self) -> None:
        """Number what was seen."""
        for kind, names in self._replaced.items():
            before = {name for name in names if (kind, name) in self._numbers}
            fresh = enumerate(sorted(names - before), len(before) + 1)
            self._numbers |= {(kind, name): number for number, name in fresh}

    def replaced(self, kind: str, name: str) -> str:
        """Return what stands for a name."""
        return f"{'/' if kind in PATHS else ''}{kind}-{self._numbers[kind, name]}"


def _document(document: Mapping[str, Any], change: Callable[[str, str], str]) -> dict[str, Any]:
    """A copy in which every name went through ``change``."""
    return {key: value if key in AS_IT_IS else _value(key, value, change) for key, value in document.items()}


def _value(key: str, value: Any, change: Callable[[str, str], str]) -> Any:
    if isinstance(value, list):
        return [_value(key, item, change) for item in value]
    if isinstance(value, dict):
        if {"robot", "kind", "name"} <= set(value):
            return _element(value, change)
        if key == "models":  # of a fleet: name -> number of robots
            return {change("model", model) if model else "": number for model, number in value.items()}
        of_map = key in MAPS
        return {
            inner: _value(key if of_map and inner not in FILES else inner, item, change)
            for inner, item in value.items()
        }
    return _text(key, value, change) if isinstance(value, str) and value else value


def _element(element: Mapping[str, Any], change: Callable[[str, str], str]) -> dict[str, Any]:
    robot = change("robot", element["robot"]) if element["robot"] else ""
    return {**element, "robot": robot, "name": change(element["kind"], element["name"])}


def _text(key: str, value: str, change: Callable[[str, str], str]) -> str:
    if key in SAFE_KEYS or (key == "file" and value.startswith(OURS)):
        return value
    if key == "subjects":
        return change("persons", value)
    return change(NAME_KEYS[key], value) if key in NAME_KEYS else LEFT_OUT
