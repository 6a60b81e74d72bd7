"""Mutates real policies and label files and counts what the readers make of them. Not collected by pytest.

    python tests/fuzz_corpus.py [--policies 10000] [--labels 2000] [--seed 1] [--keep FOLDER]

The corpus (``$ROSPRIVACY_CORPUS``, or ``../shared/corpus``) is copied to a temporary folder while this runs. Work is
done in a child process with bounds on time and memory, so that a hang or a crash of a C library ends one input only.
The same seed gives the same inputs. ``test_fuzz.py`` and ``helpers/includes.py`` use the mutations and
``Guard``.

Exit code: 0 if every input was accepted, or refused with one line per problem; 1 otherwise.
"""

from __future__ import annotations

import argparse
import ctypes
import os
import re
import resource
import select
import shutil
import signal
import struct
import sys
import tempfile
import time
import traceback
from collections import Counter
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from types import FrameType, TracebackType

LINE = re.compile(r".+?(:\d+)?: .+; .+")  # file:line: what is wrong; what to do. In JSON a place stands for the line.
SECRET = "outside_the_root"  # noqa: S105 - the name of a topic
IN_OPEN = 0x20
EVENT = struct.Struct("iIII")
GIGABYTE = 2**30

POLICY_WORDS = (
    # XML
    "<", ">", "</", "/>", "&", '"', "<!--", "-->", "<![CDATA[", "]]>", "<?x", "?>", "&#0;", "&#x1F600;", "&amp;", "&x;",
    '<?xml version="1.0" encoding="UTF-16"?>', '<?xml version="1.1" encoding="nope"?>', "\x00", "\x0b", "\xff",
    "\ufeff", "<!DOCTYPE policy>", '<!DOCTYPE policy SYSTEM "{outside}/secret.dtd">',
    '<!DOCTYPE p [<!ENTITY x SYSTEM "file://{outside}/secret.txt">]>',
    '<!DOCTYPE p [<!ENTITY % x SYSTEM "{outside}/secret.dtd"> %x;]>',
    '<!DOCTYPE p [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;"><!ENTITY x "&b;&b;&b;&b;&b;">]>',
    # XInclude
    '<xi:include href="{outside}/secret.xml"/>', '<xi:include href="file://{outside}/secret.xml"/>',
    '<xi:include href="../outside/secret.xml" xpointer="xpointer(/profile/*)"/>',
    '<xi:include href="link.xml" xpointer="xpointer(/profile/*)"/>', '<xi:include href="away/secret.xml"/>',
    '<xi:include href="{outside}/secret.txt" parse="text"/>', '<xi:include href="link.xml" parse="text"/>',
    '<xi:include href="deep/../link.xml" xpointer="xpointer(/*/*)"/>', '<xi:include href="%2e%2e/outside/secret.xml"/>',
    '<xi:include href="" xpointer="xpointer(/*/*)"/>', '<xi:include href="."/>', "<xi:include/>",
    '<xi:include href="nowhere.xml"><xi:fallback>', "</xi:fallback></xi:include>", "<xi:fallback/>",
    ' xmlns:xi="http://www.w3.org/2003/XInclude"', ' xmlns="http://ros2.org/sros2/policy"', ' xml:base="{outside}/"',
    ' xpointer="xpointer(/profile/*)"', ' xpointer="xpointer(/*/*/*/*/*)"', ' xpointer="element(/1)"',
    ' href="node.xml"', '<xi:include href="nowhere.xml"><xi:fallback>' * 90 + "</xi:fallback></xi:include>" * 90,
    # SROS 2
    "<policy>", '<policy version="0.2.0">', "</policy>", "<enclaves>", '<enclave path="/x">', "</enclave>",
    "<profiles>", '<profile ns="/" node="x">', "</profile>", "<topics>", '<topics publish="DENY">', "</topics>",
    "<topic>*</topic>", '<services reply="ALLOW" request="DENY">', "<service>~</service>", '<actions call="ALLOW">',
    "<action>a*</action>", "<topic>/x/_action/status</topic>", "<topic>[a-</topic>", "<topic>[!]]*?</topic>",
    "<topic/>", "<metadata>", "<contexts>", ' version="0.1.0"', ' publish="ALLOW"', ' subscribe="DENY"', ' ns=""',
    ' node=""', ' path="/x"', "ALLOW", "DENY", "0.1.0", "0.2.0", "~", "~/x", "~x", "x/y", "/a/b", "/robot", "*", "/*",
    "*a*b*", "[a-z]", "[!a]?", "[^/]*", "/x/_action/feedback", "/x/_action/get_result", "xpointer(/profile/*)",
    "node.xml", '<topics publish="ALLOW" subscribe="DENY"><topic>/*</topic><topic>a</topic></topics>', "<!-- x -->",
    '<services request="ALLOW"><service>*</service><service>/s</service></services>', "<metadata>x</metadata>",
    '<actions execute="ALLOW"><action>/x</action><action>*</action></actions>', '<profile ns="/b" node="c"/>',
)  # fmt: skip
LABEL_WORDS = (
    "labels: 1\n", "nodes:\n", "channels:\n", "flows:\n", "topics: {{}}\n", "\n  /x: conduit\n", "\n  '/*': mundane\n",
    "{{source: [Video]}}", "{{sanitizer: {{Video: drop}}}}", "{{derives: [{{from: Video, to: FaceTemplate}}]}}",
    "{{only: [Video], never: [Voice]}}", "{{from: /a, to: /b, never: [Video]}}", "&a", "*a", "<<: *a",
    "!!python/name:os.system", "!!binary x", "---\n", "...", "? ", "- ", ": ", "[", "]", "{{", "}}", ",", "|\n", ">-\n",
    "\t", "#", "%YAML 9.9\n", "null", "true", "1e999", "0x1", "\\ud83d\\ude00", "\\ud800", "\\u0000", "'", "Vidio",
    "PersonalData", "~", "Video", "Voice", "[Video]", "conduit", "mundane", "sensitive", "drop", "/*", "/navigator",
    "/robot_video", "\n", "\n  ", " ", "# x\n", "source", "leak", "sanitizer", "only", "never", "note",
    "[" * 500 + "]" * 500,
)  # fmt: skip
ANY_WORDS = (
    "/", "*", "\u2028", "\x85", "\x7f",
    "-1", "9" * 400, "a" * 300, "../" * 5, "/etc/passwd", "http://127.0.0.1:9/", "//127.0.0.1/x", "%00", "%",
    "{outside}",
)  # fmt: skip


