"""Who may include whom, and how large files may grow: the rules of CONTRIBUTING.md, checked by reading the tree."""

import re
import subprocess
import sys
from pathlib import Path

root = Path(__file__).resolve().parents[2]
public = {p.name for p in (root / "include/gaussmap").glob("*.h")}
include = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)
problems = []


def tracked(pattern):
    listed = subprocess.run(["git", "ls-files", pattern], cwd=root, capture_output=True, text=True, check=True).stdout
    return [root / name for name in listed.split()]


def includes(path):
    return include.findall(path.read_text())


def complain(path, text):
    problems.append(f"{path.relative_to(root)}: {text}")


for path in (root / "include/gaussmap").glob("*.h"):
    for kind, name in includes(path):
        if kind == '"' and not name.startswith("gaussmap/"):
            complain(path, f"a public header includes {name}")
        if kind == "<" and ("/" in name or name.endswith(".h")):
            complain(path, f"a public header needs {name}, which is not of the standard library")

for path in [*root.glob("src/*.h"), *root.glob("src/*.cpp")]:
    for kind, name in includes(path):
        if name == "gaussmap/io.h" or name.startswith("io/"):
            complain(path, "an algorithm includes files' formats")

for folder in ("cli", "bench", "examples", "python", "tests/consumer"):
    own = {p.name for p in (root / folder).rglob("*.h")}
    for path in [*(root / folder).rglob("*.h"), *(root / folder).rglob("*.cpp")]:
        for kind, name in includes(path):
            if kind == '"' and not name.startswith("gaussmap/") and Path(name).name not in own:
                complain(path, f"includes {name}; only include/gaussmap and its own headers are allowed")

# A verb that saw CLI11 would take twice as long to compile.
for path in [*root.glob("cli/*"), *root.glob("wasm/*.cpp")]:
    for kind, name in includes(path):
        if name.startswith("CLI/") and path.name != "commandline.cpp":
            complain(path, f"includes {name}; CLI11 is behind commandline.h")

# No cycles among the library's own headers.
graph = {}
for path in [*root.glob("src/**/*.h"), *root.glob("include/gaussmap/*.h")]:
    key = str(path.relative_to(root / ("src" if "src" in path.parts else "include")))
    graph[key] = [name for kind, name in includes(path) if kind == '"']


def visit(name, trail):
    if name in trail:
        problems.append("cycle of headers: " + " → ".join([*trail[trail.index(name):], name]))
        return
    for other in graph.get(name, []):
        visit(other, [*trail, name])


for header in graph:
    visit(header, [])

printing = re.compile(r"\b(printf|fprintf|puts|std::cout|std::cerr|std::exit|std::abort|abort|exit)\s*(\(|<<)")
for path in [*root.glob("src/**/*.cpp"), *root.glob("src/**/*.h"), *root.glob("include/gaussmap/*.h")]:
    code = re.sub(r"//[^\n]*", "", path.read_text())
    if printing.search(code):
        complain(path, "the library never prints, exits or aborts")

lengths = [(p, len(p.read_text().splitlines())) for pattern in ("*.cpp", "*.h", "*.py", "*.ts") for p in tracked(pattern)]
for path, lines in lengths:
    if lines > 560:
        complain(path, f"{lines} lines; files stay under about 500")
if not lengths:
    problems.append("no tracked file was looked at")

print("\n".join(problems) if problems else f"{len(lengths)} files follow the layout")
sys.exit(bool(problems))
