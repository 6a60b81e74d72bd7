"""What an expression of C++ can be: texts that are names, or the object that is a node; every alternative.

In: expressions, the program. Out: ``Value``. What a function's argument is, its callers say; where there are several,
``solutions`` tries each, so that the name, the type and the node of one end come from the same call. Nothing is run;
where the sources fix nothing, there is an open piece with its reason.
"""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, TypeVar

from rosprivacy.ingest.scan.cpp.cpp_expressions import (
    TRANSPARENT,
    Call,
    Choice,
    Construction,
    Expression,
    Item,
    Items,
    Member,
    Open,
    Out,
    Ref,
    Sum,
    Text,
    type_parts,
)
from rosprivacy.ingest.scan.cpp.cpp_frames import (
    Binding,
    Elements,
    Frame,
    Thing,
    TooManySteps,
    Unsettled,
    Value,
    joined,
    text_name,
    unique,
)
from rosprivacy.ingest.scan.cpp.cpp_program import DECLARE, OF_LIBRARIES
from rosprivacy.ingest.scan.cpp.cpp_units import END, Assigned, Function, assigned_name, valued
from rosprivacy.ingest.scan.scan_facts import (
    DEFAULT,
    GUESSED,
    NODE_NAME,
    NODE_SPACE,
    Name,
    NamePiece,
    as_default,
    open_name,
    plain_text,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from rosprivacy.ingest.scan.cpp.cpp_program import CallOf, CppProgram
    from rosprivacy.ingest.scan.cpp.cpp_units import CppClass

    Found = TypeVar("Found")

ALTERNATIVES = 32  # alternatives of a value
STEPS = 2000  # for one solution
TRIALS = 100  # of callers, for one end of a channel
NESTED = 60  # values that are made of each other
DEEP = 8  # functions that call each other
GET = ("get_parameter", "get_parameter_or")
OF_NODE: dict[str, tuple[NamePiece, ...]] = {
    "get_name": (NamePiece(None, DEFAULT, NODE_NAME),),
    "get_fully_qualified_name": (NamePiece("/", DEFAULT, NODE_SPACE), NamePiece(None, DEFAULT, NODE_NAME)),
    "get_namespace": (NamePiece("/", DEFAULT, NODE_SPACE),),
    "get_effective_namespace": (NamePiece("/", DEFAULT, NODE_SPACE),),
}
AN_OBJECT = "an object of"
SIMPLE = frozenset(
    ["string", "auto", "int", "double", "bool", "float", "char", "size_t", "QString", "unsigned", "long"]
)
PAIR = ("first", "second")
FORMATS = ("fmt::format", "std::format")


def solutions(program: CppProgram, task: Callable[[Evaluator], Found]) -> Iterator[Found]:
    """Yield what a task gives for each choice of callers that it hangs on.

    Raises
    ------
    TooManySteps
        If there are too many.
    """
    waiting: list[dict[tuple[object, ...], Binding | None]] = [{}]
    trials = 0
    while waiting:
        settled = waiting.pop()
        trials += 1
        if trials > TRIALS:
            raise TooManySteps
        try:
            result = task(Evaluator(program, settled))
        except Unsettled as hang:
            waiting += [{**settled, hang.key: option} for option in reversed(hang.options)]
        else:
            yield result


class Evaluator:
    """Values, for one choice of callers.

    Parameters
    ----------
    settled
        By frame: what it is called with; None if nobody is known to call it.
    """

    def __init__(self, program: CppProgram, settled: dict[tuple[object, ...], Binding | None]) -> None:
        self.program, self.settled = program, settled
        self.steps = self._deep = 0
        self._running: set[tuple[object, ...]] = set()

    def names(self, value: Expression, frame: Frame, at: int = END) -> list[Name]:
        """Return what a text can be, each alternative once."""
        found = list(dict.fromkeys(self._name(one) for one in self.values(value, frame, at)))
        full = [name for name in found if plain_text(name) != ""]
        found = full or found
        return (
            found
            if len(found) <= ALTERNATIVES
            else [*found[:ALTERNATIVES], open_name(f"more than {ALTERNATIVES} values")]
        )

    def things(self, value: Expression, frame: Frame, at: int = END) -> list[Thing]:
        """Return the objects that a value can be."""
        return [one for one in self.values(value, frame, at) if isinstance(one, Thing)]

    def _name(self, value: Value) -> Name:
        if isinstance(value, Thing):
            return open_name(f"{AN_OBJECT} {value.type or 'a type that is not known'}")
        return open_name("a list of values") if isinstance(value, Elements) else value

    def values(self, value: Expression, frame: Frame, at: int = END) -> list[Value]:
        """Return all that an expression can be.

        Parameters
        ----------
        at
            Byte of the frame's function at which it is used.
        """
        self.steps += 1
        if self.steps > STEPS:
            raise TooManySteps
        if self._deep > NESTED:
            return [open_name("a value that is handed on too often")]
        self._deep += 1
        try:
            return self._values(value, frame, at)[: ALTERNATIVES + 1]
        finally:
            self._deep -= 1

    def _values(self, value: Expression, frame: Frame, at: int) -> list[Value]:
        result: list[Value]
        if isinstance(value, Text):
            result = [text_name(value.text)]
        elif isinstance(value, Open):
            result = [open_name(value.why)]
        elif isinstance(value, Ref):
            result = self._variable(value.name, frame, at)
        elif isinstance(value, Member):
            result = self._member(value, frame, at)
        elif isinstance(value, Call):
            result = self._call(value, frame, at)
        elif isinstance(value, Construction):
            result = self._construction(value, frame, at)
        elif isinstance(value, Sum):
            result = list(self._joined([self.names(part, frame, at) for part in value.parts]))
        elif isinstance(value, Choice):
            result = [one for part in value.parts for one in self.values(part, frame, at)]
        elif isinstance(value, Out):
            result = self._out(value, frame)
        elif isinstance(value, Items):
            result = [Elements(tuple(tuple(self.values(part, frame, at)) for part in value.parts))]
        else:
            result = self._item(value, frame, at)
        return result

    def _joined(self, parts: Iterable[Sequence[Name]]) -> Iterator[Name]:
        for number, pieces in enumerate(product(*parts)):
            if number > ALTERNATIVES:
                return
            yield joined(piece for name in pieces for piece in name)

    def _item(self, value: Item, frame: Frame, at: int) -> list[Value]:
        result: list[Value] = []
        for one in self.values(value.of, frame, at):
            if isinstance(one, Elements) and value.at is not None:
                result += one.of[value.at] if value.at < len(one.of) else ()
            elif isinstance(one, Elements):
                result += [inner for element in one.of for inner in element]
            elif isinstance(one, Thing):
                result.append(one)
        return unique(result) or [open_name("an element of a list that the sources do not fix")]

    def _construction(self, value: Construction, frame: Frame, at: int) -> list[Value]:
        meant = valued(value, listed=True)
        if meant is not value:
            return self.values(meant, frame, at)
        name, types = self.program.meaning(value.type, frame.function.file)
        if name in frame.function.templates or (frame.object and name in self._templates(frame)):
            bound, file = self.type_of(name, frame)
            name, types = self.program.meaning(bound, file) if bound else (name, types)
        of_class = self.program.type_class(name, frame.function.file)
        last = name.rpartition("::")[2] if of_class else name
        return [Thing(last, types, ("made", value.start, *frame.key), of_class, value, frame)]

    def _templates(self, frame: Frame) -> tuple[str, ...]:
        one = self.program.owner(frame.function)
        return one.templates if one else ()

    def _variable(self, written: str, frame: Frame, at: int) -> list[Value]:  # noqa: PLR0911 - from the nearest
        name = written.rpartition("::")[2]
        if written == "this":
            return [frame.object] if frame.object else [open_name("this")]
        around: Frame | None = frame
        for _ in range(DEEP):
            if around is None or "::" in written:
                break
            function = around.function
            for index, parameter in enumerate(function.parameters):
                if parameter.name == name:
                    return self._argument(around, index, name, at)
            if name in function.types or (name in function.assigned and not self._is_field(name, around)):
                if function.assigned.get(name):
                    return self._assigned([(around, one) for one in function.assigned[name]], (name, around.key), at)
                return self._unassigned(function.types.get(name, ""), ("local", name, *around.key), around)
            outer = self.program.outer(function)
            around = self._around(around, outer) if outer else None
            at = END if around else at
        if self._is_field(name, frame):
            return self._field(name, frame, at)
        constants = self.program.constants(name, frame.function.file)
        some = [(frame._replace(function=_as_file(file)), one) for file, one in constants]
        some += [
            (Frame(function, ("global", *function.key), self._own_object(function, ("global", *function.key))), one)
            for function, one in self.program.assignments(name, frame.function.file)
        ]
        if some:
            return self._assigned(some, ("constant", name, frame.function.file), END)
        if written.count("::") == 1 and (
            owner := self.program.type_class(written.partition("::")[0], frame.function.file)
        ):
            default = owner.fields.get(name, ("", None))[1]
            if default is not None:
                return self.values(default, frame, END)
        return self._unassigned(
            self.program.files[frame.function.file].types.get(name, ""), ("global", name), frame
        ) or [open_name(written)]

    def _around(self, frame: Frame, outer: Function) -> Frame:
        """The frame of the function around a lambda."""
        if frame.object:
            return self.method(frame.object, outer)
        return frame._replace(function=outer, key=(*frame.key, "outer"), binding=None)

    def _is_field(self, name: str, frame: Frame) -> bool:
        return any(name in one.fields for one in self._family(frame))

    def _family(self, frame: Frame) -> list[CppClass]:
        one = frame.object.of_class if frame.object else self.program.owner(frame.function)
        return self.program.ancestors(one)[0] if one else []

    def _unassigned(self, kind: str, key: tuple[object, ...], frame: Frame) -> list[Value]:
        """An object that is only declared, with a constructor without arguments."""
        name, types = self.program.meaning(kind, frame.function.file)
        if not name or name.startswith("std::") or name.rpartition("::")[2] in SIMPLE:
            return [open_name("a variable that gets its value elsewhere")]
        of_class = self.program.type_class(name, frame.function.file)
        made = (
            Construction(kind, (), frame.function.line, 0)
            if of_class and "Ptr" not in kind and "_ptr" not in kind
            else None
        )
        return [Thing(of_class.name if of_class else name, types, key, of_class, made, frame)]

    def _field(self, name: str, frame: Frame, at: int) -> list[Value]:
        """A member: what its class, or one that is derived from it, gives it."""
        owner = frame.object or self._own_object(frame.function, frame.key)
        if owner is None:
            return [open_name(name)]
        here = [(frame, one) for one in frame.function.assigned.get(name, ())]
        if self._certain(here, at):
            return self._assigned(here, ("field", name, *owner.key), at)
        some = [(frame, one) for one in frame.function.assigned.get(name, ())]
        default: Expression | None = None
        kind = ""
        for one in self._family(frame):
            kind, default = one.fields[name] if name in one.fields and not kind else (kind, default)
            for function in self.program.methods(one):
                inner = frame if function is frame.function else self.method(owner, function)
                if inner is not frame:
                    some += [(inner, value) for value in function.assigned.get(name, ())] if function.name else []
                for given in function.initializers:
                    if given.name == name:
                        made = Construction(kind or "auto", given.arguments, given.line, given.start)
                        some.append((inner, Assigned(valued(made), given.start)))
        if default is not None and not any(one.branch == (0, END) and not one.appended for _, one in some):
            home = _as_file(frame.function.file)._replace(of_class=frame.function.of_class)
            some.append((Frame(home, ("default", *owner.key), owner), Assigned(default, -1)))
        if not some:
            return self._unassigned(kind, ("field", name, *owner.key), frame)
        return self._assigned(some, ("field", name, *owner.key), END)

    def _own_object(self, function: Function, key: tuple[object, ...]) -> Thing | None:
        one = self.program.owner(function)
        return Thing(one.name, (), ("this", *key), one) if one else None

    def _certain(self, values: Sequence[tuple[Frame, Assigned]], at: int) -> bool:
        """Whether one of some values is certainly given before a place of the same function."""
        return at != END and any(
            one.start < at and one.branch[0] <= at <= one.branch[1] and not one.appended for _, one in values
        )

    def _assigned(self, candidates: Sequence[tuple[Frame, Assigned]], key: tuple[object, ...], at: int) -> list[Value]:
        """What a variable can be by what it is given; at a place, by what it is given before it."""
        before = sorted((pair for pair in candidates if pair[1].start < at), key=lambda pair: pair[1].start)
        sure = [place for place, pair in enumerate(before) if self._certain([pair], at)]
        counted = before[sure[-1] :] if sure else candidates
        result: list[Value] = []
        appended: list[Elements] = []
        for frame, one in counted:
            running = ("value", key, frame.function.file, one.start)
            if running in self._running:
                continue
            self._running.add(running)
            try:
                values = self.values(one.value, frame, one.start if frame.function.start >= 0 else END)
            finally:
                self._running.discard(running)
            if one.appended:
                result = list(
                    self._joined(
                        [[self._name(old) for old in result or [text_name("")]], list(map(self._name, values))]
                    )
                )
            elif isinstance(one.value, Items):
                appended += [value for value in values if isinstance(value, Elements)]
            else:
                result += values
        if appended:
            result = [one for one in result if isinstance(one, Elements)]
            result = [Elements(tuple(element for part in (*result, *appended) for element in part.of))]  # type: ignore[union-attr]
        return unique(result) or [open_name("a variable that is given itself")]

    def _member(self, value: Member, frame: Frame, at: int) -> list[Value]:
        name = assigned_name(value)
        if value.of == Ref("this"):
            return self._variable(value.name, frame, at) if self._is_field(value.name, frame) else [open_name(name)]
        some = [(frame, one) for one in frame.function.assigned.get(name, ())]
        for one in self._family(frame):
            for function in self.program.methods(one):
                if function is not frame.function and name in function.assigned and frame.object:
                    some += [(self.method(frame.object, function), given) for given in function.assigned[name]]
        if some:
            return self._assigned(some, ("member", name, *frame.key), at)
        result: list[Value] = []
        for thing in self.things(value.of, frame, at):
            if thing.of_class and value.name in thing.of_class.fields:
                function = _as_file(thing.of_class.file)._replace(of_class=thing.of_class.name)
                result += self._field(value.name, Frame(function, ("of", *thing.key), thing), END)
        if not result and value.name in PAIR:
            return self._item(Item(value.of, PAIR.index(value.name)), frame, at)
        return unique(result) or [open_name(name or "a member")]

    def method(self, owner: Thing, function: Function) -> Frame:
        """Return the frame of a method of an object."""
        return Frame(function, ("method", function.file, function.start, *owner.key), owner)

    def _argument(self, frame: Frame, index: int, name: str, at: int) -> list[Value]:
        binding = self.binding(frame)
        given = frame.function.assigned.get(name, ())
        if given and self._certain([(frame, one) for one in given], at):
            return self._assigned([(frame, one) for one in given], ("argument", name, *frame.key), at)
        if binding is not None and index < len(binding.arguments):
            return self.values(binding.arguments[index], binding.frame, binding.at)
        default = self.program.parameters(frame.function)[index].default
        if default is not None:
            return [
                one if isinstance(one, Thing | Elements) else as_default(one) for one in self.values(default, frame)
            ]
        return [open_name(f"argument {name} of {frame.function.name or 'a function'}")]

    def binding(self, frame: Frame) -> Binding | None:
        """Return what a function is called with; None where nothing in the checkout calls it."""
        if frame.binding is not None:
            return frame.binding
        if frame.key in self.settled:
            return self.settled[frame.key]
        if frame.depth > DEEP:
            return None
        owner = self.program.owner(frame.function)
        if owner and frame.function.name == owner.name and frame.object:
            options = self._makers(frame, owner)
        else:
            options = [
                Binding(one.call.arguments, one.call.types, self._caller(one.function, frame), one.call.start)
                for one in self.program.callers(frame.function)
            ]
        if len(options) > TRIALS:
            return None
        if len(options) == 1:
            self.settled[frame.key] = options[0]
            return options[0]
        if not options:
            self.settled[frame.key] = None
            return None
        raise Unsettled(frame.key, options)

    def _caller(self, function: Function, frame: Frame) -> Frame:
        """The frame of a caller: of a method of the same object, or of another one."""
        key = (*frame.key, "caller", function.start)
        owner = self.program.owner(function)
        same = frame.object if owner and owner in self._family(frame) else None
        of_one = function.name and owner and function.name == owner.name and same
        key = ("method", function.file, function.start, *same.key) if of_one and same else key
        return Frame(function, key, same or self._own_object(function, key), None, frame.depth + 1)

    def _makers(self, frame: Frame, owner: CppClass) -> list[Binding]:
        """What a constructor is called with: where objects are made, by others beside it and of derived classes."""
        thing, function = frame.object, frame.function
        options = []
        if thing is not None and thing.of_class is owner and thing.construction is not None and thing.frame is not None:
            if self.program.fits(function, len(thing.construction.arguments)):
                made = thing.construction
                return [Binding(made.arguments, (), thing.frame, made.start or END)]
        elif thing is None or thing.of_class is owner:
            options = [
                Binding(
                    one.construction.arguments,
                    type_parts(one.construction.type)[1],
                    self._caller_of(one.function, frame),
                    one.construction.start,
                )
                for one in self.program.constructions(owner)
                if self.program.fits(function, len(one.construction.arguments))
            ]
        for one in self._family(frame):
            for other in self.program.methods(one):
                if other is function:
                    continue
                for given in other.initializers:
                    if given.name == owner.name and thing and self.program.fits(function, len(given.arguments)):
                        options.append(
                            Binding(
                                given.arguments,
                                (),
                                self.method(thing, other)._replace(depth=frame.depth + 1),
                                given.start,
                            )
                        )
        return options

    def _caller_of(self, function: Function, frame: Frame) -> Frame:
        key = (*frame.key, "maker", function.start)
        return Frame(function, key, self._own_object(function, key), None, frame.depth + 1)

    def type_of(self, name: str, frame: Frame) -> tuple[str, str]:
        """Return what a type is, template parameters replaced, and the file whose aliases it is written with."""
        for _ in range(DEEP):
            plain = type_parts(name)[0]
            if plain in frame.function.templates and frame.function.name:
                binding = self.binding(frame)
                index = frame.function.templates.index(plain)
                if binding is not None and index < len(binding.types):
                    name, frame = binding.types[index], binding.frame
                    continue
            owner = self.program.owner(frame.function)
            if owner is not None and plain in owner.templates:
                further = self._class_argument(owner, owner.templates.index(plain), frame)
                if further is None:
                    return "", frame.function.file
                name, frame = further
                continue
            break
        return name, frame.function.file

    def _class_argument(self, owner: CppClass, index: int, frame: Frame) -> tuple[str, Frame] | None:
        thing = frame.object
        for one in self._family(frame):
            for base in one.bases:
                name, types = self.program.meaning(base, one.file)
                if one is not owner and self.program.type_class(name, one.file) is owner and index < len(types):
                    function = _as_file(one.file)._replace(of_class=one.name)
                    return types[index], Frame(function, ("base", *frame.key), thing)
        if thing is not None and thing.types:
            home = thing.frame or frame
            return (thing.types[index], home) if index < len(thing.types) else None
        for function in self.program.methods(owner):
            if function.name == owner.name and thing is not None:
                inner = frame if frame.function is function else self.method(thing, function)
                binding = self.binding(inner)
                if binding is not None and index < len(binding.types):
                    return binding.types[index], binding.frame
        return None

    def _call(self, value: Call, frame: Frame, at: int) -> list[Value]:  # noqa: PLR0911 - a table of names
        last, given = value.last, value.arguments
        of_library = value.name.partition("::")[0] in OF_LIBRARIES
        own = self.program.callees(value, frame.function) if frame.depth <= DEEP and not of_library else []
        if (last in DECLARE or last in GET) and not any(one.results for one in own):
            return self._parameter(value, frame, at)
        if own and not any(one.name == one.of_class for one in own):
            return self._results(own, value, frame, at)
        if value.of is None and self.program.type_class(value.name, frame.function.file):
            written = f"{value.name}<{', '.join(value.types)}>" if value.types else value.name
            return self._construction(Construction(written, given, value.line, value.start), frame, at)
        if last in OF_NODE and not given:
            return [OF_NODE[last]]
        if last == "get_node" and not given and value.of in (None, Ref("this")) and frame.object:
            return [frame.object]
        if value.of is not None and last in ("at", "front", "back"):
            return self._item(Item(value.of), frame, at)
        if last in TRANSPARENT or last.partition("<")[0] in TRANSPARENT:
            if value.of is not None and not given:
                return self.values(value.of, frame, at)
            if value.of is None and given:
                return self.values(given[0], frame, at)
            if value.of is None and last == "shared_from_this" and frame.object:
                return [frame.object]
        if value.name in FORMATS and given:
            return self._formatted(given, frame, at)
        return [open_name(f"what {value.name or 'a call'}() returns")]

    def _formatted(self, arguments: tuple[Expression, ...], frame: Frame, at: int) -> list[Value]:
        texts = [plain_text(name) for name in self.names(arguments[0], frame, at)]
        if len(texts) != 1 or texts[0] is None or texts[0].count("{}") != len(arguments) - 1:
            return [open_name("a text that is formatted")]
        pieces = texts[0].split("{}")
        parts: list[list[Name]] = [[text_name(pieces[0])]]
        for piece, one in zip(pieces[1:], arguments[1:], strict=True):
            parts += [self.names(one, frame, at), [text_name(piece)]]
        return list(self._joined(parts))

    def _results(self, functions: Sequence[Function], value: Call, frame: Frame, at: int) -> list[Value]:
        result: list[Value] = []
        for function in functions:
            key = ("call", value.start, *frame.key, function.start)
            if key in self._running:
                continue
            owner = self.program.owner(function)
            same = frame.object if owner and owner in self._family(frame) and value.of in (None, Ref("this")) else None
            things = self.things(value.of, frame, at) if value.of is not None and not same else []
            target = same or next(iter(things), None) or self._own_object(function, key)
            binding = Binding(value.arguments, value.types, frame, value.start)
            inner = Frame(function, key, target, binding, frame.depth + 1)
            self._running.add(key)
            try:
                for one in function.results:
                    result += self.values(one, inner)
            finally:
                self._running.discard(key)
        return unique(result) or [open_name(f"what {value.name}() returns")]

    def _parameter(self, value: Call, frame: Frame, at: int) -> list[Value]:
        """The value of a parameter of a node: its default, which a launch file can replace."""
        place = DECLARE.get(value.last, 0)
        if len(value.arguments) <= place:
            return [open_name("a parameter")]
        result: list[Value] = []
        for name in self.names(value.arguments[place], frame, at):
            parameter = plain_text(name) or ""
            defaults = self._defaults(value, place, parameter, frame, at)
            for default in defaults:
                text = plain_text(default)
                why = (
                    ""
                    if text is not None
                    else f"parameter {parameter or 'whose name is not known'}, which has no default"
                )
                result.append((NamePiece(text, GUESSED if text is None else DEFAULT, parameter, why),))
        return unique(result)

    def _defaults(self, value: Call, place: int, parameter: str, frame: Frame, at: int) -> list[Name]:
        stated = value.arguments[place + 1 :]
        if value.last in GET:
            stated = value.arguments[2:3] if value.last == "get_parameter_or" else ()
        if stated:
            return self.names(stated[0], frame, at)
        name = value.arguments[place]
        for call in frame.function.calls:  # beside it, by the same expression
            shift = DECLARE.get(call.last, END) if isinstance(call, Call) else END
            if call.arguments[shift : shift + 1] == (name,) and len(call.arguments) > shift + 1:
                return self.names(call.arguments[shift + 1], frame, call.start)
        result: list[Name] = []
        for one in self._declarations(parameter, name, frame):
            shift, key = DECLARE[one.call.last], ("declared", one.function.file, one.call.start)
            if len(one.call.arguments) > shift + 1 and key not in self._running:
                own = self.program.owner(one.function) in self._family(frame)
                inner = Frame(one.function, (*key, *frame.key), self._own_object(one.function, (*key, *frame.key)))
                inner = self.method(frame.object, one.function) if own and frame.object else inner
                self._running.add(key)
                try:
                    result += self.names(one.call.arguments[shift + 1], inner, one.call.start)
                finally:
                    self._running.discard(key)
        return result or [open_name("no default")]

    def _declarations(self, parameter: str, name: Expression, frame: Frame) -> list[CallOf]:
        """The calls that declare a parameter: of the class of the object, otherwise of the file."""
        made_up = [one for one in self.program.declarations("") if name in one.call.arguments[:2]]
        some = [*(self.program.declarations(parameter) if parameter else ()), *made_up]
        family = self._family(frame)
        near = [one for one in some if self.program.owner(one.function) in family]
        return near or [one for one in some if one.function.file == frame.function.file]

    def _out(self, value: Out, frame: Frame) -> list[Value]:
        """What a function gives to an argument by reference."""
        result: list[Value] = []
        for function in self.program.callees(value.call, frame.function) if frame.depth <= DEEP else ():
            key = ("out", value.call.start, *frame.key, function.start)
            owner, name = self.program.owner(function), function.parameters[value.at].name
            given = [one for one in function.assigned.get(name, ()) if not isinstance(one.value, Open)]
            target = frame.object if owner and owner in self._family(frame) else self._own_object(function, key)
            binding = Binding(value.call.arguments, value.call.types, frame, value.call.start)
            inner = Frame(function, key, target, binding, frame.depth + 1)
            if given and key not in self._running:
                self._running.add(key)
                try:
                    result += self._assigned([(inner, one) for one in given], ("argument", name, *key), END)
                finally:
                    self._running.discard(key)
        return unique(result) or [open_name(f"what {value.call.name}() gives")]


def _as_file(file: str) -> Function:
    """A function without anything of its own, in which constants of a file are what they are."""
    return Function(file, -1, 0, "", "", (), (), (), {}, {}, (), ())
