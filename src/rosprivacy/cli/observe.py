"""``rosprivacy observe``: a running system, or what was told of it, in; a policy and the types of its channels out."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from rosprivacy.analysis.errors import shown
from rosprivacy.cli.exit_code import UNDETERMINED
from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.output import emit

if TYPE_CHECKING:
    from collections.abc import Callable

    from rosprivacy.ingest.running.doors import Door, Wait
    from rosprivacy.ingest.running.observation import Observation

THROUGH = "Through which door"  # panel of help
SHORTEST = "10s"  # what most middlewares need until all is found


class DoorOptions(NamedTuple):
    """Through what is looked, and how."""

    endpoint: Annotated[
        str,
        typer.Argument(
            metavar="[ENDPOINT]",
            show_default=False,
            help="With --zenoh: where the router is; by default tcp/localhost:7447.",
        ),
    ] = ""
    text: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FILE",
            show_default=False,
            help="What `ros2 node info` printed, for all nodes; - is standard input; may be repeated.",
            rich_help_panel=THROUGH,
        ),
    ] = None
    rosgraph: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FILE",
            show_default=False,
            help="A message of rosgraph_msgs: what `ros2 topic echo --full-length` printed (- is standard input), or "
            "a recording (.mcap, .db3); may be repeated.",
            rich_help_panel=THROUGH,
        ),
    ] = None
    earlier: Annotated[
        list[str] | None,
        typer.Option(
            metavar="POLICY",
            show_default=False,
            help="What an earlier run wrote, with the types beside it: adds up; may be repeated.",
            rich_help_panel=THROUGH,
        ),
    ] = None
    at: Annotated[
        str | None,
        typer.Option(
            metavar="TIME",
            show_default=False,
            help="When the texts were taken, as 2026-11-22T10:00:00Z; by default when each file was last written.",
            rich_help_panel=THROUGH,
        ),
    ] = None
    ros2: Annotated[
        bool,
        typer.Option("--ros2", help="Run `ros2 node list` and `ros2 node info` here.", rich_help_panel=THROUGH),
    ] = False
    dds: Annotated[
        bool, typer.Option("--dds", help="Join the DDS domain as a reader of discovery.", rich_help_panel=THROUGH)
    ] = False
    zenoh: Annotated[
        bool,
        typer.Option(
            "--zenoh",
            help="Ask a Zenoh router for the tokens of ROS: --zenoh, or --zenoh ENDPOINT.",
            rich_help_panel=THROUGH,
        ),
    ] = False
    domain: Annotated[
        int,
        typer.Option(
            metavar="N", min=0, max=232, envvar="ROS_DOMAIN_ID", help="The ROS domain.", rich_help_panel=THROUGH
        ),
    ] = 0
    peer: Annotated[
        list[str] | None,
        typer.Option(
            metavar="HOST",
            show_default=False,
            help="With --dds: ask this host too, where there is no multicast; may be repeated.",
            rich_help_panel=THROUGH,
        ),
    ] = None
    interface: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            show_default=False,
            help="With --dds: the network to look at; lo is this computer only.",
            rich_help_panel=THROUGH,
        ),
    ] = ""
    router: Annotated[
        str,
        typer.Option(
            metavar="ENDPOINT",
            show_default=False,
            help="The same as ENDPOINT.",
            rich_help_panel=THROUGH,
        ),
    ] = ""
    session_file: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            show_default=False,
            envvar="ZENOH_SESSION_CONFIG_URI",
            help="With --zenoh: your own session file (JSON5), such as one with TLS.",
            rich_help_panel=THROUGH,
        ),
    ] = None


@reads_system(
    "labels for --watch",
    without=(
        "policies", "fleet", "from_database", "neo4j", "add", "include_root", "decisions", "view",
        "categories", "types", "project", "no_project",
    ),
)  # fmt: skip
def observe(
    inputs: Inputs,
    look: DoorOptions,
    duration: Annotated[
        str, typer.Option("--for", metavar="DURATION", help="How long to look, such as 30s, 10m or 1h.")
    ] = SHORTEST,
    watch: Annotated[
        bool,
        typer.Option("--watch", help="Look until stopped; one line for each change, and with --labels new findings."),
    ] = False,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            metavar="FILE",
            show_default=False,
            help="Write the policy to this file, robot.policy.xml, and the types beside it, robot.types.yaml.",
        ),
    ] = None,
) -> None:
    """Make a policy and a file of types from what runs. It reads only; nothing is announced on the ROS graph.

    What was not seen proves nothing: the policy says from when to when somebody looked, and which gaps are known.
    """
    from rosprivacy.ingest.running.doors import Stop
    from rosprivacy.observing import keeps_what_is_there, seconds_of
    from rosprivacy.observing import observe as looked

    stop = Stop()
    doors = _doors(look, stop.wait if watch else time.sleep)
    if watch and (look.text or look.rosgraph or look.earlier or len(doors) > 1):
        what = "--watch looks through one door to a running system: no files, no --earlier, and no second door"
        raise typer.BadParameter(what)
    if output:
        keeps_what_is_there(output)
    if not watch:
        seen = looked(doors, seconds_of(duration))
    else:
        with stop.heard():
            seen = looked(doors, None, _watching(inputs))
    _write(seen, output)


def _doors(look: DoorOptions, wait: Wait) -> list[Door]:
    """The doors that a user named, those that have looked already first."""
    doors = _doors_of_ros(look, wait)
    if look.endpoint and not look.zenoh:
        raise typer.BadParameter(f"{shown(look.endpoint)}: an endpoint is for --zenoh, and each FILE follows a --text")
    if (look.router and not look.zenoh) or ((look.peer or look.interface) and not look.dds):
        raise typer.BadParameter("--router is for --zenoh; --peer and --interface are for --dds")
    if look.endpoint and look.router:
        raise typer.BadParameter("say once where the router is: --zenoh ENDPOINT, or --zenoh --router ENDPOINT")
    if look.zenoh:
        doors.append(_zenoh_door(look.domain, look.endpoint or look.router, look.session_file, wait))
    if look.dds:
        doors.append(_dds_door(look.domain, tuple(look.peer or ()), look.interface, wait))
    if not doors:
        raise typer.BadParameter(
            "name a door: --text FILE, --rosgraph FILE, --ros2, --zenoh, --dds, or what was seen by --earlier POLICY"
        )
    return doors


def _doors_of_ros(look: DoorOptions, wait: Wait) -> list[Door]:
    from rosprivacy.ingest.running.node_info import Ros2Program, TextFiles
    from rosprivacy.ingest.running.observed_files import EarlierFiles
    from rosprivacy.ingest.types import types_path
    from rosprivacy.observing import now, time_of

    doors: list[Door] = []
    if look.earlier:
        doors.append(EarlierFiles(tuple((file, str(types_path(Path(file)))) for file in look.earlier)))
    if look.text:
        doors.append(TextFiles(tuple(look.text), now, time_of(look.at) if look.at else ""))
    if look.rosgraph:
        from rosprivacy.ingest.running.graph_messages import GraphFiles

        doors.append(GraphFiles(tuple(look.rosgraph), now, time_of(look.at) if look.at else ""))
    if look.ros2:
        doors.append(Ros2Program(now, wait=wait))
    return doors


def _zenoh_door(domain: int, router: str, session_file: Path | None, wait: Wait) -> Door:
    from rosprivacy.ingest.running.zenoh_door import ZenohDoor
    from rosprivacy.observing import now

    return ZenohDoor(now, domain, router, session_file, wait)


def _dds_door(domain: int, peers: tuple[str, ...], interface: str, wait: Wait) -> Door:
    from rosprivacy.ingest.running.dds_door import DdsDoor
    from rosprivacy.observing import now

    return DdsDoor(now, domain, peers, interface, wait)


def _watching(inputs: Inputs) -> Callable[[Observation | None, Observation], None]:
    from rosprivacy.watching import Watch

    watch = Watch(tuple(inputs.labels or ()), inputs.settings)

    def progress(before: Observation | None, now: Observation) -> None:
        for line in watch.lines(before, now):
            print(line, flush=True)

    return progress


def _write(observation: Observation | None, output: Path | None) -> None:
    """The policy and the types, both or none; what there is to say goes to standard error."""
    from rosprivacy.ingest.types import types_path
    from rosprivacy.observing import declared_file, written

    made = written(observation) if observation else None
    if made is None:
        for remark in observation.remarks if observation else ():
            print(remark, file=sys.stderr)
        said = "nothing was seen, so nothing is written: nothing runs, it was too short a look, or you may not look"
        print(said, file=sys.stderr)
        raise typer.Exit(UNDETERMINED)
    beside = {types_path(output): made.types} if output else {}
    if output and made.declared:
        beside[declared_file(output)] = made.declared
    emit(made.policy, output, beside)
    for remark in made.remarks:
        print(remark, file=sys.stderr)
    if output:
        print(f"written: {' and '.join(shown(str(file)) for file in (output, *beside))}", file=sys.stderr)
    else:
        print("types are written only beside a policy that is written to a file (-o)", file=sys.stderr)
