"""``rosprivacy unload``: robots and bags out of the database."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rosprivacy.analysis.bounds import Bounds
from rosprivacy.analysis.errors import QueryError, shown
from rosprivacy.cli.driver import driver_of
from rosprivacy.cli.options import BoundsRaised, FleetFile, IncludeRoot, Ontologies, Server
from rosprivacy.cli.output import emit


def unload(
    robot: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Robot to remove; may be repeated.", show_default=False)
    ] = None,
    fleet: FleetFile = None,
    bag: Annotated[
        str | None,
        typer.Option(metavar="PATH", help="Bag to remove, or the folder of bags that were loaded.", show_default=False),
    ] = None,
    ontology: Ontologies = None,
    include_root: IncludeRoot = None,
    bound: BoundsRaised = None,
    neo4j: Server = None,
) -> None:
    """Remove a robot, a fleet or bags from Neo4j; what people added stays, but for what hangs on their elements."""
    from rosprivacy.ingest.neo4j_graph.loading import unload

    if [bool(robot), bool(fleet), bool(bag)].count(True) != 1:
        raise typer.BadParameter("name robots with --robot, a fleet file with --fleet, or a bag with --bag")
    if bag:
        _unload_bags(bag, neo4j)
        return
    robot = list(robot or ()) or _names_in(fleet or "", tuple(ontology or ()), include_root, Bounds.raised(bound or ()))
    with driver_of(neo4j) as driver:
        gone = unload(driver, robot)
    missing = [name for name in robot if name not in gone]
    emit("".join(f"robot {shown(name)} is removed\n" for name in gone), None)
    if missing:
        raise QueryError(f"no robot {', '.join(map(shown, missing))} in the database; see rosprivacy query robots")


def _unload_bags(path: str, neo4j: str | None) -> None:
    from rosprivacy.ingest.neo4j_graph.bag_rows import unload_bags

    with driver_of(neo4j) as driver:
        gone = unload_bags(driver, path)
    if not gone:
        raise QueryError(f"no bag {shown(path)} in the database; see rosprivacy query bags")
    emit("".join(f"bag {shown(place)} is removed\n" for place in gone), None)


def _names_in(fleet: str, ontologies: tuple[str, ...], include_root: Path | None, bounds: Bounds) -> list[str]:
    """The names under which a fleet is filed in the database."""
    from rosprivacy.ingest.fleet.alike_robots import known_to_flows
    from rosprivacy.ingest.fleet.fleet_file import read_fleet
    from rosprivacy.ontology.vocabulary import load

    read = read_fleet(fleet, load(ontologies=ontologies), include_root=include_root, bounds=bounds)
    return [*known_to_flows(read), *([read.name] if read.elements else [])]
