"""``rosprivacy fleet``: what a fleet file means, and its schema."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.cli.inputs import Inputs
from rosprivacy.cli.options import BoundsRaised, DecisionsFile, IncludeRoot, Ontologies, Output
from rosprivacy.cli.output import emit

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.fleet.alike_robots import Alike
    from rosprivacy.ingest.fleet.fleet_file import Fleet


def fleet(
    file: Annotated[str | None, typer.Argument(metavar="FLEET", show_default=False, help="Fleet file.")] = None,
    schema: Annotated[bool, typer.Option("--schema", help="Print the JSON Schema of fleet files.")] = False,
    ontology: Ontologies = None,
    decisions: DecisionsFile = None,
    include_root: IncludeRoot = None,
    bound: BoundsRaised = None,
    output: Output = None,
) -> None:
    """List the robots of a fleet file, those that are alike together; or print the schema of such files."""
    from rosprivacy.ontology.vocabulary import load

    vocabulary = load(ontologies=tuple(ontology or ()))
    if schema == bool(file):
        raise typer.BadParameter("name a fleet file, or give --schema")
    if schema or file is None:
        from rosprivacy.ingest.fleet.fleet_schema import fleet_schema
        from rosprivacy.report.json_text import as_text

        emit(as_text(fleet_schema(vocabulary.categories.values())), output)
        return
    from rosprivacy.decided import decisions_of
    from rosprivacy.ingest.fleet.alike_robots import alike
    from rosprivacy.ingest.fleet.fleet_file import read_fleet

    settings = Inputs(decisions=decisions, bound=bound).settings
    read = read_fleet(file, vocabulary, include_root=include_root, bounds=settings.bounds)
    decided = decisions_of(settings, vocabulary)
    groups = alike(read, decided.told_apart) if decided else alike(read)
    emit("".join(f"{line}\n" for line in _lines(read, groups)), output)


def _lines(fleet: Fleet, groups: tuple[Alike, ...]) -> Iterator[str]:
    from rosprivacy.report.catalogs.words import IN_ENGLISH
    from rosprivacy.report.naming import names_shown

    kinds = sum(not group.fixed for group in groups)
    yield f"{len(fleet.robots):,} robots of {kinds:,} kinds, infrastructure: {len(fleet.infrastructure):,}"
    for group in groups:
        robot = group.robots[0]
        what = "infrastructure" if group.fixed else f"model {robot.model}" if robot.model else "no model"
        domain = f", domain {robot.domain}" if robot.domain else ""
        yield f"{names_shown((one.id for one in group.robots), IN_ENGLISH)}  ({len(group.robots):,}; {what}{domain})"
        labels = ("labels", robot.labels), ("own labels", robot.own)
        for name, files in (("policies", robot.policies), *labels, ("types", robot.types)):
            if files:
                yield f"    {name}: {', '.join(files)}"
