"""`hypcheck info`: versions, which kernel runs and why, which oracles and engines are available."""

from __future__ import annotations

from typing import Any

import click

LIBRARIES = ("numpy", "sympy", "mpmath", "python-fcl", "click", "matplotlib", "jinja2", "distributed", "coal")


@click.command(short_help="Say which versions, kernel and oracles are here, and why.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object.")
def info(as_json: bool) -> None:
    """Say what this installation has: versions, the kernel in use and the reason for it, the oracles.

    HYPCHECK_KERNEL=compiled or numpy forces a kernel, HYPCHECK_LEVEL its instruction set, HYPCHECK_THREADS the number
    of threads it may use.
    """
    import json

    found = gathered()
    click.echo(json.dumps(found) if as_json else "\n".join(_lines(found)))


def gathered() -> dict[str, Any]:
    """Everything that is told, as --json has it."""
    import platform
    import sys

    from hypcheck.kernel.choice import choice, most_threads
    from hypcheck.kernel.core import HEADER
    from hypcheck.methods.engines import COAL, FCL
    from hypcheck.verify.opinions import ORACLES
    from hypcheck.version import VERSION

    chosen = choice()
    threads = most_threads() if chosen.kernel == "compiled" else 1
    return {
        "hypcheck": VERSION,
        "python": platform.python_version(),
        "executable": sys.executable,
        "system": f"{platform.system()} {platform.machine()}",
        "versions": _versions(),
        "kernel": {"name": chosen.kernel, "level": chosen.level, "reason": chosen.reason, "threads": threads},
        "header": str(HEADER),
        "oracles": {name: _there(oracle.available()) for name, oracle in ORACLES.items()},
        "engines": {engine.title: _there(engine.trouble()) for engine in (FCL, COAL)},
    }


def _there(trouble: str | None) -> dict[str, Any]:
    return {"available": trouble is None, "reason": trouble}


def _versions() -> dict[str, str | None]:
    """Of the libraries that may be used, from their metadata: to ask the modules would load them."""
    return {name: _version(name) for name in LIBRARIES}


def _version(name: str) -> str | None:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _lines(found: dict[str, Any]) -> list[str]:
    kernel = found["kernel"]
    level = f", {kernel['level']}" if kernel["level"] else ""
    present = [f"{name} {text}" for name, text in found["versions"].items() if text]
    absent = [name for name, text in found["versions"].items() if not text]
    threads = f"{kernel['threads']} thread{'s' if kernel['threads'] > 1 else ''}"
    return [
        f"hypcheck   {found['hypcheck']}, Python {found['python']} on {found['system']}",
        f"libraries  {', '.join(present)}" + (f"; not installed: {', '.join(absent)}" if absent else ""),
        f"kernel     {kernel['name']}{level}, up to {threads}: {kernel['reason']}",
        f"C header   {found['header']}",
        *_availability("oracles", found["oracles"]),
        *_availability("engines", found["engines"]),
    ]


def _availability(title: str, found: dict[str, dict[str, Any]]) -> list[str]:
    said = [
        f"{name}: {'available' if each['available'] else 'not available: ' + each['reason']}"
        for name, each in found.items()
    ]
    return [f"{title if place == 0 else '':11}{each}" for place, each in enumerate(said)]
