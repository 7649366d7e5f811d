"""`hypcheck init --from`: the requirement that the workflow installs, pinned, and sources that are refused."""

from __future__ import annotations

import hashlib
import re
import subprocess

import pytest

from hypcheck.cli.main import main
from hypcheck.errors import InputError
from hypcheck.scaffold.requirement import pinned, requirement

WORKFLOW = ".github/workflows/hypcheck.yml"
COMMIT = "0123456789abcdef0123456789abcdef01234567"
DIGEST = "#sha256=" + "0f" * 32
GIT = "git+https://example.org/owner/hypcheck"
SOURCES = {
    "1.2.0": "hypcheck==1.2.0",
    "2.0rc1": "hypcheck==2.0rc1",
    "1.0.post2.dev3": "hypcheck==1.0.post2.dev3",
    "hypcheck==1.2.0": "hypcheck==1.2.0",
    "hypcheck[report] == 1.2.0": "hypcheck[report]==1.2.0",
    "our-fork===1.2+local.1": "our-fork==1.2+local.1",
    "https://example.org/owner/hypcheck.git@v1.2.0": f"hypcheck @ {GIT}.git@v1.2.0",
    "git+https://example.org:8443/~o/hypcheck@0a1b2c": "hypcheck @ git+https://example.org:8443/~o/hypcheck@0a1b2c",
    "https://example.org/owner/hypcheck/": f"hypcheck @ {GIT}",
    "ssh://git@example.org/hypcheck.git@release/1.x": "hypcheck @ git+ssh://git@example.org/hypcheck.git@release/1.x",
    "git@example.org:owner/hypcheck.git": "hypcheck @ git+ssh://git@example.org/owner/hypcheck.git",
    f"hypcheck[report] @ {GIT}@{COMMIT}": f"hypcheck[report] @ {GIT}@{COMMIT}",
    "file:///srv/hypcheck.git@v1": "git+file:///srv/hypcheck.git@v1",
    "git+file:///srv/a%20b/.hypcheck": "git+file:///srv/a%20b/.hypcheck",
    f"https://example.org/h-1-py3-none-any.whl{DIGEST}": f"hypcheck @ https://example.org/h-1-py3-none-any.whl{DIGEST}",
    f"hypcheck@https://example.org/h-1.tar.gz{DIGEST}": f"hypcheck @ https://example.org/h-1.tar.gz{DIGEST}",
}


@pytest.mark.parametrize("source", SOURCES)
def test_source_of_hypcheck_is_written_as_a_requirement_of_pip(source, tmp_path):
    text = requirement(source, tmp_path).text
    assert text == SOURCES[source]
    assert re.fullmatch(r"[\w @:/.=~+#%\[\]-]+", text)


BAD_SOURCES = [
    "", "latest", "1.2.", "v1.2.0", ">=1", "1.0 --index-url=http://x", "hypcheck", "hypcheck>=1.0", "hypcheck==1.*",
    "./nowhere", "/srv/hypcheck.git", "./no-such.whl", "-r requirements.txt", "--no-deps",
    "http://example.org/hypcheck.git", "git://example.org/hypcheck", "git+http://example.org/hypcheck",
    "https://example.org", "file://host/srv/hypcheck", "file:///", "ext::sh -c id",
    "https://example.org/hypcheck.git@", "https://example.org/hypcheck@--upload-pack=x", "https://-x/hypcheck",
    "https://example.org/hyp'check", 'https://example.org/"', "https://example.org/$(id)", "https://example.org/a;b",
    "https://example.org/a#egg=b", "https://example.org/a b", "https://example.org/a\nrun: b", "https://example.org/`id`",
    "https://example.org/a.whl#sha256=12", "hypcheck @ 1.2.0", "hypcheck==1.0; python_version>'3'",
    "https://example.org/hypcheck${{secrets.X}}", "-oProxyCommand=x@example.org:hypcheck", "1" * 301,
]  # fmt: skip


@pytest.mark.parametrize("source", BAD_SOURCES)
def test_init_with_an_invalid_source_ends_with_2_before_it_writes_a_file(source, tmp_path, capsys):
    assert main(["init", "--language", "c", "--directory", str(tmp_path), f"--from={source}"]) == 2
    assert "it must be a git URL such as https://HOST/OWNER/hypcheck.git@COMMIT" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "source", ["https://token@example.org/h.git", "https://me:secret@example.org/h.git@v1", "ssh://me:secret@x.org/h"]
)
def test_a_url_with_a_secret_is_refused_and_the_secret_is_not_repeated(source, tmp_path):
    with pytest.raises(InputError, match="may hold a secret before its @") as refused:
        requirement(source, tmp_path)
    assert "secret@" not in str(refused.value)
    assert "token" not in str(refused.value)


def git(folder, *words: str) -> str:
    done = subprocess.run(["git", "-C", folder, *words], capture_output=True, check=True, text=True)  # noqa: S607
    return done.stdout.strip()


@pytest.fixture
def repository(tmp_path):
    """A repository with an annotated tag v1, and a later commit on its branch."""
    folder = tmp_path / "hypcheck.git"
    git(tmp_path, "init", "--quiet", "--initial-branch=main", str(folder))
    who = ["-c", "user.name=A", "-c", "user.email=a@example.org"]
    for step in (["commit", "--allow-empty", "-m1"], ["tag", "-a", "v1", "-m1"], ["commit", "--allow-empty", "-m2"]):
        git(folder, *who, *step)
    return folder


