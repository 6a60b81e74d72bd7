"""A launch file in Python -> its actions, by the signatures of ``launch``, ``launch_ros`` and ``ament_index``.

In: text. Out: what ``generate_launch_description`` returns, as actions. An ``OpaqueFunction`` is followed as if it were
called in its place. Helpers of other modules of the checkout are followed too.

Source: launch 3.x (``launch.actions``, ``launch.substitutions``, ``launch.conditions``), launch_ros 0.2x
(``launch_ros.actions``, ``launch_ros.descriptions``, ``launch_ros.substitutions``), and nav2_common.
"""

from __future__ import annotations

import ast
import re
import warnings
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import yaml

from rosprivacy.analysis.errors import InputError
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
from rosprivacy.ingest.scan.launch.launch_values import PACKAGE, Choice, Open, Perhaps, Substitution, choice, path_text
from rosprivacy.ingest.scan.launch.python_built_ins import Call, joined
from rosprivacy.ingest.scan.launch.python_evaluation import CONFIGURATIONS, DERIVED, Evaluation, Function
from rosprivacy.ingest.scan.scan_facts import CodePlace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from rosprivacy.ingest.reading.yaml_values import Value

GENERATE = "generate_launch_description"
OLD_NAMES = {
    "node_name": "name", "node_namespace": "namespace", "node_executable": "executable", "node_plugin": "executable",
    "plugin": "executable", "composable_node_descriptions": "descriptions", "cmd": "words", "default_value": "default",
    "launch_arguments": "arguments", "launch_description_source": "file", "launch_configurations": "configurations",
    "initial_entities": "actions", "filename": "file",
}  # fmt: skip


class _Class(NamedTuple):
    """What a class makes, and its arguments by their places."""

    sort: str
    positional: tuple[str, ...] = ()


CLASSES = {
    "Node": _Class(NODE),
    "LifecycleNode": _Class(NODE),
    "ComposableNodeContainer": _Class(NODE),
    "ComposableNode": _Class(COMPONENT),
    "ComposableLifecycleNode": _Class(COMPONENT),
    "LoadComposableNodes": _Class(LOAD),
    "IncludeLaunchDescription": _Class(INCLUDE, ("file",)),
    "LaunchDescription": _Class(ACTIONS, ("actions",)),
    "GroupAction": _Class(GROUP, ("actions",)),
    "TimerAction": _Class(ACTIONS),
    "DeclareLaunchArgument": _Class(DECLARE, ("name",)),
    "DeclareBooleanLaunchArg": _Class(DECLARE, ("name",)),  # of moveit_configs_utils
    "SetLaunchConfiguration": _Class(SET, ("name", "value")),
    "SetEnvironmentVariable": _Class(ENVIRONMENT, ("name", "value")),
    "PushRosNamespace": _Class(NAMESPACE, ("namespace",)),
    "PushROSNamespace": _Class(NAMESPACE, ("namespace",)),
    "SetRemap": _Class(REMAP, ("src", "dst")),
    "SetParameter": _Class(PARAMETER, ("name", "value")),
    "SetParametersFromFile": _Class(PARAMETER_FILE, ("file",)),
    "ExecuteProcess": _Class(PROCESS),
    "ExecuteLocal": _Class(NOTHING),
    "AppendEnvironmentVariable": _Class(NOTHING),
    "EmitEvent": _Class(NOTHING),
    "LogInfo": _Class(NOTHING),
    "PopLaunchConfigurations": _Class(NOTHING),
    "PushLaunchConfigurations": _Class(NOTHING),
    "ResetEnvironment": _Class(NOTHING),
    "ResetLaunchConfigurations": _Class(NOTHING),
    "RosTimer": _Class(ACTIONS),
    "SetROSLogDir": _Class(NOTHING),
    "Shutdown": _Class(NOTHING),
    "ShutdownAction": _Class(NOTHING),
    "UnregisterEventHandler": _Class(NOTHING),
    "UnsetEnvironmentVariable": _Class(NOTHING),
    "UnsetLaunchConfiguration": _Class(NOTHING),
}
SOURCES = frozenset(
    ["AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource", "LaunchDescriptionSource",
     "PythonLaunchDescriptionSource", "XMLLaunchDescriptionSource", "YAMLLaunchDescriptionSource"]
)  # fmt: skip
DONE_LATER = ("actions", "entities", "on_completion", "on_exit", "on_output", "on_start", "on_stderr", "on_stdout")
GETTERS = ("os.environ.get", "environ.get", f"{CONFIGURATIONS}.get")
SHARES = frozenset(["get_package_share_directory", "get_package_share_path", "FindPackageShare"])
PREFIXES = frozenset(["get_package_prefix", "FindPackagePrefix", "FindPackage"])
NUMBER = re.compile(r"[-+.\w]{1,40}", re.ASCII)
OF_ROS = ("launch", "launch_ros", "ament_index_python", "moveit_configs_utils", "nav2_common", "os")  # known here
LOADERS = frozenset(["load", "loads", "safe_load", "full_load"])  # of yaml and json
WRAPPERS = frozenset(  # what only wraps its first argument
    ["AnonName", "BooleanSubstitution", "FindExecutable", "ParameterFile", "ParameterValue", "Path", "PosixPath",
     "PurePath", "TextSubstitution", "abspath", "copy", "deepcopy", "expanduser", "normpath",
     "perform_substitutions", "realpath"]
)  # fmt: skip


