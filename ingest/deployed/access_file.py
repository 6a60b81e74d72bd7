"""Zenoh's access control -> its rules, subjects and policies, as they are written.

In: the path of a configuration (JSON5) of a session or router. Out: ``AccessFile``, or every problem at its line. What
Zenoh refuses is refused here too: a session with it does not start. Nothing is decided here. JSON5 is checked and its
strings are read by the package ``json5``, which knows no lines; these are found here.

Source: ``access_control`` in Zenoh's ``DEFAULT_CONFIG.json5``; ``policy_decision_point`` for the identities;
``eclipse-zenoh`` 1.10.2 is the judge of the tests.
"""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputErrors, PolicyError, shown
from rosprivacy.analysis.model import Place
from rosprivacy.ingest.deployed.zenoh_keys import problem_of
from rosprivacy.ingest.reading.bounded_file import read_utf8
from rosprivacy.ingest.reading.format_reader import FileReader
from rosprivacy.ingest.reading.yaml_values import Builder, feed_json

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.errors import InputError
    from rosprivacy.ingest.reading.yaml_values import Value

MAX_BYTES = 2**18
"""Of a file; ``json5`` takes some ten seconds for a megabyte."""
MISSING = "install the extra [zenoh] from where rosprivacy came from"
_TOKEN = re.compile(
    r"""//[^\n\r\u2028\u2029]* | /\*.*?(?:\*/|$) | [{}\[\]]
    | "(?:[^"\\]|\\(?:.|$))*(?:"|$) | '(?:[^'\\]|\\(?:.|$))*(?:'|$) | [^\s\ufeff{}\[\]"',:/]+""",
    re.DOTALL | re.VERBOSE,
)
_PLACE = re.compile(r"<string>:(\d+) (.*)", re.DOTALL)
_TOO_DEEP = ("nested more deeply than can be read", "write it flatter")


def read_json5(file: str, fail: Callable[[int, str, str], InputError], bounds: Bounds = BOUNDS) -> tuple[Value, bytes]:
    """Read a file; see ``yaml_values.read``."""
    text, data = read_utf8(file, MAX_BYTES, fail)
    return parse_json5(text, fail, bounds), data


def parse_json5(text: str, fail: Callable[[int, str, str], InputError], bounds: Bounds = BOUNDS) -> Value:
    """Read JSON5 text; see ``yaml_values.read``."""
    try:
        import json5  # noqa: PLC0415 - an extra
    except ImportError as error:
        raise fail(0, f"the package json5 is not there ({error})", MISSING) from error
    try:
        json5.loads(text)
    except RecursionError:
        raise fail(1, *_TOO_DEEP) from None
    except ValueError as error:
        place = _PLACE.fullmatch(str(error))
        line, what = (int(place[1]), place[2]) if place else (1, str(error))
        raise fail(line, f"not JSON5: {shown(what)}", "correct the syntax") from None
    builder = Builder(fail, bounds)
    feed_json(text, builder, _TOKEN, json5.loads)
    assert builder.top is not None, "json5 takes no text without a value"
    return builder.top


SECTION = "access_control"
FLOWS = ("egress", "ingress")
MESSAGES = (
    "put", "delete", "declare_subscriber", "query", "declare_queryable", "reply", "liveliness_token",
    "declare_liveliness_subscriber", "liveliness_query",
)  # fmt: skip
PROPERTIES = ("interfaces", "cert_common_names", "usernames", "link_protocols", "zids")
PERMISSIONS = {"allow": True, "deny": False}
_ZID = re.compile("[1-9a-f][0-9a-f]{0,31}")
_LISTS = ("rules", "subjects", "policies")
Identity = tuple[str | None, ...]
"""One value for each of ``PROPERTIES``; None is anybody."""


@dataclass(frozen=True, slots=True)
class AccessRule:
    """What one rule says of messages, whoever sends or gets them.

    Attributes
    ----------
    key_expressions
        (expression, where it stands).
    """

    id: str
    allow: bool
    messages: tuple[str, ...]
    flows: tuple[str, ...]
    key_expressions: tuple[tuple[str, Place], ...]
    place: Place


@dataclass(frozen=True, slots=True)
class AccessSubject:
    """The other end of a link, as far as it is told apart.

    Attributes
    ----------
    properties
        (one of ``PROPERTIES``, what it may be); without any it is everybody.
    """

    id: str
    properties: tuple[tuple[str, tuple[str, ...]], ...]
    place: Place