# ---------------------------------------------------------------- what test_fuzz.py uses too


def words(kind: str, outside: Path) -> list[bytes]:
    """Return the dictionary for policies or label files, with hostile paths that point to a folder."""
    chosen = (POLICY_WORDS if kind == "policy" else LABEL_WORDS) + ANY_WORDS
    return [word.format(outside=outside).encode() for word in chosen]


def mutate(random: Random, data: bytes, dictionary: Sequence[bytes]) -> bytes:
    """Return data with a few places flipped, deleted, doubled, spliced or filled with words."""
    for _ in range(random.choice((1, 1, 1, 2, 3, 6))):
        at = random.randint(0, len(data))
        to = min(len(data), at + random.choice((1, 2, 8, 40, 400)))
        change = random.randint(0, 9)
        if change == 0 and at < len(data):
            data = data[:at] + bytes([data[at] ^ 1 << random.randint(0, 7)]) + data[at + 1 :]
        elif change == 1:
            data = data[:at] + data[to:]
        elif change == 2:
            data = data[:to] + data[at:to] * random.choice((1, 2, 30)) + data[to:]
        elif change == 3:
            place = random.randint(0, len(data))
            data = data[:place] + data[at:to] + data[place:]
        elif change == 4:
            data = data[:at] + random.choice(dictionary) + data[at:]
        elif change == 5:
            data = _swapped(random, data)
        else:
            data = _at_a_joint(random, data, dictionary)
    return data


def _at_a_joint(random: Random, data: bytes, dictionary: Sequence[bytes]) -> bytes:
    """Put a word where it can be understood: in the place of a value, or before a tag or line."""
    values = [m.span(1) for m in re.finditer(rb'(?:="|>|: |\[|"|, )([^\s"<>\[\]{},][^"<>\[\]{},\n]*)', data)]
    if values and random.random() < 0.7:
        start, end = random.choice(values)
        return data[:start] + random.choice([w for w in dictionary if not set(w) & set(b'<>&"\n')]) + data[end:]
    at = random.choice([m.start() for m in re.finditer(rb"<|\n|$", data)])
    return data[:at] + random.choice(dictionary) + data[at:]


