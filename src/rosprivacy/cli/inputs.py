"""What a command reads: one set of options for all commands, and the one place where ``Settings`` are made of it.

In: the options of a user. Out: ``Inputs``. A field of ``Inputs`` is an option; its annotation is what typer needs.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from copy import copy
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, get_args, get_type_hints

import typer

from rosprivacy.analysis.bounds import Bounds
from rosprivacy.analysis.modes import View
from rosprivacy.cli.driver import driver_of
from rosprivacy.cli.options import (
    NOT_USED,
    AllowUnsigned,
    BoundsRaised,
    Categories,
    DecisionsFile,
    Domain,
    FleetFile,
    FromDatabase,
    IncludeRoot,
    LabelFiles,
    NoProject,
    Ontologies,
    PermissionsCA,
    Policies,
    ProjectFile,
    SavedGraphs,
    Server,
    SixLists,
    Standard,
    TypeLimitsFile,
    TypesFiles,
    ViewChosen,
    ViewOrBoth,
)
from rosprivacy.cli.output import progress_of

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator

    from rosprivacy.cli.project_file import Project
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings


class Inputs(NamedTuple):
    """What a user names of the system that is read, and how it is read."""

    policies: Policies = None
    labels: LabelFiles = None
    fleet: FleetFile = None
    from_database: FromDatabase = False
    neo4j: Server = None
    add: SavedGraphs = None
    ontology: Ontologies = None
    standard_channels: Standard = "rosprivacy:standard"
    types: TypesFiles = None
    type_limits: TypeLimitsFile = "rosprivacy:types"
    domain: Domain = None
    allow_unsigned: AllowUnsigned = False
    permissions_ca: PermissionsCA = None
    include_root: IncludeRoot = None
    bound: BoundsRaised = None
    categories: Categories = None
    category: SixLists = "PersonalData"
    view: ViewChosen = View.declared
    decisions: DecisionsFile = None
    project: ProjectFile = None
    no_project: NoProject = False

    @property
    def stated(self) -> Project | None:
        """What the project file states that these inputs were completed from; None without one."""
        from rosprivacy.cli.project_file import project_of

        return project_of(self.project) if self.project and not self.no_project else None

    @property
    def settings(self) -> Settings:
        """The settings that the options mean to the library."""
        from rosprivacy.settings import Settings

        return Settings(
            add=tuple(self.add or ()),
            view=self.view.value,
            categories=tuple(self.categories or ()),
            ontologies=tuple(self.ontology or ()),
            category=self.category,
            standard_channels=None if self.standard_channels == NOT_USED else self.standard_channels,
            types=tuple(self.types or ()),
            type_limits=None if self.type_limits == NOT_USED else self.type_limits,
            domain=self.domain,
            allow_unsigned=self.allow_unsigned,
            permissions_ca=tuple(self.permissions_ca or ()),
            include_root=str(self.include_root) if self.include_root else None,
            bounds=Bounds.raised(self.bound or ()),
            progress=progress_of,
            decisions=str(self.decisions) if self.decisions else None,
            project=stated.name_and_hash if (stated := self.stated) and self._is_of(stated) else None,
        )

    @property
    def required_policies(self) -> tuple[str, ...]:
        """The policies that are named; there has to be one, or a saved graph."""
        if not self.policies and not self.add:
            from rosprivacy.cli.folder_notice import folder_notice

            what = "name at least one policy: a file, a folder or a glob; or have one named by a project file"
            raise typer.BadParameter(f"{what} (rosprivacy init). Here {folder_notice(Path.cwd())}", param_hint="POLICY")
        return tuple(self.policies or ())

    def given_options(self, *names: str) -> list[str]:
        """Return those of some options that a user gave, as they are written; not what the project file states."""
        given = [name for name in names if getattr(self, name) != DEFAULTS[name]]
        stated = self.stated if given else None
        if stated and self._is_of(stated):
            given = [name for name in given if getattr(self, name) != _as_option(name, getattr(stated, name, None))]
        return [WRITTEN[name] for name in given]

    def check(self) -> None:
        """Refuse options that name a second system beside a first, and how to read files where none is read."""
        if self.from_database:
            refuse("--from-database", "what is in the database", self.given_options(*OF_FILES))
        if self.fleet:
            refuse("--fleet", "what the fleet file names", self.given_options("policies", "labels", "add", "types"))

    def completed(self, without: Collection[str] = ()) -> Inputs:
        """Return the same with what the project file states and is not named here; say in one line what was taken.

        Parameters
        ----------
        without
            Options that the command does not take; one that takes no policies takes nothing.
        """
        from rosprivacy.cli.project_file import project_of

        project = None if {"project", "policies"} & {*without} else project_of(self.project, ignored=self.no_project)
        if project is None:
            return self
        there = [name for name in OF_SYSTEM if name not in without and getattr(project, name) not in (None, ())]
        taken: dict[str, Any] = {}
        if self._is_of(project):
            named = [name for name in there if getattr(self, name) not in (None, [])]
            taken = {name: _as_option(name, getattr(project, name)) for name in there if name not in named}
            line = project.use([*taken], [name for name in named if name != "policies"], "others are named")
        else:
            line = project.use([], there, "another system is named")
        if line:
            print(line, file=sys.stderr)
        return self._replace(project=Path(project.file), **taken)

    def _is_of(self, project: Project) -> bool:
        return not (self.from_database or self.add) and project.is_about(self.policies, self.fleet)

    def viewed(self, view: ViewOrBoth) -> Inputs:
        """Return the same under the view of a command that has one more; with both, the declared one is of record."""
        if self.from_database and view is not ViewOrBoth.declared:
            refuse("--from-database", "what is in the database", ["--view"])
        return self._replace(view=View.enforced if view is ViewOrBoth.enforced else View.declared)

    def result(self, settings: Settings, *, both_views: bool = False) -> Result:
        """Read the system and analyse it; with ``both_views`` under both views (rule S6)."""
        if both_views:
            return self._result_of_both(settings)
        if self.from_database:
            from rosprivacy.systems.stored_system import answer_stored

            with driver_of(self.neo4j) as driver:
                return answer_stored(driver, settings)
        if self.fleet:
            from rosprivacy.systems.fleet_system import answer_fleet

            return answer_fleet(self.fleet, settings)
        from rosprivacy.systems.robot_system import answer_robot

        return answer_robot(self.required_policies, tuple(self.labels or ()), settings)

    def _result_of_both(self, settings: Settings) -> Result:
        from rosprivacy.both_views import both_views, both_views_of_fleet

        if self.fleet:
            return both_views_of_fleet(self.fleet, settings)
        return both_views(self.required_policies, tuple(self.labels or ()), settings)


OF_SYSTEM = ("policies", "fleet", "labels", "types", "decisions", "domain")  # what a project file states of one
OF_FILES = (
    "policies", "labels", "add", "fleet", "standard_channels", "types", "domain",
    "allow_unsigned", "permissions_ca", "include_root", "category", "view",
)  # fmt: skip
DEFAULTS = Inputs._field_defaults
WRITTEN = {name: f"--{name.replace('_', '-')}" for name in DEFAULTS} | {"policies": "POLICY"}


def refuse(command: str, takes: str, options: Iterable[str]) -> None:
    """Refuse options that make no sense beside a command or another option."""
    refused = ", ".join(options)
    if refused:
        raise typer.BadParameter(f"{command} takes {takes}: no {refused}")


Command = Callable[..., None]


def reads_system(takes: str = "", *, without: Collection[str] = ()) -> Callable[[Command], Command]:
    """Give a command that reads a system the options of its groups, of ``inputs: Inputs`` among them.

    Parameters
    ----------
    takes
        What the command takes, for those who give it an option that it does not take.
    without
        Names of options of ``Inputs`` that make no sense for the command: they are refused, and help does not show
        them.
    """

    def decorated(command: Command) -> Command:
        has_language = "lang" in inspect.signature(command).parameters

        def checked(context: typer.Context, values: dict[str, Any]) -> None:
            inputs = values["inputs"]
            refuse(command.__name__.replace("_", "-"), takes, inputs.given_options(*without))
            inputs = values["inputs"] = inputs.completed(without)
            inputs.check()
            if has_language and (stated := inputs.stated) and stated.lang and not _is_given(context, "lang"):
                values["lang"] = stated.lang

        return _with_groups(command, without, checked)

    return decorated


def takes_groups(command: Command) -> Command:
    """Give a command the options of its parameters that are groups of options.

    A group is a named tuple; a field is an option, and its annotation is what typer needs.
    """
    return _with_groups(command, (), lambda _, __: None)


def _with_groups(
    command: Command, without: Collection[str], check: Callable[[typer.Context, dict[str, Any]], None]
) -> Command:
    """The command with options in the place of its groups; an option of its own stands for one of ``Inputs``."""
    own = inspect.signature(command, eval_str=True).parameters
    kinds = {name: each.annotation for name, each in own.items() if hasattr(each.annotation, "_field_defaults")}
    others = {field for kind in kinds.values() if kind is not Inputs for field in kind._fields}
    left_out = {*own, *others, *(["policies"] if "policies" in without else [])}
    groups = {
        name: [each for each in _parameters(kind, without) if kind is not Inputs or each.name not in left_out]
        for name, kind in kinds.items()
    }

    @wraps(command)
    def run(context: typer.Context, **values: Any) -> None:
        for name, fields in groups.items():
            values[name] = kinds[name](**{field.name: values.pop(field.name) for field in fields})
        check(context, values)
        command(**values)

    parameters = [inspect.Parameter("context", inspect.Parameter.KEYWORD_ONLY, annotation=typer.Context)]
    for name, parameter in own.items():
        parameters += groups.get(name) or [parameter.replace(kind=inspect.Parameter.KEYWORD_ONLY)]
    vars(run)["__signature__"] = inspect.Signature(parameters)  # typer reads it
    run.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return run


def _as_option(name: str, value: Any) -> Any:
    """What a project file states, as typer gives it."""
    return [*value] if isinstance(value, tuple) else Path(value) if name == "decisions" else value


def _is_given(context: typer.Context, option: str) -> bool:
    """Whether an option stands on the command line, be it with its default."""
    source = context.get_parameter_source(option)
    return source is not None and source.name == "COMMANDLINE"


def _parameters(group: Any, hidden: Collection[str]) -> Iterator[inspect.Parameter]:
    hints = get_type_hints(group, include_extras=True)
    for name, default in group._field_defaults.items():
        kind, information = get_args(hints[name])
        information = copy(information)
        information.hidden = name in hidden
        parameter = inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default)
        yield parameter.replace(annotation=Annotated[kind, information])
