"""Where a finding stands, as SARIF has it: files as URIs, paths as ``codeFlows``, elements as logical locations.

In: the names that a user gave; a ``Finding`` and where things stand. Out: URIs as RFC 3986 has them, relative to the
root of the repository where they can be, so that they mean the same on every machine; plain dicts, the witness first,
each step at the policy line that allows it. Names come from anybody's files: they are made printable, short, and
neither links nor placeholders.
"""

from __future__ import annotations

import os
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from rosprivacy.analysis.answer import Step
from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Flow
from rosprivacy.analysis.text import one_line
from rosprivacy.report.places import of_step

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element, Place
    from rosprivacy.report.places import PlaceIndex

    Physical = Callable[[Place], dict[str, Any]]
    Pair = tuple[tuple[str, str, str, str], tuple[str, str, str, str]]

LONGEST = 4000  # characters of a path; no system has longer ones


def repository_root(files: Iterable[str]) -> Path:
    """Return the folder that file names are shown relative to.

    The repository around the working directory if it holds one of the files, else that around the first file in one,
    else the working directory. A repository is a folder with ``.git`` in it.
    """
    here = Path.cwd()
    absolute = [Path(os.path.abspath(file)) for file in files if "\0" not in file]  # noqa: PTH100 - links stay links
    around = _repository(here)
    if around and (not absolute or any(file.is_relative_to(around) for file in absolute)):
        return around
    return next((found for file in absolute if (found := _repository(file.parent))), around or here)


def uri_of(file: str, root: Path) -> tuple[str, bool]:
    """Return the URI of a file, and whether it is relative to the root.

    >>> uri_of("/work/robot/my policy.xml", Path("/work"))
    ('robot/my%20policy.xml', True)
    >>> uri_of("/etc/policy.xml", Path("/work"))
    ('file:///etc/policy.xml', False)
    """
    path = Path(os.path.abspath(file[:LONGEST].replace("\0", "")))  # noqa: PTH100 - what a link points to has another name
    for base, inside in ((root, path), (_resolved(root), _resolved(path))):
        if inside.is_relative_to(base) and inside != base:
            return _quoted(inside.relative_to(base).as_posix()), True
    return f"file://{'' if path.as_posix().startswith('/') else '/'}{_quoted(path.as_posix())}", False


def _repository(folder: Path) -> Path | None:
    try:
        return next((above for above in (folder, *folder.parents) if (above / ".git").exists()), None)
    except OSError:  # a name that is too long, a folder that may not be entered
        return None


def _resolved(path: Path) -> Path:
    try:
        return path.resolve()
    except (OSError, RuntimeError):  # as above; a loop of links
        return path


def _quoted(path: str) -> str:
    """Escape all that is no plain character of a path; a name that is no UTF-8 keeps its bytes."""
    return quote(os.fsencode(path), safe="/")


MAX_FLOWS = 10  # paths of a finding
MAX_STEPS = 1_000  # locations of a path: what GitHub shows; 10 of them are what it takes


def text(name: str) -> str:
    """Return a name for a message of SARIF, where ``{0}`` is a placeholder and ``[a](b)`` a link.

    >>> text("/a[0-9]{1}](b)")
    '/a[0-9]{{1}}] (b)'
    """
    return _neutral(shown(name))


def prose(text: str) -> str:
    """Return a longer text for a message, as ``text`` does a name."""
    return _neutral(one_line(text))


def _neutral(text: str) -> str:
    return text.replace("{", "{{").replace("}", "}}").replace("](", "] (")


def element_name(element: Element) -> str:
    """Return an element's name for a message: with its robot, and its kind where it is no node."""
    leg = f"{element.leg} of " if element.leg else ""
    kind = "" if element.is_node else f"{leg}{element.kind} "
    return f"{kind}{text(element.full_name)}"


def logical(element: Element) -> dict[str, str]:
    """Return an element as ``logicalLocation``."""
    kind = "module" if element.is_node else "resource"
    return {"name": shown(element.name), "fullyQualifiedName": shown(element.full_name), "kind": kind}


