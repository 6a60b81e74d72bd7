"""All files of C++ of a checkout together: which class, function, alias and constant a name means, and who calls what.

In: ``CppFile``. Out: look-ups. Of several that have a name the nearest counts: of the same file, of the same package,
of the folder that is nearest.
"""

from __future__ import annotations

import re
from collections import defaultdict
from itertools import islice, takewhile
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.code.node_uses import package_of
from rosprivacy.ingest.code.source_code import INTERFACES
from rosprivacy.ingest.scan.cpp.cpp_expressions import (
    Call,
    Construction,
    Expression,
    Item,
    Items,
    Member,
    Out,
    Ref,
    Text,
    type_parts,
)
from rosprivacy.ingest.scan.cpp.cpp_units import Assigned, Function, Parameter, assigned_name, valued

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.ingest.scan.cpp.cpp_units import CppClass, CppFile

    ClassKey = tuple[str, int, str]

STEPS = 5  # of names that stand for names
THIS_OBJECT = Ref("this")
LOOKED_AT = 100  # files that have something of one name
ANCESTORS = 50  # classes that one is derived from
OF_LIBRARIES = frozenset(  # namespaces of which a checkout has no classes; it may have a class of the same last name
    """
    std boost rclcpp rclcpp_lifecycle rclcpp_action rclcpp_components image_transport point_cloud_transport
    message_filters tf2 tf2_ros cv pcl Eigen controller_interface hardware_interface BT
    """.split()  # noqa: SIM905 - to be read as a text
)
DECLARE = {  # what declares a parameter -> at which place its name stands
    "declare_parameter": 0, "auto_declare": 0, "declare_or_get_parameter": 0, "declare_parameter_if_not_declared": 1,
}  # fmt: skip
WORD = re.compile(r"[A-Za-z_]\w*", re.ASCII)


class CallOf(NamedTuple):
    """A call, and the function in which it stands."""

    call: Call
    function: Function


class ConstructionOf(NamedTuple):
    """The making of an object, and the function in which it stands."""

    construction: Construction
    function: Function


