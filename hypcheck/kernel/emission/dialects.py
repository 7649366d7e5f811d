"""The languages of emitted code: phrases and templates, a file's description of itself, prefixes, printed routines.

templates/ has a file of phrases for each language, NAME.toml, and a template for each kind of file, which C and C++
share. In both ${name} is replaced by a text. In a template, a name that is alone on its line is replaced by the lines
of its text, with the indent that it has.

The description is what an emitted file says about itself: a text of JSON, or an object of its language, with a line for
each setting.

A routine is printed as a head, a statement for each part, and a result; steps are printed as those of programs are.
The phrases say how a function begins and ends, how a number is kept from round to round, and how a loop and a call are
written. The printer of routines has no code for a single language.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from importlib import resources
from typing import Any

from hypcheck import toml
from hypcheck.derivation.program import NUMBER, Program, Step
from hypcheck.derivation.routines import (
    PAIR,
    Call,
    Half,
    Loop,
    Part,
    Result,
    Routine,
    Stored,
    called,
    kind_of_part,
    names_read,
)
from hypcheck.errors import InputError
from hypcheck.kernel.printing.languages import Spelling, argument_of, spelling_of, statements_in, value_of
from hypcheck.messages import escaped

LANGUAGES = ("c", "cpp", "rust", "javascript", "python")
"""What `emit --language` takes."""

INDENT = "    "
WIDTH = 120

_MARK = re.compile(r"^( *)\$\{(\w+)\}$|\$\{(\w+)\}", re.MULTILINE)
_ESCAPED_MARK = re.compile(r"\$\{\{(\w+)\}\}")


def filled(package: str, name: str, parts: Mapping[str, str]) -> str:
    """Return a template of the package with its marks filled in; text of a part that looks like a mark stays.

    Raises KeyError for a mark that has no part.
    """

    def part(match: re.Match[str]) -> str:
        indent, alone, within = match.groups()
        if within:
            return parts[within]
        return "\n".join(f"{indent}{line}" if line else "" for line in parts[alone].splitlines())

    return _MARK.sub(part, resources.files(package).joinpath("templates", name).read_text(encoding="utf-8"))


@dataclass(frozen=True)
class Dialect:
    """A language: its types of numbers, and its phrases, as its file in templates/ has them.

    `extension` ends the names of its source files, `templates` those of its templates. `comment` begins a line of the
    head of a file, and `between` separates two functions. `numbers` has the type for each format that the language
    computes in, as printing/languages.py has it; `suffixes` has what ends a literal of a format. `types` names the
    types of a pair, an answer and the index of a table. `capitals`: the names of types are written LikeThis.

    The texts of `phrases`, `whole` and `integers` are for str.format. `whole` replaces and adds phrases for the kernel
    of a whole scene; `integers` has those for steps in whole numbers (programs/integers.py). `axis` has the texts that
    a kernel with an axis has in addition: how an axis is declared, passed to a function, read from a row.

    `exports`: a linker sees the functions of its kernels; in the other languages they are names of a module.
    `by_block`: its kernels have loops over many centres, which compilers turn into vector code.
    """

    name: str
    extension: str
    templates: str
    comment: str
    between: str
    exports: bool
    by_block: bool
    capitals: bool
    numbers: Mapping[str, str]
    suffixes: Mapping[str, str]
    types: Mapping[str, str]
    phrases: Mapping[str, str]
    whole: Mapping[str, str]
    axis: Mapping[str, str]
    integers: Mapping[str, str]

    def number_of(self, precision: str) -> str:
        """Return the type of numbers for a format. Raises InputError if the language has none."""
        if precision not in self.numbers:
            raise InputError(f"{self.name} has no {precision}; it computes in {' or '.join(self.numbers)}")
        return self.numbers[precision]

    def literal(self, value: float, precision: str) -> str:
        """Return a number of the format in decimals that read back as that very number."""
        return f"{value!r}{self.suffixes.get(precision, '')}"

    def statements(self, program: Program, wanted: tuple[str, ...], precision: str) -> tuple[str, ...]:
        """Return a statement for each step of the program that the wanted names need, in numbers of the format."""
        return statements_in(self.name, program, wanted, number=self.number_of(precision))

    def filled(self, name: str, parts: Mapping[str, str]) -> str:
        """Return the language's template of that name with its marks filled in, as `filled` does. Raises KeyError."""
        return filled("hypcheck.kernel.emission", f"{name}.{self.templates}.tmpl", parts)

    @property
    def asked_of_compiler(self) -> str:
        """The lines that refuse compiler options that change arithmetic; empty if the language has no such options."""
        return self.filled("arithmetic", {}) if self.by_block else ""

    def say(self, phrase: str, **words: object) -> str:
        """Return a phrase with its words filled in; `place` is a setting's number, `number` the type of numbers."""
        return self.phrases[phrase].format(**words)


