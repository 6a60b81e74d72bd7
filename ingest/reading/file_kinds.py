"""The beginning of a file -> what it is by its content, whatever its name (rule S11).

In: bytes. Out: ``FileKind``, or None for anything else. A file is told by how it begins: what stands before the first
element or brace may be comments and what templates put there, no prose. So a page that quotes a policy is none.
"""

from __future__ import annotations

import bz2
import lzma
import re
import zlib
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.ingest.reading.bounded_file import beginning

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

BOUND = 2**18  # bytes in which a file says what it is: a configuration of Zenoh has its list far behind
HEAD = 4096  # bytes in which a signed file says that it is
SIGNED = b"multipart/signed"
ACCESS = "access_control"


class FileKind(NamedTuple):
    """What a file is, and what to do with it."""

    name: str
    instead: str

    def refused(self, purpose: str, file: str) -> tuple[str, str]:
        """Return the problem and what to do where something else is wanted."""
        return f"this is {self.name}, and not {purpose}", self.instead.replace("FILE", shown(file))


POLICY = FileKind("an SROS 2 policy", "name it by itself")
PERMISSIONS = FileKind("permissions or governance", "name it by itself")
ACCESS_LIST = FileKind("an access list of Zenoh", "name it by itself, as .json5")
NODE_INFO = FileKind(
    "the output of `ros2 node info`",
    "see what could get out: rosprivacy try FILE; or make a policy of it: rosprivacy observe --text FILE",
)
LAUNCH = FileKind("a launch file", "start it, and make a policy of what runs: rosprivacy observe --ros2")
_BY_KEY = {
    "labels": FileKind("a label file", "give it with --labels (-l)"),
    "fleet": FileKind("a fleet file", "give it with --fleet"),
    "types": FileKind("a file of message types", "give it with --types"),
    "decisions": FileKind("a file of decisions", "give it with --decisions"),
    "rosbag2_bagfile_information": FileKind("a bag", "see what is in it: rosprivacy bag FOLDER"),
    "launch": LAUNCH,
    ACCESS: ACCESS_LIST,
}
_BY_FORMAT = {
    "graph": FileKind("a saved graph", "give it with --add"),
    "analysis": FileKind("a saved analysis", "compare with it: rosprivacy diff FILE POLICY"),
}

_BEFORE = {  # what may stand before the first element or brace -> where it ends
    "<?": "?>", "<!--": "-->", "<!": ">", "]": ">", "<%": "%>", "{%": "%}", "{#": "#}", "{{": "}}", "#": "\n",
    "//": "\n", "/*": "*/", "@": "@", "---": "\n", "%": "\n",
}  # fmt: skip
_ROOT = re.compile(r"<(?:[A-Za-z_][\w.-]*:)?([A-Za-z_][\w.-]*)")
_GRANT = re.compile(r"""(?:publish|subscribe|request|reply|call|execute)=["'](?:ALLOW|DENY)["']""")
_KEY = re.compile(r"""^["']?([A-Za-z_]\w*)["']?[ \t]*:""", re.MULTILINE)
_NODE = re.compile(r"^/\S+\r?\n  (?:Subscribers|Publishers):", re.MULTILINE)
_FORMAT = re.compile(r'"format": ?"rosprivacy\.([a-z]+)/')
_PACKED: Mapping[bytes, Callable[[bytes], bytes]] = {
    b"\x1f\x8b": lambda data: zlib.decompressobj(31).decompress(data, BOUND),
    b"BZh": lambda data: bz2.BZ2Decompressor().decompress(data, BOUND),
    b"\xfd7zXZ\0": lambda data: lzma.LZMADecompressor(memlimit=2**27).decompress(data, BOUND),
}