class CppProgram:
    """The files of a checkout."""

    def __init__(self, files: Sequence[CppFile]) -> None:
        self.files = {file.file: file for file in files}
        self._classes: dict[str, list[CppClass]] = defaultdict(list)
        self._functions: dict[str, list[Function]] = defaultdict(list)
        self._at: dict[tuple[str, int], Function] = {}
        self._aliases: dict[str, Homes] = defaultdict(Homes)
        self._constants: dict[str, Homes] = defaultdict(Homes)
        self._homes: dict[str, Homes] = defaultdict(Homes)  # of classes
        self._class_at: dict[tuple[str, str], CppClass] = {}
        self._calls: dict[str, list[CallOf]] = defaultdict(list)
        self._calls_on: dict[tuple[str, ClassKey | None], list[CallOf]] = defaultdict(list)  # None: not known on what
        self._plain_calls: dict[tuple[str, str], list[CallOf]] = defaultdict(list)  # by package; "" of all
        self._constructions: dict[ClassKey, list[ConstructionOf]] = defaultdict(list)
        self._methods: dict[ClassKey, list[Function]] = defaultdict(list)
        self._methods_named: dict[tuple[str, ClassKey], list[Function]] = defaultdict(list)
        self._lambdas: dict[tuple[str, str], list[Function]] = defaultdict(list)
        self._free: dict[str, list[Function]] = defaultdict(list)
        self._near_free: dict[tuple[str, str], list[Function]] = {}
        self._globals: dict[tuple[str, str], list[tuple[Function, Assigned]]] = defaultdict(list)
        self._nearest: dict[tuple[str, str], CppClass | None] = {}
        self._meanings: dict[tuple[str, str], str] = {}
        self._chains: dict[tuple[str, int], tuple[list[CppClass], list[tuple[str, CppClass]]]] = {}
        self._near: dict[tuple[str, str], str] = {}
        self._derived: dict[ClassKey, list[CppClass]] = defaultdict(list)
        for file in files:
            self._names(file)
        for file in files:
            for one in file.classes:
                self._bases(one)
        given_back = _given_back(files)
        for file in files:
            for function in file.functions:
                self._function(_with_given_back(function, given_back))
        for function in self._at.values():
            for call in function.calls:
                if isinstance(call, Call) and call.last in self._functions:
                    self._note_call(CallOf(call, function))
        self._declared: dict[str, list[CallOf]] = defaultdict(list)
        for last, place in DECLARE.items():
            for declared in self.calls(last):
                if len(declared.call.arguments) > place:
                    self._declared[self._parameter_name(declared, place)].append(declared)
        for several in self.calls("declare_parameters"):
            self._listed(several)

    def _listed(self, several: CallOf) -> None:
        """``declare_parameters("space", {{"name", default}, …})``, each as if it stood alone."""
        space, *rest = several.call.arguments or (None,)
        pairs = rest[0].parts if rest and isinstance(rest[0], Items) and isinstance(space, Text) else ()
        for pair in pairs:
            if isinstance(pair, Items) and len(pair.parts) > 1 and isinstance(pair.parts[0], Text):
                name = ".".join(filter(None, [space.text if isinstance(space, Text) else "", pair.parts[0].text]))
                call = several.call._replace(name="declare_parameter", arguments=(Text(name), *pair.parts[1:]))
                self._declared[name].append(CallOf(call, several.function))

    def _names(self, file: CppFile) -> None:
        for one in file.classes:
            self._classes[one.name].append(one)
            self._homes[one.name].add(one.file)
            if (one.file, one.name) not in self._class_at or _of_ros_1(self._class_at[one.file, one.name]):
                self._class_at[one.file, one.name] = one
        for name in file.names.aliases:
            self._aliases[name].add(file.file)
        for name in file.constants:
            self._constants[name].add(file.file)

    def _bases(self, cpp_class: CppClass) -> None:
        for written in cpp_class.bases:
            base = self.type_class(self.meaning(written, cpp_class.file)[0], cpp_class.file)
            if base is not None:
                self._derived[_key(base)].append(cpp_class)

    def _function(self, function: Function) -> None:
        self._functions[function.name].append(function)
        self._at[function.key] = function
        owner = self.owner(function)
        if function.outer is not None:
            self._lambdas[function.file, function.name].append(function)
        elif owner is None:
            self._free[function.name].append(function)
        else:
            self._methods_named[function.name, _key(owner)].append(function)
        if owner is not None:
            self._methods[_key(owner)].append(function)
        for one in function.calls:
            if isinstance(one, Call):
                self._calls[one.last].append(CallOf(one, function))
                if one.of is None and one.last in self._classes:
                    self._note_construction(Construction(one.name, one.arguments, one.line, one.start), function)
            else:
                self._note_construction(one, function)
        for given in function.initializers:
            made = Construction(self.field_type(function, given.name), given.arguments, given.line, given.start)
            if made.type and valued(made) is made:
                self._note_construction(made, function)
        own = {parameter.name for parameter in function.parameters}
        for name, values in function.assigned.items():
            if name not in function.types and name not in own and not self.field_type(function, name):
                self._globals[package_of(function.file), name].extend((function, value) for value in values)

    def _note_construction(self, construction: Construction, function: Function) -> None:
        one = self.type_class(self.meaning(construction.type, function.file)[0], function.file)
        if one is not None:
            self._constructions[_key(one)].append(ConstructionOf(construction, function))

    def _note_call(self, call: CallOf) -> None:
        """Note a call of a function of the checkout, by the class that it is called on."""
        name, of = call.call.last, call.call.of
        if of is None or of == THIS_OBJECT:
            owner = self.owner(call.function)
            scope = call.call.name.rpartition("::")[0]
            named = self.type_class(scope, call.function.file) if scope else None
            for one in (owner, named):
                if one is not None:
                    self._calls_on[name, _key(one)].append(call)
            for package in ("", package_of(call.function.file)):
                self._plain_calls[name, package].append(call)
            return
        classes = self._on(of, call.function)
        for one in classes or ():
            self._calls_on[name, _key(one)].append(call)
        if classes is None:
            self._calls_on[name, None].append(call)

    def _on(self, of: Expression, function: Function) -> list[CppClass] | None:
        """The classes of the checkout that a variable may be of; None if its type is not known."""
        kind = self.type_text(of, function)
        if not kind:
            return None
        name, arguments = self.meaning(kind, function.file)
        words = dict.fromkeys(WORD.findall(" ".join([name, *arguments])))
        return [one for word in words if (one := self.type_class(word, function.file)) is not None]

    def last(self, written: str, file: str) -> str:
        """Return the last name of what a type means."""
        return self.meaning(written, file)[0].rpartition("::")[2]

    def meaning(self, written: str, file: str) -> tuple[str, tuple[str, ...]]:
        """Return the name and the template arguments of what a type means, as aliases of the checkout say."""
        name, arguments = type_parts(written)
        for _ in range(STEPS):
            meant = self._alias(name, file)
            if meant == name:
                break
            name, further = type_parts(meant)
            arguments = further or arguments
        return name, arguments

    def _alias(self, name: str, file: str) -> str:
        key = (file, name)
        if key not in self._meanings:
            names = self.files[file].names if file in self.files else None
            meant = names.meaning(name) if names is not None else name
            head = name.partition("::")[0]
            if meant == name and head in self._aliases:
                other = self._aliases[head].nearest(file)
                meant = self.files[other].names.meaning(name) if other else name
            self._meanings[key] = meant
        return self._meanings[key]

    def message(self, written: str, file: str) -> str:
        """Return a type in ROS's spelling; empty where the sources do not say it."""
        name, _ = self.meaning(written, file)
        names = [part for part in name.split("::") if part]
        here = self.files.get(file)
        spaces = [*here.names.namespaces, *here.spaces] if here else []
        whole = [names, *([*space.split("::"), *names] for space in dict.fromkeys(spaces))]
        fitting = {"/".join(one[:3]) for one in whole if len(one) >= 3 and one[1] in INTERFACES}  # noqa: PLR2004
        return next(iter(fitting)) if len(fitting) == 1 else ""

    def type_class(self, name: str, file: str) -> CppClass | None:
        """Return the nearest class of a name; None if the checkout has none."""
        head, _, _ = name.partition("::")
        last = name.rpartition("::")[2]
        if head in OF_LIBRARIES and head != last:
            return None
        key = (file, last)
        if key not in self._nearest:
            near = self._homes[last].nearest(file) if last in self._homes else ""
            self._nearest[key] = self._class_at.get((near, last))
        return self._nearest[key]

    def ancestors(self, cpp_class: CppClass) -> tuple[list[CppClass], list[tuple[str, CppClass]]]:
        """Return a class with those of the checkout that it is derived from, and the bases that are not there."""
        if (cpp_class.file, cpp_class.line) in self._chains:
            return self._chains[cpp_class.file, cpp_class.line]
        chain: list[CppClass] = [cpp_class]
        outside: list[tuple[str, CppClass]] = []
        at = 0
        while at < len(chain) and len(chain) < ANCESTORS:
            for base in chain[at].bases:
                name = self.meaning(base, chain[at].file)[0]
                other = self.type_class(name, chain[at].file)
                if other is None or other in chain:
                    outside += [] if other else [(name, chain[at])]
                else:
                    chain.append(other)
            at += 1
        self._chains[cpp_class.file, cpp_class.line] = chain, outside
        return chain, outside

    def concrete(self, cpp_class: CppClass) -> list[CppClass]:
        """Return the classes that objects have which are of a class: itself, or those that are derived from it."""
        chain = self._descendants(cpp_class)
        leaves = [other for other in chain if not self._derived.get(_key(other)) or self.constructions(other)]
        return leaves or [cpp_class]

    def _descendants(self, cpp_class: CppClass) -> list[CppClass]:
        chain, at = [cpp_class], 0
        while at < len(chain) and len(chain) < ANCESTORS:
            chain += [other for other in self._derived.get(_key(chain[at]), ()) if other not in chain]
            at += 1
        return chain

    def methods(self, cpp_class: CppClass) -> Sequence[Function]:
        """Return the functions of a class, wherever they stand."""
        return self._methods.get(_key(cpp_class), ())

    def owner(self, function: Function) -> CppClass | None:
        """Return the class of a function."""
        return self.type_class(function.of_class, function.file) if function.of_class else None

    def outer(self, function: Function) -> Function | None:
        """Return the function around a lambda."""
        return self._at.get((function.file, function.outer)) if function.outer is not None else None

    def field_type(self, function: Function, name: str) -> str:
        """Return the type of a member of the class of a function, or of its bases; empty if there is none."""
        one = self.owner(function)
        for other in self.ancestors(one)[0] if one else ():
            if name in other.fields:
                return other.fields[name][0]
        return ""

    def type_text(self, value: Expression, function: Function) -> str:
        """Return the declared type of a variable; empty where it is not known."""
        while isinstance(value, Item):
            value = value.of
        if isinstance(value, Construction):
            return value.type
        if isinstance(value, Member):
            name = assigned_name(value)
            if "." in name:
                of = self.type_class(self.meaning(self.type_text(value.of, function), function.file)[0], function.file)
                return of.fields.get(value.name, ("", None))[0] if of else ""
            return self.field_type(function, name)
        if not isinstance(value, Ref):
            return ""
        name, around = value.name.rpartition("::")[2], function
        for _ in range(STEPS):
            kind = around.types.get(name, "")
            if "auto" in kind.split() or kind == "auto":
                made = [one.value for one in around.assigned.get(name, ()) if isinstance(one.value, Construction)]
                return made[0].type if made else ""
            further = self.outer(around)
            if kind or further is None:
                break
            around = further
        return kind or self.field_type(function, name) or self.files[function.file].types.get(name, "")

    def parameters(self, function: Function) -> tuple[Parameter, ...]:
        """Return the parameters of a function, with the default values of its declaration."""
        one = self.owner(function)
        listed = one.defaults.get((function.name, len(function.parameters))) if one else None
        if not listed:
            return function.parameters
        return tuple(
            own if own.default is not None else own._replace(default=declared.default)
            for own, declared in zip(function.parameters, listed, strict=False)
        )

    def fits(self, function: Function, count: int) -> bool:
        """Return whether a function can be called with so many arguments."""
        listed = self.parameters(function)
        return sum(one.default is None for one in listed) <= count <= len(listed)

    def has_method(self, name: str, function: Function, of: Expression | None) -> bool:
        """Return whether what is called is a method of a class of the checkout, not of ROS."""
        return name in self._functions and bool(self._candidates(name, of, function))

    def callees(self, call: Call, function: Function) -> list[Function]:
        """Return the functions of the checkout that a call may be of."""
        if call.last not in self._functions:
            return []
        some = self._candidates(call.last, call.of, function, call.name.rpartition("::")[0])
        return [one for one in some if self.fits(one, len(call.arguments))]

    def _candidates(self, name: str, of: Expression | None, function: Function, scope: str = "") -> list[Function]:
        if of is None or of == THIS_OBJECT:
            around = (function.start, function.outer)
            some = [one for one in self._lambdas.get((function.file, name), ()) if one.outer in around]
            named = self.type_class(scope, function.file) if scope else None
            for owner in (self.owner(function), named):
                some += self._named_methods(name, owner) if owner else []
            return some or self._nearest_free(name, function.file)
        classes = self._on(of, function)
        if classes is None:
            return self._functions[name] if self._unique(name) else []
        return [method for one in classes for method in self._named_methods(name, one)]

    def _named_methods(self, name: str, owner: CppClass) -> list[Function]:
        family = [*self.ancestors(owner)[0], *self._descendants(owner)[1:]]
        return [method for one in family for method in self._methods_named.get((name, _key(one)), ())]

    def _nearest_free(self, name: str, file: str) -> list[Function]:
        if (name, file) not in self._near_free:
            homes = Homes()
            for one in self._free.get(name, ()):
                homes.add(one.file)
            near = homes.nearest(file)
            self._near_free[name, file] = [one for one in self._free.get(name, ()) if one.file == near]
        return self._near_free[name, file]

    def _unique(self, name: str) -> bool:
        """Whether one class alone has a method of a name, which no class of ROS has."""
        some = self._functions[name]
        return "create" not in name and all(one.of_class == some[0].of_class for one in some[:LOOKED_AT])

    def callers(self, function: Function) -> list[CallOf]:
        """Return the calls of a function in the checkout."""
        name, owner = function.name, self.owner(function)
        some: list[CallOf] = []
        if function.outer is not None:
            plain = self._plain_calls.get((name, package_of(function.file)), ())
            some = [one for one in plain if one.function.file == function.file]
            some = [one for one in some if function.outer in (one.function.start, one.function.outer)]
        elif owner is None:
            package = "" if len(self._free[name]) == 1 else package_of(function.file)
            some = list(self._plain_calls.get((name, package), ()))
        else:
            family = [*self.ancestors(owner)[0], *self._descendants(owner)[1:]]
            some = [call for one in family for call in self._calls_on.get((name, _key(one)), ())]
            some += self._calls_on.get((name, None), ()) if self._unique(name) else ()
        return [one for one in some if self.fits(function, len(one.call.arguments))]

    def constructions(self, cpp_class: CppClass) -> Sequence[ConstructionOf]:
        """Return where objects of a class are made."""
        return self._constructions.get(_key(cpp_class), ())

    def constants(self, name: str, file: str) -> list[tuple[str, Assigned]]:
        """Return the values of a constant, or macro, with their files."""
        if (file, name) not in self._near:
            self._near[file, name] = self._constants[name].nearest(file) if name in self._constants else ""
        near = self._near[file, name]
        return [(near, value) for value in self.files[near].constants.get(name, ())] if near else []

    def assignments(self, name: str, file: str) -> list[tuple[Function, Assigned]]:
        """Return what functions of a file, or of its package, assign to a variable that is none of theirs."""
        some = self._globals.get((package_of(file), name), [])
        own = [one for one in some if one[0].file == file]
        return own or some

    def _parameter_name(self, declaration: CallOf, place: int) -> str:
        """The name of a parameter that is declared, a literal or a constant; empty for others."""
        name = declaration.call.arguments[place]
        if isinstance(name, Ref):
            values = self.constants(name.name.rpartition("::")[2], declaration.function.file)
            name = values[0][1].value if values else name
        return name.text if isinstance(name, Text) else ""

    def declarations(self, name: str) -> Sequence[CallOf]:
        """Return the calls that declare a parameter of nodes; for an empty name those whose name is made up."""
        return self._declared.get(name, ())

    def functions(self) -> Iterable[Function]:
        """Return all functions, by file."""
        return self._at.values()

    def calls(self, name: str) -> Sequence[CallOf]:
        """Return all calls of a name."""
        return self._calls.get(name, ())


