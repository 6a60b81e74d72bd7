"""Pins of code into label files: for each node that a label speaks of, which version of its code is there (S11).

In: checkouts or launch files, and label files. Out: the new texts of these. A pin of a node that is there and whose
code is not stays: that the code is gone is what it tells.
"""

from __future__ import annotations

import os
from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.model import Place
from rosprivacy.analysis.text import counted
from rosprivacy.ingest.labels.pins import CodePin
from rosprivacy.ingest.policies.names import covered
from rosprivacy.ingest.scan.checkout import chosen, code_of, scanned
from rosprivacy.ingest.scan.code_roots import read_as_one
from rosprivacy.labelling.label_lines import own_file
from rosprivacy.labelling.pinning import pins_of, with_pins
from rosprivacy.question import question_of
from rosprivacy.systems.granted import code_roots
from rosprivacy.systems.robot_system import read_label_files

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.labelling.label_lines import LabelLines
    from rosprivacy.settings import Settings

    Versions = Mapping[str, Mapping[str, str]]  # node -> unit of its code -> hash

NO_CODE = "is no folder of source code and no launch file", "name the checkout of the robot, or a launch file of it"


def pinned_code(sources: tuple[str, ...], labels: tuple[str, ...], settings: Settings) -> Iterator[LabelLines]:
    """Yield the label files of a robot with pins of the code that is there now.

    Raises
    ------
    InputErrors
        With every problem of the input.
    LabelError
        If a file has no place for them.
    """
    own_file(labels)
    versions = _versions(sources)
    vocabulary = question_of(settings).vocabulary
    files = {os.path.realpath(file.file): file for file in read_label_files(labels, vocabulary, settings)}
    for labels_read in files.values():
        if not labels_read.shipped:
            pins, lacking = _pins(labels_read, versions)
            written = with_pins(labels_read, labels_read.file, pins_of(labels_read)._replace(of_code=pins), vocabulary)
            what = f"the code of {counted(len(lacking), 'reviewed node')} is not there, so no pin is made"
            remarks = (f"{labels_read.file}: {what}: {', '.join(map(shown, lacking))}",) if lacking else ()
            yield replace(written, remarks=(*written.remarks, *remarks))


def _versions(sources: tuple[str, ...]) -> Versions:
    roots = code_roots(sources)
    if others := [name for name in sources if name not in roots]:
        raise InputErrors([InputError(name, 0, *NO_CODE) for name in others])
    versions: dict[str, dict[str, str]] = defaultdict(dict)
    for folders, launch in read_as_one(roots.values()):
        code = code_of(*folders, launch=launch)
        for node in chosen(*scanned(*folders, launch=launch), launch).nodes:
            units = versions[node.name]
            unit = code.unit_of(node.code) if node.code else ""
            if unit and (now := code.version(unit)):
                units[unit] = now.hash
    return versions


def _pins(labels: Labels, versions: Versions) -> tuple[tuple[CodePin, ...], list[str]]:
    """The pins of a file, and the nodes that it speaks of and whose code is not there."""
    said = [entry.name for entry in labels.entries if entry.statements and "node" in entry.kinds]
    reviewed = sorted({name for written in said for name in covered(written, versions)})
    before = {pin.ends[0][1]: pin.versions for pin in labels.code_pins}
    units = {name: tuple(sorted(versions[name].items())) or before.get(name, ()) for name in reviewed}
    pins = (CodePin((("node", name),), some, Place(labels.file, 0)) for name, some in units.items() if some)
    return tuple(pins), [name for name in reviewed if not versions[name]]
