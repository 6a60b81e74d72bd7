"""What descriptions say of nodes, and what the code of these nodes does: two policies to compare.

In: a folder of sources, and the descriptions that speak of it. Out: two policies with the same nodes, and what could
not be compared. Channels that ROS itself adds count on neither side: descriptions leave them out.

Source: ros-tooling/nodl, ``describe.md`` (which channels these are).
"""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Diagnostic, Severity
from rosprivacy.analysis.model.message_type import PARAMETER_SERVICES
from rosprivacy.ingest.reading.file_kinds import DESCRIPTIONS
from rosprivacy.ingest.scan.checkout import chosen, read_checkout, systems_of
from rosprivacy.ingest.scan.checkout_files import checkout_files
from rosprivacy.ingest.scan.descriptions import Descriptions
from rosprivacy.ingest.scan.packages import read_packages
from rosprivacy.ingest.scan.scan_facts import DESCRIBED
from rosprivacy.ingest.scan.scanned_policy import line_of_code, scanned_policy

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.model import Policy
    from rosprivacy.ingest.scan.systems import ChannelEnd, ScannedSystem

OF_ROS = frozenset([
    ("rosout", "rcl_interfaces/msg/Log"),
    ("parameter_events", "rcl_interfaces/msg/ParameterEvent"),
    *PARAMETER_SERVICES.items(),
    ("get_type_description", "type_description_interfaces/srv/GetTypeDescription"),
])  # fmt: skip


def described_and_coded(described: tuple[str, str], code: tuple[str, str]) -> tuple[Policy, Policy] | None:
    """Return what descriptions say, and what the code of the same nodes does; None where no description is.

    Parameters
    ----------
    described
        A folder, and in it the description that counts; empty where all do.
    code
        A folder, and in it the launch file that counts; empty where none is named.
    """
    folder, file = described
    files = checkout_files(folder)
    descriptions = Descriptions(Path(files.root), read_packages(files))
    above = os.path.relpath(files.root, os.path.realpath(code[0]))
    several = descriptions.of_file(file) if file.endswith(DESCRIPTIONS) else descriptions.nodes()
    speaking = tuple(one.elsewhere(above) for one in several)
    if not speaking:
        return None
    checkout = read_checkout(code[0], described=speaking)
    system = chosen(checkout, systems_of(checkout), code[1])
    of_descriptions = {end.place for one in speaking for end in one.endpoints}
    compared = {node.name for node in system.nodes if node.code and node.code.described}
    ends = [end for end in system.ends if end.node in compared and not _is_of_ros(end)]
    gaps = (*system.gaps, *(gap._replace(place=gap.place.below(above)) for gap in descriptions.gaps))
    policies = [
        scanned_policy(system._replace(ends=tuple(some), gaps=gaps), code[0])
        for some in (
            [end for end in ends if end.place in of_descriptions],
            [end for end in ends if end.place not in of_descriptions],
        )
    ]
    first, second = policies
    return replace(first, diagnostics=(*first.diagnostics, *_sides(system, code[0]))), second


def _is_of_ros(end: ChannelEnd) -> bool:
    return (end.name.rpartition("/")[2], end.type) in OF_ROS


def _sides(system: ScannedSystem, folder: str) -> Iterator[Diagnostic]:
    """Where both sides of a node stand; of a node of the code that no description speaks of, that it is so."""
    for node in system.nodes:
        if node.code and node.code.language != DESCRIBED:
            at = ", ".join(str(line_of_code(place, folder)) for place in node.code.described)
            text = f"{node.name}: compared with its description at {at}" if at else f"{node.name}: no description"
            yield Diagnostic(line_of_code(node.code.place, folder), Severity.NOTICE, text)