def _given_back(files: Iterable[CppFile]) -> set[tuple[str, int, int]]:
    """Functions that give something to an argument by reference: name, number of parameters, place of that one."""
    handing: dict[tuple[str, int, int], list[tuple[str, int, int]]] = defaultdict(list)
    waiting: list[tuple[str, int, int]] = []
    for file in files:
        for function in file.functions:
            count = len(function.parameters)
            places = {
                one.name: at
                for at, one in enumerate(function.parameters)
                if "&" in one.type and "const" not in one.type and "&&" not in one.type
            }
            waiting += [(function.name, count, at) for name, at in places.items() if name in function.assigned]
            for call in function.calls if places else ():
                for at, given in enumerate(call.arguments):
                    if isinstance(call, Call) and isinstance(given, Ref) and given.name in places:
                        key = (call.last, len(call.arguments), at)
                        handing[key].append((function.name, count, places[given.name]))
    result: set[tuple[str, int, int]] = set()
    while waiting:
        key = waiting.pop()
        if key not in result:
            result.add(key)
            waiting += handing[key]
    return result


def _with_given_back(function: Function, given_back: set[tuple[str, int, int]]) -> Function:
    """A function whose variables have what calls give to them by reference."""
    assigned = {name: list(values) for name, values in function.assigned.items()}
    for call in function.calls:
        for at, given in enumerate(call.arguments):
            if isinstance(call, Call) and (call.last, len(call.arguments), at) in given_back:
                assigned.setdefault(assigned_name(given), []).append(Assigned(Out(call, at), call.start))
    assigned.pop("", None)
    if sum(map(len, assigned.values())) == sum(map(len, function.assigned.values())):
        return function
    return function._replace(assigned={name: tuple(sorted(values, key=_begin)) for name, values in assigned.items()})


