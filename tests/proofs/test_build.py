"""`python -m hypcheck.proofs` with a stand-in for Coq and OCaml: what is asked, and what each answer leads to."""

from __future__ import annotations

import os
import re
from functools import cache

import pytest
from click.testing import CliRunner

from hypcheck.errors import InputError
from hypcheck.proofs import build, printed_c, weakenings
from hypcheck.proofs.__main__ import main
from hypcheck.proofs.build import CONTROL, Weakened

REAL_NUMBERS = """\
Axioms:
ClassicalDedekindReals.sig_not_dec : forall P : Prop,
                                     {~ ~ P} + {~ P}
FunctionalExtensionality.functional_extensionality_dep
  : forall (A : Type) (B : A -> Type)
"""
"""How Coq prints axioms: the type may begin on the next line."""

CLOSED = "Closed under the global context\n"

STAND_IN = """#!/bin/sh
name=$(basename "$0")
echo "$name $*" >> FOLDER/asked
for word in "$name" "$@"; do
    last=$word
    if [ -f "FOLDER/says/$word" ]; then cat "FOLDER/says/$word" >&2; exit 1; fi
done
case "$last" in
-where) echo FOLDER ;;
Assumptions.v) if grep -q "Require Floats" "$last"; then cat FOLDER/of-floats; else cat FOLDER/of-others; fi ;;
check_cases) cp FOLDER/checker check_cases ;;
Emitted.v) ls "$3"/*.vo ;;
*.v)
    if [ "$PWD" != FOLDER/built ] && [ -e FOLDER/strict -o -e "${last}o" ]; then exit 1; fi
    case "$last" in
    Changes.v) cat FOLDER/verdicts ;;
    HeaderText.v) ;;
    *)
        [ -f FOLDER/careless -o -f "FOLDER/careless-$last" ] ||
            cmp "$last" "SOURCES/$last" >&2 || cmp "$last" "SOURCES/header/$last" >&2 || exit 1 ;;
    esac
    : > "${last}o" ;;
esac
"""
"""Accepts the Coq files as they are, and copies of which nothing was compiled; refuses changed files.

If there is a file `careless` it accepts changed ones, if there is a file `careless-FILE` this one changed, and if there
is a file `strict` it refuses copies.
"""


ONCE = [(build, "frozen_files"), (printed_c, "changes"), (printed_c, "header_text")]
CACHED = [(module, name, cache(getattr(module, name))) for module, name in ONCE]
"""What the same files always give, and what takes a fifth of a second to make."""


class Tools:
    """Programs in place of Coq and OCaml; `main` builds in a folder beside them."""

    def __init__(self, folder):
        self.folder, self.built = folder, folder / "built"
        for name in ("bin", "says", "user-contrib/Flocq"):
            (folder / name).mkdir(parents=True)
        text = STAND_IN.replace("FOLDER", str(folder)).replace("SOURCES", str(build.SOURCES))
        for name in ("coqc", "ocamlfind", "ocamlopt"):
            self.program(f"bin/{name}", text)
        self.program("checker", "#!/bin/sh\necho $#\n")
        self.judge("true", *("false" for _ in printed_c.changes(2, seed=45)))
        self.assume(REAL_NUMBERS, f"Axioms:\n{build.OF_FLOCQ} : forall P : Prop, P\n")

    def program(self, name, text):
        """Write a program."""
        (self.folder / name).write_text(text, encoding="utf-8")
        (self.folder / name).chmod(0o755)

    def say(self, word, text):
        """Fail with this text where a command has the word."""
        (self.folder / "says" / word).write_text(text, encoding="utf-8")

    def judge(self, *verdicts):
        """What Coq prints about the printed C without a change, and with each change."""
        (self.folder / "verdicts").write_text(" ".join(verdicts), encoding="utf-8")

    def assume(self, others, floats):
        """What Coq prints about the axioms of Floats.v, and of other files."""
        (self.folder / "of-others").write_text(others, encoding="utf-8")
        (self.folder / "of-floats").write_text(floats, encoding="utf-8")

    def prove(self, *words):
        """The exit code and the output."""
        done = CliRunner().invoke(main, ["--into", str(self.built), *words])
        return done.exit_code, done.output

    @property
    def asked(self):
        """The commands that were run, one a line."""
        return (self.folder / "asked").read_text(encoding="utf-8").splitlines()