class PythonLaunches:
    """Reads launch files in Python, and the modules of the checkout that they import.

    Parameters
    ----------
    text
        Of a file of the checkout; None where it cannot be read.
    resolved
        The file of the checkout that a path leads to; empty if there is none.
    module
        A name that is imported -> the file of the checkout that defines it, and its name there; None of others.
    """

    def __init__(
        self,
        text: Callable[[str], str | None],
        resolved: Callable[[str], str],
        module: Callable[[str, str], str | None],
        spend: Callable[[], None],
    ) -> None:
        self._text = text
        self._resolved = resolved
        self._module = module
        self._spend = spend
        self._modules: dict[str, Evaluation | None] = {}

    def actions(self, file: str) -> Action | None:
        """Return what a file does; None where it is no launch file in Python.

        Raises
        ------
        SyntaxError, ValueError, RecursionError, MemoryError
            If it is not Python.
        """
        module = self._evaluation(file)
        generate = module.scope.get(GENERATE) if module else None
        if module is None or not isinstance(generate, Function):
            return None
        value = generate.module.entered(generate, Call(GENERATE, file, generate.node.lineno, [], {}))
        return Action(ACTIONS, CodePlace(file, generate.node.lineno), {"actions": value})

    def expression(self, written: str) -> object:
        """Return what an expression of Python comes to; nothing of a module is seen in it."""
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                tree = ast.parse(written.strip(), mode="eval")
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            return Open("an expression")
        alone = Evaluation("", self._call, lambda _, __: None, self._spend, written)
        return alone.value(tree.body, alone.scope)

    def _evaluation(self, file: str) -> Evaluation | None:
        if file in self._modules:
            return self._modules[file]
        self._modules[file] = None  # while it is read: modules that import each other
        text = self._text(file)
        if text is None:
            return None
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(text)
        module = Evaluation(file, self._call, self._imported, self._spend, text)
        module.block(tree.body, module.scope, [])
        module.conditions = 0
        self._modules[file] = module
        return module

    def _imported(self, importing: Evaluation, name: str) -> object:
        if name.partition(".")[0] in OF_ROS:
            return None
        module, _, last = name.rpartition(".")
        file = self._module(importing.file, module) if module else None
        if file is None or file == importing.file:
            return None
        try:
            other = self._evaluation(file)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            return Open(f"{file}, which cannot be read")
        return other.scope.get(last) if other else None

    def _call(self, module: Evaluation, call: Call) -> object:  # noqa: PLR0911 - one for each of the API
        name = call.name.rpartition(".")[2].lstrip("?")
        place = CodePlace(module.file, call.line)
        first = call.positional[0] if call.positional else None
        if call.name.startswith("."):
            return _added(module, call)
        if call.name.startswith(DERIVED) and name != "DeclareLaunchArgument":
            return Action(UNKNOWN, place, {"why": f"what a {call.name} does"})
        if name in LOADERS and isinstance(first, Substitution) and first.sort == "contents":
            return self._contents(first.parts[0]) if isinstance(first.parts[0], str) else Open("the values in a file")
        if name in CLASSES and not call.name.startswith("?"):
            return _action(CLASSES[name], call, place)
        if name == "OpaqueFunction":
            return self._opaque(call, place)
        if (
            name == "RegisterEventHandler"
            or name.startswith(("OnProcess", "OnExecution", "OnShutdown", "OnState", "OnAction"))
            or name == "EventHandler"
        ):
            return _later(call, place)
        if name in SOURCES:
            return first if call.positional else next(iter(call.keywords.values()), Open("a launch file"))
        if condition := _condition(name, call):
            return condition
        return _substitution(name, call, place)

    def _contents(self, path: str) -> object:
        """The values in a file of the checkout, in YAML or JSON."""
        file = self._resolved(path)
        text = self._text(file) if file else None
        try:
            return (
                Open(f"the values in {path_text(path)}")
                if text is None
                else self._plain(yaml_values.parse(text, partial(InputError, path)))
            )
        except InputError:
            return Open(f"the values in {path_text(path)}, which cannot be read")

    def _plain(self, value: Value) -> object:
        self._spend()
        if value.kind == "map":
            return {key: self._plain(inner) for key, _, inner in value.entries}
        if value.kind == "list":
            return [self._plain(inner) for inner in value.items]
        if value.kind == "number":
            number = yaml.safe_load(value.text) if NUMBER.fullmatch(value.text) else value.text
            return number if isinstance(number, bool | int | float) else value.text
        return value.text if value.kind == "text" else None

    def _opaque(self, call: Call, place: CodePlace) -> Action:
        function = call.keywords.get("function", call.positional[0] if call.positional else None)
        arguments, keywords = call.keywords.get("args"), call.keywords.get("kwargs")
        if not isinstance(function, Function):
            return Action(UNKNOWN, place, {"why": "a function that is not in the checkout"})
        positional = [Open("context"), *(arguments if isinstance(arguments, list) else [])]
        named = (
            {key: one for key, one in keywords.items() if isinstance(key, str)} if isinstance(keywords, dict) else {}
        )
        made = function.module.entered(function, Call("", place.file, place.line, positional, named))
        return Action(ACTIONS, place, {"actions": made, "condition": call.keywords.get("condition")})


