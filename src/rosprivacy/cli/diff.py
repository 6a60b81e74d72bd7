"""``rosprivacy diff``: what is new, gone and changed between two states of a system; an exit code for CI."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.python_311 import StrEnum
from rosprivacy.cli.exit_code import UNDETERMINED
from rosprivacy.cli.inputs import Inputs, reads_system, refuse
from rosprivacy.cli.options import READ, Output
from rosprivacy.cli.output import emit
from rosprivacy.ingest.reading.path_kinds import exists, is_file

if TYPE_CHECKING:
    from rosprivacy.report.compare.snapshot import CodeState, Snapshot
    from rosprivacy.settings import Settings


class DiffFormat(StrEnum):
    """Of what differs."""

    text = "text"
    json = "json"
    markdown = "markdown"


class FailOnChange(StrEnum):
    """Which differences end with exit code 1."""

    worse = "worse"
    any = "any"
    never = "never"


class As(StrEnum):
    """What the two are compared as."""

    states = "states"
    usage = "usage"


State = "a policy, a folder of them or of source code, a launch file, a fleet file, a saved analysis or a saved graph."
Old = Annotated[
    str | None,
    typer.Argument(
        metavar="OLD", show_default=False, help=f"Before: {State} Without both, the baseline of the project file."
    ),
]
New = Annotated[
    str | None, typer.Argument(metavar="NEW", show_default=False, help="After; the system of the project file.")
]
OldLabels = Annotated[
    list[str] | None,
    typer.Option(
        metavar="FILE", help="Label file for OLD, in place of --labels.", show_default=False, rich_help_panel=READ
    ),
]
Format = Annotated[
    DiffFormat, typer.Option("--format", "-f", help="For people, for programs, for a comment on a pull request.")
]
FailOn = Annotated[
    FailOnChange,
    typer.Option(
        help="Exit with 1 on a finding, doubt or verdict that is new or worse, and on a new way out or gap of "
        "source code; or on any difference; with 4 where labels are given and no data was followed on a side."
    ),
]
Base = Annotated[
    str,
    typer.Option(
        metavar="REVISION",
        show_default=False,
        help="Compare the one state that is named, or the working folder, with itself at this revision of the git "
        "repository in which it lies; labels are those of each.",
    ),
]
ComparedAs = Annotated[
    As, typer.Option("--as", help="Two states; or usage: OLD is what is granted, NEW what `observe` saw in use.")
]
Patch = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        show_default=False,
        help="With --as usage: write what was never seen in use, set to DENY, as a unified diff.",
    ),
]


@reads_system(
    "what OLD and NEW name, with all categories",
    without=("policies", "fleet", "from_database", "neo4j", "add", "categories"),
)
def diff(
    inputs: Inputs,
    old: Old = None,
    new: New = None,
    old_labels: OldLabels = None,
    format: Format = DiffFormat.text,  # noqa: A002 - the option's name
    output: Output = None,
    fail_on: FailOn = FailOnChange.worse,
    base: Base = "",
    compared_as: ComparedAs = As.states,
    patch: Patch = None,
) -> None:
    """Compare two states: grants, elements and findings, of source code ways out and gaps; new, gone or changed.

    Nodes whose names change at every start (a process id, an address) are matched without these. With --as usage it
    ends with 1 if something runs that is not granted, and with 4 if nothing such was seen but the observation has gaps.
    """
    if base and (new or old_labels or compared_as is As.usage):
        raise typer.BadParameter("--base is for one state, without --old-labels and --as usage")
    if compared_as is As.usage:
        refuse("diff --as usage", "policies alone", inputs.given_options("labels"))
        if not old or not new:
            raise typer.BadParameter("name what is granted and what was observed", param_hint="OLD NEW")
        _usage(old, new, inputs, format, output, patch)
    if patch:
        raise typer.BadParameter("--patch is for --as usage")
    from rosprivacy.report.compare.difference import difference, differs, incomparable

    both = _since(base, old or os.curdir, inputs) if base else _two_states(old, new, old_labels, inputs)
    document = difference(*both)
    emit(_text(document, format), output)
    if fail_on is FailOnChange.never:
        raise typer.Exit(0)
    failed = document["worse"] if fail_on is FailOnChange.worse else differs(document)
    raise typer.Exit(1 if failed else UNDETERMINED if incomparable(document) else 0)


def _since(revision: str, state: str, inputs: Inputs) -> tuple[Snapshot, Snapshot]:
    """A state as a revision of its repository has it, with the labels that this has, and as it is now."""
    from rosprivacy.cli.base_tree import at_revision, checkout_of, from_root, plain_name

    settings = _with_whole_names(inputs._replace(no_project=True).settings)
    state, labels = plain_name(state), tuple(map(plain_name, inputs.labels or ()))
    checkout = checkout_of(state)
    elsewhere = {name for name in labels if not from_root(name).is_relative_to(checkout)}
    named = [_whole(name) if name in elsewhere else name for name in labels]
    with at_revision(revision, checkout):
        try:
            before = _snapshot((state,), tuple(name for name in named if exists(name)), settings)
        except InputErrors as problems:
            raise InputErrors(
                InputError(f"{revision}:{one.file}", one.line, one.problem, one.hint) for one in problems.errors
            ) from None
    return before, _snapshot((state,), labels, settings)


def _two_states(
    old: str | None, new: str | None, old_labels: list[str] | None, inputs: Inputs
) -> tuple[Snapshot, Snapshot]:
    """The two that are named, or those of the project file, each with its labels."""
    (before, after), inputs = _states(old, new, inputs)
    settings, labels = inputs.settings, tuple(inputs.labels or ())
    return _snapshot(before, tuple(old_labels or labels), settings), _snapshot(after, labels, settings)


def _with_whole_names(settings: Settings) -> Settings:
    """Settings that name the same files from every folder: of a revision only the state and its labels are read."""
    from dataclasses import replace

    return replace(
        settings,
        ontologies=tuple(map(_whole, settings.ontologies)),
        types=tuple(map(_whole, settings.types)),
        permissions_ca=tuple(map(_whole, settings.permissions_ca)),
        standard_channels=settings.standard_channels and _whole(settings.standard_channels),
        type_limits=settings.type_limits and _whole(settings.type_limits),
        decisions=settings.decisions and _whole(settings.decisions),
    )


def _whole(name: str) -> str:
    """The name of a file from the root; of what is no file, such as a fingerprint, as it is."""
    return str(Path(name).absolute()) if exists(name) else name


def _states(old: str | None, new: str | None, inputs: Inputs) -> tuple[tuple[tuple[str, ...], ...], Inputs]:
    """What is compared: what is named, or the baseline and the system of the project file."""
    if old and new:
        return ((old,), (new,)), inputs._replace(no_project=True)
    from rosprivacy.cli.project_file import project_of

    stated = None if old else project_of(inputs.project, ignored=inputs.no_project)
    if stated is None or not stated.baseline or not (stated.policies or stated.fleet):
        what = "name two states; or a baseline, and policies or a fleet, in a project file"
        raise typer.BadParameter(what, param_hint="OLD NEW")
    inputs = inputs.completed()
    return ((stated.baseline,), (stated.fleet,) if stated.fleet else stated.policies), inputs


def _usage(
    granted: str, observed: str, inputs: Inputs, form: DiffFormat, output: Path | None, patch: Path | None
) -> NoReturn:
    """What is granted against what was seen in use."""
    from rosprivacy.checking import usage_document
    from rosprivacy.report.compare.difference import usage_lines, usage_markdown
    from rosprivacy.report.json_text import as_text

    saved = (_kind(granted) == "graph", _kind(observed) == "graph")
    document = usage_document(granted, observed, inputs.settings, saved=saved)
    texts = {
        DiffFormat.json: lambda: as_text(document),
        DiffFormat.markdown: lambda: usage_markdown(document),
        DiffFormat.text: lambda: "".join(f"{line}\n" for line in usage_lines(document)),
    }
    emit(texts[form](), output, {patch: document["patch"] or None} if patch else {})
    if patch and not document["patch"]:
        print(f"{shown(str(patch))}: left as it is: there is no patch; the answer says why", file=sys.stderr)
    raise typer.Exit(1 if document["not_granted"] else UNDETERMINED if document["gaps"] else 0)


def _text(document: dict[str, Any], form: DiffFormat) -> str:
    from rosprivacy.report.compare.difference import difference_lines, difference_markdown
    from rosprivacy.report.json_text import as_text

    if form is DiffFormat.json:
        return as_text(document)
    if form is DiffFormat.markdown:
        return difference_markdown(document)
    return "".join(f"{line}\n" for line in difference_lines(document))


def _snapshot(states: tuple[str, ...], labels: tuple[str, ...], settings: Settings) -> Snapshot:
    """Read a state, whatever it is; several files are policies."""
    from dataclasses import replace

    from rosprivacy.report.compare.snapshot import snapshot
    from rosprivacy.systems.fleet_system import answer_fleet
    from rosprivacy.systems.robot_system import answer_robot

    state, kind = states[0], _kind(states[0])
    if kind == "analysis":
        from rosprivacy.report.compare.earlier import read_earlier

        return snapshot(read_earlier(state).document, None)
    if kind == "fleet":
        result = answer_fleet(state, settings)
    elif kind == "graph":
        result = answer_robot((), labels, replace(settings, add=(state,)))
    else:
        result = answer_robot(states, labels, settings)
        return snapshot(result.document(), result.policies, _code(states))
    return snapshot(result.document(), result.policies)


def _code(states: tuple[str, ...]) -> CodeState | None:
    """What source code says beyond its policy, if a state is one."""
    from rosprivacy.systems.granted import code_roots

    roots = code_roots(states)
    if not roots:
        return None
    from rosprivacy.ingest.scan.code_roots import read_as_one
    from rosprivacy.scanning import code_state, scan

    return code_state(scan(*folders, launch=launch) for folders, launch in read_as_one(roots.values()))


def _kind(state: str) -> str:
    """What a file is, by how it begins; folders, globs and launch files are read as policies."""
    try:
        path = Path(state)
        head = path.read_bytes()[:4096] if is_file(path) else b""
    except (OSError, ValueError):
        return "policies"
    if b'"rosprivacy.analysis/' in head:
        return "analysis"
    if b'"rosprivacy.graph/' in head:
        return "graph"
    if head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<") or not head:
        return "policies"
    from rosprivacy.systems.granted import code_roots

    return "policies" if code_roots((state,)) else "fleet"