def further_paths(finding: Finding) -> int:
    """Return how many paths of a finding are known beside its witness."""
    return len(_other_elements(finding))


def flows_of(
    finding: Finding, between: Mapping[Pair, Flow], places: PlaceIndex, physical: Physical
) -> list[dict[str, Any]]:
    """Return the ``codeFlows`` of a finding: the witness, then further paths up to a bound, one ``threadFlow`` each."""
    paths: list[Sequence[Step]] = [finding.steps]
    paths += [_steps(path, between) for path in _other_elements(finding)[: MAX_FLOWS - 1]]
    start = _start(finding, places)
    return [
        {
            "threadFlows": [{"locations": _locations(finding, steps, start, physical)}],
            "message": {"text": _about(number)},
        }
        for number, steps in enumerate(paths)
    ]


def _about(number: int) -> str:
    return "A shortest path." if number == 0 else "Another path."


def _other_elements(finding: Finding) -> list[tuple[Element, ...]]:
    return [path for path in finding.paths if path != finding.witness]


def _steps(path: Iterable[Element], between: Mapping[Pair, Flow]) -> list[Step]:
    """The steps of a path that is known by its elements; what the data is on each step is not known."""
    nothing = Flow(0, 0, "flow")
    found = [(a, b, between.get((a.shown_as, b.shown_as), nothing)) for a, b in pairwise(path)]
    return [Step(a, b, flow.role, "", pseudonymised=False, grants=flow.grants) for a, b, flow in found]


def _start(finding: Finding, places: PlaceIndex) -> Place:
    """Where a path begins: the label of the source, its profile, or the first line that lets the data go."""
    said = places.of_role(finding.source, "source", finding.steps[0].category if finding.steps else finding.category)
    lines = (place for step in finding.steps for place in of_step(step))
    return said or places.of_profile(finding.source) or next(lines, None) or places.of_finding(finding)


def _locations(finding: Finding, steps: Sequence[Step], start: Place, physical: Physical) -> list[dict[str, Any]]:
    """One location per element: the source, then what each step leads to, at the line that allows the step."""
    begins = f"{element_name(finding.source)} is a source of {_data(steps[0]) if steps else text(finding.category)}."
    if not steps:
        begins = f"{element_name(finding.source)} is a source and a leak of {text(finding.category)}."
    found: list[tuple[Element, str, Place]] = [(finding.source, begins, start)]
    for step in steps:
        place = next(iter(of_step(step)), found[-1][2])  # a wildcard covers: the line before holds the wildcard
        found.append((step.target, _hop(step), place))
    if len(found) > MAX_STEPS:
        left_out = len(found) - MAX_STEPS
        element, what, place = found[-MAX_STEPS // 2]
        after = (element, f"{left_out} steps are left out before this one. {what}", place)
        found = [*found[: MAX_STEPS // 2], after, *found[len(found) - MAX_STEPS // 2 + 1 :]]
    return [
        {
            "location": {
                "physicalLocation": physical(place),
                "logicalLocations": [logical(element)],
                "message": {"text": what},
            },
            "executionOrder": order,
            "importance": "essential" if order in (1, len(found)) else "important",
        }
        for order, (element, what, place) in enumerate(found, 1)
    ]


def _data(step: Step) -> str:
    return f"pseudonymised {text(step.category)}" if step.pseudonymised else text(step.category or "data")


def _hop(step: Step) -> str:
    """One step as a sentence, with the profile that may do it."""
    source, target, data = element_name(step.source), element_name(step.target), _data(step)
    if step.role == "matches":
        return f"{source} and {target} overlap, by a wildcard."
    if step.target.is_channel:
        what = f"{source} sends {data} to {target}"
    elif step.source.is_channel:
        what = f"{target} receives {data} from {source}"
    else:
        what = f"{data} goes from {source} to {target}"
    grant = next(iter(step.grants), None)
    if grant is None or not grant.node:
        return f"{what}."
    if grant.basis:
        return f"{what} ({text(step.role)} by {text(grant.node)}; the name is known by: {text(grant.basis)})."
    return f"{what} ({text(step.role)}, profile {text(grant.node)} of enclave {text(grant.enclave)})."