def _action(api: _Class, call: Call, place: CodePlace) -> Action:
    values: dict[str, object] = dict(zip(api.positional, call.positional, strict=False))
    values |= {OLD_NAMES.get(key, key): value for key, value in call.keywords.items()}
    if api.sort in (ACTIONS, GROUP):
        value = values.get("actions")
        values["actions"] = value if isinstance(value, list) else [] if value is None else [value]
    if "ros_arguments" in values:
        words = [values.get("arguments") or [], values.pop("ros_arguments")]
        plain, ros = (one if isinstance(one, list) else [one] for one in words)
        values["arguments"] = [*plain, "--ros-args", *ros]
    return Action(api.sort, place, values)


def _added(module: Evaluation, call: Call) -> object:
    """``description.add_action(action)``."""
    owner, *added = call.positional
    listed = owner.values.get("actions") if isinstance(owner, Action) else None
    if call.name in (".add_action", ".add_entity") and isinstance(listed, list):
        listed += [Perhaps(one) if module.conditions else one for one in added]
        return None
    if call.name == ".entities":
        return listed
    return Open(f"{call.name.lstrip('.')}()")


def _later(call: Call, place: CodePlace) -> Action:
    """The actions that an event brings: they are done when it comes."""
    made: list[object] = [call.positional[0]] if call.name.endswith("RegisterEventHandler") and call.positional else []
    for key, value in call.keywords.items():
        if key in DONE_LATER or key == "event_handler":
            done = value
            if isinstance(value, Function):
                done = value.module.entered(
                    value, Call("", place.file, place.line, [Open("event"), Open("context")], {})
                )
            made.append(done)
    condition = call.keywords.get("condition")
    return Action(
        ACTIONS, place, {"actions": made, "condition": condition if isinstance(condition, Condition) else None}
    )