def _swapped(random: Random, data: bytes) -> bytes:
    """Change the places of two lines, or use one twice."""
    lines = data.split(b"\n")
    here, there = random.randrange(len(lines)), random.randrange(len(lines))
    lines[here], lines[there] = lines[there], lines[here] if random.random() < 0.5 else lines[there]
    return b"\n".join(lines)


def hide(outside: Path) -> None:
    """Make a folder with a secret in three formats."""
    outside.mkdir()
    secret = f'<profile><topics publish="ALLOW"><topic>{SECRET}</topic></topics></profile>'
    outside.joinpath("secret.xml").write_text(secret)
    outside.joinpath("secret.txt").write_text(SECRET)
    outside.joinpath("secret.dtd").write_text(f'<!ENTITY x "{SECRET}">')


def plant(folder: Path, outside: Path) -> None:
    """Put links to the secret into a folder, as a hostile repository may have them."""
    folder.joinpath("link.xml").symlink_to(outside / "secret.xml")
    folder.joinpath("away").symlink_to(outside)
    folder.joinpath("down", "below").mkdir(parents=True)
    folder.joinpath("deep").symlink_to(Path("down", "below"))
    again = '<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="" xpointer="xpointer(/profile/*)"/>'
    folder.joinpath("down", "link.xml").write_text(f"<profile>{again}</profile>")


class Guard:
    """Notes every file below a folder that is opened: by Python (audit hook), by C libraries too (inotify)."""

    _active: list[Guard] = []  # noqa: RUF012 - audit hooks are for ever, so one hook serves all
    _hooked = False

    def __init__(self, folder: Path) -> None:
        self.folder = os.path.realpath(folder)
        self.opened: list[str] = []
        self._events = -1

    def __enter__(self) -> Self:
        if not Guard._hooked:
            sys.addaudithook(_audit)
            Guard._hooked = True
        if sys.platform == "linux":
            libc = ctypes.CDLL(None)
            self._events = libc.inotify_init1(os.O_NONBLOCK)
            libc.inotify_add_watch(self._events, os.fsencode(self.folder), IN_OPEN)
        Guard._active.append(self)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.check()
        Guard._active.remove(self)
        if self._events >= 0:
            os.close(self._events)

    def check(self) -> list[str]:
        """Return what was opened until now."""
        if self._events >= 0:
            self.opened += _names(self._events)
        return self.opened

    @classmethod
    def note(cls, path: Any) -> None:
        """Look at a path that Python opens; links are followed."""
        if cls._active and isinstance(path, str | bytes):
            real = os.path.realpath(os.fsdecode(path))
            for guard in cls._active:
                if real == guard.folder or real.startswith(guard.folder + os.sep):
                    guard.opened.append(real)


def _audit(event: str, arguments: tuple[Any, ...]) -> None:
    if event == "open":
        Guard.note(arguments[0])


def _names(events: int) -> list[str]:
    """The file names of waiting inotify events."""
    try:
        data = os.read(events, 65536)
    except BlockingIOError:
        return []
    names = []
    while data:
        length = EVENT.unpack_from(data)[3]
        names.append(os.fsdecode(data[EVENT.size : EVENT.size + length].rstrip(b"\0")))
        data = data[EVENT.size + length :]
    return names


def outcome(call: Callable[[], Any]) -> str:
    """Return 'accepted' or 'refused'.

    Raises
    ------
    AssertionError
        If a message is not one line of the format, or the secret is in the result or a message.
    Exception
        Whatever else the call raises.
    """
    from rosprivacy.analysis.errors import InputErrors

    try:
        result = call()
    except InputErrors as error:
        bad = [line for line in str(error).split("\n") if not LINE.fullmatch(line)]
        assert not bad, f"not one line 'file:line: problem; hint': {bad[0][:300]!r}"
        return "refused"
    assert f"/{SECRET}" not in repr(result), "a file outside of the root was read"
    return "accepted"


# ---------------------------------------------------------------- the long run

