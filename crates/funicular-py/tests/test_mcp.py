"""The server of the Model Context Protocol, by the client of its official library: tools, resources, refusals."""

import json
import subprocess
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import anyio
import funicular
import pytest
from conftest import ROBOT_FILES, ROBOTS, ROOT
from jsonschema import Draft202012Validator
from mcp import Client, MCPError, StdioServerParameters, types

Talk = Callable[[Client], Awaitable[None]]


def talk(session: Talk, *options: object) -> None:
    """Starts the server as a client does, over standard input and output, and talks to it."""
    line = ["-m", "funicular.mcp", *map(str, options)]

    async def run() -> None:
        async with Client(StdioServerParameters(command=sys.executable, args=line)) as client:
            await session(client)

    anyio.run(run)


def text_of(found: types.CallToolResult) -> str:
    """Text of the result of a tool."""
    assert len(found.content) == 1 and isinstance(found.content[0], types.TextContent)
    return found.content[0].text


def test_the_tools_are_the_declared_commands() -> None:
    async def session(client: Client) -> None:
        tools = {tool.name: tool for tool in (await client.list_tools()).tools}
        declared = {one["properties"]["command"]["const"]: one for one in funicular.schema("request")["oneOf"]}
        assert set(tools) == set(declared) - {"merge", "plot", "report", "live", "paper"}
        for name, tool in tools.items():
            Draft202012Validator.check_schema(tool.input_schema)
            assert tool.description == declared[name]["description"]
            keys = set(declared[name]["properties"]) - {"command", "schema"}
            assert set(tool.input_schema["properties"]) == keys, name
            for key in keys - {"robot"}:
                assert tool.input_schema["properties"][key] == declared[name]["properties"][key]

    talk(session)


def test_a_tool_returns_what_the_program_computes(program: Callable[..., dict[str, Any]]) -> None:
    async def session(client: Client) -> None:
        found = await client.call_tool("statics", {"robot": "cogiro", "pose": [1, 2, 1.5]})
        ours = json.loads(text_of(found))
        theirs = program("statics", "robots/cogiro.toml", "--pose", "1,2,1.5")
        assert not found.is_error
        assert ours["cables"] == theirs["cables"] and len(ours["cables"]) == 8

        own = {"name": "own.toml", "text": (ROBOTS / "yuan2014-4mm.toml").read_text()}
        modes = json.loads(text_of(await client.call_tool("modes", {"robot": own, "below_hz": 2})))
        assert modes["modes"] == program("modes", "robots/yuan2014-4mm.toml", "--below-hz", 2)["modes"]

        grid = [{"axis": "z", "values": [1.0, 50.0]}]
        asked = {"robot": "cogiro", "grid": grid, "quantities": ["tension-max"]}
        header, first, second = text_of(await client.call_tool("map", asked)).splitlines()
        assert header.startswith("x_m,") and "true" in first and "false" in second

        made = text_of(await client.call_tool("new", {"cables": 6}))
        assert funicular.Robot.from_toml(made).name

    talk(session)


@pytest.mark.parametrize(
    ("tool", "given", "says"),
    [
        ("statics", {"robot": "cogiro", "poze": [1, 2, 3]}, "did you mean `pose`?"),
        ("statics", {"robot": "cogiro", "pose": [50, 0, 1]}, "no tensions hold this pose"),
        ("statics", {"robot": {"text": "name = 1"}}, ":1:8"),
        ("statics", {"robot": "kogiro"}, "the library has no robot 'kogiro': it has caroca, cogiro"),
        ("statics", {}, "needs `robot`"),
        ("modes", {"robot": "cogiro", "below_hz": -1}, "below_hz"),
    ],
)
def test_a_refusal_is_the_message_of_the_program(tool: str, given: dict[str, Any], says: str) -> None:
    async def session(client: Client) -> None:
        found = await client.call_tool(tool, given)
        assert found.is_error and says in text_of(found), text_of(found)
        # The server goes on.
        assert not (await client.call_tool("check", {"robot": "cogiro"})).is_error

    talk(session)


def test_robots_schemas_and_documents_are_resources() -> None:
    async def session(client: Client) -> None:
        listed = {resource.uri: resource for resource in (await client.list_resources()).resources}

        async def read(uri: str) -> str:
            (content,) = (await client.read_resource(uri)).contents
            assert isinstance(content, types.TextResourceContents)
            return content.text

        for name in ROBOT_FILES:
            assert await read(f"funicular://robots/{name}") == (ROBOTS / name).read_text()
        assert json.loads(await read("funicular://schemas/results.json")) == funicular.schema("results")
        assert await read("funicular://docs/quick-start.md") == (ROOT / "docs/quick-start.md").read_text()
        assert listed["funicular://robots/cogiro.toml"].description == "CoGiRo, LIRMM and Tecnalia, 8 cables"
        with pytest.raises(MCPError, match="there is no resource funicular://docs/../README.md"):
            await read("funicular://docs/../README.md")
        with pytest.raises(MCPError, match="there is no tool 'static'"):
            await client.call_tool("static", {})

    talk(session, "--docs", ROOT / "docs")


def test_a_page_is_written_into_the_folder_of_the_server_alone(tmp_path: Path) -> None:
    async def session(client: Client) -> None:
        found = await client.call_tool("report", {"robot": "yuan2014-4mm", "file": "report.html"})
        assert text_of(found) == f"wrote {tmp_path / 'report.html'}"
        assert (tmp_path / "report.html").stat().st_size > 100_000
        refused = await client.call_tool("report", {"robot": "yuan2014-4mm", "file": "../report.html"})
        assert refused.is_error and "give the name of a file that ends in .html" in text_of(refused)

    talk(session, "--folder", tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["report.html"]


def test_a_folder_that_is_not_there_is_refused(tmp_path: Path) -> None:
    line = [sys.executable, "-m", "funicular.mcp", "--docs", str(tmp_path / "none")]
    done = subprocess.run(line, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    assert done.returncode == 2 and "there is no folder" in done.stderr
