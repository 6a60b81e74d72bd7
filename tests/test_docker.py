"""What docker/ promises, read from its files; and docker's own word on them where it is installed."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from typing import Any

import pytest
import yaml

from rosprivacy.private_neo4j import jars
from rosprivacy.report.pictures.graphviz import LIBRARIES
from tests.helpers.paths import ROOT

COMPOSE = ROOT / "docker" / "compose.yml"
DOCKERFILE = ROOT / "docker" / "Dockerfile"
FROM_THE_ENVIRONMENT = re.compile(r"\$\{NEO4J_PASSWORD:\?[^}]+\}")


@pytest.fixture
def services() -> Any:
    return yaml.safe_load(COMPOSE.read_text("utf-8"))["services"]


def test_the_image_is_the_version_that_we_start_ourselves(services: Any) -> None:
    assert services["neo4j"]["image"] == f"neo4j:{jars.VERSION}-community"


def test_the_password_comes_from_the_environment_only(services: Any) -> None:
    assert re.fullmatch(f"neo4j/{FROM_THE_ENVIRONMENT.pattern}", services["neo4j"]["environment"]["NEO4J_AUTH"])
    assert FROM_THE_ENVIRONMENT.fullmatch(services["tool"]["environment"]["NEO4J_PASSWORD"])
    assert not re.search("pass|auth", str(services["neo4j"]["healthcheck"]), re.IGNORECASE)  # a command line is seen


def test_it_is_for_this_machine_only_and_reports_to_nobody(services: Any) -> None:
    neo4j = services["neo4j"]
    assert neo4j["ports"] == ["127.0.0.1:7474:7474", "127.0.0.1:7687:7687"]
    assert "ports" not in services["tool"]
    for name in ("dbms_usage__report_enabled", "server_bolt_telemetry_enabled", "client_allow__telemetry"):
        assert neo4j["environment"][f"NEO4J_{name}"] == "false"


def test_data_and_logs_outlive_the_container(services: Any) -> None:
    volumes = dict(volume.split(":") for volume in services["neo4j"]["volumes"])
    assert sorted(volumes.values()) == ["/data", "/logs"]
    assert set(volumes) == set(yaml.safe_load(COMPOSE.read_text("utf-8"))["volumes"])


def test_the_tool_waits_until_the_server_is_healthy(services: Any) -> None:
    assert services["neo4j"]["healthcheck"]["test"][0] == "CMD"
    tool = services["tool"]
    assert tool["profiles"] == ["tool"]
    assert tool["depends_on"] == {"neo4j": {"condition": "service_healthy"}}
    assert tool["environment"]["NEO4J_URI"] == "bolt://neo4j:7687"
    assert (COMPOSE.parent / tool["build"]["context"] / tool["build"]["dockerfile"]).samefile(DOCKERFILE)


def test_the_tools_image_is_pinned_slim_and_not_roots() -> None:
    lines = DOCKERFILE.read_text("utf-8").splitlines()
    bases = [line.split()[1] for line in lines if line.startswith("FROM ")]
    assert len(bases) == 2
    assert all(re.fullmatch(r"python:3\.\d+\.\d+-slim-\w+", base) for base in bases)
    end = lines[lines.index(f"FROM {bases[1]}") :]
    (user,) = [line.split()[1] for line in end if line.startswith("USER ")]
    assert user not in {"root", "0"}
    assert any(LIBRARIES in line for line in end)  # slim has none of them, and Graphviz's wheel needs them
    assert end[-1] == 'ENTRYPOINT ["rosprivacy"]'


def test_the_builder_gets_what_the_wheel_is_made_of() -> None:
    kept = {line[1:] for line in (ROOT / ".dockerignore").read_text("utf-8").splitlines() if line.startswith("!")}
    rooms = {path.name for path in (ROOT / "src" / "rosprivacy").iterdir() if path.is_symlink()}
    assert rooms | {"src", "pyproject.toml", "README.md", "LICENSE"} <= kept


def test_compose_takes_the_file() -> None:
    """Asked where docker has its compose; what can be seen without is that all it refers to is declared."""
    assert set(yaml.safe_load(COMPOSE.read_text("utf-8"))) == {"name", "services", "volumes"}
    compose = ["docker", "compose"]
    if (
        shutil.which("docker")
        and not subprocess.run([*compose, "version"], capture_output=True, check=False).returncode
    ):
        for password, code in {"long enough": 0, "": 1}.items():
            command = [*compose, "--file", str(COMPOSE), "--profile", "tool", "config", "--quiet"]
            environment = os.environ | {"NEO4J_PASSWORD": password}
            done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
            assert bool(done.returncode) == bool(code), done.stderr
            assert code == 0 or "set NEO4J_PASSWORD" in done.stderr