LABELS = """\
labels: 1
nodes:
  /safety_camera: {source: [Video], note: a}
  /robot_camera: {source: {Video: [/robot_video]}}
  "/arch*": {leak: [Video, Voice], derives: [{from: Video, to: FaceTemplate}]}
  /navigator: conduit
  /emergency_stop: {sanitizer: {Video: pseudonymise, Voice: drop}, conduit: [Location]}
channels:
  /new_pose: mundane
  /safety_video: sensitive
  /robot_video: {only: [Video], note: b}
services:
  "/*": {never: [Health]}
flows:
  - {from: /navigator, to: /new_pose, never: [Video]}
"""
SOME = """\
labels: 1
nodes:
  "*": {derives: [{from: Video, to: FaceTemplate}]}
  "/*[m-z]a*": {source: [Video]}
  "*_server": {leak: [Biometric], sanitizer: {Video: pseudonymise}}
  "*_control": {leak: [Video]}
channels:
  "*/[a-c]*": {never: [Video]}
  "*parameter*": mundane
"""


class Hang(BaseException):
    """An input took longer than the bound."""


def _alarm(_signal: int, _frame: FrameType | None) -> None:
    raise Hang


class Corpus:
    """A copy of the corpus with hostile neighbours, and the inputs made from it."""

    def __init__(self, source: Path, folder: Path, seed: int) -> None:
        self.root, self.outside, self.seed = folder / "root", folder / "outside", seed
        shutil.copytree(source / "policies", self.root, copy_function=shutil.copyfile)
        for path in self.root.rglob("*"):
            path.chmod(0o755 if path.is_dir() else 0o644)
        self.root.chmod(0o755)
        self.policies = sorted(self.root.rglob("*.xml"))
        self.repositories = sorted(path for path in self.root.iterdir() if path.is_dir())
        hide(self.outside)
        for parent in sorted({path.parent for path in self.policies}):
            plant(parent, self.outside)
        self.categorizations = sorted((source / "categorizations").rglob("*.json"))
        self.words = {kind: words(kind, self.outside) for kind in ("policy", "label")}
        self.some = folder / "some.yaml"
        self.some.write_text(SOME)
        self.labels = folder / "labels.yaml"
        self.thesis = next(path for path in self.policies if "thesis_final" in path.name)
        self.turtlebot = next(path for path in self.policies if "tb3_gazebo" in path.name)

    def policy(self, number: int) -> str:
        """Read a mutated policy, or a policy with a mutated fragment; every fourth time analyse it too."""
        import rosprivacy
        from rosprivacy.ingest.policies.policy_xml import read_policy

        random = Random(f"{self.seed} policy {number}")  # noqa: S311 - repeatable
        path = random.choice(self.policies)
        original = path.read_bytes()
        target = path if b"<policy" in original else self._user_of(random, path)
        path.write_bytes(mutate(random, original, self.words["policy"]))
        root = str(self.root)
        try:
            result = outcome(lambda: read_policy(str(target), include_root=root))
            if number % 4 == 0:
                standard = str(self.some)  # may name what is not there
                outcome(lambda: rosprivacy.analyze(target, standard_channels=standard, include_root=root).document())
            return result
        finally:
            path.write_bytes(original)

    def _user_of(self, random: Random, fragment: Path) -> Path:
        """A policy of the same repository that may include a fragment, or the fragment itself."""
        home = next(folder for folder in self.repositories if fragment.is_relative_to(folder))
        users = [p for p in self.policies if p.is_relative_to(home) and b"<policy" in p.read_bytes()]
        return random.choice([*users, fragment])

    def label(self, number: int) -> str:
        """Analyse an unchanged policy with a mutated label file."""
        import rosprivacy

        random = Random(f"{self.seed} label {number}")  # noqa: S311 - repeatable
        policy, data = self.thesis, LABELS.encode()
        if random.random() < 0.5:
            chosen = random.choice(self.categorizations)
            policy, data = self.turtlebot if "turtlebot" in chosen.name else self.thesis, chosen.read_bytes()
        self.labels.write_bytes(mutate(random, data, self.words["label"]))
        root, labels = str(self.root), [str(self.labels)]
        return outcome(lambda: rosprivacy.analyze([str(policy)], labels, include_root=root).document())


