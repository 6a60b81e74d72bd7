"""What CMake builds: executables with their sources through variables, loops and globs, components, scripts."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.ingest.scan.cmake_targets import Target, read_targets

FILES = ("p/CMakeLists.txt", "p/src/a.cpp", "p/src/b.cpp", "p/src/lib.cpp", "p/src/deep/c.cpp", "p/scripts/run.py")


def read(text: str) -> dict[str, tuple[str, ...]]:
    return {one.name: one.files for one in read_targets("p", FILES, {"p/CMakeLists.txt": text}.get).targets}


@pytest.mark.parametrize(
    "text",
    [
        "add_executable(a src/a.cpp)",
        "ADD_EXECUTABLE ( a\n  src/a.cpp # of the first\n)",
        "ament_auto_add_executable(a src/a.cpp)",
        "set(S src/a.cpp)\nadd_executable(a ${S})",
        "set(DIR src)\nset(S ${DIR}/a.cpp)\nadd_executable(a ${S})",
        "set(S)\nlist(APPEND S src/a.cpp)\nadd_executable(a ${S})",
        "file(GLOB S src/a*.cpp)\nadd_executable(a ${S})",
        "file(GLOB S ${CMAKE_CURRENT_SOURCE_DIR}/src/a*.cpp)\nadd_executable(a ${S})",
        "foreach(n a)\nadd_executable(${n} src/${n}.cpp)\nendforeach()",
        "set(L a)\nforeach(n IN LISTS L)\nadd_executable(${n} src/${n}.cpp)\nendforeach()",
        "project(a)\nadd_executable(${PROJECT_NAME} src/a.cpp)",
        "add_executable(x src/a.cpp)\nset_target_properties(x PROPERTIES OUTPUT_NAME a)",
        "if(WIN32)\nelse()\nadd_executable(a src/a.cpp)\nendif()",
        "#[[ add_executable(b src/b.cpp) ]]\nadd_executable(a src/a.cpp)",
        "macro(node name)\nadd_executable(${name} ${ARGN})\nendmacro()\nnode(a src/a.cpp)",
        "function(node n s)\nfile(GLOB S ${s})\nadd_executable(${n} ${S})\nendfunction()\nNODE(a src/a*)",
        "if(BUILD_TESTING)\nadd_executable(b src/b.cpp)\nendif()\nadd_executable(a src/a.cpp)",
    ],
)
def test_an_executable_has_its_sources(text: str) -> None:
    assert read(text) == {"a": ("p/src/a.cpp",)}


def test_all_of_a_glob_belong_to_it() -> None:
    sources = tuple(sorted(file for file in FILES if file.endswith(".cpp")))
    assert read("file(GLOB_RECURSE S src/*.cpp)\nadd_executable(a ${S})") == {"a": sources}


def test_the_libraries_of_the_package_that_it_links_belong_to_it() -> None:
    text = "add_library(l src/lib.cpp)\nadd_executable(a src/a.cpp)\ntarget_link_libraries(a l elsewhere)"
    assert read(text) == {"a": ("p/src/a.cpp", "p/src/lib.cpp")}


def test_a_component_is_what_its_library_is_made_of_and_its_executable_names_it() -> None:
    text = (
        'add_library(l SHARED src/lib.cpp)\nrclcpp_components_register_node(l PLUGIN "demo::Talker" EXECUTABLE talker)'
    )
    found = read_targets("p", FILES, {"p/CMakeLists.txt": text}.get).targets
    assert found == (
        Target("demo::Talker", "p/CMakeLists.txt", 2, ("p/src/lib.cpp",)),
        Target("talker", "p/CMakeLists.txt", 2, ("p/src/lib.cpp",), "demo::Talker"),
    )


def test_several_components_of_a_library() -> None:
    text = 'add_library(l src/lib.cpp)\nrclcpp_components_register_nodes(l "demo::A" "demo::B")'
    assert set(read(text)) == {"demo::A", "demo::B"}


@pytest.mark.parametrize(
    "text",
    [
        "install(PROGRAMS scripts/run.py DESTINATION lib/${PROJECT_NAME})",
        "install(DIRECTORY scripts/ DESTINATION lib/${PROJECT_NAME} USE_SOURCE_PERMISSIONS)",
    ],
)
def test_an_installed_script_can_be_run(text: str) -> None:
    assert read(f"project(p)\n{text}") == {"run.py": ("p/scripts/run.py",)}


def test_a_subfolder_is_read_from_there() -> None:
    texts = {"p/CMakeLists.txt": "add_subdirectory(src)", "p/src/CMakeLists.txt": "add_executable(a a.cpp)"}
    found = read_targets("p", (*FILES, "p/src/CMakeLists.txt"), texts.get).targets
    assert [(one.name, one.files, one.file) for one in found] == [("a", ("p/src/a.cpp",), "p/src/CMakeLists.txt")]


def test_a_module_has_the_name_of_its_package() -> None:
    texts = {"p/CMakeLists.txt": "install(PROGRAMS p/node.py DESTINATION lib/p RENAME node)"}
    assert read_targets("p", ("p/CMakeLists.txt", "p/p/node.py"), texts.get).targets == (
        Target("node", "p/CMakeLists.txt", 1, ("p/p/node.py",)),
    )


def test_a_file_of_macros_of_the_package_is_read() -> None:
    macros = "macro(node name)\nadd_executable(${name} src/${name}.cpp)\nendmacro()"
    texts = {"p/CMakeLists.txt": "include(cmake/m.cmake)\nnode(a)", "p/cmake/m.cmake": macros}
    found = read_targets("p", (*FILES, "p/cmake/m.cmake"), texts.get).targets
    assert [(one.name, one.files) for one in found] == [("a", ("p/src/a.cpp",))]


@pytest.mark.parametrize(
    "bomb",
    [
        "set(A x;x)\n" + "set(A ${A};${A})\n" * 60 + "add_executable(a ${A})",
        "set(L a;b;c;d;e;f;g;h)\n" + "foreach(i ${L})\n" * 15 + "set(x y)\n" + "endforeach()\n" * 15,
        "macro(m)\nm()\nm()\nendmacro()\nm()",
        "macro(m)\nm(${ARGN} ${ARGN})\nm(${ARGN} ${ARGN})\nendmacro()\nm(a b)",
    ],
)
def test_what_grows_without_end_ends_and_that_is_said(bomb: str) -> None:
    assert not read_targets("p", FILES, {"p/CMakeLists.txt": bomb}.get).whole


@pytest.mark.parametrize(
    "text",
    [
        "add_subdirectory(.)",
        "include(CMakeLists.txt)",
        "set(A ${B})\nset(B ${A})\nadd_executable(a ${A})",
        "foreach(" * 5000,
        "(" * 5000 + ")" * 5000,
    ],
)
def test_what_names_itself_ends(text: str) -> None:
    read(text)


@given(st.text(alphabet='ad_execut(){}$" \n#[]=;IFfor') | st.text())
def test_no_text_ends_the_reader(text: str) -> None:
    read(text)