def _key(cpp_class: CppClass) -> ClassKey:
    return cpp_class.file, cpp_class.line, cpp_class.name


def _of_ros_1(cpp_class: CppClass) -> bool:
    """Whether a class is that of a branch of ``#if`` for ROS 1."""
    return any(base.startswith("ros::") for base in cpp_class.bases)


def _begin(value: Assigned) -> int:
    return value.start


class Homes:
    """Files that have something of one name, and which of them is nearest to another file: of its package, its folder.

    Examples
    --------
    >>> homes = Homes()
    >>> for file in ("b/include/x.hpp", "a/include/x.hpp"):
    ...     homes.add(file)
    >>> homes.nearest("a/src/x.cpp"), homes.nearest("b/include/x.hpp")
    ('a/include/x.hpp', 'b/include/x.hpp')
    """

    def __init__(self) -> None:
        self._files: dict[str, None] = {}
        self._of_package: dict[str, list[str]] = defaultdict(list)

    def add(self, file: str) -> None:
        """Note a file."""
        if file not in self._files:
            self._files[file] = None
            self._of_package[package_of(file)].append(file)

    def nearest(self, file: str) -> str:
        """Return the nearest file; empty if there is none. Of very many the first are looked at."""
        if file in self._files:
            return file
        parts = PurePosixPath(file).parts

        def far(other: str) -> tuple[int, str]:
            pairs = zip(parts, PurePosixPath(other).parts, strict=False)
            return -sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs)), other

        own = self._of_package.get(package_of(file))
        return min(islice(own or self._files, LOOKED_AT), key=far, default="")
