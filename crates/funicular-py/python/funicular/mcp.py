"""Server of the Model Context Protocol over standard input and output: programs that speak it compute cable robots.

Every command of the program is a tool. Its name, description and arguments are those that the command declares for
requests; only `robot` may also be the name of a robot of the library. The texts of these robots, the JSON Schemas and,
with `--docs`, the pages of the documentation are resources. A refused request returns the message of the program.

The extra `mcp` installs the library of the protocol: `pip install 'funicular[mcp]'`. A client starts
`funicular-mcp` or `python -m funicular.mcp`.
"""

import argparse
import csv
import io
import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import anyio.to_thread
from mcp import MCPError, types
from mcp.server import ServerRequestContext
from mcp.server.lowlevel import Server
from mcp.server.stdio import stdio_server

import funicular
from funicular._funicular import library

# Beginning of the addresses of resources.
SCHEME = "funicular://"

# Commands about files of maps on the disk, which a client does not have.
OF_FILES = ("merge", "plot")

# Commands whose result is a page of some megabytes.
PAGES = ("report", "live", "paper")

Context = ServerRequestContext[Any]


@dataclass(frozen=True)
class Text:
    """Text with its address, which a client can read."""

    uri: str
    about: str
    kind: str
    read: Callable[[], str]

    def listed(self) -> types.Resource:
        """Entry of the list of resources."""
        name = self.uri.removeprefix(SCHEME)
        return types.Resource(name=name, uri=self.uri, description=self.about, mime_type=self.kind)


def _schema(of: Any) -> str:
    return json.dumps(funicular.schema(of), ensure_ascii=False)


def _robot_name(text: str) -> str:
    """First line of a robot file that says what it is."""
    return next(line.partition("=")[2].strip().strip('"') for line in text.splitlines() if line.startswith("name"))


def texts(docs: Path | None) -> dict[str, Text]:
    """Texts by address: robots of the library, schemas, and pages below a folder."""
    found = []
    for name, text in library():
        found.append(Text(f"{SCHEME}robots/{name}.toml", _robot_name(text), "application/toml", partial(str, text)))
    for of, about in (("robot-file", "robot files"), ("request", "requests"), ("results", "results of all commands")):
        uri = f"{SCHEME}schemas/{of}.json"
        found.append(Text(uri, f"JSON Schema of {about}", "application/schema+json", partial(_schema, of)))
    if docs is not None:
        for path in sorted([*docs.rglob("*.md"), *docs.glob("llms*.txt")]):
            name = path.relative_to(docs).as_posix()
            read = partial(path.read_text, encoding="utf-8")
            found.append(Text(f"{SCHEME}docs/{name}", "Page of the documentation", "text/markdown", read))
    return {text.uri: text for text in found}


def tools(folder: Path | None) -> dict[str, types.Tool]:
    """Tools by name: the declared commands with their keys."""
    made = {}
    names = [name for name, _ in library()]
    for command in funicular.schema("request")["oneOf"]:
        keys: dict[str, Any] = dict(command["properties"])
        name: str = keys.pop("command")["const"]
        keys.pop("schema", None)
        if name in OF_FILES or (name in PAGES and folder is None):
            continue
        required = [key for key in command.get("required", []) if key != "command"]
        if "robot" in keys:
            about = "Robot file, or the name of a robot of the library"
            by_name = {"type": "string", "enum": names}
            keys["robot"] = {"anyOf": [by_name, keys["robot"]], "description": about}
        if name in PAGES:
            keys["file"] = {"type": "string", "description": "Name of the HTML file, in the folder of the server"}
            required.append("file")
        schema = {"type": "object", "properties": keys, "required": required, "additionalProperties": False}
        made[name] = types.Tool(name=name, description=command["description"], input_schema=schema)
    return made


def _cell(value: Any) -> str:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _rows(sweep: funicular.Sweep) -> str:
    """Rows of a map or sweep as CSV."""
    out = io.StringIO()
    written = csv.writer(out, lineterminator="\n")
    written.writerow(sweep.columns)
    columns = [column.tolist() for column in sweep.columns.values()]
    written.writerows([_cell(value) for value in row] for row in zip(*columns, strict=True))
    return out.getvalue()


