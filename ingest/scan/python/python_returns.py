"""What a call in Python code gives: a function of the checkout, or one of a library of which that is known.

Of libraries it is what their documentation says: ``os.path``, ``os.environ``, ``argparse``, strings, lists and
dictionaries, and the methods of a node of rclpy that speak of parameters and names.
"""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from rosprivacy.ingest.scan.python.python_scopes import DEEP, is_super
from rosprivacy.ingest.scan.python.python_texts import (
    MANY,
    changed,
    every,
    formatted,
    literal,
    path_of,
)
from rosprivacy.ingest.scan.python.python_value_types import (
    ClassValue,
    Frame,
    FunctionValue,
    Inherited,
    Instance,
    Item,
    Items,
    Library,
    Made,
    Open,
    Pairs,
    Place,
    Plain,
    Run,
    Setting,
    Text,
    Value,
    Values,
    union,
    written,
)
from rosprivacy.ingest.scan.scan_facts import plain_text

if TYPE_CHECKING:
    from collections.abc import Callable

    from rosprivacy.ingest.scan.python.python_scopes import Checkout
    from rosprivacy.ingest.scan.python.python_values import PythonValues

UNCHANGED = ("str", "int", "float", "list", "tuple", "set", "sorted", "reversed", "typing.cast", "copy.copy",
        "copy.deepcopy", "pathlib.Path", "os.path.expanduser", "os.path.normpath", "os.fspath", "iter")  # fmt: skip
MOST_COUNTED = 64
READ_BY_ROS = ("rosidl_runtime_py.utilities.get_message", "rosidl_runtime_py.utilities.get_service",
               "rosidl_runtime_py.utilities.get_action")  # fmt: skip


