"""What an analysis gives back: the ``Answer`` that every format is made of, and what was read to get it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, TypedDict, overload

from rosprivacy.analysis.errors import InputError
from rosprivacy.analysis.findings.findings import Options
from rosprivacy.answer import Answer
from rosprivacy.documents import document_of
from rosprivacy.formats import Style, TextFormat, written
from rosprivacy.report.document.analysis import json_document
from rosprivacy.report.document.contents import IN_JSON, RELIANCE

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import networkx as nx

    from rosprivacy.analysis.model import Element, Policy
    from rosprivacy.analysis.python_311 import Unpack
    from rosprivacy.analysis.whatif.why_not import WhyNot
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.ingest.types.types_file import TypesFile
    from rosprivacy.outputs import Findings
    from rosprivacy.report.document.tables import Row


class Presentation(TypedDict, total=False):
    """How an answer is shown to a person; see ``Result.to``."""

    verbose: bool
    quiet: bool
    language: str
    title: str
    since: str | None
    redact: bool
    base: str | None
    assessment: str | None


@dataclass(frozen=True, slots=True, repr=False)
class Result(Answer):
    """An answer with the policies and label files behind it; ``formats.py`` says in which formats it is written.

    Attributes
    ----------
    policies, labels, types
        As they were read; none where the system comes from a database.
    options
        What was asked.
    reanalyse
        Analyses the same policies, as they were read, under other labels; None of a fleet and of a database.
    label_files
        Of a fleet: by robot, the label files that it was read with.
    """

    policies: tuple[Policy, ...] = ()
    labels: tuple[Labels, ...] = ()
    types: tuple[TypesFile, ...] = ()
    options: Options = field(default_factory=Options)
    reanalyse: Callable[[tuple[str | Labels, ...]], Result] | None = field(default=None, compare=False)
    label_files: Mapping[str, tuple[str, ...]] = field(default_factory=dict, compare=False)

    def __repr__(self) -> str:
        return f"<Result: {self._verdict()}>"

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        return self.findings._repr_html_()

    def _verdict(self) -> str:
        """The line that every report begins with."""
        from rosprivacy.report.text.analysis import verdict_line  # noqa: PLC0415 - light start

        return verdict_line(self.document())[0]

    @property
    def findings(self) -> Findings:
        """The findings as a table: a sequence of ``Finding``, with ``to_rows()``; of a fleet one of each pattern.

        Examples
        --------
        >>> import rosprivacy
        >>> result = rosprivacy.analyze("examples/factory/before.policy.xml", "examples/factory/run2.labels.yaml")
        >>> [(finding.source.name, finding.leak.name) for finding in result.findings]
        [('/robot_camera', '/archive_server'), ('/safety_camera', '/archive_server')]
        """
        from rosprivacy.outputs import Findings  # noqa: PLC0415 - light start

        return Findings(self.shown.findings, self.fleet, self._verdict)

    @property
    def named_files(self) -> tuple[str, ...]:
        """The policy files that a user named, without what they include; none of a fleet and of a database."""
        return () if self.fleet else tuple(policy.file for policy in self.policies)

    def document(self) -> dict[str, Any]:
        """Return the whole JSON document, ``rosprivacy.analysis/1``; ``to("json")`` is the short one, ``/2``."""
        return {**json_document(document_of(self, (*IN_JSON, RELIANCE)))}

    def tables(self) -> dict[str, list[Row]]:
        """Return the answer as named tables of plain rows, for ``pandas.DataFrame`` and ``polars.DataFrame``.

        The columns are those of ``rosprivacy.report.document.tables.TABLES``. Table ``answer`` has the verdict; what is
        open and in doubt stands in ``open`` and ``doubts``: ``findings`` alone is not the answer.

        Examples
        --------
        >>> import rosprivacy
        >>> result = rosprivacy.analyze("examples/factory/before.policy.xml", "examples/factory/run2.labels.yaml")
        >>> tables = result.tables()
        >>> tables["answer"][0]["verdict"], len(tables["findings"]), len(tables["open"])
        ('leak', 2, 6)
        """
        from rosprivacy.report.document.tables import tables  # noqa: PLC0415 - light start

        return tables(document_of(self, ()))

    @overload
    def to(self, format: Literal["docx"], **how: Unpack[Presentation]) -> bytes: ...
    @overload
    def to(self, format: TextFormat, **how: Unpack[Presentation]) -> str: ...
    @overload
    def to(self, format: str, **how: Unpack[Presentation]) -> str | bytes: ...
    def to(
        self,
        format: str,  # noqa: A002 - the option's name
        *,
        verbose: bool = False,
        quiet: bool = False,
        language: str = "en",
        title: str = "",
        since: str | None = None,
        redact: bool = False,
        base: str | None = None,
        assessment: str | None = None,
    ) -> str | bytes:
        """Return the answer in a format, as the command line writes it: text, and of ``docx`` bytes.

        Parameters
        ----------
        format
            A name of ``rosprivacy.formats.FORMATS``: ``text``, ``json``, ``sarif``, ``html``, ``docx``, …
        verbose, quiet
            Of text: every open element and notice, or the verdict only.
        language
            Of text, a report and the answers for the CNIL's tool: ``en``, ``de`` or ``fr``.
        title
            Of a report: name of the system.
        redact
            Of a report and of linked data: replace names of elements, files, robots and persons.
        since
            File of an earlier analysis, to tell what changed.
        base
            Of linked data: what the IRIs of elements and findings begin with; by default a UUID of the system.
        assessment
            Of a report or a file for the CNIL's tool: file of the answers that an earlier page saved.

        Raises
        ------
        InputError
            If there is no such format or language, the earlier file cannot be read, or the base is no IRI.
        ValueError
            If it was asked without the number of paths, and there are findings: none would be taken for one.

        Examples
        --------
        >>> import rosprivacy
        >>> result = rosprivacy.analyze("examples/factory/after.policy.xml", "examples/factory/run5.labels.yaml")
        >>> print(result.to("text", quiet=True), end="")
        no-leak-found: no way to a leak, everything on the way is reviewed
        """
        if self.analysis.findings and not self.options.count_paths:
            raise ValueError("nobody asked for the number of paths of the findings")
        style = Style(
            verbose=verbose,
            quiet=quiet,
            language=language,
            title=title,
            since=since,
            redact=redact,
            base=base,
            assessment=assessment,
        )
        return written(self, format, style)

    def to_networkx(self) -> nx.MultiDiGraph[Element]:
        """Return the graph: elements with what they carry and do, flows with what goes along them.

        Of a fleet one robot stands in it for all that are alike. What a DENY takes away is not in it (rule S5).
        """
        from rosprivacy.outputs import to_networkx  # noqa: PLC0415 - networkx, only where it is used

        return to_networkx(self.analysis)

    def why_not(self, source: str, leak: str, *categories: str) -> tuple[WhyNot, ...]:
        """Return for each category what is between two elements: a finding, or what stands in the way.

        Parameters
        ----------
        source, leak
            Names; of a fleet ``robot:name``.
        *categories
            To ask about; by default what the source emits, or all if it emits nothing.

        Raises
        ------
        InputError
            If nothing is called so, or nothing emits the category.
        """
        from rosprivacy.outputs import explained  # noqa: PLC0415 - light start

        return explained(self.analysis, self.vocabulary, source, leak, categories)

    def with_labels(self, *labels: str | Labels) -> Result:
        """Analyse the same policies under other labels, without reading the policies again.

        Parameters
        ----------
        *labels
            Label files, or labels from ``parse_labels``, in place of all those before; the standard channels stay.

        Raises
        ------
        InputError
            Of the result of a fleet or a database, whose labels stand elsewhere.
        InputErrors
            With every problem of the labels.
        """
        if self.reanalyse is None:
            hint = "change what it was read from, and analyse that again"
            raise InputError("labels", 0, "of a fleet or a database labels are not replaced", hint)
        return self.reanalyse(labels)

    def with_entry(self, section: str, name: str, entry: object) -> Result:
        """Analyse the same policies with one entry in place of all that the label files say of a name.

        Parameters
        ----------
        section
            ``nodes``, ``channels``, ``topics``, ``services``, ``actions`` or ``elements``.
        name
            As the label files write it: a glob stands for the entry of that glob.
        entry
            The entry as in a label file; None to say nothing of it.

        Raises
        ------
        InputError, InputErrors
            As ``with_labels``.

        Examples
        --------
        >>> import rosprivacy
        >>> result = rosprivacy.analyze("examples/factory/before.policy.xml", "examples/factory/run2.labels.yaml")
        >>> len(result.with_entry("nodes", "/robot_camera", "conduit").findings)
        1
        """
        from rosprivacy.ingest.labels.edited_entries import with_entry  # noqa: PLC0415 - light start

        return self.with_labels(*with_entry(self.labels, section, name, entry, self.vocabulary))
