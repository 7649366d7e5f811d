"""Which variables an isolated program sees, and which secrets are masked in what reports quote of a program."""

from __future__ import annotations

import json
import sys

import pytest

from hypcheck.cli.main import main
from hypcheck.implementations.process import OutputTail, quoted
from hypcheck.isolation.launch import VARIABLES, environment_of, masked

RUNTIMES = {"PATH": "/bin", "PYTHONPATH": "lib", "JAVA_HOME": "/opt/java", "OMP_NUM_THREADS": "1", "R_LIBS": "/r"}
SECRETS = {
    "GHCR_PAT": "blue-42",
    "REGISTRY_PW": "hunter",
    "GOOGLE_MAPS": "c7f0a1b2c3",
    "REDIS_URL": "redis://bot:open5sesame@cache:1/0",
    "JAVA_KEYSTORE_PASSWORD": "xyzzy",
    "NODE_PG_DSN": "pg-17-east",
    "R_STUDIO_ID": "abcdef0123",
    "PATH_TO_KEY": "k-e-y-2",
}


def test_isolated_program_sees_variables_of_exact_names_and_those_that_are_passed():
    seen = environment_of({**RUNTIMES, **SECRETS, "PWD": "/a", "GO": "1"}, "/scratch", ("GHCR_PAT",))
    ours = {"TMPDIR": "/scratch", "XDG_CACHE_HOME": "/scratch", "DOTNET_EnableDiagnostics": "0"}
    assert seen == {**RUNTIMES, **ours, "PWD": "/a", "GHCR_PAT": "blue-42"}
    assert not {name for name in VARIABLES if "TOKEN" in name or "PASS" in name or "_KEY" in name.replace("_KEYS", "")}


@pytest.mark.parametrize("name", SECRETS)
def test_value_of_a_variable_that_looks_like_a_secret_is_masked_in_output(name, monkeypatch):
    monkeypatch.setenv(name, SECRETS[name])
    assert masked(f"connecting with {SECRETS[name]}, {SECRETS[name]}!") == "connecting with ***, ***!"


TOKENS = (
    "ghp_0123456789abcdefghij",
    "github_pat_11ABCDEFG0123456789",
    "glpat-abcdefghijklmnop12",
    "AKIAIOSFODNN7EXAMPLE",
    "eyJhbGciOiJIUzI1NiJ9.eyJzdWIiOiIxMjM0In0.dozjgNryP4J3jVmNHl0w5N",
    "-----BEGIN RSA PRIVATE KEY-----\nMIIBOgIB\nAAJB\n-----END RSA PRIVATE KEY-----",
)


@pytest.mark.parametrize("token", TOKENS)
def test_key_or_token_that_shows_what_it_is_is_masked_in_output(token):
    assert masked(f"found '{token}' there") == "found '***' there"


def test_password_in_an_address_is_masked_in_output_and_the_address_stays():
    assert masked("cannot reach https://bot:pass@example.org/x") == "cannot reach https://***@example.org/x"
    assert masked("see https://example.org:8080/a@b") == "see https://example.org:8080/a@b"


@pytest.mark.parametrize(
    "line",
    [
        'File "/home/runner/work/engine/engine/mine.py", line 12, in classify',
        "ValueError: operands could not be broadcast together with shapes (7,) (3,)",
        "thread 'main' panicked at src/main.rs:42:9: index out of bounds: the len is 7 but the index is 7",
        "AddressSanitizer: heap-buffer-overflow on address 0x602000000014 at pc 0x55d0",
        "SyntaxError: Unexpected token '}' in 0x1.8p+1",
    ],
)
def test_output_without_secrets_stays_as_it_is(line, monkeypatch, tmp_path):
    monkeypatch.setenv("GITHUB_WORKSPACE", str(tmp_path))
    monkeypatch.setenv("GITHUB_RUN_ID", "1234567890")
    monkeypatch.setenv("CI", "true")
    monkeypatch.setenv("SSH_AUTH_SOCK", str(tmp_path))
    assert masked(f"{line} {tmp_path}") == f"{line} {tmp_path}"


def test_secret_is_masked_before_output_is_cut_so_that_no_part_of_it_stays(monkeypatch):
    monkeypatch.setenv("REGISTRY_PW", "swordfish")
    tail = OutputTail()
    tail.add(b"x" * 396 + b"swordfish")
    assert tail.lines() == ("x" * 396 + "***",)
    assert "swo" not in quoted(b"y" * 77 + b"swordfish")


@pytest.mark.parametrize("kind", ["command", "python"])
def test_no_report_holds_a_secret_that_a_program_prints(kind, monkeypatch, tmp_path, capsys, text_reports):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("REGISTRY_PW", "sword+fish")
    (tmp_path / "tells.py").write_text(
        "import os\ndef classify(rows):\n    raise ValueError(os.environ['REGISTRY_PW'])\n"
    )
    code = "import os, sys; sys.exit('cannot log in with ' + os.environ['REGISTRY_PW'])"
    specs = {"command": "command:" + json.dumps([sys.executable, "-c", code]), "python": "python:tells.py:classify"}
    words = ("--families", "ring", "--count", "1", "--pass-env", "REGISTRY_PW", "--out", "out")
    assert main(["verify", specs[kind], *words]) in (1, 5)
    said = "".join(capsys.readouterr())
    written = {path.name: path.read_text() for path in (tmp_path / "out").iterdir()}
    assert "***" in said
    assert "***" in written["record.jsonl"]
    assert not [name for name, text in {**written, "terminal": said}.items() if "sword" in text or "fish" in text]
