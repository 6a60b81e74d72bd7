"""By which calls a function of Python code may run, for which objects, and with what arguments."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from rosprivacy.ingest.scan.python.python_scopes import DEEP, Scope, is_super, self_of
from rosprivacy.ingest.scan.python.python_texts import (
    MANY,
    literal,
)
from rosprivacy.ingest.scan.python.python_value_types import (
    ClassValue,
    Frame,
    FunctionValue,
    Instance,
    Item,
    Items,
    Library,
    Open,
    Pairs,
    Place,
    Run,
    Text,
    Value,
    Values,
    written,
)
from rosprivacy.ingest.scan.python.python_values import PythonValues

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rosprivacy.ingest.scan.python.python_scopes import Checkout, CodeCall

INIT = "__init__"


class PythonCalls:
    """Follows the calls of a checkout to the functions that they run."""

    def __init__(self, checkout: Checkout) -> None:
        self.checkout = checkout
        self.values = PythonValues(checkout)
        self.values.callers = self.runs
        self.values.bound = self._bound
        self._constructions: dict[Scope, tuple[CodeCall, ...]] = {}
        self._derived: dict[Scope, list[Scope]] = {}
        self._frames: dict[tuple[Scope, int], tuple[Frame, ...]] = {}

    # who calls

    def constructions(self, cls: Scope) -> tuple[CodeCall, ...]:
        """Return the calls that make an object of a class."""
        if cls not in self._constructions:
            self._constructions[cls] = ()
            self._constructions[cls] = tuple(
                one
                for one in self.checkout.calls.get(cls.name, ())
                if ClassValue(cls) in self.values.of(one.call.func, self.values.frame_of(one.scope))
            )
        return self._constructions[cls]

    def derived(self, cls: Scope) -> list[Scope]:
        """Return the classes that are derived of one, itself too, but not one that only others are made of."""
        if not self._derived:
            for read in self.checkout.files.values():
                for one in read.classes:
                    for base in self.values.line(one)[0]:
                        self._derived.setdefault(base, []).append(one)
        every_one = self._derived.get(cls, [cls])
        return [one for one in every_one if one is not cls or len(every_one) == 1 or self.constructions(cls)]

    def instances(self, cls: Scope, depth: int = DEEP) -> list[Instance]:
        """Return the objects of a class that the code makes; one that may be any where they are not known."""
        found: list[Instance] = []
        if depth:
            for one in self.constructions(cls):
                found += [Instance(cls, Run(one.call, frame)) for frame in self.frames(one.scope, depth - 1)]
        return found if 0 < len(found) <= MANY else [Instance(cls)]

    def frames(self, scope: Scope, depth: int = DEEP) -> tuple[Frame, ...]:
        """Return for what the code of a scope may run."""
        key = (scope, depth)
        if key not in self._frames:
            whole = self.values.frame_of(scope)
            self._frames[key] = (whole,)  # while it is looked for
            found = list(self._runs_of(scope, depth))
            self._frames[key] = tuple(dict.fromkeys(found)) if 0 < len(found) <= MANY else (whole,)
        return self._frames[key]

    def _runs_of(self, scope: Scope, depth: int) -> Iterator[Frame]:
        objects: list[Instance | None] = [None]
        if scope.of_class is not None:
            objects = [one for cls in self.derived(scope.of_class) for one in self.instances(cls, depth)]
        given = scope.arguments
        count = len([*given.posonlyargs, *given.args, *given.kwonlyargs]) if given else 0
        takes = given is not None and (count > bool(scope.own_name) or given.vararg or given.kwarg)
        for me in objects:
            runs = self.runs(scope, me, depth) if takes and depth and scope.name != INIT else []
            yield from (Frame(scope, me, run) for run in runs)
            if not runs:
                yield Frame(scope, me)

    def runs(self, scope: Scope, me: Instance | None, depth: int = 0) -> Sequence[Run]:
        """Return the calls by which a function may run for an object."""
        if scope.is_method and me is not None:
            if scope.name == INIT:
                return self._constructors(scope, me)
            return [*self._of_method(scope, me)]
        found: list[Run] = []
        for one in self.checkout.calls.get(scope.name, ()):
            func = self.values.of(one.call.func, self.values.frame_of(one.scope))
            if any(isinstance(value, FunctionValue) and value.scope is scope for value in func):
                inside = self.frames(one.scope, depth - 1) if depth else (self.values.frame_of(one.scope),)
                found += [Run(one.call, frame) for frame in inside]
        return found

    def _constructors(self, scope: Scope, me: Instance) -> list[Run]:
        if self.values.method(me.scope, INIT) is scope:
            if me.origin is not None:
                return [me.origin]
            return [Run(one.call, self.values.frame_of(one.scope)) for one in self.constructions(me.scope)]
        found: list[Run] = []
        classes = self.values.line(me.scope)[0]
        for one in self.checkout.calls.get(INIT, ()):
            above = one.scope.of_class
            if above in classes and above is not scope.of_class and self.constructor(one.call, above, me) is scope:
                found.append(Run(one.call, Frame(one.scope, me)))
        return found

    def constructor(self, call: ast.Call, above: Scope, me: Instance) -> Scope | str | None:
        """Return what ``super().__init__()`` or ``Base.__init__(self)`` in a class runs for an object.

        A function of the checkout, or the name of a library's class.
        """
        before = call.func.value if isinstance(call.func, ast.Attribute) else None
        if is_super(before):
            classes = self.values.order(me.scope)
            for base in classes[classes.index(above) + 1 :] if above in classes else ():
                if isinstance(base, str) or INIT in base.inner:
                    return base if isinstance(base, str) else base.inner[INIT]
            return None
        for one in self.values.of(before, self.values.frame_of(above)) if before is not None else ():
            if isinstance(one, ClassValue):
                return self.values.method(one.scope, INIT)
            if isinstance(one, Library):
                return one.name
        return None

    def _of_method(self, scope: Scope, me: Instance) -> Iterator[Run]:
        classes = self.values.line(me.scope)[0]
        runs_it = self.values.method(me.scope, scope.name) is scope
        for one in self.checkout.calls.get(scope.name, ()):
            func = one.call.func
            if not isinstance(func, ast.Attribute):
                continue
            itself = isinstance(func.value, ast.Name) and func.value.id == self_of(one.scope)
            if one.scope.of_class in classes and (is_super(func.value) or (itself and runs_it)):
                yield Run(one.call, Frame(one.scope, me))
            elif one.scope.of_class not in classes or not itself:
                frame = self.values.frame_of(one.scope)
                if any(self._may_be(value, me, scope.name) for value in self.values.of(func.value, frame)):
                    yield Run(one.call, frame)

    def _may_be(self, value: Value, me: Instance, method: str) -> bool:
        """Whether a method of a value is that of an object."""
        if isinstance(value, Instance):
            same = value.origin is None or me.origin is None or value.origin.call is me.origin.call
            return value.scope is me.scope and same
        return isinstance(value, Open) and len(self.checkout.methods[method]) == 1

    def _bound(self, scope: Scope, run: Run) -> dict[str, Item]:
        given = scope.arguments
        if given is None:
            return {}
        listed = [one.arg for one in (*given.posonlyargs, *given.args)]
        if scope.own_name and not _gives_itself(run, scope):
            listed = listed[1:]
        in_order, unknown = self._by_place(run)
        by_name, open_too = self._by_name(run)
        unknown = unknown or open_too
        found: dict[str, Item] = dict(zip(listed, in_order, strict=False))
        names = {*listed, *(one.arg for one in given.kwonlyargs)}
        others: list[tuple[Item, Item]] = []
        for key, value in by_name:
            texts = self.values.plain_texts(self.values.item(key))
            found.update({text: value for text in texts if text in names})
            others += [] if set(texts) <= names else [(key, value)]
        if given.vararg:
            found[given.vararg.arg] = unknown or (Items(tuple(in_order[len(listed) :])),)
        if given.kwarg:
            found[given.kwarg.arg] = unknown or (Pairs(tuple(others)),)
        for name in names if unknown else ():
            found.setdefault(name, unknown)
        return found

    def _by_place(self, run: Run) -> tuple[list[Item], Values]:
        """Arguments in their order, up to one that is open."""
        items: list[Item] = []
        for one in run.call.args:
            if not isinstance(one, ast.Starred):
                items.append(Place(one, run.frame))
                continue
            listed = self.values.listed(self.values.of(one.value, run.frame))
            if listed is None:
                return items, (Open(written(one.value)),)
            items += listed
        return items, ()

    def _by_name(self, run: Run) -> tuple[list[tuple[Item, Item]], Values]:
        """Arguments with keywords, and whether there are open ones."""
        pairs: list[tuple[Item, Item]] = []
        unknown: Values = ()
        for keyword in run.call.keywords:
            if keyword.arg is not None:
                pairs.append(((Text(literal(keyword.arg)),), Place(keyword.value, run.frame)))
                continue
            for one in self.values.of(keyword.value, run.frame):
                if isinstance(one, Pairs):
                    pairs += one.pairs
                else:
                    unknown = (Open(written(keyword.value)),)
        return pairs, unknown


def _gives_itself(run: Run, scope: Scope) -> bool:
    """Whether a call names the object among its arguments: ``Base.__init__(self, "name")``."""
    func = run.call.func
    if not isinstance(func, ast.Attribute) or is_super(func.value) or "classmethod" in scope.decorators:
        return False
    own = self_of(run.frame.scope)
    first = run.call.args[0] if run.call.args else None
    through = isinstance(func.value, ast.Name) and func.value.id == own
    return bool(own) and isinstance(first, ast.Name) and first.id == own and not through
