"""``rosprivacy scan``: source code in, with its launch files; a policy and the types of its channels out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rosprivacy.cli.exit_code import UNDETERMINED


def scan(
    folders: Annotated[
        list[str],
        typer.Argument(
            metavar="FOLDER",
            help="Folders of sources, read as one checkout, launch files, or descriptions of nodes (NoDL).",
        ),
    ],
    launch: Annotated[
        str,
        typer.Option(metavar="FILE", show_default=False, help="The launch file whose system counts."),
    ] = "",
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            metavar="POLICY",
            show_default=False,
            help="Write the policy to this file, robot.policy.xml; beside it the types, robot.types.yaml, and what "
            "lies outside ROS as a label file, robot.outside.labels.yaml.",
        ),
    ] = None,
    types: Annotated[
        Path | None, typer.Option(metavar="FILE", show_default=False, help="Write the types to this file instead.")
    ] = None,
) -> None:
    """Say which nodes and channels source code makes, by each launch file. Nothing is run.

    What could not be resolved is listed with its line. What code says is not all that runs: the answer is undetermined.
    """
    import sys

    from rosprivacy.analysis.errors import InputError, InputErrors, shown
    from rosprivacy.cli.output import emit
    from rosprivacy.ingest.scan.code_roots import read_as_one
    from rosprivacy.ingest.types import types_path
    from rosprivacy.observing import declared_file, keeps_what_is_there
    from rosprivacy.scanning import scan as scanned
    from rosprivacy.scanning import scan_lines
    from rosprivacy.systems.granted import code_roots

    if types and not output:
        raise typer.BadParameter("--types is written beside --output POLICY")
    roots = code_roots(folders, granted=True)
    if unread := [name for name in folders if name not in roots]:
        hint = "name a folder of a ROS 2 package, or a launch file; policies are for rosprivacy analyze"
        raise InputErrors([InputError(name, 0, "no source code of ROS 2 to read", hint) for name in unread])
    if output:
        keeps_what_is_there(output)
    parts = read_as_one(roots.values())
    if (output or types or launch) and len(parts) > 1:
        raise typer.BadParameter("--launch, --output and --types are for one launch file")
    made = [scanned(*names, launch=launch or inner) for names, inner in parts]
    emit("".join(f"{line}\n" for one in made for line in scan_lines(one)), None)
    if not any(one.system.nodes for one in made):
        print("no node is found, so nothing is written", file=sys.stderr)
    elif output:
        beside = {types or types_path(output): made[0].types} if made[0].types else {}
        if made[0].labels:
            beside[declared_file(output, "outside")] = made[0].labels
        emit(made[0].policy, output, dict(beside))
        print(f"written: {' and '.join(shown(str(file)) for file in (output, *beside))}", file=sys.stderr)
    raise typer.Exit(UNDETERMINED)