def _condition(name: str, call: Call) -> Condition | None:
    first = call.positional[0] if call.positional else next(iter(call.keywords.values()), None)
    if name in ("IfCondition", "UnlessCondition"):
        return Condition(first, name == "UnlessCondition")
    if name in ("LaunchConfigurationEquals", "LaunchConfigurationNotEquals"):
        wanted = call.positional[1] if len(call.positional) > 1 else call.keywords.get("expected_value")
        held = Substitution("configuration", (first,))
        return Condition(Substitution("equal", (held, wanted)), name.endswith("NotEquals"))
    return None


def _substitution(name: str, call: Call, place: CodePlace) -> object:  # noqa: PLR0911, PLR0912 - one for each of the API
    arguments, keywords = call.positional, call.keywords
    first = arguments[0] if arguments else next(iter(keywords.values()), None)
    second = arguments[1] if len(arguments) > 1 else None
    if name in ("LaunchConfiguration", "EnvironmentVariable", "getenv") or call.name in GETTERS:
        default = keywords.get("default", keywords.get("default_value", second))
        sort = "configuration" if name == "LaunchConfiguration" or CONFIGURATIONS in call.name else "environment"
        return Substitution(sort, (first,) if default is None else (first, default))
    if name in SHARES:
        return PACKAGE + first if isinstance(first, str) else Substitution("share", (first,))
    if name in PREFIXES:
        return Substitution("prefix", (first,))
    if name in ("PathJoinSubstitution", "join", "PathSubstitution") and arguments:
        return joined(first if isinstance(first, list) and name != "join" else arguments)
    if name == "dirname":
        return Substitution("folder", (first,))
    if name == "ThisLaunchFileDir":
        return Substitution("here", ())
    if name in ("PythonExpression", "LocalSubstitution"):
        return Substitution("expression", (first,)) if name[0] == "P" else Open(name)
    if name == "IfElseSubstitution":
        if_true, if_false = keywords.get("if_value", second), keywords.get("else_value", (*arguments, "", "", "")[2])
        return choice([if_true, if_false], f"{place.file}:{place.line}")
    if name in ("RewrittenYaml", "ReplaceString"):
        changes = keywords.get("param_rewrites", {}), keywords.get("replacements", {})
        return Substitution("rewritten", (keywords.get("source_file", first), *changes))
    if name in ("Path", "PosixPath", "PurePath") and len(arguments) > 1:
        return joined(arguments)
    if name in WRAPPERS and not call.name.startswith("?"):
        return first
    if name == "exists" or name.startswith("is"):
        return Open("whether a file is there")
    held = [one for one in (*arguments, *keywords.values()) if _does_something(one)]
    why = f"what {name or 'a call'}() in line {call.line} makes"
    if held:
        return Action(ACTIONS, place, {"actions": [Perhaps(held), Action(UNKNOWN, place, {"why": why})]})
    return Open(why)


def _does_something(value: object) -> bool:
    if isinstance(value, Choice):
        return any(isinstance(one, Action) for one in value.options)
    listed: Iterable[object] = value if isinstance(value, list) else (value,)
    return any(isinstance(one, Action) and one.sort != DECLARE for one in listed)
