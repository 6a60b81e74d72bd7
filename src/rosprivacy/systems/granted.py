"""What a user names -> policies: SROS 2 policies, permissions files, keystores and Zenoh files, each by its reader.

In: paths, and the settings. Out: policies with what a reader has to know of them.
"""

from __future__ import annotations

import os
from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, PolicyError
from rosprivacy.clock import today
from rosprivacy.ingest.deployed.deployed_paths import deployed
from rosprivacy.ingest.policies.policy_files import read_policies
from rosprivacy.ingest.reading.bounded_file import WIDEN, leaves, what_leaves
from rosprivacy.ingest.reading.file_kinds import DESCRIPTIONS, OBSERVE, START

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import Diagnostic, Policy
    from rosprivacy.ingest.scan.checkout import Checkout
    from rosprivacy.ingest.scan.systems import ScannedSystem
    from rosprivacy.ingest.types.types_file import TypesFile
    from rosprivacy.settings import Settings

LAUNCH_ENDINGS = ("py", "xml", "yml", "yaml")
ZENOH = ".json5"
"""How the name of a Zenoh configuration ends."""
NO_NODE = (
    0,
    "no SROS 2 policy found, and no ROS 2 node in its code",
    f"name a file or folder that has one; or {OBSERVE}",
)
CORRECT = "correct it, as `ros2 nodl validate` checks it"
NO_START = (1, "this is a launch file, and no node is found that it starts", START)
UNSIGNED = "nobody signs such a file, and --permissions-ca asks for the CA of all that is read"
Read = tuple[tuple["Policy", ...], tuple["Diagnostic", ...]]


def read_granted(names: Iterable[str], settings: Settings, within: str | None = None) -> Read:
    """Read all that is named.

    Parameters
    ----------
    within
        A folder that no file may lie outside of, its own links followed; for names that a file states.

    Raises
    ------
    InputErrors
        With the problems of all files.
    """
    names = tuple(names)
    code = code_roots(names)
    names = tuple(name for name in names if name not in code)
    access = [name for name in dict.fromkeys(names) if name.endswith(ZENOH)]
    granted, stated = deployed(name for name in names if not name.endswith(ZENOH))
    policies: tuple[Policy, ...] = ()
    said: tuple[Diagnostic, ...] = ()
    if settings.permissions_ca and (unsigned := (*stated, *access)):
        raise InputErrors(
            [PolicyError(name, 0, UNSIGNED, "name a keystore, or leave the option away") for name in unsigned]
        )
    if stated or not (granted or access or code):
        policies, said = read_policies(
            stated,
            include_root=settings.include_root,
            within=within,
            besides=(*access, *granted),
            bounds=settings.bounds,
            progress=settings.progress,
        )
    if granted:
        policies = (*policies, *_deployed(granted, settings, within, (*stated, *access)))
    if access:
        policies = (*policies, *_zenoh(access, settings, within))
    if code:
        policies = (*policies, *_scanned_policies(code, within))
    return policies, said


def code_roots(names: Iterable[str], *, granted: bool = False) -> dict[str, tuple[str, str]]:
    """Return those names that are sources, each with the folder to read and the launch file or description in it.

    Parameters
    ----------
    granted
        Whether folders with a policy in them count, too: then it is not read.
    """
    found = {}
    for name in dict.fromkeys(names):
        if os.path.isdir(name) or name.endswith(DESCRIPTIONS) or _may_be_launch(os.path.basename(name)):  # noqa: PTH112, PTH119 - by its text
            from rosprivacy.ingest.scan.code_roots import root_of  # noqa: PLC0415 - light start

            root = root_of(name, granted=granted)
            if root:
                found[name] = root
    return found


def _may_be_launch(name: str) -> bool:
    """Whether a file is a launch file by its name; what it says is looked at then."""
    stem, _, ending = name.rpartition(".")
    return name.endswith(".launch") or (ending in LAUNCH_ENDINGS and "launch" in stem)


def code_folders(names: Iterable[str]) -> list[str]:
    """Return the folders of sources among some names: their code is evidence for suggestions, too."""
    return [folder for folder, file in code_roots(names).values() if not file.endswith(DESCRIPTIONS)]


