"""A launch file in XML or YAML -> its actions, as ``launch_xml``, ``launch_yaml`` and ``launch_ros`` take them.

In: bytes. Out: the same actions as of a launch file in Python. ``$(…)`` in a text becomes a substitution. What an
element is that nobody here knows is said as an unknown action.

Source: design.ros2.org, "ROS 2 Launch XML Format"; ``launch/frontend``, ``launch_xml``, ``launch_yaml`` and the
``parse`` methods of ``launch_ros.actions``.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputError
from rosprivacy.ingest.policies.xinclude import parsed
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.scan.launch.launch_actions import (
    ACTIONS,
    COMPONENT,
    DECLARE,
    ENVIRONMENT,
    GROUP,
    INCLUDE,
    LOAD,
    NAMESPACE,
    NODE,
    NOTHING,
    PARAMETER,
    PARAMETER_FILE,
    PROCESS,
    REMAP,
    SET,
    UNKNOWN,
    Action,
    Condition,
)
from rosprivacy.ingest.scan.launch.launch_values import PACKAGE, Open, Substitution, choice
from rosprivacy.ingest.scan.scan_facts import CodePlace

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from lxml import etree

    from rosprivacy.ingest.reading.yaml_values import Value

DEEPEST = 40  # elements in elements
TOO_DEEP = "element that is nested too deeply"
QUIET = frozenset(
    ["log", "log_info", "shutdown", "reset", "unset_env", "append_env", "set_use_sim_time", "let_env", "keep", "test"]
)


class Element(NamedTuple):
    """An element of XML, or an entry of YAML that stands for one."""

    tag: str
    line: int
    attributes: Mapping[str, str]
    children: tuple[Element, ...]

    def tagged(self, *tags: str) -> Iterator[Element]:
        """Its children of some tags."""
        return (child for child in self.children if child.tag in tags)


def of_xml(data: bytes, file: str) -> Element:
    """Return the outermost element of a launch file in XML.

    Raises
    ------
    InputError
        If it cannot be read.
    """
    return _of_xml(parsed(data, file), 0)


def _of_xml(node: etree._Element, depth: int) -> Element:
    attributes = {str(name): str(value) for name, value in node.attrib.items()}
    tag = str(node.tag).replace("-", "_") if depth < DEEPEST else TOO_DEEP
    inner = () if tag == TOO_DEEP else tuple(_of_xml(child, depth + 1) for child in node if isinstance(child.tag, str))
    return Element(tag, node.sourceline or 1, attributes, inner)


def of_yaml(text: str, file: str) -> Element:
    """Return the outermost element of a launch file in YAML; see ``of_xml``."""
    top = yaml_values.parse(text, partial(InputError, file))
    launch = top.get("launch")
    children = tuple(_entries(launch, 0)) if launch else ()
    return Element("launch" if launch else "", top.line, {}, children)


def _entries(value: Value, depth: int) -> Iterator[Element]:
    """The elements that a list or a map of YAML stands for."""
    if depth > DEEPEST:
        yield Element(TOO_DEEP, value.line, {}, ())
        return
    for item in value.items:
        for key, line, inner in item.entries:
            yield _of_yaml(key, line, inner, depth + 1)
    for key, line, inner in value.entries:
        if inner.kind in ("map", "list"):
            yield from _entries(inner, depth + 1) if key == "children" else _repeated(key, line, inner, depth + 1)


def _repeated(tag: str, line: int, value: Value, depth: int) -> Iterator[Element]:
    """``remap: [{from: a, to: b}, …]`` is an element for each item."""
    for item in value.items if value.kind == "list" else (value,):
        yield _of_yaml(tag, item.line if item.kind == "map" else line, item, depth)


def _of_yaml(tag: str, line: int, value: Value, depth: int) -> Element:
    plain = {key: inner.text for key, _, inner in value.entries if inner.kind not in ("map", "list")}
    plain |= {
        key: str([one.text for one in inner.items])
        for key, _, inner in value.entries
        if inner.kind == "list" and all(one.kind not in ("map", "list") for one in inner.items)
    }
    if value.kind not in ("map", "list"):
        plain["value"] = value.text
    return Element(tag.replace("-", "_"), line, plain, tuple(_entries(value, depth)))


def actions(top: Element, file: str) -> Action | None:
    """Return what a launch file does; None where it is none of ROS 2."""
    if top.tag != "launch" or _of_ros_1(top):
        return None
    return Action(ACTIONS, CodePlace(file, top.line), {"actions": _actions(top.children, file)})


def _of_ros_1(top: Element) -> bool:
    """Whether nodes have a ``type`` or parameters stand outside of nodes, as ROS 1 has it."""
    waiting, old = [top], False
    while waiting:
        element = waiting.pop()
        waiting += element.children
        if element.tag == "node":
            if "exec" in element.attributes:
                return False
            old = old or "type" in element.attributes
        old = old or element.tag in ("rosparam", "machine")
        old = old or any("$(find " in value or "$(arg " in value for value in element.attributes.values())
    return old


def _actions(elements: Sequence[Element], file: str) -> list[object]:
    return [_action(element, file) for element in elements]


def _action(element: Element, file: str) -> Action:
    place = CodePlace(file, element.line)
    made = _values(element, file)
    if made is None:
        return Action(UNKNOWN, place, {"why": f"what <{element.tag}> does"})
    sort, values = made
    for name in ("if", "unless"):
        if name in element.attributes:
            values["condition"] = Condition(substituted(element.attributes[name]), name == "unless")
    return Action(sort, place, values)


def _values(element: Element, file: str) -> tuple[str, dict[str, object]] | None:  # noqa: PLR0911, PLR0912 - one for each tag
    tag, written = element.tag, element.attributes
    text = {key: substituted(value) for key, value in written.items()}
    if tag in ("node", "node_container", "lifecycle_node"):
        values = _node(element, "exec")
        values["descriptions"] = _actions([*element.tagged("composable_node")], file)
        return NODE, values
    if tag == "composable_node":
        return COMPONENT, _node(element, "plugin")
    if tag == "load_composable_node":
        return LOAD, {"descriptions": _actions([*element.tagged("composable_node")], file)}
    if tag == "include":
        passed = [*element.tagged("arg"), *element.tagged("let")]
        pairs = [
            [substituted(one.attributes.get("name", "")), substituted(one.attributes.get("value", ""))]
            for one in passed
        ]
        return INCLUDE, {"file": text.get("file", Open("the file")), "arguments": pairs}
    if tag == "group":
        configurations = {
            one.attributes["name"]: substituted(one.attributes.get("value", ""))
            for one in element.tagged("keep")
            if "name" in one.attributes
        }
        return GROUP, {
            "actions": _actions(element.children, file),
            "scoped": written.get("scoped", "true").lower() != "false",
            "configurations": configurations,
        }
    if tag == "arg":
        choices = [one.attributes["value"] for one in element.tagged("choice") if "value" in one.attributes]
        values = {"name": written.get("name", ""), "default": text.get("default"), "choices": choices}
        return DECLARE, values
    if tag in ("let", "set_env"):
        return (SET if tag == "let" else ENVIRONMENT), {"name": text.get("name", ""), "value": text.get("value", "")}
    if tag in ("push_ros_namespace", "push_namespace"):
        return NAMESPACE, {"namespace": text.get("namespace", "")}
    if tag == "set_remap":
        return REMAP, {"src": text.get("from", ""), "dst": text.get("to", "")}
    if tag == "set_parameter":
        return PARAMETER, {"name": text.get("name", ""), "value": text.get("value", "")}
    if tag == "set_parameters_from_file":
        return PARAMETER_FILE, {"file": text.get("filename", text.get("file"))}
    if tag == "executable":
        return PROCESS, {"words": [text.get("cmd", "")]}
    if tag in ("timer", "ros_timer"):
        return ACTIONS, {"actions": _actions(element.children, file)}
    return (NOTHING, {}) if tag in QUIET else None


def _node(element: Element, executable: str) -> dict[str, object]:
    text = {key: substituted(value) for key, value in element.attributes.items()}
    values: dict[str, object] = {
        "package": text.get("pkg", ""),
        "executable": text.get(executable, ""),
        "name": text.get("name"),
        "namespace": text.get("namespace"),
        "arguments": [
            one for one in (text.get("args"), text.get("ros_args") and ["--ros-args ", text["ros_args"]]) if one
        ],
        "remappings": [
            [substituted(one.attributes.get("from", "")), substituted(one.attributes.get("to", ""))]
            for one in element.tagged("remap")
        ],
    }
    parameters: list[object] = []
    for one in element.tagged("param"):
        if "from" in one.attributes:
            parameters.append(substituted(one.attributes["from"]))
        else:
            parameters.append(dict(_parameters(one, "", 0)))
    values["parameters"] = parameters
    return values


def _parameters(element: Element, before: str, depth: int) -> Iterator[tuple[str, object]]:
    name = before + element.attributes.get("name", "")
    if "value" in element.attributes:
        yield name, substituted(element.attributes["value"])
    if depth < DEEPEST:
        for child in element.tagged("param"):
            yield from _parameters(child, f"{name}.", depth + 1)


def substituted(text: str) -> object:
    """Return a text with its substitutions, as a value.

    >>> substituted("robot"), substituted("/$(var ns)/x").parts[1]
    ('robot', Substitution(sort='configuration', parts=('ns',)))
    """
    if "$(" not in text:
        return text
    stack: list[list[list[object]]] = [[[]]]  # of each $(…) that is open, its words; of each word, its parts
    quote, at = "", 0
    while at < len(text):
        sign, inside = text[at], len(stack) > 1
        if text.startswith("$(", at):
            if len(stack) > DEEPEST:
                return Open("substitutions that are nested too deeply")
            stack.append([[]])
            at += 2
            continue
        if inside and not quote and sign == ")":
            words = [_word(word) for word in stack.pop() if word]
            stack[-1][-1].append(_substitution(words))
        elif inside and not quote and sign == " ":
            stack[-1].append([])
        elif inside and sign in "'\"" and quote in ("", sign):
            quote = "" if quote else sign
            if not stack[-1][-1]:
                stack[-1][-1].append("")
        else:
            word = stack[-1][-1]
            if word and isinstance(word[-1], str):
                word[-1] += sign
            else:
                word.append(sign)
        at += 1
    return _word(stack[0][0]) if len(stack) == 1 else Open("a substitution that does not end")


def _word(parts: list[object]) -> object:
    return parts[0] if len(parts) == 1 else Substitution("text", tuple(parts))


def _substitution(words: list[object]) -> object:  # noqa: PLR0911 - one for each
    name, *rest = words or [""]
    first: object = rest[0] if rest else ""
    if name in ("var", "env", "optenv"):
        sort = "configuration" if name == "var" else "environment"
        default = [_spaced(rest[1:])] if len(rest) > 1 else [""] if name == "optenv" else []
        return Substitution(sort, (first, *default))
    if name == "find-pkg-share":
        return PACKAGE + first if isinstance(first, str) else Substitution("share", (first,))
    if name in ("find-pkg-prefix", "find-pkg"):
        return Substitution("prefix", (first,))
    if name == "dirname":
        return Substitution("here", ())
    if name == "eval":
        return Substitution("expression", (_spaced(rest),))
    if name in ("anon", "find-exec"):
        return first
    if name == "if" and len(rest) > 1:
        return choice(rest[1:], str(rest[0]))
    return Open(f"$({name} …)")


def _spaced(words: list[object]) -> object:
    parts: list[object] = []
    for word in words:
        parts += [word] if not parts else [" ", word]
    return _word(parts)
