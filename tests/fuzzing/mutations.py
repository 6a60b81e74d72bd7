"""Files changed at random, with words of their format and hostile paths; and ``Guard``, which notes what is opened.

The same seed gives the same changes.
"""

from __future__ import annotations

import ctypes
import os
import re
import struct
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from random import Random
    from types import TracebackType

    from rosprivacy.analysis.python_311 import Self

LINE = re.compile(r".+?(:\d+)?: .+; .+")  # file:line: what is wrong; what to do. In JSON a place stands for the line.
SECRET = "outside_the_root"  # noqa: S105 - the name of a topic
IN_OPEN = 0x20
EVENT = struct.Struct("iIII")

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