@cache
def dialect_of(language: str) -> Dialect:
    """Return the language of that name, one of LANGUAGES."""
    tables = _tables_of(language)
    for section in ("phrases", "whole", "integers"):
        tables[section] = {name: _format_of(text) for name, text in tables[section].items()}
    return Dialect(name=language, **tables)


def _tables_of(language: str) -> dict[str, Any]:
    """Read the file of a language. Where its tables have no entry, that of the language it is based on holds."""
    own = dict(toml.shipped("hypcheck.kernel.emission", f"templates/{language}.toml"))
    base = own.pop("based_on", None)
    if base is None:
        return own
    tables = _tables_of(base)
    added = {key: {**tables[key], **value} if isinstance(value, dict) else value for key, value in own.items()}
    return {**tables, **added}


def _format_of(phrase: str) -> str:
    """Return the phrase with ${name} written as {name}, for str.format."""
    return _ESCAPED_MARK.sub(r"{\1}", phrase.replace("{", "{{").replace("}", "}}"))


LONGEST = 4095
"""Characters in a string that every compiler of ISO C takes."""

_BY_PARTS = """static const char *const parts[] = {{
    {parts},
}};
static char text[{size}];  /* ISO C has no strings of more than {longest} characters */
size_t end = 0;
for (size_t part = 0; part < sizeof parts / sizeof *parts; part++)
    for (const char *from = parts[part]; *from; from++) text[end++] = *from;
return text;"""


def description_in_language(
    value: dict[str, Any],
    language: str,
    prefix: str,
    asked: tuple[str, int],
    separators: tuple[str, str] | None = None,
) -> str:
    """Return the description as code: in C the body of the function that returns it, in Rust the whole function.

    `asked` is the name of the function that the description is about, and how many numbers a row has; `separators` are
    those of json.dumps.
    """
    if language == "python":
        return "\n    ".join(line.rstrip() for line in _lines(value, repr))
    lines = list(_lines(value, partial(json.dumps, separators=separators)))
    if language == "javascript":
        return "\n    ".join(line.rstrip() for line in lines)
    quoted = [json.dumps(line) for line in lines]  # C, C++ and Rust escape quotation marks and backslashes alike
    if language == "rust":
        return _in_rust(quoted, prefix, *asked)
    if language == "c" and sum(map(len, lines)) > LONGEST:
        size = sum(map(len, lines)) + 1
        return _BY_PARTS.format(parts=",\n    ".join(quoted), size=size, longest=LONGEST)
    return "return " + "\n    ".join(quoted) + ";"


def _in_rust(quoted: Sequence[str], prefix: str, predicate: str, width: int) -> str:
    """Return the description in Rust, with the names that the adapter of `hypcheck init` takes from a module.

    `predicate` is the name of the function that answers, and `width` the number of columns of a row. The other one of
    `predicate` and `tilted` exists too, but answers no row.
    """
    columns = str(width)
    other, other_columns = ("tilted", "10") if predicate == "predicate" else ("predicate", "7")
    named = {"asked": predicate, "columns": columns, "other": other, "other_columns": other_columns}
    parts = {"description": ",\n".join(quoted), "prefix": prefix, **named}
    return dialect_of("rust").filled("description", parts).strip("\n")


def _lines(value: dict[str, Any], written: Callable[[Any], str]) -> Iterator[str]:
    """Yield the text of a description in pieces: the part before the domain's settings, each setting, the end."""
    settings = value["domain"].get("settings")
    if settings is None:
        yield written(value)
        return
    text = written({**value, "domain": {"settings": []}})  # the settings come last: the text ends with []}}
    yield text[:-3]
    for place, setting in enumerate(settings, start=1):
        yield written(setting) + (", " if place < len(settings) else "")
    yield text[-3:]


PREFIX = "hypcheck"
"""With it the functions have the names that `verify library:` asks for."""

