"""What must hold before a release: run ``python .ci/release_check.py [TAG]``; it needs Python 3.11 and nothing else.

The address of the repository stands in ``pyproject.toml``; every other file that names it has to name the same. While
it is a placeholder, or the maintainer of the ROS package is, nothing is released. Each problem is one line on standard
error; the exit code is 1 if there is any.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import tomllib

PLACEHOLDERS = ("OWNER/", "example.org", "example.com", ".invalid")
VERSIONS = {
    "src/rosprivacy/version.py": r'^__version__ = "(.+)"$',
    "ros2privacy/package.xml": r"<version>(.+)</version>",
    "ros2privacy/setup.py": r'^    version="(.+)",$',
    "CITATION.cff": r"^version: (.+)$",
}
# Where the address stands: as it is, or as the two last parts of it in 'uses:'.
ADDRESSED = (
    "README.md", "CITATION.cff", "mkdocs.yml", "ros2privacy/README.md", "ros2privacy/package.xml", "docs/formats.md",
    "docs/editors.md", "docs/labels.schema.json", "docs/fleet.schema.json", "docs/project.schema.json",
    "examples/ci/privacy.yml", ".github/ISSUE_TEMPLATE/config.yml",
)  # fmt: skip


def problems(root: Path, tag: str | None) -> list[str]:
    """Say what stands against a release of the tree at ``root``, one line each, in the order of this file.

    ``tag`` is the tag that is released, such as ``v0.2.0``; None where there is none yet.
    """
    texts = {
        name: (root / name).read_text("utf-8") for name in (*VERSIONS, *ADDRESSED, "pyproject.toml", "CHANGELOG.md")
    }
    address = tomllib.loads(texts["pyproject.toml"])["project"]["urls"]["Repository"]
    versions = {name: _only(pattern, texts[name]) for name, pattern in VERSIONS.items()}
    version = versions["src/rosprivacy/version.py"]
    maintainer = _only(r'<maintainer email="(.+)">', texts["ros2privacy/package.xml"])
    lines = [f"pyproject.toml: {address} is a placeholder; write the address of the repository"] * _is_placeholder(
        address
    )
    lines += [
        f"{name}: does not name the repository as pyproject.toml does ({address})"
        for name in ADDRESSED
        if not _named(texts[name], address)
    ]
    lines += [f"{name}: has version {found}, not {version}" for name, found in versions.items() if found != version]
    if _is_placeholder(maintainer):
        lines.append(f"ros2privacy/package.xml: the maintainer {maintainer} is a placeholder; write who answers for it")
    if f"\n## {version}\n" not in texts["CHANGELOG.md"] and not re.search(
        rf"^## {re.escape(version)} \(\d{{4}}-\d\d-\d\d\)$", texts["CHANGELOG.md"], re.MULTILINE
    ):
        lines.append(f"CHANGELOG.md: has no heading '## {version} (YYYY-MM-DD)'")
    if tag is not None and tag != f"v{version}":
        lines.append(f"the tag {tag} is not v{version}, the version of src/rosprivacy/version.py")
    return lines


def _only(pattern: str, text: str) -> str:
    matched = re.search(pattern, text, re.MULTILINE)
    return matched[1] if matched else "none"


def _is_placeholder(text: str) -> bool:
    return any(part in text for part in PLACEHOLDERS)


def _named(text: str, address: str) -> bool:
    """Whether a file names this repository, and no other of this name."""
    owner_and_name = "/".join(address.split("/")[-2:])
    owner, name = owner_and_name.split("/")
    others = re.findall(rf"\b([\w.-]+)/{re.escape(name)}(?=[\s@'\")<>]|/(?:issues|security|releases)|\.git|$)", text)
    return owner_and_name in text and {*others} <= {owner}


if __name__ == "__main__":
    found = problems(Path(__file__).parents[1], sys.argv[1] if len(sys.argv) > 1 else None)
    print(*found, sep="\n", end="\n" if found else "", file=sys.stderr)
    sys.exit(bool(found))