def _page(made: Any, name: str, folder: Path) -> str:
    """Writes a page into the folder of the server; returns what was written."""
    if Path(name).name != name or not name.endswith(".html"):
        raise funicular.InputError(f"`file` is {name!r}: give the name of a file that ends in .html, without a folder")
    made.write(folder / name)
    return f"wrote {folder / name}"


def computed(command: str, given: Mapping[str, Any], folder: Path | None) -> str:
    """Text of the result of a command: JSON, CSV of rows, or the file that it makes."""
    request = {**given, "command": command}
    name = request.pop("file", "") if command in PAGES else ""
    if isinstance(request.get("robot"), str):
        known = dict(library())
        if request["robot"] not in known:
            raise funicular.InputError(f"the library has no robot {request['robot']!r}: it has {', '.join(known)}")
        request["robot"] = {"name": f"{request['robot']}.toml", "text": known[request["robot"]]}
    made = funicular.run(request)
    if isinstance(made, funicular.Sweep):
        return _rows(made)
    if command in PAGES and folder is not None:
        return _page(made, name, folder)
    if isinstance(made, (funicular.Exported, funicular.Imported, funicular.NewRobot)):
        notes = [f"# {key}: {note}\n" for key in ("assumed", "lost", "warnings") for note in getattr(made, key, ())]
        return "".join(notes) + made.text
    return json.dumps(made, ensure_ascii=False)


def server(folder: Path | None = None, docs: Path | None = None) -> Server[Any]:
    """Makes the server. Pages go into `folder`; without one it offers no commands that make pages."""
    offered, resources = tools(folder), texts(docs)

    async def list_tools(_: Context, __: types.PaginatedRequestParams | None) -> types.ListToolsResult:
        return types.ListToolsResult(tools=list(offered.values()))

    async def call_tool(_: Context, params: types.CallToolRequestParams) -> types.CallToolResult:
        if params.name not in offered:
            raise MCPError(types.INVALID_PARAMS, f"there is no tool {params.name!r}: there are {', '.join(offered)}")
        try:
            text = await anyio.to_thread.run_sync(computed, params.name, params.arguments or {}, folder)
        except (funicular.Error, OSError) as error:
            return types.CallToolResult(content=[types.TextContent(type="text", text=str(error))], is_error=True)
        return types.CallToolResult(content=[types.TextContent(type="text", text=text)])

    async def list_resources(_: Context, __: types.PaginatedRequestParams | None) -> types.ListResourcesResult:
        return types.ListResourcesResult(resources=[text.listed() for text in resources.values()])

    async def read_resource(_: Context, params: types.ReadResourceRequestParams) -> types.ReadResourceResult:
        uri = str(params.uri)
        if uri not in resources:
            raise MCPError(types.INVALID_PARAMS, f"there is no resource {uri}")
        text = resources[uri]
        return types.ReadResourceResult(
            contents=[types.TextResourceContents(uri=uri, mime_type=text.kind, text=text.read())]
        )

    return Server(
        "funicular",
        version=funicular.__version__,
        instructions=(funicular.__doc__ or "").partition(">>>")[0].strip(),
        on_list_tools=list_tools,
        on_call_tool=call_tool,
        on_list_resources=list_resources,
        on_read_resource=read_resource,
    )


async def _serve(made: Server[Any]) -> None:
    async with stdio_server() as (read, write):
        await made.run(read, write, made.create_initialization_options())


def main() -> None:
    """Serves on standard input and output until the client ends."""
    parser = argparse.ArgumentParser(prog="funicular-mcp", description=(__doc__ or "").partition("\n\n")[0])
    parser.add_argument("--folder", type=Path, help="folder for pages; without it the server writes no file")
    parser.add_argument("--docs", type=Path, help="folder of pages (.md), which become resources")
    given = parser.parse_args()
    for folder in (given.folder, given.docs):
        if folder is not None and not folder.is_dir():
            parser.error(f"there is no folder {folder}")
    anyio.run(_serve, server(given.folder, given.docs))


if __name__ == "__main__":
    main()
