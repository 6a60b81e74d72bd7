"""The options of ``suggest`` that ask a language model, and what they mean together.

Nothing is sent without ``--model`` and ``--model-url``; no host is known here. The key comes from the environment.
"""

from __future__ import annotations

import os
import sys
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from rosprivacy.cli.inputs import refuse

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.labelling.model_interview import Asking, Interview

PANEL = "A language model, only if you ask one"
LONGEST_NAME = 200


def _asks(name: str, says: str, metavar: str | None = None, **settings: Any) -> Any:
    """An option that says how a language model is asked."""
    if metavar and "min" not in settings:
        settings["show_default"] = False
    return typer.Option(name, metavar=metavar, help=says, rich_help_panel=PANEL, **settings)


Model = Annotated[
    str | None,
    _asks("--model", "Ask this language model for more suggestions: its name, as its server knows it.", "NAME"),
]
ModelUrl = Annotated[
    str | None,
    _asks(
        "--model-url",
        "Where it is: the address of an OpenAI-compatible server, up to /v1. A key is read from ROSPRIVACY_MODEL_KEY.",
        "URL",
    ),
]
DryRun = Annotated[bool, _asks("--dry-run", "Print what would be sent, and where to; send nothing.")]
MaskNames = Annotated[bool, _asks("--mask", "Send placeholders for words of names that are not in the shipped rules.")]
Record = Annotated[Path | None, _asks("--record", "Write what was sent and answered into a new file.", "FILE")]
Replay = Annotated[
    str | None, _asks("--replay", "Take the answers from a file that --record wrote; send nothing.", "FILE")
]
Requests = Annotated[int, _asks("--model-requests", "Send at most so many.", "N", min=1)]
Timeout = Annotated[int, _asks("--model-timeout", "How long to wait for one answer.", "SECONDS", min=1)]
Unencrypted = Annotated[
    bool,
    _asks(
        "--model-unencrypted",
        "Send over plain http to any host, where others on the way can read all of it, the key too.",
    ),
]


class ModelOptions(NamedTuple):
    """What a user says of a language model."""

    model: Model = None
    url: ModelUrl = None
    mask: MaskNames = False
    dry_run: DryRun = False
    record: Record = None
    replay: Replay = None
    requests: Requests = 20
    timeout: Timeout = 300
    unencrypted: Unencrypted = False

    def check(self, into: Path | None) -> None:
        """Refuse options that make no sense together, before anything is read."""
        said = {
            "--model": self.model is not None,
            "--model-url": self.url is not None,
            "--dry-run": self.dry_run,
            "--mask": self.mask,
            "--record": self.record is not None,
            "--model-unencrypted": self.unencrypted,
        }
        given = [name for name, there in said.items() if there]
        if self.replay is not None:
            refuse("--replay", "all of it from the file", given)
        elif given and (self.model is None or self.url is None):
            raise typer.BadParameter(f"{given[0]} goes with --model NAME and --model-url URL")
        name = self.model or ""
        if self.model is not None and (not name.strip() or not name.isprintable() or len(name) > LONGEST_NAME):
            raise typer.BadParameter(f"--model takes a name of at most {LONGEST_NAME} printable signs")
        if self.dry_run:
            refuse(
                "--dry-run", "nothing to write", [*(["--into"] if into else []), *(["--record"] if self.record else [])]
            )

    @property
    def asking(self) -> Asking:
        """What is asked, and where."""
        from rosprivacy.ingest.language_model import address_of
        from rosprivacy.labelling.model_interview import Asking

        address = address_of(self.url or "", unencrypted=self.unencrypted)
        return Asking(self.model or "", address.url, self.mask, self.requests)

    @contextmanager
    def interview(self, output: Path | None) -> Iterator[Interview | None]:
        """Give who asks the model, if one is to be asked; what was sent is recorded, also where an error ended it.

        Parameters
        ----------
        output
            Where the answer is written to: another file than the record.
        """
        if self.replay is not None:
            yield self._replayed(self.replay)
        elif self.model is None:
            yield None
        else:
            yield from self._live(output)

    def _live(self, output: Path | None) -> Iterator[Interview]:
        from rosprivacy.ingest.language_model import KEY, ModelServer, address_of
        from rosprivacy.labelling.model_interview import Interview

        address = address_of(self.url or "", unencrypted=self.unencrypted)
        server = ModelServer(address, os.environ.get(KEY, "").strip(), self.timeout, _progress)
        interview = Interview(self.asking, server, _progress)
        if self.record:
            _refuse_existing(self.record, output)
        try:
            yield interview
        finally:
            if self.record and interview.exchanges:
                _write(self.record, interview)

    def _replayed(self, file: str) -> Interview:
        from rosprivacy.ingest.language_model import read_exchanges, replayed
        from rosprivacy.labelling.model_interview import Asking, Interview

        record = read_exchanges(file)
        asking = Asking(record.model, record.url, record.masked, sys.maxsize, record.date)  # nothing is sent: no bound
        return Interview(asking, replayed(file, record), _progress, ((file, record.sha256),))


def _progress(line: str) -> None:
    from rosprivacy.analysis.text import one_line

    typer.echo(one_line(line), err=True)


def _refuse_existing(file: Path, output: Path | None) -> None:
    """Evidence is not written over; that it can be written is known before anything is sent."""
    from rosprivacy.analysis.errors import InputError
    from rosprivacy.report.atomic import check_outputs

    check_outputs([file, *([output] if output else [])])
    if file.exists():
        raise InputError(str(file), 0, "is there already", "what was recorded is evidence: name a new file")
    if not os.access(file.parent, os.W_OK):
        raise InputError(str(file), 0, "cannot be written", "name a file in a folder that can be written")


def _write(file: Path, interview: Interview) -> None:
    from rosprivacy.clock import today
    from rosprivacy.ingest.language_model import Exchanges, as_document
    from rosprivacy.report.atomic import write_texts
    from rosprivacy.report.json_text import as_text

    asking = interview.asking
    said = Exchanges(asking.model, asking.url, asking.masked, today(os.environ), tuple(interview.exchanges))
    write_texts([(file, as_text(as_document(said)))])
