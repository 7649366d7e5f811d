"""The written form of a program: one step a line, as `name = left + right`.

    h1 = c2_squared - three_c1      two arguments, with one of + - * / > < >= <= == != and or between them
    root = sqrt h1                  one argument, after one of - abs sqrt not cos arccos
    side = inside ? -1 : 0          select: the condition, then what holds and what does not
    # a remark

Nothing nests: what is written is what is rounded, and in that order.
"""

from __future__ import annotations

from hypcheck.derivation.program import KNOWN, Argument, Program, Step

_INFIX = {operation.sign: name for name, operation in KNOWN.items() if len(operation.takes) == 2}
_PREFIX = {operation.sign: name for name, operation in KNOWN.items() if len(operation.takes) == 1}


def steps_of(text: str) -> tuple[Step, ...]:
    """The steps a listing says, without remarks and blank lines. Raises ValueError naming a line it cannot read."""
    lines = (line.partition("#")[0].strip() for line in text.splitlines())
    return tuple(_step_of(line) for line in lines if line)


def program_of(name: str, inputs: tuple[str, ...], *listings: str) -> Program:
    """The program whose steps the listings say one after the other."""
    return Program(name, inputs, tuple(step for text in listings for step in steps_of(text)))


def listing_of(program: Program) -> str:
    """The program's steps in the written form; `steps_of` reads them back."""
    return "".join(f"{line_of(step)}\n" for step in program.steps)


def line_of(step: Step) -> str:
    """One step in the written form."""
    sign = KNOWN[step.operation].sign
    if step.operation == "select":
        condition, left, right = step.arguments
        return f"{step.name} = {condition} ? {left} : {right}"
    if len(step.arguments) == 1:
        return f"{step.name} = {sign} {step.arguments[0]}"
    left, right = step.arguments
    return f"{step.name} = {left} {sign} {right}"


def _step_of(line: str) -> Step:
    name, equals, formula = (part.strip() for part in line.partition("="))
    words = formula.split()
    if equals and len(words) == 3 and words[1] in _INFIX:
        return Step(name, _INFIX[words[1]], (_argument(words[0]), _argument(words[2])))
    if equals and len(words) == 2 and words[0] in _PREFIX:
        return Step(name, _PREFIX[words[0]], (_argument(words[1]),))
    if equals and len(words) == 5 and (words[1], words[3]) == ("?", ":"):
        return Step(name, "select", (_argument(words[0]), _argument(words[2]), _argument(words[4])))
    raise ValueError(f"this line of a listing is no step: {line!r}")


def _argument(word: str) -> Argument:
    return int(word) if word.lstrip("-").isdigit() else word
