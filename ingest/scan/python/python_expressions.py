"""What an expression of Python code can be, by what its parts can be: texts, numbers, lists, conditions."""

from __future__ import annotations

import ast
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

from rosprivacy.ingest.scan.python.python_texts import (
    MANY,
    Texts,
    every,
    literal,
    literal_format,
    percent,
)
from rosprivacy.ingest.scan.python.python_value_types import (
    Frame,
    FunctionValue,
    Inherited,
    Item,
    Items,
    Library,
    Made,
    Open,
    Pairs,
    Place,
    Plain,
    Setting,
    Text,
    Value,
    Values,
    computed,
    constant,
    is_false,
    number,
    union,
    written,
)
from rosprivacy.ingest.scan.scan_facts import (
    DEFAULT,
    GUESSED,
    Name,
    NamePiece,
    as_default,
    open_name,
    plain_text,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

ITEMS = 2000  # of a list


class PythonExpressions(ABC):
    """Looks at expressions; what names, attributes and calls give is told by who derives of it."""

    call_values: Callable[[ast.Call, Frame], Values]

    @abstractmethod
    def of(self, expression: ast.expr, frame: Frame) -> Values:
        """Return what an expression can be; each is looked at once."""

    @abstractmethod
    def name(self, node: ast.Name, frame: Frame) -> Values:
        """Return what a name can be."""

    @abstractmethod
    def attribute(self, value: Value, name: str, at: ast.AST | None = None, frame: Frame | None = None) -> Values:
        """Return what an attribute of a value can be."""

    def item(self, item: Item) -> Values:
        """Return what an item can be."""
        return self.of(item.expression, item.frame) if isinstance(item, Place) else item

    def texts(self, values: Values, of: str = "") -> Texts:
        """Return values as texts; what is none is open.

        Parameters
        ----------
        of
            What they are the values of, for people.
        """
        found: list[Name] = []
        for one in values:
            if isinstance(one, Text):
                found.append(one.pieces)
            elif isinstance(one, Plain):
                found.append(literal(str(one.value)))
            elif isinstance(one, Setting):
                found += self.setting(one)
            else:
                why = f"attribute {one.name}" if isinstance(one, Inherited) else of
                found.append(open_name(one.why if isinstance(one, Open) else why or "a value that is no text"))
        return tuple(dict.fromkeys(found))

    def setting(self, setting: Setting) -> Texts:
        """Return what a parameter can be, as texts."""
        if not setting.values:
            return ((NamePiece(None, GUESSED, setting.name, f"parameter {setting.name}, which has no default"),),)
        found: list[Name] = []
        for text in self.texts(setting.values):
            known = [one.text for one in text if one.text is not None]
            whole = len(known) == len(text)
            why = next((one.why for one in text if one.text is None), "")
            piece = NamePiece("".join(known), DEFAULT, setting.name) if whole else None
            found.append((piece or NamePiece(None, GUESSED, setting.name, f"parameter {setting.name}: {why}"),))
        return tuple(dict.fromkeys(found))

    def read(self, node: ast.expr, frame: Frame) -> Values:  # noqa: PLR0911, PLR0912 - a case each
        """Return what an expression can be, by what its parts can be."""
        if isinstance(node, ast.Constant):
            return (constant(node.value),)
        if isinstance(node, ast.Name):
            return self.name(node, frame)
        if isinstance(node, ast.Attribute):
            return tuple(
                got for one in self.of(node.value, frame) for got in self.attribute(one, node.attr, node, frame)
            )
        if isinstance(node, ast.Call):
            return self.call_values(node, frame)
        if isinstance(node, ast.JoinedStr):
            return tuple(Text(one) for one in every([self._part(one, frame) for one in node.values]))
        if isinstance(node, ast.BinOp):
            return self._computed(node, frame)
        if isinstance(node, ast.IfExp):
            return self._alternatives([self.of(node.body, frame), self.of(node.orelse, frame)])
        if isinstance(node, ast.BoolOp):
            return self._either(node, frame)
        if isinstance(node, ast.List | ast.Tuple | ast.Set):
            return self._items(node.elts, frame)
        if isinstance(node, ast.Dict):
            return self._pairs(node, frame)
        if isinstance(node, ast.Subscript):
            return self._subscript(node, frame)
        if isinstance(node, ast.ListComp | ast.SetComp | ast.GeneratorExp | ast.DictComp):
            return self._comprehension(node, frame)
        if isinstance(node, ast.NamedExpr | ast.Await | ast.Starred | ast.YieldFrom):
            return self.of(node.value, frame)
        if isinstance(node, ast.Lambda):
            return (FunctionValue(frame.scope.file.lambdas[node], frame.me),)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            return tuple(computed(ast.Sub(), Plain(0), one) for one in self.of(node.operand, frame))
        return (Open(written(node)),)

    def _part(self, part: ast.expr, frame: Frame) -> Texts:
        """A part of an f-string."""
        if not isinstance(part, ast.FormattedValue):
            return self.texts(self.of(part, frame), written(part))
        values = self.of(part.value, frame)
        spec = part.format_spec
        parts = spec.values if isinstance(spec, ast.JoinedStr) else []
        form = parts[0].value if len(parts) == 1 and isinstance(parts[0], ast.Constant) else None
        if form and all(isinstance(one, Plain) for one in values):
            return tuple(literal_format(one.value, str(form)) for one in values if isinstance(one, Plain))
        return self.texts(values, written(part.value))

    def _computed(self, node: ast.BinOp, frame: Frame) -> Values:
        if isinstance(node.op, ast.Add):
            return self._sum(node, frame)
        lefts = self.of(node.left, frame)
        if isinstance(node.op, ast.Mod) and any(isinstance(one, Text) for one in lefts):
            return self._percent(node, lefts, frame)
        rights = self.of(node.right, frame)
        if isinstance(node.op, ast.Div) and all(isinstance(one, Made | Text) for one in (*lefts, *rights)):
            parts = [self.texts(lefts, written(node.left)), (literal("/"),), self.texts(rights, written(node.right))]
            return tuple(Text(one) for one in every(parts))  # of pathlib
        if isinstance(node.op, ast.Sub | ast.Mult | ast.FloorDiv | ast.Mod):
            return tuple(computed(node.op, left, right) for left in lefts for right in rights)
        return (Open(written(node)),)

    def _percent(self, node: ast.BinOp, templates: Values, frame: Frame) -> Values:
        """``"/%s/image" % name``."""
        rights = node.right.elts if isinstance(node.right, ast.Tuple) else [node.right]
        places = [self.texts(self.of(one, frame), written(one)) for one in rights]
        names = {
            text: self.texts(self.item(value))
            for one in self.of(node.right, frame)
            if isinstance(one, Pairs)
            for key, value in one.pairs
            for text in self.plain_texts(self.item(key))
        }
        found: list[Value] = []
        for one in templates:
            template = plain_text(one.pieces) if isinstance(one, Text) else None
            made = percent(template, places, names) if template is not None else (open_name(written(node.left)),)
            found += [Text(text) for text in made]
        return tuple(found)

    def plain_texts(self, values: Values) -> list[str]:
        """Return the texts among values that have no open part."""
        return [text for one in values if isinstance(one, Text) and (text := plain_text(one.pieces)) is not None]

    def _sum(self, node: ast.BinOp, frame: Frame) -> Values:
        """``a + b + c``, however long."""
        parts: list[ast.expr] = []
        left: ast.expr = node
        while isinstance(left, ast.BinOp) and isinstance(left.op, ast.Add):
            parts.append(left.right)
            left = left.left
        values = [self.of(one, frame) for one in (left, *reversed(parts))]
        if all(isinstance(one, Items) for some in values for one in some):
            listed = [one for some in values for one in some if isinstance(one, Items)]
            return (Items(tuple(item for one in listed for item in one.items)[:ITEMS]),)
        if all(number(one) is not None for some in values for one in some):
            total: Values = values[0]
            for some in values[1:]:
                total = union(computed(ast.Add(), first, second) for first in total for second in some)
            return total
        texts = [self.texts(some, written(of)) for some, of in zip(values, (left, *reversed(parts)), strict=True)]
        return tuple(Text(one) for one in every(texts))

    def _either(self, node: ast.BoolOp, frame: Frame) -> Values:
        """``a or b``, ``a and b``."""
        if isinstance(node.op, ast.And):
            return self.of(node.values[-1], frame)
        parts = [self.of(one, frame) for one in node.values]
        before = [tuple(one for one in some if not is_false(one)) for some in parts[:-1]]
        return self._alternatives([*before, parts[-1]])

    def _alternatives(self, parts: Sequence[Values]) -> Values:
        """Each alternative; where one is wholly open, the others are what holds by default."""
        is_open = [bool(some) and all(isinstance(one, Open) for one in some) for some in parts]
        return tuple(one for some in parts for one in (self.as_defaults(some) if any(is_open) else some))

    def _items(self, elements: Iterable[ast.expr], frame: Frame) -> Values:
        items: list[Item] = []
        for one in elements:
            if isinstance(one, ast.Starred):
                listed = self.listed(self.of(one.value, frame))
                if listed is None:
                    return (Open(written(one.value)),)
                items += listed
            else:
                items.append(Place(one, frame))
        return (Items(tuple(items[:ITEMS])),)

    def _pairs(self, node: ast.Dict, frame: Frame) -> Values:
        pairs: list[tuple[Item, Item]] = []
        for key, value in zip(node.keys, node.values, strict=True):
            if key is not None:
                pairs.append((Place(key, frame), Place(value, frame)))
                continue
            for one in self.of(value, frame):
                if not isinstance(one, Pairs):
                    return (Open(written(value)),)
                pairs += one.pairs
        return (Pairs(tuple(pairs[:ITEMS])),)

    def _subscript(self, node: ast.Subscript, frame: Frame) -> Values:
        values = self.of(node.value, frame)
        if isinstance(node.slice, ast.Slice):
            return (Open(written(node)),)
        keys = self.of(node.slice, frame)
        found: list[Value] = []
        for one in values:
            if isinstance(one, Items):
                found += self.chosen(one, keys)
            elif isinstance(one, Pairs):
                found += self.looked_up(one, keys)
            elif one != Plain(None):
                found.append(one if isinstance(one, Library) else Open(written(node)))
        return tuple(found)

    def chosen(self, items: Items, keys: Values) -> Values:
        """Return the items that some numbers choose; all where they are not known."""
        numbers = [one.value for one in keys if isinstance(one, Plain) and isinstance(one.value, int)]
        if len(numbers) == len(keys):
            chosen = [items.items[one] for one in numbers if -len(items.items) <= one < len(items.items)]
        else:
            chosen = [*items.items]
        return self.all_of(chosen)

    def looked_up(self, pairs: Pairs, keys: Values) -> Values:
        """Return the values that some keys choose; all where the keys are not known."""
        if all(isinstance(one, Plain | Text) for one in keys):
            chosen = [value for key, value in pairs.pairs if set(self.item(key)) & set(keys)]
            if chosen:
                return self.all_of(chosen)
        return self.all_of([value for _, value in pairs.pairs])

    def all_of(self, items: Sequence[Item]) -> Values:
        """Return what any of some items can be."""
        if len(items) > MANY:
            return (Open(f"more than {MANY} values"),)
        return tuple(one for item in items for one in self.item(item)) or (Open("an empty list"),)

    def listed(self, values: Values) -> list[Item] | None:
        """Return the items that a loop goes over; None where they are not known."""
        items: list[Item] = []
        for one in values:
            if isinstance(one, Items):
                items += one.items
            elif isinstance(one, Pairs):
                items += [key for key, _ in one.pairs]
            elif isinstance(one, Setting) and one.values:
                items += self.listed(one.values) or []
            elif not is_false(one):
                return None
        return items

    def _comprehension(
        self, node: ast.ListComp | ast.SetComp | ast.GeneratorExp | ast.DictComp, frame: Frame
    ) -> Values:
        frames = self.turns([(one, one.iter) for one in node.generators], frame)
        if frames is None:
            return (Open(written(node)),)
        if isinstance(node, ast.DictComp):
            return (Pairs(tuple((Place(node.key, one), Place(node.value, one)) for one in frames)),)
        return (Items(tuple(Place(node.elt, one) for one in frames)),)

    def turns(self, loops: Iterable[tuple[ast.AST, ast.expr]], frame: Frame) -> list[Frame] | None:
        """Return a frame for each turn that loops take, one within the other; None where that is not known."""
        frames = [frame]
        for loop, over in loops:
            inside: list[Frame] = []
            for one in frames:
                listed = self.listed(self.of(over, one))
                if listed is None or len(listed) + len(inside) > ITEMS:
                    return None
                inside += [one._replace(turns=(*one.turns, (loop, item))) for item in listed]
            frames = inside
        return frames

    def as_defaults(self, values: Values) -> Values:
        """Return texts as such that hold unless something else is given."""
        return tuple(Text(as_default(one.pieces)) if isinstance(one, Text) else one for one in values)
