"""What expressions of a launch file in Python come to, as far as constants fix it; nothing of it is run.

In: a syntax tree. Out: values of Python (texts, numbers, lists, maps), and those of ``launch_values.py`` where a part
stays open. Of a condition that is open both branches are followed; a list that several branches fill holds what each of
them puts there. Loops over lists are followed item by item; a loop over what is open is followed once. How deep
and how long it goes is bounded, since the code may be anybody's.
"""

from __future__ import annotations

import ast
import operator
from collections import ChainMap
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import cut
from rosprivacy.ingest.scan.launch.launch_actions import Action
from rosprivacy.ingest.scan.launch.launch_values import CHECKOUT, LONGEST, Choice, Open, Perhaps, Substitution, choice
from rosprivacy.ingest.scan.launch.python_built_ins import (
    BUILTINS,
    KEEPING,
    MOST_ITEMS,
    NO_TEXTS,
    PATHS,
    TEXT_METHODS,
    Call,
    built_in,
    formatted,
    is_key,
    is_plain,
    joined,
    of_map,
    of_text,
    path_by,
    text_of,
    truth,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

DEEPEST = 60  # expressions in expressions, statements in statements and calls of functions
MOST_BITS = 128  # of a number
LONGEST_SHOWN = 60  # characters of an expression
Scope = ChainMap[str, object]
DERIVED = "class of "  # begins the name of a class of the code by the class that it is derived from
CONFIGURATIONS = "launch_configurations"  # of a context
RETURN, RAISE, LOOP = "return", "raise", "loop"  # how a block ends before its end
_OPERATORS: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv, ast.Mod: operator.mod,
    ast.Eq: operator.eq, ast.NotEq: operator.ne, ast.Lt: operator.lt, ast.LtE: operator.le,
    ast.Gt: operator.gt, ast.GtE: operator.ge,
}  # fmt: skip


class Reference(NamedTuple):
    """Something that is imported, or built in."""

    name: str


class Function(NamedTuple):
    """A function of the code, with what it sees."""

    node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
    module: Evaluation
    scope: Scope


class Method(NamedTuple):
    """An attribute of a value, which is called or looked at."""

    owner: object
    name: str