@pytest.mark.parametrize(("end", "name"), [("", "HEAD"), ("@main", "HEAD"), ("@v1", "v1^{commit}")])
def test_a_branch_or_tag_of_a_repository_is_pinned_to_its_commit(end, name, repository, tmp_path):
    wanted = pinned(requirement(f"file://{repository}{end}", tmp_path))
    assert wanted.text == f"git+file://{repository}@{git(repository, 'rev-parse', name)}"
    assert any(said.startswith(f"pinned to the commit that {end[1:] or 'HEAD'} of") for said in wanted.says)


def test_path_and_file_url_of_a_repository_give_the_same_requirement(repository, tmp_path):
    assert requirement(str(repository), tmp_path / "engine") == requirement(f"file://{repository}", tmp_path)


def test_a_source_with_a_commit_is_pinned_without_asking_git(tmp_path):
    wanted = requirement(f"file:///no/such/repository@{COMMIT}", tmp_path)
    assert pinned(wanted) == wanted


def test_a_short_commit_is_left_as_it_is_since_git_lists_none(repository, tmp_path):
    wanted = requirement(f"file://{repository}@{git(repository, 'rev-parse', '--short=10', 'HEAD')}", tmp_path)
    assert pinned(wanted) == wanted


@pytest.mark.parametrize("end", ["", "@v1"])
def test_a_remote_repository_that_cannot_be_reached_is_reported_as_not_pinned(end, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))  # no git, hence no network
    wanted = pinned(requirement(f"https://example.org/hypcheck.git{end}", tmp_path))
    assert wanted.text == f"hypcheck @ git+https://example.org/hypcheck.git{end}"
    assert wanted.says[0].startswith("not pinned: https://example.org/hypcheck.git could not be queried")


@pytest.mark.parametrize(("end", "said"), [("@v9", "has no branch or tag 'v9'"), ("", "git cannot read")])
def test_a_local_repository_that_cannot_be_read_or_lacks_the_ref_is_refused(end, said, repository, tmp_path):
    where = repository if end else tmp_path / "nothing"
    with pytest.raises(InputError, match=said):
        pinned(requirement(f"file://{where}{end}", tmp_path))


def test_wheel_outside_the_repository_is_pinned_by_its_digest(tmp_path):
    wheel = tmp_path / "a wheel" / "hypcheck-1-py3-none-any.whl"
    wheel.parent.mkdir()
    wheel.write_bytes(b"content")
    expected = f"hypcheck @ file://{tmp_path}/a%20wheel/{wheel.name}#sha256={hashlib.sha256(b'content').hexdigest()}"
    for source in (str(wheel), f"file://{tmp_path}/a%20wheel/{wheel.name}"):
        wanted = requirement(source, tmp_path / "engine")
        assert wanted.text == expected
        assert wanted.says[0].startswith("the machine that runs the workflow must have file://")


def test_a_wheel_in_the_repository_is_named_from_its_root(tmp_path, monkeypatch):
    (tmp_path / "engine/vendor").mkdir(parents=True)
    (tmp_path / "engine/vendor/h.whl").touch()
    monkeypatch.chdir(tmp_path)
    assert requirement("engine/vendor/h.whl", tmp_path / "engine").text == "./vendor/h.whl"


def test_a_folder_in_the_repository_whose_name_pip_would_not_read_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "our;fork").mkdir()
    with pytest.raises(InputError, match=r"'our;fork'; its path must consist of letters, digits and \. _ - /"):
        requirement("./our;fork", tmp_path)


def test_source_that_is_a_file_but_neither_wheel_nor_sdist_is_refused(tmp_path):
    (tmp_path / "h.txt").touch()
    with pytest.raises(InputError, match="neither a folder nor a wheel or sdist"):
        requirement(str(tmp_path / "h.txt"), tmp_path)


TOLD = {
    "1.2.0": "make sure that this is the project you mean",
    "https://example.org/h.whl": "not pinned: add #sha256=DIGEST",
}


@pytest.mark.parametrize("source", TOLD)
def test_notes_about_a_source_are_printed_and_written_into_the_workflow(source, tmp_path, capsys):
    assert main(["init", "--language", "c", "--directory", str(tmp_path), "--from", source]) == 0
    assert TOLD[source] in capsys.readouterr().out
    comments = re.findall(r"^ +# (.*)$", (tmp_path / WORKFLOW).read_text(), flags=re.MULTILINE)
    assert TOLD[source].lower() in " ".join(comments).lower()


def test_without_a_source_the_workflow_installs_nothing_and_fails_with_a_sentence(tmp_path, capsys):
    assert main(["init", "--language", "c", "--directory", str(tmp_path)]) == 0
    assert "nothing to install was named" in capsys.readouterr().out
    text = (tmp_path / WORKFLOW).read_text()
    step = text.partition("- name: Install hypcheck\n")[2].partition("      - name")[0]
    lines = step.partition("run: |\n")[2]
    assert "pip install" not in lines
    done = subprocess.run(["/bin/sh", "-e", "-c", lines], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "nothing to install was named" in done.stdout