@pytest.fixture
def tools(monkeypatch, tmp_path):
    for module, name, cached in CACHED:
        monkeypatch.setattr(module, name, cached)
    found = Tools(tmp_path)
    monkeypatch.setenv("PATH", os.pathsep.join([str(tmp_path / "bin"), os.environ["PATH"]]))
    return found


def test_missing_libraries_of_ocaml_and_coq_are_named_where_the_programs_are_there(tools):
    assert build.missing() == []
    tools.say("query", "")
    (tools.folder / "user-contrib" / "Flocq").rmdir()
    assert build.missing() == ["libzarith-ocaml-dev", "libcoq-flocq"]
    code, output = tools.prove()
    assert code == 2
    assert "apt-get install libzarith-ocaml-dev libcoq-flocq" in output


def test_prove_lists_each_file_with_its_axioms_and_counts_the_refused_statements(tools):
    code, output = tools.prove("--weakened", "2")
    lines = output.splitlines()
    assert code == 0
    assert [line.split()[0] for line in lines[: len(build.FILES)]] == [f"{name}.v" for name in build.FILES]
    total = sum(len(build.statements(name)) for name in build.FILES)
    assert lines[len(build.FILES)].startswith(f"{total} statements in ")
    made, given = len(weakenings.made(build.source)), "for a reason that is given"
    long = len(build.changed_integers())
    stages, runs = ", ".join(build.OF_STAGES), ", ".join(build.OF_RUNS)
    assert lines[-11:] == [
        "    ClassicalDedekindReals.sig_not_dec",
        f"    {build.OF_FLOCQ} (Flocq alone)",
        "    FunctionalExtensionality.functional_extensionality_dep",
        f"Print Assumptions of all without Flocq, {stages} among them: {build.AXIOMS[0]}, {build.AXIOMS[2]}",
        f"Print Assumptions of all on Flocq, {runs} among them: {build.OF_FLOCQ}",
        f"{len(printed_c.changes(2, seed=45))} changes of the printed C are refused",
        f"{len(build.weakened())} weakened statements are written by hand; 2 are tried: all are refused",
        f"{len(build.changed_functions())} changes of the header's functions of words; 2 are tried: all are refused",
        f"{len(build.changed_decisions())} changes of the header's functions that decide; 1 are tried: all are refused",
        f"{long} changes of the header's functions of long integers; 1 are tried: all are refused",
        f"{made} weakened statements are made by a program; 2 are tried: 2 are refused, 0 hold too, {given}",
    ]
    everything = (tools.built / "Assumptions.v").read_text(encoding="utf-8")
    assert all(f"@Floats.{each}" in everything for each in build.statements("Floats"))
    for program in ("witnesses.ml", "check_cases.ml"):
        assert (tools.built / program).read_bytes() == (build.SOURCES / program).read_bytes()


@pytest.mark.parametrize(
    ("place", "verdict", "message"),
    [
        (0, "", "Coq does not say whether it accepts changes"),
        (0, "false", "Coq refuses the printed C without a change"),
        (7, "true", "Coq accepts the printed C with"),
    ],
)
def test_prove_ends_with_1_if_coq_accepts_a_change_of_the_printed_c_or_gives_no_verdict(place, verdict, message, tools):
    verdicts = ["true", *("false" for _ in printed_c.changes(2, seed=45))]
    verdicts[place] = verdict
    tools.judge(*verdicts)
    if place:
        code, output = tools.prove("--weakened", "0")
        assert code == 1
        assert message in output
        return
    tools.built.mkdir()
    with pytest.raises(build.ProofError, match=message):
        build.refuse_changes(2, tools.built)


def test_changes_of_the_printed_c_cover_every_part_and_change_one_line_each():
    parts = printed_c.parts(printed_c.HEADER.read_text(encoding="utf-8"))
    found = printed_c.changes(2, seed=45)
    assert {part for part, _, _ in found} == set(range(len(parts)))
    assert len(parts) >= 27
    for part, line, new in found:
        old = parts[part][1].splitlines()[line]
        assert new != old
        assert (
            sum(
                left != right
                for left, right in zip(re.findall(r"\w+|\S", old), re.findall(r"\w+|\S", new), strict=True)
            )
            == 1
        )


