"""What a launch file does, whatever it is written in: actions with their arguments, in the order of the text.

Made by ``launch_python.py`` and ``launch_markup.py``, done by ``launch_runs.py``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rosprivacy.ingest.scan.scan_facts import CodePlace

NODE, COMPONENT, LOAD, INCLUDE, PROCESS = "node", "component", "load", "include", "process"
GROUP, ACTIONS, UNKNOWN, NOTHING = "group", "actions", "unknown", "nothing"
DECLARE, SET, ENVIRONMENT, NAMESPACE, REMAP = "declare", "set", "environment", "namespace", "remap"
PARAMETER, PARAMETER_FILE = "parameter", "parameter file"


class Action(NamedTuple):
    """One action.

    Attributes
    ----------
    values
        By name; those that there are of each sort::

            node            package, executable, name, namespace, remappings, parameters, arguments, descriptions
            component       the same; the class is the executable
            load            descriptions (of components)
            include         file, arguments (pairs)
            process         words
            group           actions, scoped, configurations
            actions         actions: one after the other, in no scope
            declare         name, default, choices (of an argument)
            set             name, value (of a configuration); environment: of a variable
            namespace       namespace
            remap           src, dst
            parameter       name, value
            parameter file  file
            unknown         why

        With ``condition`` it is done only if that holds.
    """

    sort: str
    place: CodePlace
    values: dict[str, object]


class Condition(NamedTuple):
    """When an action is done.

    Attributes
    ----------
    text
        A value that is true or false as text.
    negated
        Whether the action is done where the text is false.
    """

    text: object
    negated: bool = False