def kind_of(data: bytes) -> FileKind | None:
    r"""Return what a file is by its first ``MOST`` bytes; packed ones are looked into.

    >>> [kind_of(text) for text in (b"# A page\n\nof a <policy>", b"")]
    [None, None]
    >>> kind_of(b"<!-- a template -->\n<policy version='0.2.0'>").name, kind_of(b"labels: 1\n").name
    ('an SROS 2 policy', 'a label file')
    """
    data = _unpacked(data[:BOUND])
    if is_signed(data):
        return PERMISSIONS
    text = _text(data)
    at = _beginning(text)
    if root := _ROOT.match(text, at):
        return _of_xml(root[1].lower(), text)
    if "def generate_launch_description(" in text:
        return LAUNCH
    return _of_values(text, at) or (NODE_INFO if _NODE.search(text) else None)


def kind_of_file(name: str) -> FileKind | None:
    """Return what a regular file is by its beginning; None of anything else.

    Raises
    ------
    OSError, ValueError
        If it cannot be read.
    """
    return kind_of(beginning(name, BOUND, passed_over=True))


def is_signed(data: bytes) -> bool:
    """Return whether a file says of itself that it is signed (S/MIME)."""
    return SIGNED in data[:HEAD].partition(b"<dds")[0]


def _unpacked(data: bytes) -> bytes:
    for magic, unpack in _PACKED.items():
        if data.startswith(magic):
            try:
                return unpack(data)
            except (zlib.error, OSError, ValueError, EOFError, lzma.LZMAError):
                return b""
    return data


def _text(data: bytes) -> str:
    """What is no text is none: a zero byte is in no UTF-8 that people write."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "ignore")
    return "" if b"\0" in data[:HEAD] else data.decode("utf-8", "ignore").removeprefix("\ufeff")


def _beginning(text: str) -> int:
    """Where the first element, brace or word stands."""
    at, last = 0, -1
    while at != last:
        last = at
        while at < len(text) and text[at].isspace():
            at += 1
        for begins, ends in _BEFORE.items():
            if text.startswith(begins, at):
                end = text.find(ends, at + len(begins))
                at = len(text) if end < 0 else end + len(ends)
                break
    return at


def _of_xml(root: str, text: str) -> FileKind | None:
    if root == "launch":
        return LAUNCH
    if root == "dds":
        return PERMISSIONS if "permissions" in text or "domain_access_rules" in text else None
    return POLICY if root == "policy" or (root != "html" and _GRANT.search(text)) else None


def _of_values(text: str, at: int) -> FileKind | None:
    """YAML, JSON or JSON5, by keys of the outermost map: the first, or that of an access list."""
    if text.startswith("{", at):
        if match := _FORMAT.search(text, at, at + HEAD):
            return _BY_FORMAT.get(match[1])
        keys = _keys(text, at)
        listed = ACCESS in text
    else:
        keys = (match[1] for match in _KEY.finditer(text, at)) if _KEY.match(text, at) else iter(())
        listed = True
    first = next(keys, "")
    return _BY_KEY.get(first) or (ACCESS_LIST if listed and ACCESS in keys else None)


def _keys(text: str, at: int) -> Iterator[str]:
    """The keys of the outermost map of JSON5, which need no quotes; a comment or a text may hold anything."""
    depth, end = 0, len(text)
    while at < end:
        sign, begin = text[at], at
        at += 1
        if sign in "{[":
            depth += 1
        elif sign in "}]":
            depth -= 1
        elif sign == "/":
            ends = _BEFORE.get(text[begin : at + 1], "")
            closed = text.find(ends, at + 1)
            at = end if closed < 0 else max(at, closed + len(ends)) if ends else at
        elif sign in "\"'":
            while at < end and text[at] != sign:
                at += 1 + (text[at] == "\\")
            at += 1
        elif sign.isidentifier():
            while at < end and text[at].isidentifier():
                at += 1
        else:
            continue
        word = text[begin:at].strip("\"'")
        if depth == 1 and word.isidentifier() and text[at : at + 64].lstrip().startswith(":"):
            yield word
