"""What changed since an earlier report, in words: the verdict, the files, the paths to assess, the open elements.

In: what differs between two documents, and the entries of the report. Out: ``Changed``, in plain texts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.text import fit
from rosprivacy.report.compare.changes import QUESTION_KEYS
from rosprivacy.report.naming import name
from rosprivacy.report.page.index import Index

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.compare.changes import Changes
    from rosprivacy.report.compare.earlier import Earlier
    from rosprivacy.report.page.finding_entries import PathEntry


class Changed(NamedTuple):
    """What changed, in words.

    Attributes
    ----------
    sentences
        Verdict, files, kinds of data.
    scope
        What was asked or assumed otherwise.
    new, changed
        Entries; of a changed one also what changed.
    removed
        (kind of data, ends, id) as they were.
    """

    intro: str
    sentences: tuple[str, ...]
    scope: tuple[str, ...]
    new: tuple[PathEntry, ...]
    changed: tuple[tuple[PathEntry, str], ...]
    removed: tuple[tuple[str, str, str], ...]
    opened: tuple[str, ...]
    closed: tuple[str, ...]


def changed(differ: Changes, earlier: Earlier, entries: tuple[PathEntry, ...], index: Index) -> Changed:
    """Return what changed since an earlier document."""
    words = index.words
    of_finding = {finding: entry for entry in entries for finding in (entry.id, *entry.alike)}
    old = Index(earlier.document, words)
    by_entry: dict[PathEntry, list[str]] = {}
    for finding, what in differ.changed.items():
        by_entry.setdefault(of_finding[finding], []).extend(what)
    return Changed(
        intro=words("changes.intro", file=fit(earlier.file), sha=earlier.sha256[:12]),
        sentences=tuple(_sentences(differ, index, old)),
        scope=tuple(_scope(differ, words)),
        new=tuple(dict.fromkeys(of_finding[finding] for finding in differ.new)),
        changed=tuple(
            (entry, words.row(words(f"changes.what.{w}") for w in dict.fromkeys(what)))
            for entry, what in by_entry.items()
        ),
        removed=tuple(
            (
                old.data(f["category"], pseudonymised=f["pseudonymised"]),
                words("entry.from.to", source=name(f["source"]), leak=name(f["leak"])),
                f["id"],
            )
            for f in differ.removed
        ),
        opened=index.names(differ.opened),
        closed=old.names(differ.closed),
    )


def _sentences(differ: Changes, index: Index, old: Index) -> Iterator[str]:
    """What changed on the whole: the verdict, the files, the kinds of data."""
    words = index.words
    same = "changes.verdict.same" if differ.before == differ.now else "changes.verdict"
    yield words(same, before=differ.before, now=differ.now)
    if differ.nothing:
        yield words("changes.none")
    yield (
        words("changes.files", names=words.row(map(fit, differ.files))) if differ.files else words("changes.files.same")
    )
    if differ.kinds_new:
        yield words("changes.kinds.new", names=index.all_data(differ.kinds_new))
    if differ.kinds_gone:
        yield words("changes.kinds.gone", names=old.all_data(differ.kinds_gone))


def _scope(differ: Changes, words: Words) -> Iterator[str]:
    plain = {
        "true": words("yes"),
        "false": words("no"),
        "null": words("none"),
        "": words("none"),
        "all": words("entry.all"),
    }
    for what, before, now in differ.scope:
        assert what in QUESTION_KEYS
        yield words(f"changes.scope.{what}", before=plain.get(before, before), now=plain.get(now, now))
