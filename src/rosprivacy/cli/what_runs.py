"""What ``try`` and ``init`` are given: policies, or what runs, which stands for a policy and its types."""

from __future__ import annotations

import re
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from rosprivacy.ingest.types import types_path

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.cli.inputs import Inputs
    from rosprivacy.observing import ObservedTexts

Ros2 = Annotated[bool, typer.Option("--ros2", help="Ask the `ros2` program of this machine what runs.")]
AS_OBSERVED = "as observed"  # in place of a file that is not written
LINE_AS_OBSERVED = re.compile(r"as observed:\d+")


class Read(NamedTuple):
    """What is read.

    Attributes
    ----------
    inputs
        With a policy and types in place of what runs.
    observed
        The texts of these, if they were made of what runs.
    """

    inputs: Inputs
    observed: ObservedTexts | None = None

    def with_names(self, text: str, policy: str = "", types: str = "") -> str:
        """Return a text with the names that files get in place of those that they have as long as the block lasts.

        Without a name a line of such a file is told as observed.
        """
        if self.observed is None or not self.inputs.policies or not self.inputs.types:
            return text
        for name, instead in ((self.inputs.policies[0], policy), (self.inputs.types[-1], types)):
            text = text.replace(name, instead or AS_OBSERVED)
        return text if policy else LINE_AS_OBSERVED.sub(AS_OBSERVED, text)


@contextmanager
def as_policies(inputs: Inputs, *, ros2: bool) -> Iterator[Read]:
    """Read what runs as a policy and its types: they are there as long as the block lasts.

    Raises
    ------
    InputErrors
        If a text cannot be read.
    ObservationError
        If nothing is seen.
    """
    named = tuple(inputs.policies or ())
    texts = tuple(filter(_is_text, named))
    if ros2 and named:
        raise typer.BadParameter("--ros2 looks at what runs: name no policy beside it")
    if texts and len(texts) < len(named):
        raise typer.BadParameter("texts of `ros2 node info`, or policies: name one sort")
    if not (ros2 or texts):
        yield Read(inputs)
        return
    from rosprivacy.observing import observed_texts

    made = observed_texts(texts)
    with TemporaryDirectory(prefix="rosprivacy-") as folder:
        policy = Path(folder, "observed.policy.xml")
        policy.write_bytes(made.policy)
        types_path(policy).write_text(made.types, "utf-8")
        types = [*(inputs.types or ()), str(types_path(policy))]
        yield Read(inputs._replace(policies=[str(policy)], types=types), made)


def _is_text(name: str) -> bool:
    """Whether a file is a text of ``ros2 node info``; what cannot be read the reader of policies speaks about."""
    from rosprivacy.ingest.reading.file_kinds import NODE_INFO, kind_of_file

    try:
        return kind_of_file(name) == NODE_INFO
    except (OSError, ValueError):
        return False
