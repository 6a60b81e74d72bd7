"""The actions of a launch file, done in their order without starting anything -> what it starts and includes.

In: actions, and how to read what is included. Out: each node with its final namespace, remappings and parameters, one
for each way that its arguments allow; includes; gaps. Conditions are not decided unless the text alone fixes them: both
ways are kept.

Source: ``launch`` (configurations are one table; a group keeps its changes to itself, an include does not) and
``launch_ros`` (``prefix_namespace``; remappings and parameters that are set for all nodes come before a node's own).
"""

from __future__ import annotations

import posixpath
import re
import shlex
from typing import TYPE_CHECKING, NamedTuple, Protocol

from rosprivacy.ingest.scan.final_names import OPEN
from rosprivacy.ingest.scan.launch import launch_actions as kinds
from rosprivacy.ingest.scan.launch.launch_actions import Action, Condition
from rosprivacy.ingest.scan.launch.launch_settings import NodeParameters, RosOptions, Setting, ros_options
from rosprivacy.ingest.scan.launch.launch_values import (
    CHECKOUT,
    MOST_VALUES,
    PACKAGE,
    Alternative,
    Choice,
    LaunchContext,
    Open,
    Perhaps,
    Substitution,
    combined,
    path_text,
    still_open,
    together,
)
from rosprivacy.ingest.scan.recorded_topics import recorder_name
from rosprivacy.ingest.scan.scan_facts import DEFAULT, LITERAL, Gap, StartedNode

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from rosprivacy.ingest.scan.launch.launch_values import Alternatives
    from rosprivacy.ingest.scan.launch.parameter_files import ParameterEntry
    from rosprivacy.ingest.scan.scan_facts import CodePlace

TRUE, FALSE = ("true", "1", "True"), ("false", "0", "False", "")
NO_TEXT = (Alternative(""),)
RENAMING = ("__node", "__name", "__ns")
NO_NAME = re.compile(r"true|false|[-+]?[0-9.]+(?:e[-+]?[0-9]+)?", re.IGNORECASE)
LONGEST_NAME = 1000  # of a parameter in maps in maps
DEEPEST = 60  # actions in actions, includes in includes


class IncludeUse(NamedTuple):
    """A launch file that another includes.

    Attributes
    ----------
    file
        Its path in the checkout; empty where it is not there, or where it cannot be told.
    text
        The path as it is written.
    """

    place: CodePlace
    file: str
    text: str
    conditional: bool


class LaunchSources(Protocol):
    """What a run reads."""

    def resolved(self, path: str) -> str:
        """Return the file of the checkout that a path leads to; empty if there is none."""

    def actions(self, file: str) -> Action | Gap:
        """Return what a launch file does."""

    def parameters(self, file: str) -> tuple[ParameterEntry, ...] | None:
        """Return what a file of parameters sets; None where it cannot be read."""


