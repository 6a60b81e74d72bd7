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

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import Diagnostic, Policy
    from rosprivacy.settings import Settings

ZENOH = ".json5"
"""How the name of a Zenoh configuration ends."""
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
    access = [name for name in dict.fromkeys(names) if name.endswith(ZENOH)]
    granted, stated = deployed(name for name in names if not name.endswith(ZENOH))
    policies: tuple[Policy, ...] = ()
    said: tuple[Diagnostic, ...] = ()
    if settings.permissions_ca and (unsigned := (*stated, *access)):
        raise InputErrors(
            [PolicyError(name, 0, UNSIGNED, "name a keystore, or leave the option away") for name in unsigned]
        )
    if stated or not (granted or access):
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
    return policies, said


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
