"""The package for JavaScript, as a stranger has it: installed by npm, asked in node and in a browser, and gated."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest

from packages.trials import ADAPTERS
from tests.packages.archives import gate, packed, quietly, unpacked_archive
from tests.report import browser

NPM = shutil.which("npm")
NODE = shutil.which("node")
TOOLS = ("clang", "wasm-ld", "npm", "node")
MISSING = [tool for tool in TOOLS if shutil.which(tool) is None]

pytestmark = [
    pytest.mark.skipif(bool(MISSING), reason=f"not here: {', '.join(MISSING)} (Debian: clang, lld, nodejs, npm)"),
    pytest.mark.slow,
]

PAGE = """<!doctype html><script type="importmap">{"imports": {"hypcheck": "./package/index.mjs"}}</script>
<script type="module">
import { position, version } from "hypcheck";
const sizes = { alpha: 2, gamma: 17.8, b: 0.25, d: 0.15 };
document.title = [version, ...[2.25, 2.2500000000000004, 1].map((x) => position(sizes, [x, 0, 0]))].join(" ");
</script>"""


@pytest.fixture(scope="module")
def archive(tmp_path_factory):
    return packed(tmp_path_factory.mktemp("javascript"), "javascript")


@pytest.fixture(scope="module")
def installed(archive, tmp_path_factory):
    """A folder of somebody who has installed the archive."""
    folder = tmp_path_factory.mktemp("somebody")
    (folder / "package.json").write_text('{"private": true, "type": "module"}', encoding="utf-8")
    quietly(NPM, "install", "--offline", "--no-audit", "--no-fund", archive, cwd=folder)
    return folder


def test_the_package_installs_without_a_network_and_its_own_tests_pass(installed):
    package = installed / "node_modules" / "hypcheck"
    assert "# fail 0" in quietly(NODE, "--test", package / "test", cwd=package)


def test_the_example_of_the_readme_says_what_its_comments_say(installed):
    text = (installed / "node_modules" / "hypcheck" / "README.md").read_text(encoding="utf-8")
    code = text.split("```js\n")[1].split("```")[0]
    lines = [line for line in code.splitlines() if " // " in line]
    calls = [line.split("; // ") for line in lines]
    script = code.split("\n\n")[0] + "\n" + next(line for line in code.splitlines() if line.startswith("const"))
    script += "".join(f"\nconsole.log({call});" for call, _ in calls)
    (installed / "example.mjs").write_text(script, encoding="utf-8")
    said = quietly(NODE, "example.mjs", cwd=installed).split()
    assert len(said) == len(calls) == 5
    for answer, (_, comment) in zip(said, calls, strict=True):
        assert answer.startswith(comment.split(":")[0].rstrip("…"))


def test_its_types_name_all_that_it_exports(installed):
    types = (installed / "node_modules" / "hypcheck" / "index.d.ts").read_text(encoding="utf-8")
    names = quietly(
        NODE, "--input-type=module", "-e", "console.log(Object.keys(await import('hypcheck')).join(' '))", cwd=installed
    ).split()
    assert len(names) == 11
    assert [name for name in names if f" {name}:" not in types and f" {name}(" not in types] == []


def test_npm_packs_what_the_archive_holds_and_no_source_of_c(archive, installed, tmp_path):
    folder = unpacked_archive(archive)
    quietly(NPM, "pack", "--offline", "--pack-destination", tmp_path, cwd=folder)
    assert [path.suffix for path in tmp_path.iterdir()] == [".tgz"]
    assert not list(folder.rglob("*.c"))


def test_a_browser_loads_the_package_as_a_module(installed):
    package = installed / "node_modules" / "hypcheck"
    kinds = {".mjs": "text/javascript", ".html": "text/html"}

    def served(route):
        path = Path(route.request.url.removeprefix("http://hypcheck.test/"))
        body = PAGE if path.suffix == ".html" else (package / path.name).read_text(encoding="utf-8")
        route.fulfill(body=body, content_type=kinds[path.suffix])

    with browser.opened() as window:
        window.page.route("http://hypcheck.test/**", served)
        window.page.goto("http://hypcheck.test/page.html")
        window.page.wait_for_function("document.title.includes(' ')", timeout=30000)
        assert window.page.title().split()[1:] == ["0", "1", "-1"]
        assert [line for line in window.said if "favicon" not in line] == []


@pytest.mark.thorough
def test_the_package_is_held_by_the_gate_about_upright_and_tilted_rows(installed):
    quietly(sys.executable, "-m", "hypcheck", "init", "--language", "javascript", "--name", "package", cwd=installed)
    (installed / "hypcheck-javascript" / "predicate.mjs").write_text(ADAPTERS["predicate.mjs"], encoding="utf-8")
    said = gate(installed, f"command:{NODE} hypcheck-javascript/adapter.mjs", "--count", "40")
    assert "HELD" in said