class LaunchRun:
    """Does the actions of one launch file, and of what it includes.

    Parameters
    ----------
    follow
        Whether included files are done too.
    """

    def __init__(
        self,
        sources: LaunchSources,
        spend: Callable[[], None],
        evaluate: Callable[[str], object],
        *,
        follow: bool = True,
    ) -> None:
        self.sources = sources
        self.started: list[StartedNode] = []
        self.includes: list[IncludeUse] = []
        self.gaps: list[Gap] = []
        self._spend = spend
        self._follow = follow
        self._context = LaunchContext(spend, evaluate)
        self._namespace: Alternatives | None = None
        self._remaps: list[tuple[Alternatives, Alternatives]] = []
        self._parameters: list[Setting] = []  # of all nodes from here on
        self._files: list[str] = []  # that are open
        self._depth = 0

    def file(self, file: str, place: CodePlace | None = None, *, conditional: bool = False) -> None:
        """Do what a launch file does."""
        found = self.sources.actions(file)
        if isinstance(found, Gap):
            self.gaps.append(found)
            return
        folder, self._context.folder = self._context.folder, CHECKOUT + posixpath.dirname(file)
        self._files.append(file)
        self._do(found, place or found.place, conditional=conditional)
        self._files.pop()
        self._context.folder = folder

    def _gap(self, place: CodePlace, sort: str, text: str) -> None:
        self.gaps.append(Gap(place, sort, text))

    def _do(self, value: object, place: CodePlace, *, conditional: bool) -> None:
        self._spend()
        self._depth += 1
        if self._depth > DEEPEST:
            self._gap(place, "started", "actions that are nested too deeply")
        elif isinstance(value, Action):
            self._action(value, conditional=conditional)
        elif isinstance(value, Perhaps):
            self._do(value.value, place, conditional=True)
        elif isinstance(value, Choice):
            for option in value.options:
                self._do(option, place, conditional=True)
        elif isinstance(value, list):
            for item in value:
                self._do(item, place, conditional=conditional)
        elif value is not None:
            why = value.why if isinstance(value, Open) else "a value that is no action"
            self._gap(place, "started", f"an action that is not known: {why}")
        self._depth -= 1

    def _action(self, action: Action, *, conditional: bool) -> None:  # noqa: PLR0912 - one for each sort
        values, place = action.values, action.place
        holds = self._holds(values.get("condition"))
        if holds is False:
            return
        conditional = conditional or holds is None
        match action.sort:
            case kinds.NODE:
                self._start(action, conditional=conditional)
                self._do(values.get("descriptions"), place, conditional=conditional)
                self._after(values.get("on_exit"), place, conditional=conditional)
            case kinds.COMPONENT:
                self._start(action, conditional=conditional)
            case kinds.LOAD:
                listed = values.get("descriptions")
                self._do(listed, place, conditional=conditional)
            case kinds.INCLUDE:
                self._include(action, conditional=conditional)
            case kinds.PROCESS:
                self._process(action, conditional=conditional)
                self._after(values.get("on_exit"), place, conditional=conditional)
            case kinds.GROUP:
                self._group(action, conditional=conditional)
            case kinds.ACTIONS:
                self._do(values.get("actions"), place, conditional=conditional)
            case kinds.DECLARE:
                self._declare(action)
            case kinds.SET | kinds.ENVIRONMENT:
                context = self._context
                held = context.configurations if action.sort == kinds.SET else context.environment
                for name in context.texts(values.get("name")):
                    self._set(held, name.text, context.texts(values.get("value")), place, conditional=conditional)
            case kinds.NAMESPACE:
                pushed = self._within(self._context.texts(values.get("namespace")))
                if conditional:
                    before = self._namespace or NO_TEXT
                    pushed = self._either([before, pushed], place)
                self._namespace = pushed
            case kinds.REMAP:
                self._remaps.append((self._context.texts(values.get("src")), self._context.texts(values.get("dst"))))
            case kinds.PARAMETER:
                self._parameters += self._settings(place, {values.get("name"): values.get("value")})
            case kinds.PARAMETER_FILE:
                self._parameters += self._settings(place, values.get("file"))
            case kinds.UNKNOWN:
                self._gap(place, "started", f"not known: {values.get('why')}")

    def _after(self, value: object, place: CodePlace, *, conditional: bool) -> None:
        """Do the actions that come when a program ends."""
        if isinstance(value, Action | list):
            self._do(value, place, conditional=conditional)

    def _holds(self, condition: object) -> bool | None:
        """Whether a condition holds; None where it may and may not."""
        if condition is None:
            return True
        if not isinstance(condition, Condition):
            return None
        value = condition.text
        if isinstance(value, Substitution) and value.sort == "equal":
            left, right = (self._context.texts(part) for part in value.parts)
            sure = len(left) == len(right) == 1 and _sure(left[0]) and _sure(right[0])
            return ((left[0].text == right[0].text) != condition.negated) if sure else None
        texts = self._context.texts(value)
        if len(texts) != 1 or not _sure(texts[0]):
            return None
        word = texts[0].text.strip()
        return None if word not in (*TRUE, *FALSE) else (word in TRUE) != condition.negated

    def _either(self, values: Sequence[Alternatives], place: CodePlace) -> Alternatives:
        chooser = f"{place.file}:{place.line}"
        made = [
            one._replace(picks=tuple(sorted({**dict(one.picks), chooser: number}.items())))
            for number, alternatives in enumerate(values)
            for one in alternatives
        ]
        return tuple(made) if len(made) <= MOST_VALUES else still_open(f"more than {MOST_VALUES} values")

    def _set(
        self, table: dict[str, Alternatives], name: str, value: Alternatives, place: CodePlace, *, conditional: bool
    ) -> None:
        table[name] = self._either([table[name], value], place) if conditional and name in table else value

    def _declare(self, action: Action) -> None:
        name, default, choices = (action.values.get(key) for key in ("name", "default", "choices"))
        for text in self._context.texts(name):
            if text.text in self._context.configurations:
                continue
            listed = choices if isinstance(choices, list) else []
            if default is None and not listed:
                value = still_open(f"the argument {text.text}", text.text)
            else:
                values = [self._context.texts(one) for one in ([] if default is None else [default])]
                others = [self._context.texts(one) for one in listed]
                values += [one for one in others if one not in values]
                value = values[0] if len(values) == 1 else self._either(values, action.place)
            self._context.configurations[text.text] = tuple(one._replace(surety=DEFAULT) for one in value)

    def _group(self, action: Action, *, conditional: bool) -> None:
        context = self._context
        held = (
            dict(context.configurations),
            dict(context.environment),
            self._namespace,
            list(self._remaps),
            list(self._parameters),
        )
        passed = action.values.get("configurations")
        for key, value in passed.items() if isinstance(passed, dict) else ():
            context.configurations[str(key)] = context.texts(value)
        self._do(action.values.get("actions"), action.place, conditional=conditional)
        if action.values.get("scoped", True) is not False:
            context.configurations, context.environment, self._namespace, self._remaps, self._parameters = held

    def _include(self, action: Action, *, conditional: bool) -> None:
        context, place = self._context, action.place
        paths = context.texts(action.values.get("file"))
        passed = [
            (name.text, value)
            for names, value in self._pairs(place, "include", action.values.get("arguments"))
            for name in names
        ]
        for path in paths:
            sure = not conditional and len(paths) == 1
            file = "" if path.why else self.sources.resolved(path.text)
            text = path_text(path.text)
            self.includes.append(IncludeUse(place, file, text, not sure))
            if not file:
                why = f"cannot be told: it depends on {', '.join(path.why)}" if path.why else "is not in the checkout"
                self._gap(place, "include", f"{text} {why}")
            elif file in self._files:
                self._gap(place, "include", f"{text} includes itself")
            elif self._follow:
                for name, value in passed:
                    self._set(context.configurations, name, value, place, conditional=False)
                self.file(file, place, conditional=not sure)
                for name, _ in passed:  # they stay set, but no condition is decided by what is left over
                    stays = context.configurations[name]
                    context.configurations[name] = tuple(one._replace(surety=DEFAULT) for one in stays)

    def _within(self, names: Alternatives) -> Alternatives:
        """A namespace below the one that was pushed."""
        rows = combined([self._namespace or NO_TEXT, names])
        if rows is None:
            return still_open(f"more than {MOST_VALUES} values")
        made = []
        for before, name in rows:
            text = (
                name.text if name.text.startswith("/") else f"{before.text}/{name.text}" if before.text else name.text
            )
            whole = Alternative(text.rstrip("/") or text, *_rest([before, name]))
            made.append(whole)
        return tuple(made)

    def _start(self, action: Action, *, conditional: bool) -> None:
        values, texts = action.values, self._context.texts
        options = ros_options(self._words(values.get("arguments")))
        space = values.get("namespace")
        own = self._namespace or NO_TEXT if space is None else self._within(texts(space))
        slots = (texts(values.get("package")), texts(values.get("executable")), texts(values.get("name")), own)
        pairs = [*self._remaps, *self._pairs(action.place, "remap", values.get("remappings"))]
        settings = [
            *self._settings(action.place, self._parameters),
            *self._settings(action.place, values.get("parameters")),
        ]
        self._node(action.place, slots, pairs, settings, options, conditional=conditional)

    def _node(
        self,
        place: CodePlace,
        slots: Sequence[Alternatives],
        pairs: Sequence[tuple[Alternatives, Alternatives]],
        settings: Sequence[Setting],
        options: RosOptions,
        *,
        conditional: bool,
    ) -> None:
        """Note a node for each way that its arguments allow."""
        first, last = len(slots), len(slots) + 2 * len(pairs)
        every = [*slots, *(end for pair in pairs for end in pair), *(one.texts for one in settings)]
        for row in self._rows(every):
            package, executable, name, space = row[:first]
            ends = [one.text for one in row[first:last]]
            pairs_of_row = zip(ends[::2], ends[1::2], strict=True)
            remaps = [*(pair for pair in pairs_of_row if pair[0]), *options.remaps]
            renamed = {end: to for end, to in remaps if end in RENAMING}
            final = renamed.get("__node", renamed.get("__name", name.text))
            namespace = absolute(renamed.get("__ns", space.text))
            self._open_texts(place, row[:first], row[first:last])
            parameters = NodeParameters(f"{namespace.rstrip('/')}/{final}" if final else "")
            for setting, one in zip(settings, row[last:], strict=True):
                self._set_parameter(place, setting, one, parameters)
            for file in options.files:
                self._set_parameter(place, Setting("", (), file=True), Alternative(file), parameters)
            for key, value in options.parameters:
                parameters.add(key, value)
            self.started.append(
                StartedNode(
                    place,
                    package.text,
                    executable.text,
                    final or None,
                    namespace or None,
                    tuple(pair for pair in remaps if pair[0] not in RENAMING),
                    tuple(parameters.values.items()),
                    conditional,
                    DEFAULT if any(one.surety == DEFAULT for one in row[:last]) else LITERAL,
                    tuple(parameters.unresolved),
                    tuple(parameters.by_node),
                    options.words,
                )
            )

    def _rows(self, slots: Sequence[Alternatives]) -> list[tuple[Alternative, ...]]:
        """Each way to fill some slots; from where they are too many, a slot is open."""
        whole = combined(slots)
        if whole is not None:
            return whole
        narrow: list[Alternatives] = []
        for slot in slots:
            fitting = len(slot) == 1 or combined([*narrow, slot]) is not None
            narrow.append(slot if fitting else still_open(f"more than {MOST_VALUES} values"))
        return combined(narrow) or []

    def _open_texts(self, place: CodePlace, names: Sequence[Alternative], remaps: Sequence[Alternative]) -> None:
        for one, sort in [
            *zip(names, ("started", "started", "node", "node"), strict=True),
            *((one, "remap") for one in remaps),
        ]:
            if one.why:
                self._gap(place, sort, f"{one.text} is not known: it depends on {', '.join(one.why)}")

    def _pairs(self, place: CodePlace, sort: str, value: object) -> list[tuple[Alternatives, Alternatives]]:
        """Pairs of texts: remappings, or arguments of an include."""
        if value is None:
            return []
        if isinstance(value, dict):
            value = [[key, one] for key, one in value.items()]
        if isinstance(value, Choice):
            return self._chosen_pairs(place, sort, value)
        made = []
        for pair in value if isinstance(value, list) else [value]:
            inner = pair.value if isinstance(pair, Perhaps) else pair
            if isinstance(inner, list) and len(inner) == 2:  # noqa: PLR2004 - a pair
                made.append((self._context.texts(inner[0]), self._context.texts(inner[1])))
            elif isinstance(inner, list):
                made += self._pairs(place, sort, inner) if inner and self._spent() else []
            else:
                why = inner.why if isinstance(inner, Open) else "a value that is no pair of texts"
                self._gap(place, sort, f"{'remappings' if sort == 'remap' else 'arguments'} that are not known: {why}")
        return made

    def _chosen_pairs(self, place: CodePlace, sort: str, value: Choice) -> list[tuple[Alternatives, Alternatives]]:
        """Pairs of which each is there only where its option is chosen; it is empty elsewhere."""
        made = []
        for number, option in enumerate(value.options):
            mine = ((value.chooser, number),)
            others = [
                Alternative("", picks=((value.chooser, other),))
                for other in range(len(value.options))
                if other != number
            ]
            for pair in self._pairs(place, sort, option):
                ends = [
                    (
                        *(one._replace(picks=both) for one in end if (both := together(one.picks, mine)) is not None),
                        *others,
                    )
                    for end in pair
                ]
                made.append((ends[0], ends[1]))
        return made

    def _spent(self) -> bool:
        self._spend()
        return True

    def _settings(self, place: CodePlace, value: object) -> list[Setting]:
        """What a list of parameters sets, in its order: single values and files."""
        made: list[Setting] = []
        for entry in value if isinstance(value, list) else [] if value is None else [value]:
            inner = entry.value if isinstance(entry, Perhaps) else entry
            self._spend()
            if isinstance(inner, dict):
                made += self._of_map(place, inner)
            elif isinstance(inner, Setting):
                made.append(inner)
            elif isinstance(inner, Substitution) and inner.sort == "rewritten":
                source, changes, replaced = inner.parts
                written = (
                    {str(key): self._context.texts(one) for key, one in changes.items()}
                    if isinstance(changes, dict)
                    else {}
                )
                words = tuple(str(key) for key in replaced) if isinstance(replaced, dict) else ()
                made.append(
                    Setting("", self._context.texts(source), file=True, written=tuple(written.items()), replaced=words)
                )
            elif isinstance(inner, Choice) and not all(isinstance(one, str | Substitution) for one in inner.options):
                for option in inner.options:
                    several = self._settings(place, [option])
                    made += [one._replace(texts=still_open("a condition")) for one in several]
            elif not isinstance(inner, str | Substitution | Choice | list):
                why = inner.why if isinstance(inner, Open) else getattr(inner, "name", "a value that is no file")
                self._gap(place, "parameter", f"parameters that are not known: {why}")
            elif isinstance(inner, list) and not all(_is_text(one) for one in inner):
                made += self._settings(place, inner)
            else:
                made.append(Setting("", self._context.texts(inner), file=True))
        return made

    def _of_map(self, place: CodePlace, entries: dict[object, object]) -> Iterator[Setting]:
        waiting: list[tuple[str, object, object]] = [("", key, value) for key, value in entries.items()]
        while waiting:
            self._spend()
            before, key, value = waiting.pop(0)
            names = (
                self._context.texts(key)
                if isinstance(key, str | int | float | Substitution | Choice)
                else still_open("a name")
            )
            if names[0].why:
                self._gap(place, "parameter", f"a parameter whose name is not known: {', '.join(names[0].why)}")
                continue
            name = before + names[0].text
            if isinstance(value, dict):
                waiting += (
                    [(f"{name}.", inner, one) for inner, one in value.items()] if len(name) < LONGEST_NAME else []
                )
            elif isinstance(value, list) and not any(isinstance(one, Substitution) for one in value):
                texts = [self._context.texts(one) for one in value]
                yield Setting(name, (Alternative("[" + ", ".join(one[0].text for one in texts) + "]"),))
            else:
                yield Setting(name, alike(self._context.texts(value)))

    def _set_parameter(self, place: CodePlace, setting: Setting, text: Alternative, parameters: NodeParameters) -> None:
        """Set what a setting sets with one of its values."""
        if not setting.file:
            parameters.add(setting.name, None if text.why else text.text)
            return
        file = "" if text.why or not text.text else self.sources.resolved(text.text)
        entries = self.sources.parameters(file) if file else None
        if entries is None:
            if text.text or text.why:
                self._gap(place, "parameter", f"a file of parameters that is not read: {path_text(text.text)}")
            return
        changed = dict(setting.written)
        for entry in entries:
            last = entry.name.rpartition(".")[2]
            values = changed.get(entry.name, changed.get(last, (Alternative(entry.value),)))
            unresolved = len(values) > 1 or values[0].why or any(word in entry.value for word in setting.replaced)
            value = None if unresolved else values[0].text
            parameters.of_file(entry.node, entry.name, value)

    def _process(self, action: Action, *, conditional: bool) -> None:
        """``ros2 run`` and ``ros2 launch`` start what a node or an include would, ``ros2 bag record`` a recorder."""
        place = action.place
        words = [one[0].text for one in self._words(action.values.get("words"))]
        words = words[words.index("ros2") :] if "ros2" in words else [*_after_path(words)]
        if words[:2] == ["ros2", "run"]:
            plain = [word for word in words[2:] if not word.startswith("--prefix")]
            if len(plain) > 1:
                options = ros_options([(Alternative(word),) for word in plain[2:]])
                slots = ((Alternative(plain[0]),), (Alternative(plain[1]),), NO_TEXT, NO_TEXT)
                self._node(place, slots, (), (), options, conditional=conditional)
        elif words[:3] == ["ros2", "bag", "record"]:
            of_recorder = [(Alternative(text),) for text in ("rosbag2", "recorder", recorder_name(words[3:]), "")]
            self._node(place, of_recorder, (), (), RosOptions(words=tuple(words[3:])), conditional=conditional)
        elif words[:2] == ["ros2", "launch"]:
            plain = [word for word in words[2:] if not word.startswith("-")]
            files = [word for word in plain if ":=" not in word]
            path = f"{PACKAGE}{files[0]}/launch/{files[1]}" if len(files) > 1 else files[0] if files else ""
            pairs: list[object] = [list(word.split(":=", 1)) for word in plain if ":=" in word]
            values: dict[str, object] = {"file": path, "arguments": pairs}
            self._group(
                Action(kinds.GROUP, place, {"actions": [Action(kinds.INCLUDE, place, values)]}), conditional=conditional
            )

    def _words(self, value: object) -> list[Alternatives]:
        """The words of a command, one after the other."""
        listed = value if isinstance(value, list) else [] if value is None else [value]
        return [word for one in listed for word in self._split(one)]

    def _split(self, value: object) -> list[Alternatives]:
        texts = self._context.texts(value)
        written = OPEN.sub(lambda part: part[0].replace(" ", "_"), texts[0].text)  # what is open is no several words
        if len(texts) == 1 and " " in written:
            try:
                return [(texts[0]._replace(text=word),) for word in shlex.split(written)]
            except ValueError:
                return [texts]
        return [texts]