class Evaluation:
    """Follows one module.

    Parameters
    ----------
    call
        What a call of something imported comes to.
    imported
        The value of a name that is imported, where it is one of the checkout; otherwise None.
    spend
        Called for every step; ends what takes too long.
    text
        Of the module, to show pieces of it.
    """

    def __init__(
        self,
        file: str,
        call: Callable[[Evaluation, Call], object],
        imported: Callable[[Evaluation, str], object],
        spend: Callable[[], None],
        text: str = "",
    ) -> None:
        self.file = file
        self._lines = text.splitlines()
        self.spend = spend
        self.scope: Scope = ChainMap({})
        self.conditions = 0  # that are open, around what is followed now
        self._call = call
        self._imported = imported
        self._all_of: list[str] = []  # modules of which all names are imported
        self._depth = 0
        self._outside = 0  # conditions around the function that is followed now

    def block(self, body: Sequence[ast.stmt], scope: Scope, returned: list[object]) -> str:
        """Follow some statements; return how they end, empty where they end at their end."""
        self._depth += 1
        end = ""
        for statement in body:
            self.spend()
            end = self._statement(statement, scope, returned) if self._depth < DEEPEST else RAISE
            if end:
                break
        self._depth -= 1
        return end

    def _statement(self, node: ast.stmt, scope: Scope, returned: list[object]) -> str:  # noqa: PLR0911, PLR0912 - one for each kind
        match node:
            case ast.Expr():
                self.value(node.value, scope)
            case ast.Assign():
                value = self.value(node.value, scope)
                for target in node.targets:
                    self._assign(target, value, scope)
            case ast.AnnAssign():
                if node.value:
                    self._assign(node.target, self.value(node.value, scope), scope)
            case ast.AugAssign():
                self._add_to(node, scope)
            case ast.Return():
                value = self.value(node.value, scope) if node.value else None
                returned.append(Perhaps(value) if self.conditions > self._outside else value)
                return RETURN
            case ast.Raise():
                return RAISE
            case ast.Continue() | ast.Break():
                return LOOP
            case ast.If():
                holds = truth(self.value(node.test, scope))
                if holds is not None:
                    return self.block(node.body if holds else node.orelse, scope, returned)
                return self._fork([node.body, node.orelse], scope, returned, node.lineno)
            case ast.For() | ast.AsyncFor():
                return self._loop(node, scope, returned)
            case ast.While():
                for inner in ast.walk(node):
                    if isinstance(inner, ast.AugAssign) and isinstance(inner.target, ast.Name):
                        scope[inner.target.id] = Open(f"{inner.target.id} in a loop")
                self._fork([node.body, []], scope, returned, node.lineno)
            case ast.With() | ast.AsyncWith():
                for item in node.items:
                    value = self.value(item.context_expr, scope)
                    if item.optional_vars:
                        self._assign(item.optional_vars, value, scope)
                return self.block(node.body, scope, returned)
            case ast.Try():
                return self._tried(node, scope, returned)
            case ast.Match():
                return self._fork([*(case.body for case in node.cases), []], scope, returned, node.lineno)
            case ast.FunctionDef() | ast.AsyncFunctionDef():
                scope[node.name] = Function(node, self, scope)
            case ast.ClassDef():
                base = self.value(node.bases[0], scope) if node.bases else None
                derived = Reference(f"{DERIVED}{base.name}") if isinstance(base, Reference) else None
                scope[node.name] = derived or Open(f"the class {node.name}")
            case ast.Import():
                for name in node.names:
                    whole = name.name if name.asname else name.name.partition(".")[0]
                    scope[name.asname or whole] = Reference(whole)
            case ast.ImportFrom():
                for name in node.names:
                    whole = ".".join(filter(None, ["." * node.level + (node.module or ""), name.name]))
                    if name.name == "*":
                        self._all_of.append(whole.removesuffix(".*"))
                        continue
                    local = self._imported(self, whole)
                    scope[name.asname or name.name] = Reference(whole) if local is None else local
        return ""

    def _perhaps(self, value: object) -> object:
        return Perhaps(value) if self.conditions else value

    def _fork(self, branches: Sequence[Sequence[ast.stmt]], scope: Scope, returned: list[object], line: int) -> str:
        """Follow several branches of which one is taken; what they assign becomes a choice."""
        mine = scope.maps[0]
        before = dict(mine)
        conditions = self.conditions
        outcomes, ends = [], []
        for branch in branches:
            mine.clear()
            mine.update(before)
            self.conditions = conditions + 1
            ends.append(self.block(branch, scope, returned))
            outcomes.append(dict(mine))
            for _ in mine:
                self.spend()
        alive = [outcome for outcome, end in zip(outcomes, ends, strict=True) if not end]
        mine.clear()
        mine.update(before)
        for name in dict.fromkeys(name for outcome in alive for name in outcome):
            mine[name] = choice([outcome[name] for outcome in alive if name in outcome], f"{self.file}:{line}")
        self.conditions = conditions + (RETURN in ends or LOOP in ends)  # what follows is done in the other branches
        return "" if alive else next((end for end in ends if end != RAISE), RAISE)

    def _tried(self, node: ast.Try, scope: Scope, returned: list[object]) -> str:
        end = self.block([*node.body, *node.orelse], scope, returned)
        handlers = [one.body for one in node.handlers]
        conditions = self.conditions
        other = self._fork(handlers if end else [[], *handlers], scope, returned, node.lineno) if handlers else end
        self.conditions = conditions + bool(end and not other)  # what follows is done by a handler's way alone
        return self.block(node.finalbody, scope, returned) or other

    def _loop(self, node: ast.For | ast.AsyncFor, scope: Scope, returned: list[object]) -> str:
        conditions = self.conditions
        for item, sure in self._items(self.value(node.iter, scope)):
            self.conditions = conditions + (not sure)
            self._assign(node.target, item, scope)
            end = self.block(node.body, scope, returned)
            if end in (RETURN, RAISE) and sure:
                self.conditions = conditions
                return end
        self.conditions = conditions
        return self.block(node.orelse, scope, returned)

    def _items(self, value: object) -> Iterator[tuple[object, bool]]:
        """The items of a value, and whether each is surely there."""
        if isinstance(value, list):
            for item in list(value):
                yield (item.value, False) if isinstance(item, Perhaps) else (item, True)
        elif isinstance(value, dict):
            yield from ((key, True) for key in list(value))
        elif isinstance(value, str):
            yield from ((sign, True) for sign in value)
        elif isinstance(value, Choice):
            for option in value.options:
                if isinstance(option, list):
                    yield from ((item, False) for item, _ in self._items(option))
                else:
                    yield Open("an item of a list that is not known"), False
        else:
            yield Open(value.why if isinstance(value, Open) else "an item of a list that is not known"), False

    def _assign(self, target: ast.expr, value: object, scope: Scope) -> None:
        if isinstance(target, ast.Name):
            scope[target.id] = value
        elif isinstance(target, ast.Tuple | ast.List):
            known = isinstance(value, list) and len(value) == len(target.elts)
            for number, one in enumerate(target.elts):
                self._assign(one, value[number] if known else Open(self._shown(one)), scope)  # type: ignore[index]
        elif isinstance(target, ast.Subscript):
            owner, key = self.value(target.value, scope), self.value(target.slice, scope)
            if isinstance(owner, dict) and isinstance(key, str | int) and len(owner) < MOST_ITEMS:
                old = owner.get(key)
                both = self.conditions and old is not None
                owner[key] = choice([old, value], f"{self.file}:{target.lineno}") if both else value
            elif isinstance(owner, dict) and len(owner) < MOST_ITEMS:
                owner[Open(self._shown(target.slice))] = value
            elif isinstance(owner, Reference) and owner.name == "os.environ":
                self._call(self, Call("os.environ.__setitem__", self.file, target.lineno, [key, value], {}))
            elif isinstance(owner, list) and isinstance(key, int) and -len(owner) <= key < len(owner):
                owner[key] = value

    def _add_to(self, node: ast.AugAssign, scope: Scope) -> None:
        value = self.value(node.value, scope)
        if isinstance(node.target, ast.Name):
            old = scope.get(node.target.id)
            if isinstance(old, list) and isinstance(node.op, ast.Add):
                self._extend(old, value)
            else:
                scope[node.target.id] = self._operated(node.op, old, value)

    def _extend(self, items: list[object], value: object) -> None:
        inner = value.options if isinstance(value, Choice) else (value,)
        for one in inner:
            added = one[:MOST_ITEMS] if isinstance(one, list) else [one]
            perhaps = self.conditions or len(inner) > 1
            items += [Perhaps(item) if perhaps else item for item in added]
        if len(items) > MOST_ITEMS:
            items[MOST_ITEMS:] = [Open(f"more than {MOST_ITEMS} items")]

    def value(self, node: ast.expr, scope: Scope) -> object:
        """Return what an expression comes to."""
        self.spend()
        if self._depth > DEEPEST:
            return Open("an expression that is nested too deeply")
        self._depth += 1
        value = self._expression(node, scope)
        self._depth -= 1
        if isinstance(value, str) and len(value) > LONGEST:
            return Open("a text that is too long")
        if isinstance(value, list) and len(value) > MOST_ITEMS:
            return [*value[:MOST_ITEMS], Open(f"more than {MOST_ITEMS} items")]
        return value

    def _expression(self, node: ast.expr, scope: Scope) -> object:  # noqa: PLR0911, PLR0912 - one for each kind
        match node:
            case ast.Constant():
                huge = isinstance(node.value, int) and node.value.bit_length() > MOST_BITS
                return node.value if is_plain(node.value) and not huge else Open("a constant")
            case ast.Name():
                return self._name(node.id, scope)
            case ast.Attribute():
                return self._attribute(self.value(node.value, scope), node.attr)
            case ast.Call():
                return self._call_of(node, scope)
            case ast.List() | ast.Tuple() | ast.Set():
                return self._listed(node.elts, scope)
            case ast.Dict():
                return self._mapped(node, scope)
            case ast.JoinedStr():
                return text_of([self.value(part, scope) for part in node.values])
            case ast.FormattedValue():
                return self.value(node.value, scope)
            case ast.BinOp():
                return self._binary(node, scope)
            case ast.BoolOp():
                return self._either(node, scope)
            case ast.UnaryOp():
                inner = self.value(node.operand, scope)
                if isinstance(node.op, ast.Not):
                    holds = truth(inner)
                    return Open(self._shown(node)) if holds is None else not holds
                return -inner if isinstance(node.op, ast.USub) and isinstance(inner, int | float) else Open("a number")
            case ast.Compare():
                return self._compared(node, scope)
            case ast.IfExp():
                holds = truth(self.value(node.test, scope))
                if holds is not None:
                    return self.value(node.body if holds else node.orelse, scope)
                both = [self.value(node.body, scope), self.value(node.orelse, scope)]
                return choice(both, f"{self.file}:{node.lineno}:{node.col_offset}")
            case ast.Subscript():
                return self._item(self.value(node.value, scope), node, scope)
            case ast.ListComp() | ast.SetComp() | ast.GeneratorExp():
                made: list[object] = []
                self._comprehended(
                    node.generators,
                    scope.new_child(),
                    lambda inner: made.append(self._perhaps(self.value(node.elt, inner))),
                )
                return made
            case ast.DictComp():
                entries: dict[object, object] = {}

                def enter(inner: Scope) -> None:
                    key = self.value(node.key, inner)
                    if isinstance(key, str | int) and len(entries) < MOST_ITEMS:
                        entries[key] = self.value(node.value, inner)

                self._comprehended(node.generators, scope.new_child(), enter)
                return entries
            case ast.Lambda():
                return Function(node, self, scope)
            case ast.NamedExpr():
                value = self.value(node.value, scope)
                self._assign(node.target, value, scope)
                return value
            case ast.Starred():
                return self.value(node.value, scope)
        return Open(self._shown(node))

    def _shown(self, node: ast.expr) -> str:
        """The beginning of an expression, for people."""
        if node.lineno > len(self._lines):
            return f"line {node.lineno}"
        end = node.end_col_offset if node.end_lineno == node.lineno else None
        piece = self._lines[node.lineno - 1].encode()[node.col_offset : end].decode("utf-8", "replace")
        return shown(cut(piece, LONGEST_SHOWN))

    def _name(self, name: str, scope: Scope) -> object:
        if name in scope:
            return scope[name]
        if name == "__file__":
            return CHECKOUT + self.file
        if name in BUILTINS:
            return Reference(name)
        for module in self._all_of:
            if (local := self._imported(self, f"{module}.{name}")) is not None:
                return local
        if self._all_of:
            return Reference(f"{self._all_of[-1]}.{name}")
        return Open(name)

    def _attribute(self, owner: object, name: str) -> object:
        if isinstance(owner, Reference):
            local = self._imported(self, f"{owner.name}.{name}")
            return Reference(f"{owner.name}.{name}") if local is None else local
        if name == CONFIGURATIONS:
            return Reference(name)
        if name == "read_text" and isinstance(owner, str | Substitution):
            return Method(Substitution("contents", (owner,)), "read")
        if name == "parent" and isinstance(owner, str | Substitution):
            return Substitution("folder", (owner,))
        return Method(owner, name)

    def _listed(self, nodes: Sequence[ast.expr], scope: Scope) -> list[object]:
        made: list[object] = []
        for node in nodes:
            value = self.value(node, scope)
            if isinstance(node, ast.Starred):
                made += value if isinstance(value, list) else [value]
            else:
                made.append(value)
        return made

    def _mapped(self, node: ast.Dict, scope: Scope) -> dict[object, object]:
        made: dict[object, object] = {}
        for key_node, value_node in zip(node.keys, node.values, strict=True):
            value = self.value(value_node, scope)
            if key_node is None:
                made.update(value if isinstance(value, dict) else {Open(self._shown(value_node)): value})
                continue
            key = self.value(key_node, scope)
            made[key if is_key(key) else Open(self._shown(key_node))] = value
        return made

    def _binary(self, node: ast.BinOp, scope: Scope) -> object:
        chain: list[ast.BinOp] = []
        rest: ast.expr = node
        while isinstance(rest, ast.BinOp):  # a + b + c + … without recursion
            chain.append(rest)
            rest = rest.left
        value = self.value(rest, scope)
        for link in reversed(chain):
            value = self._operated(link.op, value, self.value(link.right, scope))
        return value

    def _operated(self, sign: ast.operator, first: object, second: object) -> object:  # noqa: PLR0911 - one for each type
        if isinstance(sign, ast.Add) and isinstance(first, list):
            whole = list(first)
            self._extend_unconditionally(whole, second)
            return whole
        if (
            isinstance(sign, ast.Add)
            and isinstance(first, Choice)
            and all(isinstance(one, list) for one in first.options)
        ):
            return Choice(tuple(self._operated(sign, one, second) for one in first.options), first.chooser)
        if isinstance(sign, ast.BitOr) and isinstance(first, dict) and isinstance(second, dict):
            return {**first, **second}
        if isinstance(sign, ast.Div) and not isinstance(first, int | float):
            return joined([first, second])
        if isinstance(sign, ast.Mod) and isinstance(first, str):
            return formatted(first, second if isinstance(second, list) else [second])
        if isinstance(sign, ast.Add) and not (isinstance(first, int | float) and isinstance(second, int | float)):
            return text_of([first, second])
        numbers = isinstance(first, int | float) and isinstance(second, int | float)
        how = _OPERATORS.get(type(sign))
        if how and numbers and max(abs(first), abs(second)) < 10**9:  # type: ignore[arg-type]
            try:
                return how(first, second)
            except ArithmeticError:
                pass
        return Open("a calculation")

    def _extend_unconditionally(self, items: list[object], value: object) -> None:
        conditions, self.conditions = self.conditions, 0
        self._extend(items, value)
        self.conditions = conditions

    def _either(self, node: ast.BoolOp, scope: Scope) -> object:
        """``a or b`` and ``a and b``."""
        stops = isinstance(node.op, ast.Or)
        values: list[object] = []
        for one in node.values:
            value = self.value(one, scope)
            holds = truth(value)
            if holds is stops:
                return choice([*values, value], f"{self.file}:{node.lineno}:{node.col_offset}")
            if holds is None:
                values.append(value)
        return choice([*values, value], f"{self.file}:{node.lineno}:{node.col_offset}")

    def _compared(self, node: ast.Compare, scope: Scope) -> object:
        left, right = self.value(node.left, scope), self.value(node.comparators[0], scope)
        sign = node.ops[0]
        if len(node.ops) > 1:
            return Open("a comparison")
        if isinstance(sign, ast.Is | ast.IsNot) and right is None:
            plain = left is None or isinstance(left, str | int | float | list | dict)
            return ((left is None) == isinstance(sign, ast.Is)) if plain else Open("a comparison")
        if (
            isinstance(sign, ast.In | ast.NotIn)
            and isinstance(left, str | int)
            and isinstance(right, list | dict | str)
        ):
            inside = [item for item in right if item == left] or (isinstance(right, str) and str(left) in right)
            plain = isinstance(right, str) or all(isinstance(item, str | int | float) for item in right)
            return (bool(inside) == isinstance(sign, ast.In)) if plain else Open("a comparison")
        how = _OPERATORS.get(type(sign))
        alike = isinstance(left, str) and isinstance(right, str)
        numbers = isinstance(left, int | float) and isinstance(right, int | float)
        if how and (alike or numbers or isinstance(sign, ast.Eq | ast.NotEq)) and is_plain(left) and is_plain(right):
            return bool(how(left, right))
        return Open("a comparison")

    def _item(self, owner: object, node: ast.Subscript, scope: Scope) -> object:  # noqa: PLR0911 - one for each type
        if isinstance(node.slice, ast.Slice):
            ends = [self.value(end, scope) if end else None for end in (node.slice.lower, node.slice.upper)]
            bounds = [end for end in ends if end is None or isinstance(end, int)]
            if isinstance(owner, list | str) and len(bounds) == len(ends) and node.slice.step is None:
                return owner[slice(*bounds)]
            return Open(self._shown(node))
        key = self.value(node.slice, scope)
        if isinstance(owner, dict) and isinstance(key, str | int | float) and key in owner:
            return owner[key]
        if isinstance(owner, dict) and owner and not is_plain(key):
            return choice(owner.values(), f"{self.file}:{node.lineno}:{node.col_offset}")
        if isinstance(owner, list | str) and isinstance(key, int) and -len(owner) <= key < len(owner):
            return owner[key]
        if isinstance(owner, list) and owner and not is_plain(key):
            return choice(owner, f"{self.file}:{node.lineno}:{node.col_offset}")
        if isinstance(owner, Choice):
            inner = [one[key] for one in owner.options if isinstance(one, dict) and is_plain(key) and key in one]
            return Choice(tuple(inner), owner.chooser) if len(inner) == len(owner.options) else Open(self._shown(node))
        if isinstance(owner, Reference) and owner.name in ("os.environ", CONFIGURATIONS):
            return Substitution("configuration" if owner.name == CONFIGURATIONS else "environment", (key,))
        return Open(self._shown(node))

    def _comprehended(self, loops: Sequence[ast.comprehension], scope: Scope, enter: Callable[[Scope], None]) -> None:
        if not loops:
            enter(scope)
            return
        conditions = self.conditions
        for item, sure in self._items(self.value(loops[0].iter, scope)):
            self.spend()
            self._assign(loops[0].target, item, scope)
            tests = [truth(self.value(test, scope)) for test in loops[0].ifs]
            if False in tests:
                continue
            self.conditions = conditions + (not sure or None in tests)
            self._comprehended(loops[1:], scope, enter)
        self.conditions = conditions

    def _call_of(self, node: ast.Call, scope: Scope) -> object:
        function = self.value(node.func, scope)
        positional = self._listed(node.args, scope)
        keywords: dict[str, object] = {}
        for keyword in node.keywords:
            value = self.value(keyword.value, scope)
            if keyword.arg:
                keywords[keyword.arg] = value
            elif isinstance(value, dict):
                keywords.update({key: one for key, one in value.items() if isinstance(key, str)})
        call = Call(
            function.name if isinstance(function, Reference) else "", self.file, node.lineno, positional, keywords
        )
        if isinstance(function, Function):
            return function.module.entered(function, call)
        if isinstance(function, Method):
            return self._method(function, call)
        if isinstance(function, Reference):
            return built_in(call) if call.name in BUILTINS else self._call(self, call)
        return self._call(self, call._replace(name="?" + self._shown(node.func)))

    def entered(self, function: Function, call: Call) -> object:
        """Follow a call of a function of this module; return what it may return."""
        if self._depth > DEEPEST // 2:
            return Open("functions that call each other too deeply")
        inner = function.scope.new_child()
        arguments = function.node.args
        names = [one.arg for one in (*arguments.posonlyargs, *arguments.args)]
        defaults = dict(zip(reversed(names), reversed(arguments.defaults), strict=False))
        defaults |= {
            one.arg: value for one, value in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True) if value
        }
        for name in (*names, *(one.arg for one in arguments.kwonlyargs)):
            inner[name] = self.value(defaults[name], function.scope) if name in defaults else Open(name)
        inner.update(zip(names, call.positional, strict=False))
        known = {key: value for key, value in call.keywords.items() if key in inner.maps[0]}
        inner.update(known)
        if arguments.vararg:
            inner[arguments.vararg.arg] = call.positional[len(names) :]
        if arguments.kwarg:
            inner[arguments.kwarg.arg] = {key: one for key, one in call.keywords.items() if key not in known}
        if isinstance(function.node, ast.Lambda):
            return self.value(function.node.body, inner)
        conditions, outside = self.conditions, self._outside
        self._outside = conditions
        returned: list[object] = []
        self._depth += 1
        self.block(function.node.body, inner, returned)
        self._depth -= 1
        self.conditions, self._outside = conditions, outside
        line = f"{self.file}:{function.node.lineno}"
        if len(returned) == 1 and isinstance(returned[0], Perhaps) and isinstance(returned[0].value, list):
            return [Perhaps(item) for item in returned[0].value]
        return choice([one.value if isinstance(one, Perhaps) else one for one in returned], line) if returned else None

    def _method(self, method: Method, call: Call) -> object:  # noqa: PLR0911 - one for each type
        owner, name, arguments = method.owner, method.name, call.positional
        first = arguments[0] if arguments else None
        if isinstance(owner, Action):
            return self._call(self, call._replace(name=f".{name}", positional=[owner, *arguments]))
        if isinstance(owner, list):
            if name == "append":
                self._extend(owner, [first])
            elif name == "extend":
                self._extend(owner, first)
            elif name == "insert" and len(arguments) > 1:
                self._extend(owner, [arguments[1]])
            return list(owner) if name == "copy" else Open(name)
        if isinstance(owner, dict):
            return of_map(owner, name, call)
        if isinstance(owner, str):
            return of_text(owner, name, call)
        if isinstance(owner, Substitution | Choice | Open):
            if name in KEEPING:
                return owner
            if name in PATHS:
                return path_by(name, owner, arguments)
            if isinstance(owner, Substitution) and name in TEXT_METHODS - NO_TEXTS and all(map(is_plain, arguments)):
                return Substitution("method", (owner, name, *arguments))
            if isinstance(owner, Choice) and name in ("format", *TEXT_METHODS):
                options = [of_text(one, name, call) if isinstance(one, str) else Open(name) for one in owner.options]
                return Choice(tuple(options), owner.chooser)
        return self._call(self, call._replace(name=f"?{name}"))