def test_changes_of_functions_of_words_cover_every_function_and_change_one_word_each():
    texts = printed_c.functions(printed_c.HEADER.read_text(encoding="utf-8"))
    assert len(texts) == len(printed_c.FUNCTIONS)
    unchanged = [re.findall(r"\w+|\S", text) for text in texts]
    found = build.changed_functions()
    assert all(any(f" in {name}," in change.allows for change in found) for name in printed_c.FUNCTIONS)
    for change in found:
        new = [re.findall(r"\w+|\S", text) for text in re.findall(r'_string "(.*?)"\)', change.new, re.DOTALL)]
        assert sum(left != right for left, right in zip(unchanged, new, strict=True)) == 1


def test_each_changed_function_of_words_is_named_in_the_coq_file_that_is_tried():
    for change in build.changed_functions():
        name = re.search(r" in (\w+),", change.allows)[1]
        assert f'called "{name}"' in build.source(change.file)


def test_changes_of_functions_that_decide_cover_every_such_function_of_the_header():
    header = printed_c.HEADER.read_text(encoding="utf-8")
    of_doubles = printed_c.of_doubles(header)
    deciding = (*printed_c.deciding(header), *printed_c.beside_tangency(header))
    texts = (*deciding, *of_doubles, *printed_c.floats(header), *printed_c.tangents(header))
    exact = (*printed_c.MACROS, *printed_c.DECIDING, *printed_c.BESIDE_TANGENCY)
    names = (*exact, *printed_c.OF_DOUBLES, *printed_c.FLOATS, *printed_c.TANGENTS)
    assert [re.search(r"(\w+)\(", text)[1] for text in texts] == list(names)
    found = build.changed_decisions()
    assert {re.search(r" in (\w+),", change.allows)[1] for change in found} == set(names)
    for change in found:
        name = re.search(r" in (\w+),", change.allows)[1]
        source = build.source(change.file)
        called = rf'(called\w* functions|puts\w* functions|returned) [^"]*"{name}"|look "{name}" functions'
        assert re.search(called, source)
        assert source.count(change.old) == 1


def test_prove_with_soundness_compiles_only_the_files_on_which_the_checker_depends(tools):
    tools.assume(CLOSED, "")
    code, output = tools.prove("--soundness")
    names = (*build.SOUNDNESS, "ExtractedChecker")
    weakened = sum(change.file in names for change in build.weakened())
    assert code == 0
    assert f"of the real numbers:\n{weakened} weakened statements are written by hand; 4 are tried: all are " in output
    compiled = {line.split()[-1] for line in tools.asked if line.startswith("coqc -q")}
    assert compiled == {f"{name}.v" for name in (*names, "Assumptions")}


@pytest.mark.parametrize(("said", "message"), [(" Error: no.\n", "Error: no."), ("", "coqc failed without a message")])
def test_a_file_that_coq_refuses_raises_an_error_with_the_message_of_coq(tools, said, message):
    tools.say("Geometry.v", said)
    assert tools.prove() == (1, f"proofs: error: Coq refuses Geometry.v: {message}\n")


def test_coq_that_does_not_print_assumptions_is_an_error(tools):
    tools.assume("no such file", "")
    code, output = tools.prove("--soundness")
    assert code == 1
    assert output.endswith("error: Coq does not say what the proofs assume: no such file\n")
    tools.say("Assumptions.v", "Error: nothing")
    assert tools.prove("--soundness")[1].endswith("error: Coq does not say what the proofs assume: Error: nothing\n")


def test_prove_allows_the_excluded_middle_only_for_the_floats_and_no_other_axiom(tools):
    tools.assume(f"Axioms:\n{build.OF_FLOCQ} : P\n", CLOSED)
    assert tools.prove()[1].endswith(f"error: the proofs assume {build.OF_FLOCQ}; that is not allowed\n")
    tools.assume(CLOSED, "Axioms:\nFalse_is_true : P\n")
    assert tools.prove()[1].endswith("error: the proofs assume False_is_true; that is not allowed\n")


def test_an_emitted_proof_is_checked_beside_the_compiled_proofs(tools, tmp_path):
    proof = tmp_path / "kernel.v"
    assert "the proofs are not compiled" in tools.prove(str(proof))[1]
    tools.built.mkdir()
    (tools.built / "Region.vo").touch()
    code, output = tools.prove(str(proof))
    assert code == 2
    assert "kernel.v cannot be read: [Errno 2] No such file" in output
    proof.write_text("Theorem sign : True.", encoding="utf-8")
    code, output = tools.prove(str(proof), str(proof))
    assert code == 0
    assert len(re.findall(r"kernel\.v: the bound is proved, \d+\.\d s\n", output)) == 2
    assert tools.asked[-1] == f"coqc -q -R {tools.built.resolve()} Hypcheck Emitted.v"
    tools.say("Emitted.v", "it is false")
    assert tools.prove(str(proof)) == (1, f"proofs: error: Coq refuses {proof}: it is false\n")


