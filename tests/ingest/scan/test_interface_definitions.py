"""What definitions of a checkout limit (rule S15): no more than the same fields in a known type, in doubt nothing."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.ingest.scan.checkout_files import checkout_files
from rosprivacy.ingest.scan.interface_definitions import FEW, NUMBERS, read_definitions
from rosprivacy.ingest.scan.packages import read_packages
from rosprivacy.ingest.types import TABLE
from rosprivacy.ingest.types.type_table import read_table
from rosprivacy.ontology.vocabulary import load
from rosprivacy.scanning import scan
from tests.helpers.checkouts import CAMERA, UPLOADER, put_checkout

LIMITS = read_table(TABLE, load()).limits
MANIFEST = "<package format='3'><name>{}</name><export><build_type>ament_cmake</build_type></export></package>"
STORES = ("ROS2_FOXY", "ROS2_HUMBLE", "ROS2_IRON", "ROS2_JAZZY", "ROS2_KILTED", "ROS2_LYRICAL")
PICTURES = {"Video", "FaceImage", "ThermalImage", "DocumentImage"}


def read(root: Path, files: dict[str, str]) -> tuple[dict[str, tuple[tuple[str, ...], ...]], list[tuple[str, int]]]:
    """(fields by type, (file, line) of each gap) of packages whose definitions are given by path."""
    for name, text in files.items():
        file = root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, "utf-8")
        (root / name.split("/")[0] / "package.xml").write_text(MANIFEST.format(name.split("/")[0].split(".")[0]))
    checkout = checkout_files(root)
    definitions, gaps = read_definitions(checkout.root, read_packages(checkout))
    return {name: defined.fields for name, defined in definitions.items()}, [
        (gap.place.file, gap.place.line) for gap in gaps
    ]


def excluded(types: tuple[str, ...]) -> frozenset[str]:
    """S15: several types exclude what all of them exclude; none, and one that the table does not know, nothing."""
    limits = [LIMITS.of.get((name, "")) for name in types]
    return frozenset.intersection(*(each.kinds for each in limits if each)) if limits and all(limits) else frozenset()


def of(root: Path, text: str, **more: str) -> frozenset[str]:
    files = {"own/msg/Thing.msg": text, **{f"own/msg/{name}.msg": other for name, other in more.items()}}
    return excluded(next(iter(read(root, files)[0]["own/msg/Thing"]), ()))


def test_a_few_numbers_carry_no_pictures_and_one_number_what_one_number_can(tmp_path: Path) -> None:
    assert of(tmp_path, "uint8 IDLE=0\nuint8 MOVING = 1 # a state\nstd_msgs/Header header\nuint8 state") == excluded(
        ("std_msgs/msg/UInt8", "builtin_interfaces/msg/Time")
    )
    assert of(tmp_path, "float32 left\nfloat32 right 1.0\n") >= PICTURES
    assert "PersonPointCloud" not in of(tmp_path, "float64 x\nfloat64 y\nfloat64 z")  # as a Point is
    assert of(tmp_path, "") == excluded(("std_msgs/msg/Empty",))
    assert of(tmp_path, "bool open") == excluded(("std_msgs/msg/Bool",))
    assert "Voice" not in of(tmp_path, "\n".join(f"bool b{at}" for at in range(7)))  # a byte in its bits


@pytest.mark.parametrize(
    "text",
    [
        "string text",
        "string<=5 text",
        "wstring text",
        "string frame_id",  # only that of a header is known to be a frame's
        "uint8[] data",
        "uint8[4] data",
        "byte[<=2] data",
        "float32[] data",
        f"float32[{FEW + 1}] data",
        f"float32[<={FEW + 1}] data",
        "float32[9999999999] data",
        "\n".join(f"float32 f{at}" for at in range(FEW + 1)),
        "geometry_msgs/Point[] points",
        "std_msgs/Header[] headers",
        "sensor_msgs/Image image",
        "other_msgs/Unknown thing",
        "Missing thing",
        "Thing thing",  # a circle
        "Round thing",
        "Own thing",
        "time stamp",  # of ROS 1
        "float32 x\nthis is: no field",
        "float32",
        "float32[ x",
        "float32 x\n---\nfloat32 y",
    ],
)
def test_what_is_not_certain_limits_nothing(tmp_path: Path, text: str) -> None:
    assert of(tmp_path, text, Round="Back back", Back="Round round", Own="float32 x\nstring why") == frozenset()


def test_types_in_types_are_those_of_the_checkout_or_known_ones(tmp_path: Path) -> None:
    pose = "geometry_msgs/Pose pose\nLevel level"
    assert of(tmp_path, pose, Level="float32 level") == excluded(
        ("geometry_msgs/msg/Pose", "geometry_msgs/msg/PoseArray", "std_msgs/msg/Float32")
    )
    assert of(tmp_path, "geometry_msgs/Pose[] poses") == excluded(("geometry_msgs/msg/PoseArray",))
    assert of(tmp_path, "own/Level[3] levels\nown/msg/Level level", Level="float32 level") >= PICTURES
    assert of(tmp_path, "Level[4] levels", Level="float32 a\nfloat32 b") == frozenset()
    own = {"geometry_msgs/msg/Pose.msg": "string where"}  # not that of ROS
    assert read(tmp_path, own | {"own/msg/Thing.msg": pose})[0]["own/msg/Thing"] == ((),)


def test_each_leg_by_itself_and_a_result_with_its_feedback(tmp_path: Path) -> None:
    fields, _ = read(
        tmp_path,
        {"own/srv/Open.srv": "bool open\n---\nstring why", "own/action/Go.action": "---\nbool done\n---\nfloat32 left"},
    )
    assert fields["own/srv/Open"] == (("std_msgs/msg/Bool",), ())
    assert fields["own/action/Go"][0] == ("std_msgs/msg/Empty",)
    assert {"std_msgs/msg/Bool", "std_msgs/msg/Float32"} < set(fields["own/action/Go"][1])


def test_two_definitions_of_one_name_limit_only_where_they_are_the_same(tmp_path: Path) -> None:
    files = {"own/msg/A.msg": "bool a", "own.copy/msg/A.msg": "bool a # copied", "own/msg/B.msg": "bool b"}
    assert read(tmp_path, files)[0]["own/msg/A"] == (("std_msgs/msg/Bool",),)
    assert read(tmp_path, files | {"own.copy/msg/A.msg": "int8 a"})[0]["own/msg/A"] == ()


def test_only_where_packages_of_ros_2_have_them(tmp_path: Path) -> None:
    (tmp_path / "msg").mkdir()
    (tmp_path / "msg" / "Loose.msg").write_text("bool a")
    assert set(read(tmp_path, {"own/msg/A.msg": "bool a", "own/mail/B.msg": "bool a"})[0]) == {"own/msg/A"}


def test_a_hostile_definition_is_one_gap_at_its_line_and_ends(tmp_path: Path) -> None:
    chain = {f"own/msg/A{at}.msg": f"A{at + 1} a\nA{at + 1} b\n" for at in range(2000)}
    fields, gaps = read(
        tmp_path,
        chain
        | {
            "own/msg/Bad.msg": "bool a\n\x00\x1b[31m]\n",
            "own/msg/Wide.msg": "bool " + "[" * 100_000,
            "own/msg/Long.msg": "float32 x\n" * 100_000,
            "own/msg/A2000.msg": "",
        },
    )
    assert gaps == [("own/msg/Bad.msg", 2), ("own/msg/Wide.msg", 1)]
    assert fields["own/msg/Bad"] == ()
    assert fields["own/msg/Long"] == fields["own/msg/A0"] == ((),)


def definition(definitions: object, name: str) -> str:
    """A type of the definitions of ROS as the text of a file."""
    from rosbags.interfaces import Nodetype

    lines = []
    for field_name, (kind, described) in definitions.fielddefs[name][1]:  # type: ignore[attr-defined]
        inner, ending = (kind, described), ""
        if kind in (Nodetype.ARRAY, Nodetype.SEQUENCE):
            inner, count = described
            ending = f"[{count or ''}]" if kind == Nodetype.ARRAY else f"[<={count}]" if count else "[]"
        type_ = inner[1] if inner[0] == Nodetype.NAME else inner[1][0].replace("octet", "byte")
        lines.append(f"{type_}{ending} {field_name}")
    return "\n".join(lines)


@pytest.mark.parametrize("store", STORES)
def test_by_its_fields_no_known_type_is_limited_more_than_by_its_name(store: str, tmp_path: Path) -> None:
    """Under another name it is another type, of which only the fields are known."""
    from rosbags.typesys import Stores, get_typestore

    definitions = get_typestore(Stores[store])
    names = [name for name, leg in LIMITS.of if not leg and name in definitions.fielddefs]
    texts = {
        f"own/msg/{name.replace('/msg/', '').replace('_', '')}.msg": definition(definitions, name) for name in names
    }
    fields, gaps = read(tmp_path, texts)
    assert not gaps
    closed = 0
    for name in names:
        kinds = excluded(fields[f"own/msg/{name.replace('/msg/', '').replace('_', '')}"][0])
        assert kinds <= LIMITS.of[name, ""].kinds, name
        closed += bool(kinds)
    assert closed > len(names) / 2


FIELDS = st.sampled_from(
    [*NUMBERS, "float32[2]", "int32[<=3]", "geometry_msgs/Twist", "geometry_msgs/Pose[]", "std_msgs/Header", "string"]
)


@given(st.lists(FIELDS, max_size=5), st.lists(FIELDS, max_size=3))
def test_more_fields_carry_more_however_they_are_packed(fields: list[str], more: list[str]) -> None:
    def lines(types: list[str]) -> str:
        return "\n".join(f"{type_} f{at}" for at, type_ in enumerate(types))

    with TemporaryDirectory() as folder:
        files = {"Few": lines(fields), "Inner": lines(more), "Whole": lines([*fields, *more])}
        texts = {f"own/msg/{name}.msg": text for name, text in files.items()}
        known, _ = read(Path(folder), {**texts, "own/msg/Packed.msg": f"{lines(fields)}\nInner inner"})
        few, whole, packed = (excluded(known[f"own/msg/{name}"][0]) for name in ("Few", "Whole", "Packed"))
        assert packed == whole <= few or (not fields and whole <= excluded(("std_msgs/msg/Empty",)))


@pytest.mark.parametrize(
    ("fields", "closed"), [("std_msgs/Header header\nfloat32 level\n", True), ("string why", False)]
)
def test_a_scan_closes_what_a_definition_cannot_carry_and_so_do_its_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fields: str, *, closed: bool
) -> None:
    monkeypatch.chdir(tmp_path)
    code = {
        f"guide__{name}_dot_py": text.replace("sensor_msgs.msg import Image", "guide.msg import Level").replace(
            "Image,", "Level,"
        )
        for name, text in {"camera": CAMERA, "uploader": UPLOADER}.items()
    }
    put_checkout(Path("guide"), msg__Level_dot_msg=fields, **code)
    Path("l.yaml").write_text("labels: 1\nnodes: {/robot/camera: {source: [Video]}, /uploader: {leak: [Video]}}\n")
    read = scan("guide")
    Path("robot.policy.xml").write_bytes(read.policy)
    Path("robot.types.yaml").write_text(read.types)
    results = [
        rosprivacy.analyze("guide", "l.yaml"),
        rosprivacy.analyze("robot.policy.xml", "l.yaml", types="robot.types.yaml"),
    ]
    for result in results:
        assert bool(result.findings) != closed
        (why,) = result.why_not("/robot/camera", "/uploader", "Video")
        assert ("guide/msg/Level.msg:1" in {str(place) for stop in why.obstacles for place in stop.places}) == closed
    assert rosprivacy.analyze("guide", "l.yaml", type_limits=None).findings