_PREFIX, _LONGEST_PREFIX = re.compile(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*", re.ASCII), 40


def require_prefix(prefix: str, language: str) -> None:
    """Raise InputError unless functions of a kernel in this language can begin with `prefix`."""
    if prefix != PREFIX and not dialect_of(language).exports:
        exporting = ", ".join(name for name in LANGUAGES if dialect_of(name).exports)
        raise InputError(f"--prefix is for {exporting}: a {language} kernel is a module with names of its own")
    if not _PREFIX.fullmatch(prefix) or len(prefix) > _LONGEST_PREFIX:
        raise InputError(
            f"the prefix is {escaped(repr(prefix), 60)}; it must be a letter, then letters, digits and single "
            f"underscores between them, {_LONGEST_PREFIX} characters at most"
        )


def routines_text(routines: Sequence[Routine], dialect: Dialect, precision: str) -> str:
    """Return the code of the routines and of all routines that they call, with the types of their records.

    Each routine is there once, and before those that call it.

    Raises ValueError for a name that the language reserves.
    """
    printer = _Printer(dialect, precision)
    every = {part.name: part for routine in routines for part in (*called(routine), routine)}
    pairs = any(PAIR in (*part.takes, part.gives) for part in every.values())
    texts = [dialect.say("pair_type")] if pairs else []
    texts += [
        text
        for part in every.values()
        for text in (*printer.tables(part.needed), printer.record(part), printer.text(part))
        if text
    ]
    return dialect.between.join(texts) + "\n"


@dataclass(frozen=True)
class _Printer:
    """Prints routines in one language, with numbers of one format."""

    dialect: Dialect
    precision: str

    @property
    def spelling(self) -> Spelling:
        """The spelling of steps in the language."""
        return spelling_of(self.dialect.name, self.dialect.number_of(self.precision))

    def say(self, phrase: str, **words: object) -> str:
        """A phrase of the language."""
        return self.dialect.say(phrase, number=self.dialect.number_of(self.precision), **words)

    def type_of(self, kind: str) -> str:
        """Return the name of the language's type for a kind of names: NUMBER, BOOLEAN, PAIR or ANSWER."""
        if kind in self.dialect.types:
            return self.dialect.types[kind]
        return self.spelling.number if kind == NUMBER else self.spelling.boolean

    def record(self, routine: Routine) -> str:
        """Return the code of the type of a routine's record; empty if it has none, or the language needs no type."""
        if not routine.record:
            return ""
        lines = (self._named("record_field", name, routine) for name in routine.record)
        return self.say("record", record=self._type_of_record(routine), fields="\n".join(INDENT + one for one in lines))

    def tables(self, parts: Iterable[Part]) -> Iterator[str]:
        """Yield the code of each table whose rows a loop of the parts reads."""
        for part in parts:
            if isinstance(part, Loop):
                if part.table is not None:
                    rows = (", ".join(map(repr, row)) for row in part.table.rows)
                    body = "\n".join(f"{INDENT}{self.say('table_row', values=row)}," for row in rows)
                    size = {"rows": part.times, "columns": len(part.given)}
                    yield self.say("table", name=part.table.name, body=body, **size)
                yield from self.tables(part.body)

    def text(self, routine: Routine) -> str:
        """Return the code of the routine, a function."""
        inputs = ", ".join(self._named("input", name, routine) for name in routine.inputs)
        if routine.record:
            of = ", ".join(self._named("input", name, routine) for name in routine.record)
            inputs += self.say("given_record", inputs=of, record=self._type_of_record(routine))
        unpacked = [self._named("unpack", name, routine) for name in routine.record]
        read = names_read(routine)
        constants = [
            self.say("constant", name=name, value=repr(value))
            for name, value in routine.constants.items()
            if name in read
        ]
        head = self.say(
            "function", type=self.type_of(routine.gives), name=routine.name, inputs=inputs, meaning=routine.meaning
        )
        parts = self._parts(routine.needed, dict(routine.given))
        body = [*filter(None, unpacked), *constants, *parts, *self._result(routine.result)]
        return "\n".join([*_broken(head), *_indented(body), *filter(None, [self.say("end")])])

    def _named(self, phrase: str, name: str, routine: Routine) -> str:
        """Return a phrase about a name that the routine is given, with the type of the name."""
        return self.say(phrase, name=name, type=self.type_of(routine.given[name]))

    def _type_of_record(self, routine: Routine) -> str:
        """Return the name of the type of a routine's record."""
        words = routine.record_name.split("_")
        return "".join(map(str.capitalize, words)) if self.dialect.capitals else routine.record_name

    def _parts(self, parts: Iterable[Part], kinds: dict[str, str]) -> Iterator[str]:
        """Yield the statements of the parts. `kinds` holds the kind of each name so far; the new names are added."""
        several = list(parts)
        for part, next_part in zip(several, (*several[1:], None), strict=False):
            if isinstance(part, Loop):
                yield from self._loop(part, kinds)
                continue
            self._require_free(part.name)
            if part.name in kinds:  # it came with the half before
                continue
            kinds[part.name] = kind_of_part(part, kinds)
            low = _low_half(part, next_part) if self.dialect.phrases["both"] else None
            if low is not None:
                kinds[low.name] = NUMBER
                yield self.say("both", high=part.name, low=low.name, pair=low.pair)
            elif isinstance(part, Stored):
                phrase = "opaque" if part.opaque else "stored"
                yield self.say(phrase, name=part.name, value=part.value, type=self.type_of(NUMBER))
            else:
                words = {"type": self.type_of(kinds[part.name]), "name": part.name, "value": self._value(part)}
                yield self.spelling.declaration.format(**words)

    def _value(self, part: Step | Call | Half) -> str:
        """Return the expression of a step, a call or a half of a pair."""
        if isinstance(part, Step):
            return value_of(part, self.spelling)
        if isinstance(part, Half):
            return self.say("low" if part.low else "high", pair=part.pair)
        arguments = ", ".join(argument_of(argument, self.spelling) for argument in part.arguments)
        return f"{part.routine.name}({arguments})"

    def _loop(self, loop: Loop, kinds: dict[str, str]) -> Iterator[str]:
        """Yield the statements of a loop: the kept numbers, its head, the cells of its table, its body, its end."""
        for name, start, _ in loop.kept:
            kinds[name] = NUMBER
            self._require_free(name)
            yield self.say("keep", name=name, value=start)
        table = loop.table
        if table is None:
            yield self.say("loop", times=loop.times)
        else:
            yield self.say("loop_over", times=loop.times, table=table.name)
            cells = enumerate(table.columns)
            yield from _indented(self.say("cell", name=name, index=index, table=table.name) for index, name in cells)
        inside = {**kinds, **dict.fromkeys(loop.given, NUMBER)}
        ends = [self.say("keep_on", name=name, value=end) for name, _, end in loop.kept]
        until = [] if loop.until is None else self.say("leave_if", condition=loop.until).splitlines()
        yield from _indented([*self._parts(loop.body, inside), *ends, *until])
        yield from filter(None, [self.say("end_if")])

    def _require_free(self, name: str) -> None:
        """Raise ValueError if the language reserves the name."""
        if name in self.spelling.reserved:
            raise ValueError(f"{name} is not a name in {self.dialect.name}")

    def _result(self, result: Result) -> Iterator[str]:
        """Yield the statements that return the result."""
        if isinstance(result, str):
            yield self.say("return", value=result)
        elif isinstance(result, tuple):
            high, low = (argument_of(argument, self.spelling) for argument in result)
            yield self.say("return", value=self.say("pair", high=high, low=low))
        else:
            for name, value in result.choices:
                yield from self.say("return_if", condition=name, value=value).splitlines()
            yield self.say("return", value=result.otherwise)


def _low_half(part: Part, next_part: Part | None) -> Half | None:
    """Return the next part if it is the low half of the pair whose high half `part` is, else None."""
    if isinstance(part, Half) and isinstance(next_part, Half) and part.pair == next_part.pair:
        return next_part if next_part.low and not part.low else None
    return None


def _broken(head: str) -> Iterator[str]:
    """Yield the lines of a function's head; a line that is too long is broken after commas."""
    for line in head.splitlines():
        inputs = line.split(", ") if len(line) > WIDTH else [line]
        begun, *others = inputs
        for parameter in others:
            if len(begun) + len(parameter) + 3 > WIDTH:
                yield f"{begun},"
                begun = f"{2 * INDENT}{parameter}"
            else:
                begun = f"{begun}, {parameter}"
        yield begun


def _indented(lines: Iterable[str]) -> list[str]:
    """Return the lines, each indented by one step."""
    return [f"{INDENT}{line}" for line in lines]