def test_an_error_of_ocaml_is_quoted(tools):
    tools.say("ocamlopt", "Unbound module Checker\n")
    assert tools.prove("--soundness")[1].endswith("error: OCaml refuses the checker: Unbound module Checker\n")


@pytest.mark.parametrize(
    ("script", "code", "message"),
    [
        ("exit 0", 0, ""),
        ("exit 1", 1, ""),
        ("echo 'check_cases: a.json: no list' >&2; exit 2", 2, "proofs: error: a.json: no list\n"),
        ("exit 3", 2, "check_cases ended with 3\n"),
    ],
)
def test_prove_ends_with_the_exit_code_of_the_checker_of_the_frozen_vectors(tools, script, code, message):
    """With 1 where a label is wrong, with 2 where a file cannot be read."""
    tools.program("checker", f'#!/bin/sh\necho "$@" > {tools.folder}/files\n{script}\n')
    found, output = tools.prove("--soundness", "--weakened", "0")
    assert found == code
    assert output.endswith(f"; 0 are tried: all are refused\n{message}" if code < 2 else message)
    assert (tools.folder / "files").read_text(encoding="utf-8").split() == build.frozen_files()


@pytest.mark.parametrize(("more", "tried"), [((), 4), (("--weakened", "3"), 3), (("--every",), None)])
def test_prove_tries_four_weakened_statements_or_the_requested_number_or_all(tools, more, tried):
    output = tools.prove("--soundness", *more)[1]
    changes = [change for change in build.weakened() if change.file in (*build.SOUNDNESS, "ExtractedChecker")]
    assert f"{len(changes)} weakened statements are written by hand; {tried or len(changes)} are tried: all" in output


def test_a_missing_checker_is_an_error_that_says_how_to_build_it(tmp_path):
    with pytest.raises(InputError, match=f"not built: there is no {tmp_path}/check_cases; `make prove` builds it"):
        build.run_checker([], tmp_path)


def test_prove_ends_with_1_where_coq_accepts_a_weakened_statement_or_refuses_the_control(tools):
    (tools.folder / "careless").touch()
    code, output = tools.prove("--soundness")
    assert code == 1
    assert "error: Coq accepts Checker.v, weakened to allow a λ beyond the pole B" in output
    (tools.folder / "careless").unlink()
    (tools.folder / "strict").touch()
    code, output = tools.prove("--soundness")
    assert code == 1
    assert "error: Coq refuses Checker.v in the folder in which it must refuse" in output


def test_prove_ends_with_1_where_coq_accepts_a_statement_that_a_program_weakened_and_no_reason_is_given(
    tools,
):
    (change,) = weakenings.sample(weakenings.made(build.source), 1, seed=45)
    (tools.folder / f"careless-{change.file}.v").touch()
    code, output = tools.prove("--weakened", "1")
    assert code == 1
    assert output.endswith(f"Coq accepts {change.file}.v with {change.allows}, and no reason is given for that\n")


def test_an_automatically_weakened_statement_is_tried_without_the_text_after_its_proof(tools):
    change = next(change for change in weakenings.made(build.source) if change.until)
    tools.program("bin/coqc", f"#!/bin/sh\ncp {change.file}.v {tools.folder}/tried\n")
    assert build.accepted(change, tools.built)
    text = (tools.folder / "tried").read_text(encoding="utf-8")
    assert change.new in text
    assert change.until not in text
    assert build.source(change.file).replace(change.old, change.new).startswith(text + change.until)


def test_weakened_statement_that_matches_no_place_or_is_not_valid_coq_raises_an_error(tools):
    with pytest.raises(ValueError, match=r"Checker\.v has 0 places with 'not there'; one is needed"):
        build.accepted(Weakened("Checker", "not there", "", "anything"), tools.built)
    tools.say("Checker.v", "Syntax error: '.' expected")
    with pytest.raises(ValueError, match=r"the change of Checker\.v is no Coq: Syntax error"):
        build.accepted(CONTROL, tools.built)