def _work(corpus: Corpus, jobs: Sequence[tuple[str, int]], seconds: float, to: int) -> None:
    """In the child: one line per input."""
    resource.setrlimit(resource.RLIMIT_AS, (6 * GIGABYTE, 6 * GIGABYTE))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    signal.signal(signal.SIGPROF, _alarm)
    with Guard(corpus.outside) as guard:
        for kind, number in jobs:
            before = len(guard.check())
            signal.setitimer(signal.ITIMER_PROF, seconds)
            try:
                result = corpus.policy(number) if kind == "policy" else corpus.label(number)
            except Hang:
                result = f"hang in {_where(sys.exc_info()[2])}"
            except BaseException as error:  # noqa: BLE001 - every one is a finding
                message = " ".join(str(error).split())[:120]
                result = f"crash {type(error).__name__} in {_where(error.__traceback__)}: {message}"
            finally:
                signal.setitimer(signal.ITIMER_PROF, 0)
            if len(guard.check()) > before:
                result = f"escape: {guard.opened[-1]} was opened, then: {result}"
            os.write(to, f"{result}\n".encode("utf-8", "replace"))


def _where(trace: TracebackType | None) -> str:
    """The innermost place in our code."""
    frames = [f for f in traceback.extract_tb(trace) if "rosprivacy" in f.filename or "/main/" in f.filename]
    ours = [f for f in frames if "fuzz_corpus" not in f.filename] or frames
    return f"{Path(ours[-1].filename).name}:{ours[-1].name}" if ours else "?"


def _results(corpus: Corpus, jobs: Sequence[tuple[str, int]], seconds: float) -> Iterator[str]:
    """One result per job; a child that dies or sticks is replaced by another."""
    done = 0
    while done < len(jobs):
        here, there = os.pipe()
        child = os.fork()
        if child == 0:
            os.close(here)
            _work(corpus, jobs[done:], seconds, there)
            os._exit(0)
        os.close(there)
        stuck = False
        for line in _lines(here, 6 * seconds):
            if line is None:
                stuck = True
                os.kill(child, signal.SIGKILL)
                break
            done += 1
            yield line
        os.close(here)
        _, status = os.waitpid(child, 0)
        if done < len(jobs):
            done += 1
            yield "hang outside of Python" if stuck else f"crash of the process, signal {os.WTERMSIG(status)}"


def _lines(pipe: int, seconds: float) -> Iterator[str | None]:
    """The lines that a child writes, until it ends; None if it is silent for too long."""
    rest = b""
    while True:
        if not select.select([pipe], [], [], seconds)[0]:
            yield None
            return
        data = os.read(pipe, 65536)
        if not data:
            return
        *whole, rest = (rest + data).split(b"\n")
        yield from (line.decode("utf-8", "replace") for line in whole)


def main() -> int:
    """Run, and print the counts."""
    parser = argparse.ArgumentParser(description="Fuzz the readers with mutations of the corpus.")
    parser.add_argument("--policies", type=int, default=10_000, help="mutated policies (default 10000)")
    parser.add_argument("--labels", type=int, default=2_000, help="mutated label files (default 2000)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=10, help="of processor time for one input (default 10)")
    parser.add_argument("--shown", type=int, default=20, help="different failures to print (default 20)")
    asked = parser.parse_args()
    here = Path(__file__).resolve().parent.parent
    source = Path(os.environ.get("ROSPRIVACY_CORPUS", here.parent / "shared" / "corpus"))
    if not (source / "policies").is_dir():
        parser.error(f"no corpus at {source}: set ROSPRIVACY_CORPUS")
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        os.environ["XDG_CACHE_HOME"] = f"{folder}/cache"
        corpus = Corpus(source, Path(folder), asked.seed)
        for kind, count in (("policy", asked.policies), ("label", asked.labels)):
            begun = time.monotonic()
            counts: Counter[str] = Counter()
            failures: dict[str, list[int]] = {}
            jobs = [(kind, number) for number in range(count)]
            for number, result in enumerate(_results(corpus, jobs, asked.seconds)):
                counts[result.split(maxsplit=1)[0].strip(":")] += 1
                if result not in ("accepted", "refused"):
                    signature = re.sub(r"[0-9a-f]{4,}|'.*", "…", result.replace(folder, ""))
                    failures.setdefault(signature, []).append(number)
            names = ("accepted", "refused", "crash", "hang", "escape")
            shown = ", ".join(f"{name} {counts[name]}" for name in names)
            print(f"{count} mutated {kind} files, seed {asked.seed}: {shown} ({time.monotonic() - begun:.0f} s)")
            for signature, numbers in sorted(failures.items(), key=lambda f: -len(f[1]))[: asked.shown]:
                print(f"  {len(numbers)} x {signature} (first: {kind} {numbers[0]})")
            bad += count - counts["accepted"] - counts["refused"]
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
