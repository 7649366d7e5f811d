"""SPEC: its kinds, its words, and the messages for texts that are no SPEC; descriptions and overrides."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck import classify
from hypcheck.errors import InputError
from hypcheck.implementations import description
from hypcheck.implementations.builtin import builtin
from hypcheck.implementations.frames import WIDTH
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.process import KEPT, OutputTail, quoted, stderr_excerpt
from hypcheck.implementations.session import Outcome
from hypcheck.implementations.spec import parse_spec
from hypcheck.messages import escaped
from hypcheck.runs import judge
from tests.tools.miniatures import restarts_of, rows

WORDS = [
    ("builtin:fast", ("fast",)),
    ("python:package.module:function", ("package.module", "function")),
    ("python:dir/my kernel.py:classify", ("dir/my kernel.py", "classify")),
    (r"python:C:\gate\kernel.py:classify", (r"C:\gate\kernel.py", "classify")),
    ("python:/a:b/c.py:f", ("/a:b/c.py", "f")),
    ("library:build/libgate.so", ("build/libgate.so",)),
    ("library:libgate.so.1.2", ("libgate.so.1.2",)),
    (r"library:C:\gate\gate.dll", (r"C:\gate\gate.dll",)),
    ("library:/o:p/libgate.dylib", ("/o:p/libgate.dylib",)),
    ("command:./gate --fast 'a b'", ("./gate", "--fast", "a b")),
    ('command:["java", "-jar", "a b.jar", ""]', ("java", "-jar", "a b.jar", "")),
    ("command:gate ; rm $HOME", ("gate", ";", "rm", "$HOME")),
]


@pytest.mark.parametrize(("text", "words"), WORDS)
def test_parse_spec_splits_a_spec_into_its_kind_and_words(text, words):
    parsed = parse_spec(text)
    assert (parsed.text, parsed.kind, parsed.words) == (text, text.partition(":")[0], words)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "begins with none of builtin:, python:, library:, command:$"),
        ("gate --fast", "command: with its arguments"),
        ("gate", "was builtin:gate meant, or command:gate"),
        ("comand:./gate", "was command:./gate meant"),
        ("libary:gate.so", "was library:gate.so meant"),
        ("kernel.py:classify", "was python:kernel.py:classify meant"),
        ("build/libgate.so", "was library:build/libgate.so meant"),
        ("Python:kernel.py:f", "begins with none of .*; was python:kernel.py:f meant"),
        ("builtin:", "names no method"),
        ("python:kernel.py", "names no function; it must be python:package.module:function"),
        ("python:kernel.py:", "names no function"),
        ("python:kernel.py:a-b", "names no function"),
        ("python::f", "names no function"),
        ("python:a-b:f", "names 'a-b', neither a module nor a file"),
        ("library:gate", "names no shared library"),
        ("library:", "names no shared library"),
        ("command:", "names no program"),
        ("command:'' x", "names no program"),
        ("command:gate 'a", "not quoted as a shell has it: no closing quotation"),
        ('command:["gate"', "begins an array; it must be JSON texts"),
        ('command:["gate", 1]', "begins an array; it must be JSON texts"),
        ("command:[]", "names no program"),
        ("command:gate\0x", "a character that no path or argument can have"),
        (r'command:["gate", "\u0000"]', "a character that no argument can have"),
        (r'command:["gate", "\ud800"]', "a character that no argument can have"),
        ("\x1b[31m", r"'\\x1b\[31m' begins with none of"),
    ],
)
def test_parse_spec_refuses_other_text_with_a_correct_example(text, sentence):
    with pytest.raises(InputError, match=sentence) as caught:
        parse_spec(text)
    assert str(caught.value).isprintable()
    assert caught.value.exit_code == 2


@given(st.sampled_from(["builtin:", "python:", "library:", "command:", "command:[", ""]), st.text())
def test_parse_spec_accepts_any_text_or_refuses_it_with_an_input_error(kind, rest):
    try:
        parsed = parse_spec(kind + rest)
    except InputError as error:
        shown = str(error)
    else:
        assert parsed.words[0]
        shown = str(parsed)
    assert shown.isprintable()


def test_every_outcome_of_a_row_except_answered_is_a_status_in_judge():
    assert {each.label for each in Outcome} - {"answered"} <= {each.value for each in judge.Status}


def test_a_built_in_method_has_the_interface_of_an_implementation():
    some = rows(300)
    with open_implementation("builtin:fast") as it:
        answered = it.classify(some)
        assert answered.answered.all()
        assert answered.answers.tolist() == classify(some).tolist()
        assert it.time(some, 3) > 0
        it.close()
        assert it.classify(some, batch=7).answers.tolist() == answered.answers.tolist()
        assert (it.description.name, it.description.precision) == ("fast", "float64")
        assert it.description.domain == builtin("fast").domain
        assert (it.max_rows, it.scene, restarts_of(it)) == (None, False, 0)
    with pytest.raises(InputError, match="there is no built-in method 'slow'"):
        open_implementation("builtin:slow")


def test_batches_grow_while_answers_are_quick_and_shrink_while_they_are_slow():
    """A tenth of the timeout, 1 s, is what a question should take."""
    with open_implementation("builtin:fast") as it:
        sizes = [it.proven_batch]
        for seconds, rows in (
            (0.01, 3),
            (0.01, 64),
            (0.3, 1024),
            (0.6, 2048),
            (0.01, 2048),
            (5.0, 32768),
            (2.0, 16384),
            (0.01, 500),
            (0.01, 600),
        ):
            it._adapt(seconds, rows)
            sizes.append(it.proven_batch)
    assert sizes == [64, 64, 1024, 2048, 2048, 32768, 16384, 8192, 8192, 9600]


def test_parsing_a_spec_that_is_not_built_in_loads_no_built_in_method():
    code = (
        "import sys; from hypcheck.implementations.implementation import open_implementation; "
        "bad = {'sympy', 'mpmath', 'fcl', 'hypcheck.implementations.builtin', 'hypcheck.derivation'}; "
        "bad &= set(sys.modules); "
        "sys.exit(str(bad) if bad else 0)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


DEFAULTS = description.Description(name="it")


def test_a_description_with_all_keys_is_read():
    said = description.described_by_json(
        '{"protocol":1,"name":"a\\u001b","version":"2","language":"go","precision":"x87","question":"contact",'
        '"domain":{"regimes":["c2>=a"],"ratio":[1,1e9],"magnitude":[0,1e999]},"refuses":true,"binary":true,"time":false}',
        DEFAULTS,
    )
    assert (said.name, said.version, said.language) == (r"a\x1b", "2", "go")
    assert (said.precision, said.question) == ("x87", "contact")
    assert (said.refuses, said.binary, said.time) == (True, True, False)
    assert said.domain.regimes == ("c2>=a",)
    assert said.domain.magnitude == (0.0, np.inf)


def test_the_range_of_a_domain_may_end_at_infinity_but_not_at_nan():
    assert description.parse_domain('{"magnitude":[1e-6,Infinity]}').magnitude == (1e-6, np.inf)
    with pytest.raises(InputError, match="NaN is not JSON"):
        description.parse_domain('{"magnitude":[1e-6,NaN]}')


def test_an_empty_description_gets_the_default_values():
    assert description.described({}, DEFAULTS) == DEFAULTS


@pytest.mark.parametrize(
    ("said", "sentence"),
    [
        ({"name": ""}, "name is ''; it must be a text that is not empty"),
        ({"name": 5}, "name is 5; it must be a text that is not empty"),
        ({"version": 1.0}, "version is 1.0; it must be a text"),
        ({"protocol": True}, "protocol is True; it must be 1"),
        ({"question": ["position"]}, "question is .*; it must be one of position, exterior"),
        ({"domain": [1, 2]}, r"domain is \[1, 2\]; it must be an object with regimes, ratio, magnitude"),
        ({"domain": {"ratios": [1, 2]}}, "domain has the key 'ratios', which is not known; did you mean ratio"),
        ({"domain": {"ratio": [1]}}, "must be two numbers"),
        ({"domain": {"ratio": [1, "2"]}}, r"ratio is \[1, '2'\]; it must be two numbers"),
        ({"domain": {"ratio": [1, True]}}, r"ratio is \[1, True\]; it must be two numbers"),
        ({"domain": {"ratio": [1, 10**400]}}, "it must be two numbers, .* that float64 holds"),
        ({"domain": {"ratio": [float("nan"), 1]}}, r"ratio is \[nan, 1\]"),
        ({"domain": {"regimes": "a>=1"}}, "must be a list of names"),
        ({"domain": {"regimes": ["a>1"]}}, "the regime 'a>1'; it must be one of"),
        ({1: 2}, "has the key 1, which is not known; it may have protocol"),
    ],
)
def test_an_invalid_description_is_refused_with_its_key_and_value(said, sentence):
    with pytest.raises(InputError, match=sentence):
        description.described(said, DEFAULTS)


def test_parse_domain_reads_json_and_refuses_other_text():
    assert description.parse_domain('{"ratio":[1,2]}').ratio == (1.0, 2.0)
    with pytest.raises(InputError, match="the domain is '1 to 2'; it must be JSON"):
        description.parse_domain("1 to 2")


def test_an_override_of_a_description_is_checked_like_a_declared_value():
    with pytest.raises(InputError, match="the question is 'where'"):
        DEFAULTS.overridden(question="where")


@given(st.binary())
def test_quoted_makes_any_bytes_printable(data):
    assert quoted(data).isprintable()


@given(st.lists(st.binary(max_size=9000), max_size=30))
def test_output_tail_keeps_the_last_bytes_of_any_stream(chunks):
    tail = OutputTail()
    for chunk in chunks:
        tail.add(chunk)
    whole = b"".join(chunks)
    assert bytes(tail._bytes[-KEPT:]) == whole[-KEPT:]
    assert len(tail._bytes) <= 2 * KEPT


def test_output_tail_holds_a_long_stream_in_bounded_memory():
    tail = OutputTail()
    for number in range(300):
        tail.add(b"%04d" % number * 1024)
        assert len(tail._bytes) <= 2 * KEPT
    assert tail.lines() == (escaped("0296" * 1024 + "0297" * 1024 + "0298" * 1024 + "0299" * 1024, WIDTH),)


def test_output_tail_returns_the_lines_since_the_last_mark():
    tail = OutputTail()
    tail.add(b"old\n")
    tail.mark()
    assert stderr_excerpt(tail.lines()) == ""
    tail.add(b"a\nb\x1b\n\nc\nd")
    assert tail.lines() == ("a", r"b\x1b", "c", "d")
    assert stderr_excerpt(tail.lines()) == r"; stderr: b\x1b | c | d"