def scanned_types(names: Iterable[str]) -> tuple[TypesFile, ...]:
    """Return the message types that sources among some names state."""
    code = code_roots(names)
    if not code:
        return ()
    from rosprivacy.ingest.scan.scanned_policy import scanned_types as types_of  # noqa: PLC0415 - light start

    return tuple(types_of(system, read.folder, read.definitions) for system, read, *_ in _scanned_systems(code))


def _scanned_policies(code: dict[str, tuple[str, str]], within: str | None) -> Iterator[Policy]:
    from rosprivacy.ingest.scan.scanned_policy import placed, scanned_policy  # noqa: PLC0415 - light start

    _confined([folder for folder, _ in code.values()], within)
    for system, checkout, folders, launch in _scanned_systems(code):
        folder = checkout.folder
        if not system.nodes:
            gaps = system.gaps if launch.endswith(DESCRIPTIONS) else ()
            refused = [PolicyError(placed(gap.place.file, folder), gap.place.line, gap.text, CORRECT) for gap in gaps]
            raise InputErrors(refused or [PolicyError(launch or next(iter(code)), *(NO_START if launch else NO_NODE))])
        yield replace(scanned_policy(system, folder), checkout=(folders, launch))


def _scanned_systems(
    code: dict[str, tuple[str, str]],
) -> Iterator[tuple[ScannedSystem, Checkout, tuple[str, ...], str]]:
    """The systems that code makes: the checkout that they are of, what was read as one, and the launch file."""
    from rosprivacy.ingest.scan.checkout import chosen, scanned  # noqa: PLC0415 - light start
    from rosprivacy.ingest.scan.code_roots import read_as_one  # noqa: PLC0415 - light start

    for folders, launch in read_as_one(code.values()):
        checkout, systems = scanned(*folders, launch=launch)
        yield chosen(checkout, systems, launch), checkout, folders, launch


def _zenoh(names: list[str], settings: Settings, within: str | None) -> tuple[Policy, ...]:
    from rosprivacy.ingest.deployed.zenoh_grants import read_zenoh  # noqa: PLC0415 - light start

    _confined(names, within)
    return read_zenoh(names, settings.domain, view=settings.view)


def _deployed(names: list[str], settings: Settings, within: str | None, besides: Iterable[str]) -> Iterator[Policy]:
    from rosprivacy.ingest.deployed.deployed_inputs import read_deployed  # noqa: PLC0415 - light start

    _confined(names, within)
    on = settings.today or today(os.environ)
    policies, said = read_deployed(
        names,
        settings.domain,
        on,
        allow_unsigned=settings.allow_unsigned,
        view=settings.view,
        authorities=settings.permissions_ca,
        besides=besides,
    )
    _confined([file for policy in policies for file, _ in policy.sources], within)
    return _with_said(policies, said)


def _with_said(policies: Iterable[Policy], diagnostics: Iterable[Diagnostic]) -> Iterator[Policy]:
    """What is said of a file goes with each policy that rests on it, else with one beside it, into saved graphs too."""
    policies = tuple(policies)
    resting: dict[str, list[int]] = defaultdict(list)
    beside: dict[str, int] = {}
    for at, policy in enumerate(policies):
        for file, _ in policy.sources:
            resting[file].append(at)
            beside.setdefault(os.path.dirname(file), at)  # noqa: PTH120 - by its text
    more: dict[int, list[Diagnostic]] = defaultdict(list)
    for one in diagnostics:
        file = one.place.file
        for at in resting.get(file) or (beside.get(os.path.dirname(file), 0),):  # noqa: PTH120 - by its text
            more[at].append(one)
    for at, policy in enumerate(policies):
        yield replace(policy, diagnostics=(*policy.diagnostics, *more[at]))


def _confined(files: Iterable[str], within: str | None) -> None:
    outside = dict.fromkeys(file for file in files if within is not None and leaves(file, within))
    if outside:
        raise InputErrors([PolicyError(file, 0, what_leaves(file, within or ""), WIDEN) for file in outside])
