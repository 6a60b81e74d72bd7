"""What an expression of Python code can be, as far as the text of the checkout says; nothing is run.

The answer is a union: each value that a condition, a loop over constants or a caller allows. What the text does not fix
is an open value that says what it depends on. Where a function is looked into, it is for a *frame*: the object whose
method it is, and the call by which it runs, as far as these are known; so a helper that gets a node and a name gives
each node its own names.
"""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from rosprivacy.ingest.scan.python.python_expressions import ITEMS, PythonExpressions
from rosprivacy.ingest.scan.python.python_reaching import reaching
from rosprivacy.ingest.scan.python.python_scopes import (
    ADDED,
    ITEM,
    LONGEST_LINE,
    MEMBER,
    Binding,
    PythonFile,
    Scope,
)
from rosprivacy.ingest.scan.python.python_texts import (
    every,
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
    ModuleValue,
    Open,
    Place,
    Plain,
    Run,
    Setting,
    Text,
    Value,
    Values,
    is_false,
    union,
    written,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from rosprivacy.ingest.scan.python.python_scopes import Checkout

DEEPEST = 40  # expressions, each looked into for the one before
STEPS = 6000  # expressions that are looked into for one answer
PARSED = (".parse_args", ".parse_known_args")
NO_BASES = ("object", "abc.ABC", "typing.Generic", "typing.Protocol")


class PythonValues(PythonExpressions):
    """Looks at the expressions of a checkout.

    Attributes
    ----------
    call_values, callers, bound, option
        What a call gives; the calls by which a function may run, for an object; the arguments that a call gives; what
        an option of the command line is: set by ``python_calls.py``, which follows calls.
    """

    def __init__(self, checkout: Checkout) -> None:
        self.checkout = checkout
        self.call_values: Callable[[ast.Call, Frame], Values]
        self.callers: Callable[[Scope, Instance | None], Sequence[Run]]
        self.bound: Callable[[Scope, Run], dict[str, Item]]
        self.option: Callable[[Made, str], Values]
        self._memo: dict[tuple[ast.expr, Frame], Values] = {}
        self._active: set[tuple[ast.expr, Frame]] = set()
        self._modules_active: set[tuple[PythonFile, str]] = set()
        self._cuts = self._steps = 0
        self._lines: dict[Scope, tuple[Scope | str, ...]] = {}

    def forget(self) -> None:
        """Look at all anew: something else is known of parameters, or it was broken off."""
        self._memo.clear()
        self._active.clear()
        self._modules_active.clear()

    def answer(self, expression: ast.expr | None, frame: Frame) -> Values:
        """Return what an expression can be, with all the steps that there are for one answer."""
        self._steps = 0
        return self.of(expression, frame) if expression is not None else ()

    def of(self, expression: ast.expr, frame: Frame) -> Values:
        """Return what an expression can be."""
        key = (expression, frame)
        if key in self._memo:
            return self._memo[key]
        self._steps += 1
        if key in self._active or len(self._active) >= DEEPEST or self._steps > STEPS:
            self._cuts += 1
            return (Open("itself" if key in self._active else "code that is too deep to follow"),)
        self._active.add(key)
        cuts = self._cuts
        values = union(self.read(expression, frame))
        self._active.discard(key)
        if cuts == self._cuts:
            self._memo[key] = values
        return values

    def name(self, node: ast.Name, frame: Frame) -> Values:
        """Return what a name can be."""
        scope: Scope | None = frame.scope
        at: ast.AST | None = node
        while scope is not None:
            if scope is frame.scope or not isinstance(scope.node, ast.ClassDef):
                here = frame if scope is frame.scope else outer_frame(scope, frame)
                values = self.variable(node.id, at, here)
                if values:
                    return values
            at = None
            scope = scope.above
        if node.id in ("True", "False", "None"):
            return (Plain(None),)
        return (Library(node.id),)

    def variable(self, name: str, at: ast.AST | None, frame: Frame) -> Values:
        """Return what a name of a scope can be; empty where the scope gives none of that name.

        Parameters
        ----------
        at
            Where it is used, in that scope; None for any time after all of it.
        """
        scope = frame.scope
        given = scope.arguments
        values: list[Value] = []
        selected, start = reaching(scope.bindings.get(name, []), at, scope)
        if given is not None and name in _argument_names(given) and start:
            values += self._argument(name, frame)
        values = [*self.bindings(selected, frame, tuple(values))]
        if name in scope.inner:
            inner = scope.inner[name]
            values.append(ClassValue(inner) if isinstance(inner.node, ast.ClassDef) else FunctionValue(inner))
        if scope.above is None:
            values += self._imported(name, scope.file)
        return union(values)

    def bindings(self, selected: Sequence[tuple[Binding, bool]], frame: Frame, start: Values = ()) -> Values:
        """Return what a variable can be after some places that give it a value.

        Parameters
        ----------
        selected
            In the order of the text, each with whether it takes place whenever the variable is used.
        """
        values: list[Value] = [*start]
        for binding, certain in selected:
            here = frame if binding.scope is frame.scope else self.frame_of(binding.scope, frame.me)
            got = self._bound_value(binding, here)
            if binding.sort == MEMBER:
                items = [item for one in values if isinstance(one, Items) for item in one.items]
                if binding.value is not None and any(isinstance(one, Items) for one in values):
                    values = [one for one in values if not isinstance(one, Items)]
                    values.append(Items((*items, Place(binding.value, here))[:ITEMS]))
            elif binding.sort == ADDED:
                longer = self._longer(tuple(values), got)
                values = [*longer] if certain else [*values, *longer]
            else:
                values += got
        return union(values)

    def _longer(self, values: Values, added: Values) -> Values:
        """What ``+=`` makes."""
        if all(isinstance(one, Items) for one in (*values, *added)):
            return (
                Items(tuple(item for one in (*values, *added) if isinstance(one, Items) for item in one.items)[:ITEMS]),
            )
        if all(isinstance(one, Plain) for one in (*values, *added)):
            return (Open("a number that is counted up"),)
        return tuple(Text(one) for one in every([self.texts(values), self.texts(added)]))

    def _bound_value(self, binding: Binding, frame: Frame) -> Values:
        if binding.value is None:
            return (Open("a value that the code takes apart"),)
        if binding.sort == MEMBER:
            return ()
        if binding.sort == ITEM:
            turn = next((item for loop, item in frame.turns if loop is binding.at), None)
            if turn is not None:
                values = self.item(turn)
            else:
                over = self.of(binding.value, frame)
                listed = self.listed(over)
                why = next((one.why for one in over if isinstance(one, Open)), written(binding.value))
                if not listed and listed is not None:
                    return ()
                values = self.all_of(listed) if listed is not None else (Open(why),)
        else:
            values = self.of(binding.value, frame)
        for place in binding.path:
            values = self._unpacked(values, place, written(binding.value))
        return values

    def _unpacked(self, values: Values, place: int, why: str) -> Values:
        found: list[Value] = []
        for one in values:
            items = one.items if isinstance(one, Items) else ()
            if place < 0 and items:
                found += self.all_of(items)
            elif 0 <= place < len(items):
                found += self.item(items[place])
            elif place == 0 and isinstance(one, Made) and one.name.endswith(PARSED):
                found.append(one)
            else:
                found.append(one if isinstance(one, Open) else Open(why))
        return union(found)

    def _argument(self, name: str, frame: Frame) -> Values:
        scope = frame.scope
        if name == scope.own_name and scope.of_class is not None:
            if "classmethod" in scope.decorators:
                return (ClassValue(frame.me.scope if frame.me else scope.of_class),)
            return (frame.me or Instance(scope.of_class),)
        runs = [frame.run] if frame.run else self.callers(scope, frame.me)
        values: list[Value] = []
        for run in runs:
            item = self.bound(scope, run).get(name)
            values += self.item(item) if item is not None else self._by_default(name, scope)
        return union(values) if runs else self._by_default(name, scope)

    def _by_default(self, name: str, scope: Scope) -> Values:
        """What an argument is where no caller gives it."""
        default = _default_of(name, scope)
        if default is None:
            return (Open(f"argument {name} of {scope.name}"),)
        above = self.frame_of(scope.above) if scope.above else Frame(scope)
        return self.as_defaults(self.of(default, above))

    def frame_of(self, scope: Scope, me: Instance | None = None) -> Frame:
        """Return a frame of a scope, for any call of it."""
        of_class = scope.of_class
        mine = me if me is not None and of_class is not None and of_class in self.line(me.scope)[0] else None
        return Frame(scope, mine or (Instance(of_class) if of_class is not None else None))

    def _imported(self, name: str, read: PythonFile) -> Values:
        values: list[Value] = []
        for meant in read.names.get(name, ()):
            values += self._import(meant, read)
        if not values and name not in read.names:
            values += self._of_all(name, read)
        return tuple(values)

    def _of_all(self, name: str, first: PythonFile) -> Iterator[Value]:
        """What a name is in the modules of which all is imported, each looked at once."""
        waiting = [first]
        seen = {first}
        for read in waiting:
            for module in read.all_of:
                place = self.checkout.module(read, module)
                if place and not place[1] and place[0] not in seen:
                    seen.add(place[0])
                    scope = place[0].scope
                    if name in scope.bindings or name in scope.inner or name in place[0].names:
                        yield from self.of_module(place[0], name)
                    else:
                        waiting.append(place[0])
                elif module.split(".")[1:2] in (["msg"], ["srv"], ["action"]):
                    yield Library(f"{module}.{name}")

    def _import(self, dotted_name: str, read: PythonFile) -> Values:
        place = self.checkout.module(read, dotted_name)
        if place is None:
            return (Library(dotted_name),)
        values: Values = (ModuleValue(place[0]),)
        for part in place[1]:
            values = tuple(got for one in values for got in self.attribute(one, part))
        known = [one for one in values if not isinstance(one, Open)]
        return tuple(known) or (Library(dotted_name),)

    def of_module(self, read: PythonFile, name: str) -> Values:
        """Return what a name of a module can be."""
        if (read, name) in self._modules_active:  # modules that import from each other
            return ()
        self._modules_active.add((read, name))
        values = self.variable(name, None, Frame(read.scope))
        self._modules_active.discard((read, name))
        return values

    # attributes

    def attribute(self, value: Value, name: str, at: ast.AST | None = None, frame: Frame | None = None) -> Values:  # noqa: PLR0911 - a case each
        """Return what an attribute of a value can be."""
        if isinstance(value, ModuleValue):
            return self.of_module(value.file, name) or self._submodule(value.file, name) or (Open(f"{name}"),)
        if isinstance(value, Library):
            return (Library(f"{value.name}.{name}"),)
        if isinstance(value, Instance):
            return self.member(value, name, at, frame)
        if isinstance(value, ClassValue):
            return self.member(Instance(value.scope), name, of_class=True)
        if isinstance(value, Setting) and (name == "value" or name.endswith("_value")):
            return self.value_of(value)
        if isinstance(value, Text) and name == "value":  # of an enumeration
            return (value,)
        if isinstance(value, Made):
            if value.name.startswith("argparse.") and value.name.endswith(PARSED):
                return self.option(value, name)
            return (Made(f"{value.name}.{name}", value.run),)
        if value == Plain(None):  # code that would fail
            return ()
        return (value if isinstance(value, Open) else Open(f".{name}"),)

    def value_of(self, setting: Setting) -> Values:
        """Return what the value of a parameter can be."""
        listed = [one for one in setting.values if isinstance(one, Items)]
        if listed:
            return self._defaults_of(listed)
        return tuple(Text(one) for one in self.setting(setting))

    def _defaults_of(self, listed: Sequence[Items]) -> Values:
        return tuple(Items(tuple(self.as_defaults(self.item(item)) for item in one.items[:ITEMS])) for one in listed)

    def _submodule(self, read: PythonFile, name: str) -> Values:
        place = self.checkout.module(read, f".{name}")
        return (ModuleValue(place[0]),) if place and not place[1] else ()

    def line(self, scope: Scope) -> tuple[tuple[Scope, ...], tuple[str, ...]]:
        """Return a class with those it is derived of, from the nearest, and the libraries' classes among these."""
        order = self.order(scope)
        return tuple(one for one in order if isinstance(one, Scope)), tuple(
            one for one in order if isinstance(one, str)
        )

    def order(self, scope: Scope) -> tuple[Scope | str, ...]:
        """Return the classes that an attribute is looked for in, one after the other, those of libraries by name."""
        waiting = [] if scope in self._lines else [scope]
        bases: dict[Scope, list[Scope | str]] = {}
        while waiting:
            one = waiting.pop()
            if one in bases:
                every_one: list[Scope | str] = [one]
                for base in bases.pop(one):
                    every_one += self._lines[base] if isinstance(base, Scope) else (base,)
                last = dict.fromkeys(reversed(every_one))  # a base of two comes after both
                self._lines[one] = tuple(reversed(last))[:LONGEST_LINE]
            elif one not in self._lines:
                self._lines[one] = (one,)  # while it is looked for
                bases[one] = self._bases(one)
                above = [base for base in bases[one] if isinstance(base, Scope) and base not in self._lines]
                waiting += [one, *above]
        return self._lines[scope]

    def _bases(self, scope: Scope) -> list[Scope | str]:
        frame = self.frame_of(scope.above) if scope.above else Frame(scope)
        found: list[Scope | str] = []
        for base in getattr(scope.node, "bases", ()):
            for one in self.of(base, frame):
                if isinstance(one, ClassValue):
                    found.append(one.scope)
                elif isinstance(one, Library) and one.name not in NO_BASES:
                    found.append(one.name)
        return found

    def method(self, scope: Scope, name: str) -> Scope | None:
        """Return the function that a class has under a name."""
        return next((one.inner[name] for one in self.line(scope)[0] if name in one.inner), None)

    def member(
        self, me: Instance, name: str, at: ast.AST | None = None, frame: Frame | None = None, *, of_class: bool = False
    ) -> Values:
        """Return what an attribute of an object, or of a class, can be."""
        classes, libraries = self.line(me.scope)
        bindings = [] if of_class else [one for cls in classes for one in cls.attributes.get(name, ())]
        here = [one for one in bindings if frame is not None and one.scope is frame.scope]
        if here and frame is not None and me == frame.me:
            selected, start = reaching(here, at, frame.scope)
            if not start:
                return self.bindings(selected, frame)
        values: Values = ()
        if bindings:
            ordered = [(one, False) for one in bindings]
            wholes = [one for one in ordered if one[0].sort not in (ADDED, MEMBER)]
            rest = [one for one in ordered if one[0].sort in (ADDED, MEMBER)]
            base = self._of_class(classes, name, me) if not wholes else ()
            values = self.bindings([*wholes, *rest], Frame(me.scope, me), base)
        if values and not all(is_false(one) for one in values):
            return values
        values = union([*values, *self._of_class(classes, name, me)])
        field = self._field(me, classes, name)
        if field:
            return field
        if values or not libraries:
            return values or (Open(f"attribute {name}"),)
        return (Library(f"{libraries[0]}.{name}") if of_class else Inherited(me, name),)

    def _of_class(self, classes: Sequence[Scope], name: str, me: Instance) -> Values:
        """What stands in the class itself, or is a method of it."""
        for cls in classes:
            if name in cls.inner:
                inner = cls.inner[name]
                if isinstance(inner.node, ast.ClassDef):
                    return (ClassValue(inner),)
                if inner.decorators & {"property", "cached_property"}:
                    return self.returned(inner, me, None)
                return (FunctionValue(inner, me),)
            if name in cls.bindings:
                return self.bindings([(one, False) for one in cls.bindings[name]], Frame(cls))
        return ()

    def _field(self, me: Instance, classes: Sequence[Scope], name: str) -> Values:
        """What a call that makes an object gives a field of it, where the class writes no constructor."""
        if me.origin is None or self.method(me.scope, "__init__") is not None:
            return ()
        call = me.origin.call
        fields = [
            one.target.id
            for cls in reversed(classes)
            for one in getattr(cls.node, "body", ())
            if isinstance(one, ast.AnnAssign) and isinstance(one.target, ast.Name)
        ]
        given = next((one.value for one in call.keywords if one.arg == name), None)
        if given is None and name in fields and fields.index(name) < len(call.args):
            given = call.args[fields.index(name)]
        return self.of(given, me.origin.frame) if given is not None else ()

    def returned(self, function: Scope, me: Instance | None, run: Run | None) -> Values:
        """Return what a function returns."""
        frame = Frame(function, me, run)
        values = union(one for node in function.returns for one in self.of(node, frame))
        return values or (Plain(None),)


def outer_frame(scope: Scope, frame: Frame) -> Frame:
    """Return a frame of what a function stands in."""
    return Frame(scope, frame.me if scope.of_class is frame.scope.of_class else None)


def _argument_names(arguments: ast.arguments) -> Iterator[str]:
    yield from (one.arg for one in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs))
    yield from (one.arg for one in (arguments.vararg, arguments.kwarg) if one)


def _default_of(name: str, scope: Scope) -> ast.expr | None:
    given = scope.arguments
    if given is None:
        return None
    listed = [*given.posonlyargs, *given.args]
    pairs = [*zip(reversed(listed), reversed(given.defaults), strict=False)]
    pairs += [(one, value) for one, value in zip(given.kwonlyargs, given.kw_defaults, strict=True) if value is not None]
    return next((value for one, value in pairs if one.arg == name), None)
