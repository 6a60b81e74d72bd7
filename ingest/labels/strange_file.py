"""A label file whose names are not in the policies -> one sentence that says what it looks like.

In: label files, and the names of a graph. Out: an error for a file, said before those of its single names: they are
there below one namespace, or the file is that of another robot (rule S11).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.written_names import LITERAL, bare_name, is_glob

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.ingest.labels.entries import Entry
    from rosprivacy.ingest.labels.label_file import Labels

    Matching = Callable[[str, Iterable[str]], Collection[int]]  # name or glob, kinds -> vertices
    Names = Mapping[str, Iterable[str]]  # of a graph, by kind

FEWEST = 3  # names of a file of which it can be said that it is about another robot
SHARED = 3  # one of so many names may be that of every robot, such as /cmd_vel
PUSHED = 2  # names that have to be there below a namespace
NAMESPACES = 8  # that are tried


def strange_files(labels: Iterable[Labels], matching: Matching, names: Names) -> Iterator[LabelError]:
    """Yield what each label file looks like of whose names many are not in the policies."""
    for file in labels:
        entries = {(entry.name, entry.kinds): entry for entry in file.entries}.values()
        missing = [entry for entry in entries if not matching(entry.name, entry.kinds)]
        if file.shipped or len(missing) < PUSHED:
            continue
        if namespace := _namespace(missing, matching, names):
            yield _pushed(file.file, len(missing), shown(namespace))
        elif len(entries) >= FEWEST and (len(entries) - len(missing)) * SHARED <= len(entries):
            yield _of_another_robot(file.file, len(entries) - len(missing), len(entries))


def _pushed(file: str, missing: int, namespace: str) -> LabelError:
    what = f"the {missing:,} of its names that are not in the policies are there below {namespace}"
    hint = f"name the robot in a fleet file (--fleet) with namespace: {{strip: {namespace}}}"
    return LabelError(file, 0, what, f"{hint}, or write {namespace} before each")


def _of_another_robot(file: str, matches: int, total: int) -> LabelError:
    are = "1 is" if matches == 1 else f"{matches or 'none'} are"
    what = f"of its {total:,} names {are} in the policies, so it looks like another robot's"
    return LabelError(file, 0, what, "name the label file of this one, or begin one: rosprivacy labels --init")


def _namespace(missing: Sequence[Entry], matching: Matching, names: Names) -> str:
    """The one namespace below which all missing names are; empty if there is none, or several."""
    first = next((entry for entry in missing if not is_glob(entry.name)), None)
    if first is None or not all(bare_name(entry.name).startswith("/") for entry in missing):
        return ""
    end = bare_name(first.name)
    longer = (name for kind in first.kinds for name in names.get(kind, ()) if name.endswith(end))
    begins = sorted({name.removesuffix(end) for name in longer} - {""})[:NAMESPACES]
    fit = [begin for begin in begins if all(matching(_below(begin, one.name), one.kinds) for one in missing)]
    return fit[0] if len(fit) == 1 else ""


def _below(namespace: str, written: str) -> str:
    sign = LITERAL if written.startswith(LITERAL) else ""
    return f"{sign}{namespace}{bare_name(written)}"
