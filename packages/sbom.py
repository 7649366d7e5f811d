"""What an archive is made of, as CycloneDX 1.6: itself with its hash, what it holds of others, and what it asks for.

Made from metadata alone, beside the archive, the same bytes each time: no date and no number drawn at random.
"""

from __future__ import annotations

import hashlib
import json
import re
import sys
from pathlib import Path
from typing import Any

from packages.archives import ROOT

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

SUFFIX = ".cdx.json"
Component = dict[str, Any]


def ecosystem_of(archive: Path) -> str:
    """Of which ecosystem an archive is, by its name: pypi, generic (C and C++), cargo or npm."""
    named = re.match(r"hypcheck-(c|rust|javascript)-", archive.name)
    return {"c": "generic", "rust": "cargo", "javascript": "npm"}[named[1]] if named else "pypi"


def version_of(archive: Path) -> str:
    """The version that the name of an archive says."""
    found = re.match(r"hypcheck-(?:[a-z]+-)?(\d+\.\d+\.\d+)", archive.name)
    if found is None:
        raise ValueError(f"{archive.name} names no version")
    return found[1]


def _component(kind: str, name: str, licence: str | None = None, **more: Any) -> Component:  # noqa: ANN401 - JSON
    licences = {"licenses": [{"expression": licence}]} if licence else {}
    return {"type": kind, "name": name, **licences, **more}


def _held() -> list[Component]:
    """What a package for Python holds of others, or under a licence of its own."""
    readme = (ROOT / "hypcheck" / "pictures" / "three" / "README.md").read_text(encoding="utf-8")
    version = re.match(r"# three\.js (\S+)", readme)[1]  # type: ignore[index]
    three = _component("library", "three", "MIT", version=version, purl=f"pkg:npm/three@{version}")
    return [three, _component("data", "cases", "CC0-1.0", description="the frozen vectors")]


def _asked(ecosystem: str) -> list[Component]:
    """What is installed with it: required, or optional; a requirement names a range, so no version is said."""
    if ecosystem == "cargo":
        manifest = tomllib.loads((ROOT / "packages" / "rust" / "Cargo.toml").read_text(encoding="utf-8"))
        wanted = [(f"{name}{range_}", "excluded") for name, range_ in manifest["build-dependencies"].items()]
    elif ecosystem == "pypi":
        project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
        extras = (text for extra in ("report", "cluster", "peers") for text in project["optional-dependencies"][extra])
        wanted = [*((text, "required") for text in project["dependencies"]), *((text, "optional") for text in extras)]
    else:
        wanted = []
    return [_requirement(text, scope, ecosystem) for text, scope in wanted]


def _requirement(text: str, scope: str, ecosystem: str) -> Component:
    name = re.match(r"[A-Za-z][A-Za-z-]*", text)[0]  # type: ignore[index]
    said = [{"name": "hypcheck:requirement", "value": text}]
    return _component("library", name, purl=f"pkg:{ecosystem}/{name}", scope=scope, properties=said)


def document(archive: Path) -> Component:
    """The document of an archive."""
    ecosystem, version = ecosystem_of(archive), version_of(archive)
    digest = hashlib.sha256(archive.read_bytes()).hexdigest()
    root = _component(
        "library",
        "hypcheck",
        "MIT AND CC0-1.0" if ecosystem == "pypi" else "MIT",
        version=version,
        purl=f"pkg:{ecosystem}/hypcheck@{version}",
        hashes=[{"alg": "SHA-256", "content": digest}],
        properties=[{"name": "hypcheck:archive", "value": archive.name}],
    )
    components = [*(_held() if ecosystem == "pypi" else []), *_asked(ecosystem)]
    for component in (root, *components):
        component["bom-ref"] = component.get("purl", component["name"])
    needs = [component["bom-ref"] for component in components]
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": {"component": root},
        "components": components,
        "dependencies": [{"ref": root["bom-ref"], "dependsOn": needs}],
    }


def write(archive: Path) -> Path:
    """The document beside its archive."""
    target = archive.with_name(archive.name + SUFFIX)
    target.write_text(json.dumps(document(archive), indent=1) + "\n", encoding="utf-8")
    return target
