"""``python -m tests.golden``: write ``hashes.tsv`` anew, on two seeds of Python's hashes, which have to agree.

``--keep FOLDER`` writes the answers themselves too, to compare those of two commits with ``diff -r``; ``--only TEXT``
takes the calls that hold it, and then nothing is written. The corpus is taken from ``ROSPRIVACY_CORPUS``; without it
its lines stay as they are.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import re
import subprocess
import sys
import zipfile
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.analysis.python_311 import chdir
from tests.golden.runs import calls, lay_out
from tests.helpers.command import UNSET
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

HASHES = Path(__file__).parent / "hashes.tsv"
FONTS = Path(__file__).with_name("fonts.conf")
SEEDS = ("1", "2")
DATE = "1780000000"  # of reports
CORPUS = " corpus/"  # in calls about it


def answers(only: str = "", keep: Path | None = None, *, first: int = 0, step: int = 1) -> Iterator[str]:
    """Run calls in this process, from ``first`` on each ``step``-th, and yield ``hash, exit code, call`` of each."""
    from rosprivacy.cli.app import main

    corpus = os.environ.get("ROSPRIVACY_CORPUS")
    os.environ["SOURCE_DATE_EPOCH"] = DATE
    for name in UNSET:
        os.environ.pop(name, None)
    with TemporaryDirectory() as laid, chdir(laid):
        lay_out(Path(laid), Path(corpus) if corpus else None)
        each = dict.fromkeys(calls(Path(laid)))  # two systems may share a call
        for call in islice(each, first, None, step):
            if only not in " ".join(call):
                continue
            code, answer = _answer(call, main)
            if keep:
                name = hashlib.sha256(repr(call).encode()).hexdigest()[:12]
                (keep / name).write_bytes(f"{code} {' '.join(call)}\n".encode() + answer)
            yield f"{hashlib.sha256(answer).hexdigest()[:16]}\t{code}\t{' '.join(call)}"


def _answer(call: tuple[str, ...], main: Callable[[], None]) -> tuple[int, bytes]:
    """What one call ends with, and what it writes: standard output, standard error, the file ``out``."""
    streams = [io.TextIOWrapper(io.BytesIO(), "utf-8", write_through=True) for _ in range(2)]
    sys.argv = ["rosprivacy", *call]
    code: object = 0
    with contextlib.redirect_stdout(streams[0]), contextlib.redirect_stderr(streams[1]):
        try:
            main()
        except SystemExit as ended:
            code = ended.code or 0
    assert isinstance(code, int)
    written = [stream.buffer.getvalue() for stream in streams if isinstance(stream.buffer, io.BytesIO)]
    out = Path("out")
    if out.exists():
        written.append(out.read_bytes())
        out.unlink()
    return code, b"\0".join(_comparable(each) for each in written)


def _comparable(written: bytes) -> bytes:
    """Return what no machine changes: a Word document unpacked; pictures without places, which fonts decide."""
    if written.startswith(b"PK"):
        with zipfile.ZipFile(io.BytesIO(written)) as parts:
            return b"".join(name.encode() + parts.read(name) for name in parts.namelist())
    return re.sub(rb"<svg.*?</svg>", lambda svg: re.sub(rb"-?\d+(\.\d+)?", b"0", svg[0]), written, flags=re.DOTALL)


def on_two_seeds() -> list[str]:
    """Return the lines that both seeds give.

    Raises
    ------
    AssertionError
        If an answer depends on the seed; it names the calls.
    """
    first, second = _on_each_seed(["--lines"], ["--lines"])
    assert first == second, [line for line in first if line not in second]
    return first


def by_turns() -> list[str]:
    """Return the lines of calls of which each has one of both seeds, one after the other: half of the work."""
    return [line for lines in _on_each_seed(*(["--lines", "--turn", str(turn)] for turn in (0, 1))) for line in lines]


def _on_each_seed(*options: list[str]) -> list[list[str]]:
    """Return the lines of one process for each seed, with these options; they run side by side.

    Without the machine's fonts: these decide how wide a picture is, and so how a page is laid out.
    """
    command = [sys.executable, "-m", "tests.golden"]
    runs = [
        subprocess.Popen(
            [*command, *some],
            stdout=subprocess.PIPE,
            text=True,
            cwd=ROOT,
            env={**os.environ, "PYTHONHASHSEED": seed, "FONTCONFIG_FILE": str(FONTS)},
        )
        for seed, some in zip(SEEDS, options, strict=True)
    ]
    lines = [run.communicate()[0].splitlines() for run in runs]
    assert [run.returncode for run in runs] == [0, 0]
    return lines


def differences(lines: list[str]) -> list[str]:
    """Return the calls whose answer is another one than in ``hashes.tsv``, is new there or is gone."""
    return sorted({line.rpartition("\t")[2] for line in {*known()} ^ {*lines}})


def known(*, corpus: bool = "ROSPRIVACY_CORPUS" in os.environ) -> list[str]:
    """Return the lines of ``hashes.tsv`` about what is at hand here."""
    return [line for line in HASHES.read_text("utf-8").splitlines() if corpus or CORPUS not in line]


def run(
    only: str = "",
    keep: Annotated[Path | None, typer.Option()] = None,
    turn: int | None = None,
    *,
    lines: bool = False,
    check: bool = False,
) -> None:
    if lines or only or keep:
        if keep:
            keep.mkdir(parents=True, exist_ok=True)
        for line in answers(only, keep, first=turn or 0, step=1 if turn is None else len(SEEDS)):
            print(line, flush=True)
        return
    answered = on_two_seeds()
    if check:
        print(*(changed := differences(answered)), sep="\n")
        raise SystemExit(bool(changed))
    absent = [line for line in known(corpus=True) if line not in known()]
    HASHES.write_text("\n".join([*answered, *absent, ""]), "utf-8")


if __name__ == "__main__":
    typer.run(run)