@dataclass(frozen=True, slots=True)
class AccessPolicy:
    """Which rules hold for which subjects, by their ids.

    Attributes
    ----------
    id
        Need not be stated.
    """

    id: str
    rules: tuple[str, ...]
    subjects: tuple[str, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class AccessFile:
    """Access control of one session or router.

    Attributes
    ----------
    enabled
        Nothing is held back without it.
    allow
        Whether what no rule names is allowed.
    namespace
        What all keys of the session begin with, on its links and in its rules too; empty for none.
    """

    file: str
    enabled: bool
    allow: bool
    rules: tuple[AccessRule, ...]
    subjects: tuple[AccessSubject, ...]
    policies: tuple[AccessPolicy, ...]
    place: Place
    namespace: str = ""

    @property
    def decides(self) -> bool:
        """Whether rules are looked at: with a list missing or empty, Zenoh looks at none of them."""
        return self.enabled and all((self.rules, self.subjects, self.policies))


def read_access(file: str) -> AccessFile:
    """Read the access control of a configuration; ``InputErrors`` has every problem."""
    try:
        top, _ = read_json5(file, lambda line, problem, hint: PolicyError(file, line, problem, hint))
    except PolicyError as error:
        raise InputErrors([error]) from None
    reader = _AccessReader(file, error=PolicyError)
    access = reader.access(top)
    if reader.problems:
        raise InputErrors(reader.problems)
    return access


def identities(access: AccessFile) -> dict[Identity, list[AccessRule]]:
    """Return the rules that hold for each identity; two subjects that state the same are one."""
    rules = {rule.id: rule for rule in access.rules}
    of_subject = {subject.id: _stated(subject) for subject in access.subjects}
    held: dict[Identity, list[AccessRule]] = defaultdict(list)
    for identities in of_subject.values():
        for identity in identities:
            held[identity] = []  # a subject without a policy has the default
    for policy in access.policies:
        for subject in policy.subjects:
            for identity in of_subject[subject]:
                held[identity] += (rules[name] for name in policy.rules)
    return held


def _stated(subject: AccessSubject) -> tuple[Identity, ...]:
    """Every combination of what a subject's lists name."""
    properties = dict(subject.properties)
    return tuple(dict.fromkeys(product(*(properties.get(name, (None,)) for name in PROPERTIES))))


class _AccessReader(FileReader):
    """Walks the section once. Protocols of links are not checked: each version of Zenoh knows others."""

    def access(self, top: Value) -> AccessFile:
        section, namespace = top.get(SECTION), self._namespace(top.get("namespace"))
        if section is None:
            return AccessFile(self.file, enabled=False, allow=False, rules=(), subjects=(), policies=(),
                              place=Place(self.file, top.line), namespace=namespace)  # fmt: skip
        parts = self._parts(section, ("enabled", "default_permission", *_LISTS))
        enabled = "enabled" in parts and self._chosen(parts["enabled"], {"true": True, "false": False}, "number")
        allow = "default_permission" in parts and self._chosen(parts["default_permission"], PERMISSIONS)
        lists = {name: self._list(parts[name]) if name in parts else () for name in _LISTS}
        missing = [name for name in _LISTS if name not in parts]
        if enabled and missing:
            self.problem(section.line, f"no {', '.join(missing)}", "write all three lists, or enabled: false")
        rules = tuple(self._rule(value) for value in lists["rules"])
        subjects = tuple(self._subject(value) for value in lists["subjects"])
        policies = tuple(self._policy(value) for value in lists["policies"])
        self._without_repeats((rule.id, rule.place) for rule in rules)
        self._without_repeats((subject.id, subject.place) for subject in subjects)
        self._without_repeats((policy.id, policy.place) for policy in policies if policy.id)
        if all(lists.values()):  # otherwise Zenoh looks at none of them
            self._of_known_kind(policies, {rule.id for rule in rules}, {subject.id for subject in subjects})
        place = Place(self.file, section.line)
        return AccessFile(self.file, enabled, allow, rules, subjects, policies, place, namespace)

    def _namespace(self, value: Value | None) -> str:
        if value is None or value.kind == "empty":
            return ""
        if value.kind == "text" and problem_of(value.text) is None and not set(value.text) & set("*$"):
            return value.text
        self.problem(value.line, f"namespace {shown(value.text or value.kind)!r}", "write chunks without wildcards")
        return ""

    def _rule(self, value: Value) -> AccessRule:
        parts = self._parts(value, ("id", "permission", "messages", "flows", "key_exprs"))
        self._required(value, parts, ("id", "permission", "messages", "key_exprs"))
        keys = [(item.text, Place(self.file, item.line)) for item in self._texts(parts.get("key_exprs"))]
        for key, place in keys:
            problem = problem_of(key)
            if problem:
                self.problem(place.line, f"key expression {shown(key)!r}: {problem[0]}", problem[1])
        return AccessRule(
            self._id(parts),
            "permission" in parts and self._chosen(parts["permission"], PERMISSIONS),
            self._words(parts.get("messages"), MESSAGES),
            self._words(parts["flows"], FLOWS) if "flows" in parts else FLOWS,
            tuple(keys),
            Place(self.file, value.line),
        )

    def _subject(self, value: Value) -> AccessSubject:
        parts = self._parts(value, ("id", *PROPERTIES))
        self._required(value, parts, ("id",))
        properties = []
        for name in PROPERTIES:
            if name in parts:
                items = self._texts(parts[name])
                for item in items:
                    if not item.text.strip():
                        self.problem(item.line, f"an empty name in {name}", "write who is meant, or leave it out")
                    elif name == "zids" and not _ZID.fullmatch(item.text):
                        self.problem(item.line, f"{shown(item.text)!r} in zids", "write up to 32 digits 0-9 and a-f")
                properties.append((name, tuple(item.text for item in items)))
        return AccessSubject(self._id(parts), tuple(properties), Place(self.file, value.line))

    def _policy(self, value: Value) -> AccessPolicy:
        parts = self._parts(value, ("id", "rules", "subjects"))
        self._required(value, parts, ("rules", "subjects"))
        rules, subjects = (tuple(item.text for item in self._texts(parts.get(name))) for name in ("rules", "subjects"))
        return AccessPolicy(self._id(parts), rules, subjects, Place(self.file, value.line))

    def _parts(self, value: Value, keys: tuple[str, ...]) -> dict[str, Value]:
        """What a map states; null is as good as nothing."""
        if value.kind != "map":
            self.problem(value.line, f"a {value.kind} where a map belongs", f"write {{…}} with {', '.join(keys)}")
            return {}
        return {key: part for key, _, part in self.entries_of(value, keys) if part.kind != "empty"}

    def _required(self, value: Value, parts: dict[str, Value], names: Iterable[str]) -> None:
        for name in names:
            if value.kind == "map" and name not in parts:
                self.problem(value.line, f"no {name!r}", f"add {name}: …")

    def _list(self, value: Value) -> tuple[Value, ...]:
        return self.list_of(value, "this")

    def _texts(self, value: Value | None) -> list[Value]:
        """The words of a list, which may not be empty."""
        if value is None:
            return []
        items = self._list(value)
        if value.kind == "list" and not items:
            self.problem(value.line, "an empty list", "name one at least, or leave it out where Zenoh lets you")
        for item in items:
            if item.kind != "text":
                self.problem(item.line, f"a {item.kind} where a text belongs", "write it in quotes")
        return [item for item in items if item.kind == "text"]

    def _words(self, value: Value | None, words: tuple[str, ...]) -> tuple[str, ...]:
        items = self._texts(value)
        for item in items:
            self._chosen(item, dict.fromkeys(words, True))
        return tuple(dict.fromkeys(item.text for item in items))

    def _chosen(self, value: Value, words: dict[str, bool], kind: str = "text") -> bool:
        if value.kind == kind and value.text in words:
            return words[value.text]
        self.problem(value.line, f"{shown(value.text or value.kind)!r}", f"write one of {', '.join(words)}")
        return False

    def _id(self, parts: dict[str, Value]) -> str:
        if "id" not in parts:
            return ""
        if parts["id"].kind != "text" or not parts["id"].text.strip():
            self.problem(parts["id"].line, "an id that is no text, or empty", "write a name in quotes")
        return parts["id"].text

    def _without_repeats(self, ids: Iterable[tuple[str, Place]]) -> None:
        first: dict[str, Place] = {}
        for one, place in ids:
            if one in first:
                self.problem(place.line, f"id {shown(one)!r} again, first in line {first[one].line}", "rename one")
            first.setdefault(one, place)

    def _of_known_kind(self, policies: Iterable[AccessPolicy], rules: set[str], subjects: set[str]) -> None:
        for policy in policies:
            for what, named, there in (("rule", policy.rules, rules), ("subject", policy.subjects, subjects)):
                for name in named:
                    if name not in there:
                        self.problem(policy.place.line, f"no {what} has the id {shown(name)!r}", "correct the id")
