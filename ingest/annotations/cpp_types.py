"""Names of message types in C++ -> ``sensor_msgs/msg/Image``, as far as the file itself says what a name stands for."""

from __future__ import annotations

INTERFACES = ("msg", "srv", "action")
STEPS = 5  # of names that stand for names


class TypeNames:
    """What ``using`` says in a file."""

    def __init__(self) -> None:
        self.meant: dict[str, str] = {}

    def add(self, kind: str, names: list[str]) -> None:
        """Note one ``using A::B;``, ``using B = A::C;`` or ``namespace b = a::c;``."""
        if kind == "using_declaration" and len(names) == 1:
            self.meant[names[0].rpartition("::")[2].strip()] = names[0]
        elif kind != "using_declaration" and len(names) > 1:
            self.meant[names[0]] = names[-1]

    def meaning(self, name: str) -> str:
        """Return what a name stands for, by what ``using`` says of its first part.

        >>> types = TypeNames()
        >>> types.add("namespace_alias_definition", ["b", "a::c"])
        >>> types.meaning("b::D"), types.meaning("D")
        ('a::c::D', 'D')
        """
        for _ in range(STEPS):
            head, colons, rest = name.partition("::")
            if head not in self.meant or self.meant[head] == name:
                break
            name = self.meant[head] + colons + rest
        return name

    def message(self, written: str) -> str:
        """Return the type in ROS's spelling; empty where the file does not say.

        >>> types = TypeNames()
        >>> types.add("alias_declaration", ["Image", "sensor_msgs::msg::Image"])
        >>> types.message("Image"), types.message("Other"), types.message("std_msgs::msg::String")
        ('sensor_msgs/msg/Image', '', 'std_msgs/msg/String')
        """
        name = self.meaning(written.removeprefix("const ").strip())
        parts = [part.strip() for part in name.replace("/", "::").split("::") if part.strip()]
        known = len(parts) >= len(("package", "msg", "Name")) and parts[1] in INTERFACES
        return "/".join(parts[:3]) if known and all(part.isidentifier() for part in parts[:3]) else ""