def absolute(namespace: str) -> str:
    """Return a namespace from the root; empty where there is none."""
    return namespace if not namespace or namespace.startswith("/") else f"/{namespace}"


def alike(texts: Alternatives) -> Alternatives:
    """Return the first of some numbers or truth values: none is the name of a channel."""
    return texts[:1] if all(NO_NAME.fullmatch(one.text) for one in texts) else texts


def _rest(parts: Sequence[Alternative]) -> tuple[str, tuple[str, ...], tuple[tuple[str, int], ...]]:
    """How some alternatives together are known, why they are open, and what was chosen for them."""
    known = DEFAULT if any(one.surety == DEFAULT for one in parts) else LITERAL
    why = tuple(dict.fromkeys(reason for one in parts for reason in one.why))
    return known, why, tuple(sorted({pick for one in parts for pick in one.picks}))


def _is_text(value: object) -> bool:
    return isinstance(value, str) or (isinstance(value, Substitution) and value.sort != "rewritten")


def _sure(value: Alternative) -> bool:
    return not value.why and value.surety == LITERAL


def _after_path(words: Sequence[str]) -> Iterator[str]:
    """A command whose program is found by its path, or in a shell: ``bash -c "ros2 run …"``."""
    for at, word in enumerate(words):
        if word.rpartition("/")[2] in ("ros2", "{ros2}"):
            yield "ros2"
            yield from words[at + 1 :]
            return