class PythonReturns:
    """What the calls of a checkout give.

    Attributes
    ----------
    settings, own_names
        Give the parameter of an object by its name, and what a node is called; set by who reads what nodes say.
    """

    def __init__(self, checkout: Checkout, values: PythonValues) -> None:
        self.checkout = checkout
        self.values = values
        values.call_values = self.call_values
        values.option = self.option
        self.settings: Callable[[str, Frame, Instance], Values] = lambda name, *_: (Setting(name, ()),)
        self.own_names: Callable[[str, Instance], Values] = lambda *_: ()

    def call_values(self, call: ast.Call, frame: Frame) -> Values:
        """Return what a call gives."""
        func = call.func
        if isinstance(func, ast.Attribute):
            if is_super(func.value):
                return self._of_super(func.attr, call, frame)
            owners = self.values.of(func.value, frame)
            return union(got for one in owners for got in self._of_method_call(one, func.attr, call, frame))
        return union(got for one in self.values.of(func, frame) for got in self._of_value(one, call, frame))

    def _of_super(self, name: str, call: ast.Call, frame: Frame) -> Values:
        above = frame.scope.of_class
        if above is not None and frame.me is not None:
            for one in self.values.line(above)[0][1:]:
                if name in one.inner:
                    return self.values.returned(one.inner[name], frame.me, Run(call, frame))
            return self._of_node(frame.me, name, call, frame) or (Open(written(call)),)
        return (Open(written(call)),)

    def _of_value(self, value: Value, call: ast.Call, frame: Frame) -> Values:
        if isinstance(value, FunctionValue):
            return self.values.returned(value.scope, value.me, Run(call, frame))
        if isinstance(value, ClassValue):
            return (Instance(value.scope, Run(call, frame)),) if _short(frame) else (Instance(value.scope),)
        if isinstance(value, Library):
            return self._of_library(value.name, call, frame)
        if isinstance(value, Inherited):
            return self._of_node(value.me, value.name, call, frame) or (Open(written(call)),)
        if value == Plain(None):
            return ()
        return (value if isinstance(value, Open) else Open(written(call)),)

    def _of_method_call(self, owner: Value, name: str, call: ast.Call, frame: Frame) -> Values:  # noqa: PLR0911 - a case each
        if isinstance(owner, Text):
            return self._of_text(owner, name, call, frame)
        if isinstance(owner, Pairs):
            return self._of_pairs(owner, name, call, frame)
        if isinstance(owner, Instance):
            if self.values.method(owner.scope, name) is None:
                known = self._of_node(owner, name, call, frame)
                if known:
                    return known
        elif isinstance(owner, Made):
            known = self._of_node(Instance(frame.scope), name, call, frame)
            return known or (Made(f"{owner.name}.{name}", Run(call, frame)),)
        elif isinstance(owner, Setting):
            return (owner,) if name == "get_parameter_value" else (Open(written(call)),)
        elif isinstance(owner, Open):
            known = self._of_node(frame.me or Instance(frame.scope), name, call, frame)
            return known or (owner,)
        elif isinstance(owner, Library):
            return self._of_library(f"{owner.name}.{name}", call, frame)
        elif owner == Plain(None):  # code that would fail
            return ()
        elif isinstance(owner, Items) and name in ("copy", "__iter__"):
            return (owner,)
        return union(
            got for one in self.values.attribute(owner, name, call, frame) for got in self._of_value(one, call, frame)
        )

    def argument(self, call: ast.Call, frame: Frame, place: int, name: str = "") -> Values:
        """Return what an argument of a call can be; empty where it is not given."""
        for at, one in enumerate(call.args[: place + 1]):
            if isinstance(one, ast.Starred):
                listed = self.values.listed(self.values.of(one.value, frame))
                if listed is None:
                    return (Open(written(one.value)),)
                if place - at < len(listed):
                    return self.values.item(listed[place - at])
                return ()
        if place < len(call.args):
            return self.values.of(call.args[place], frame)
        return self._keyword(call, frame, name) if name else ()

    def _keyword(self, call: ast.Call, frame: Frame, name: str) -> Values:
        for given in call.keywords:
            if given.arg == name:
                return self.values.of(given.value, frame)
        for given in call.keywords:
            for pairs in self.values.of(given.value, frame) if given.arg is None else ():
                if not isinstance(pairs, Pairs):
                    return (Open(written(given.value)),)
                for key, value in pairs.pairs:
                    if name in self.values.plain_texts(self.values.item(key)):
                        return self.values.item(value)
        return ()

    def _of_node(self, owner: Instance, name: str, call: ast.Call, frame: Frame) -> Values:
        """What a method of a node of rclpy gives."""
        if name in ("declare_parameter", "get_parameter", "get_parameter_or"):
            names = self.values.texts(self.argument(call, frame, 0, "name"))
            found: list[Value] = []
            for one in names:
                text = plain_text(one)
                default = self.argument(call, frame, 1, "value" if name[0] == "d" else "alternative_value")
                if text is None:
                    found.append(Open("a parameter whose name is not known"))
                elif name == "declare_parameter" and default:
                    found.append(Setting(text, default))
                else:
                    found += self.settings(text, frame, owner)
            return tuple(found)
        if name == "get_parameters":
            listed = self.values.listed(self.argument(call, frame, 0, "names")) or []
            return (
                Items(
                    tuple(
                        tuple(
                            got
                            for text in self.values.plain_texts(self.values.item(item))
                            for got in self.settings(text, frame, owner)
                        )
                        for item in listed
                    )
                ),
            )
        if name in ("get_name", "get_namespace", "get_fully_qualified_name") and not call.args:
            return self.own_names(name, owner)
        if name in ("resolve_topic_name", "resolve_service_name"):
            return self.argument(call, frame, 0, "topic" if "topic" in name else "service")
        return ()

    def _of_text(self, owner: Text, name: str, call: ast.Call, frame: Frame) -> Values:  # noqa: PLR0911 - a case each
        template = plain_text(owner.pieces)
        if name == "format" and template is not None:
            places = [self.values.texts(self.values.of(one, frame), written(one)) for one in call.args]
            names = {one.arg: self.values.texts(self.values.of(one.value, frame)) for one in call.keywords if one.arg}
            return tuple(Text(one) for one in formatted(template, places, names))
        if name == "join" and template is not None and call.args:
            listed = self.values.listed(self.values.of(call.args[0], frame))
            if listed is None or len(listed) > MANY:
                return (Open(written(call)),)
            parts = [self.values.texts(self.values.item(one)) for one in listed]
            between = [part for one in parts for part in ((literal(template),), one)][1:]
            return tuple(Text(one) for one in every(between))
        if name in ("encode", "decode", "strip") and not call.args and name != "strip":
            return (owner,)
        if name == "split" and template is not None and template:
            separators = self.values.plain_texts(self.values.of(call.args[0], frame)) if call.args else [""]
            return tuple(
                Items(
                    tuple(
                        (Text((owner.pieces[0]._replace(text=part, parameter=""),)),)
                        for part in template.split(one or None)
                    )
                )
                for one in separators
            )
        arguments = [self.values.plain_texts(self.values.of(one, frame)) for one in call.args]
        if all(len(one) == 1 for one in arguments):
            after = changed(name, owner.pieces, [one[0] for one in arguments])
            if after is not None:
                return (Text(after),)
        return (Open(written(call)),)

    def _of_pairs(self, owner: Pairs, name: str, call: ast.Call, frame: Frame) -> Values:  # noqa: PLR0911 - a case each
        if name == "items":
            return (Items(tuple((Items((key, value)),) for key, value in owner.pairs)),)
        if name == "keys":
            return (Items(tuple(key for key, _ in owner.pairs)),)
        if name == "values":
            return (Items(tuple(value for _, value in owner.pairs)),)
        if name in ("get", "pop", "setdefault") and call.args:
            keys = self.values.of(call.args[0], frame)
            fixed = all(isinstance(one, Plain | Text) for one in keys)
            there = {value for key, _ in owner.pairs for value in self.values.item(key)}
            if fixed and not there & set(keys):
                return self.values.as_defaults(self.argument(call, frame, 1, "default")) or (Plain(None),)
            return self.values.looked_up(owner, keys)
        if name == "copy":
            return (owner,)
        return (Open(written(call)),)

    def option(self, parsed: Made, name: str) -> Values:
        """Return what ``argparse`` gives under a name by default."""
        found: list[Value] = []
        for one in self.checkout.calls.get("add_argument", ()):
            if one.scope.file is parsed.run.frame.scope.file:
                frame = self.values.frame_of(one.scope)
                flags = [text for arg in one.call.args for text in self.values.plain_texts(self.values.of(arg, frame))]
                flags += self.values.plain_texts(self.argument(one.call, frame, len(flags), "dest"))
                if name in {flag.lstrip("-").replace("-", "_") for flag in flags}:
                    found += self.values.as_defaults(self.argument(one.call, frame, len(flags), "default"))
        return tuple(found) or (Open(f"option {name}"),)

    def _of_library(self, name: str, call: ast.Call, frame: Frame) -> Values:  # noqa: PLR0911 - a case each
        if name in ("os.environ.get", "os.getenv", "os.environ.setdefault"):
            default = self.argument(call, frame, 1, "default")
            variable = self.values.plain_texts(self.argument(call, frame, 0, "key"))
            return self.values.as_defaults(default) or (Open(f"environment variable {' '.join(variable)}"),)
        if name in ("os.path.join", "posixpath.join"):
            parts = [self.values.texts(self.values.of(one, frame), written(one)) for one in call.args]
            return tuple(Text(one) for one in every(parts, path_of)) if parts else (Open(written(call)),)
        if name in READ_BY_ROS:
            return self.argument(call, frame, 0)
        if name in UNCHANGED and call.args:
            given = self.argument(call, frame, 1 if name == "typing.cast" else 0)
            return tuple(Text(one) for one in self.values.texts(given)) if name == "str" else given
        if name in ("list", "tuple", "set") and not call.args:
            return (Items(()),)
        if name == "dict":
            given = self.argument(call, frame, 0)
            own = tuple(((Text(literal(one.arg)),), Place(one.value, frame)) for one in call.keywords if one.arg)
            return tuple(Pairs((*one.pairs, *own)) for one in given if isinstance(one, Pairs)) or (Pairs(own),)
        if name in ("enumerate", "zip", "range"):
            return self._counted(name, call, frame)
        if name.endswith("Parameter") and name.startswith("rclpy"):
            names = self.values.plain_texts(self.argument(call, frame, 0, "name"))
            return tuple(Setting(one, self.argument(call, frame, 2, "value")) for one in names) or (
                Open(written(call)),
            )
        if name == "getattr" and len(call.args) > 1:
            names = self.values.plain_texts(self.values.of(call.args[1], frame))
            owners = self.values.of(call.args[0], frame)
            found = union(
                got for one in owners for text in names for got in self.values.attribute(one, text, call, frame)
            )
            return found or (Open(written(call)),)
        return (Made(name, Run(call, frame)) if _short(frame) else Open(written(call)),)

    def _counted(self, name: str, call: ast.Call, frame: Frame) -> Values:
        given = [self.values.of(one, frame) for one in call.args]
        if name == "range":
            numbers = [
                one[0].value
                for one in given
                if len(one) == 1 and isinstance(one[0], Plain) and isinstance(one[0].value, int)
            ]
            if len(numbers) != len(given) or not 1 <= len(numbers) <= len(("first", "end", "step")) or 0 in numbers[2:]:
                return (Open(written(call)),)
            counted = range(*numbers)
            if len(counted) > MOST_COUNTED:
                return (Open("a long range of numbers"),)
            return (Items(tuple((Plain(one),) for one in counted)),)
        listed = [self.values.listed(one) for one in given]
        lists = [one for one in listed if one is not None]
        if len(lists) != len(listed) or not lists:
            return (Open(written(call)),)
        if name == "zip":
            return (Items(tuple((Items(tuple(one)),) for one in zip(*lists, strict=False))),)
        first = next((one.value for one in (given[1] if len(given) > 1 else ()) if isinstance(one, Plain)), 0) or 0
        pairs: list[Item] = [(Items(((Plain(int(first) + at),), item)),) for at, item in enumerate(lists[0])]
        return (Items(tuple(pairs)),)


def _short(frame: Frame) -> bool:
    """Whether few calls are known through which a frame runs: others are not told apart."""
    count, run = 0, frame.run
    while run is not None:
        count, run = count + 1, run.frame.run
    made = frame.me.origin if frame.me else None
    while made is not None:
        count, made = count + 1, (made.frame.me.origin if made.frame.me else None)
    return count < DEEP + 1
