"""Changes of one operator, constant, condition or statement of a module, made in functions that are loaded."""

from __future__ import annotations

import ast
import copy
import gc
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from types import CodeType, FunctionType

Function = ast.FunctionDef | ast.AsyncFunctionDef

LONGEST = 100
"""Characters of the expression that stands for a constant in it."""

COMPARISONS: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
}

OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Add,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.FloorDiv,
    ast.Pow: ast.Mult,
    ast.LShift: ast.RShift,
    ast.RShift: ast.LShift,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.BitXor: ast.BitOr,
    ast.MatMult: ast.Mult,
}


@dataclass(frozen=True)
class Mutation:
    """One change of a module: of the node with this number in the order of ast.walk; `what` says it in a few words.

    `key` names the change by what it says, so that it stays the same when other code of the file is edited.
    """

    module: str
    line: int
    column: int
    number: int
    choice: int
    what: str
    key: str


def mutations(module: str, source: str) -> Iterator[Mutation]:
    """Every change of the functions of a module."""
    tree = ast.parse(source)
    inside = _places_in_functions(tree)
    parents = {id(child): node for node in ast.walk(tree) for child in ast.iter_child_nodes(node)}
    seen: Counter[str] = Counter()
    for number, node in enumerate(ast.walk(tree)):
        if number in inside:
            for choice, (what, new) in enumerate(_changes(node)):
                key = f"{module} {_function_of(node, parents)}: {_texts(node, new, parents)}"
                seen[key] += 1
                key += f" ({seen[key]})" if seen[key] > 1 else ""
                yield Mutation(module, node.lineno, node.col_offset, number, choice, what, key)


def _function_of(node: ast.AST, parents: dict[int, ast.AST]) -> str:
    """The function that a node stands in, with the classes and functions around it."""
    names: list[str] = []
    while id(node) in parents:
        node = parents[id(node)]
        if isinstance(node, Function | ast.ClassDef):
            names.append(node.name)
    return ".".join(reversed(names))


def _texts(node: ast.AST, new: ast.AST, parents: dict[int, ast.AST]) -> str:
    """The changed code, before and after: of a constant, the expression that holds it."""
    match node:
        case ast.If() | ast.While() | ast.IfExp():
            return f"if {ast.unparse(node.test)} → if {ast.unparse(new.test)}"
        case ast.AugAssign() | ast.stmt():
            return f"{ast.unparse(node)} → {ast.unparse(new)}"
    before, after = node, new
    while isinstance(before, ast.Constant | ast.UnaryOp | ast.Tuple | ast.Slice):
        holder = parents[id(before)]
        if not isinstance(holder, ast.expr | ast.keyword | ast.Return) or len(ast.unparse(holder)) > LONGEST:
            break
        before, after = holder, _with_child(holder, before, after)
    return f"{ast.unparse(before)} → {ast.unparse(after)}"


def _with_child(node: ast.AST, old: ast.AST, new: ast.AST) -> ast.AST:
    """A copy of a node with another child."""
    changed = copy.copy(node)
    for name, value in ast.iter_fields(node):
        if value is old:
            setattr(changed, name, new)
        elif isinstance(value, list):
            setattr(changed, name, [new if each is old else each for each in value])
    return changed


def mutated(source: str, mutation: Mutation) -> ast.Module:
    """The tree of a module with the change."""
    tree = ast.parse(source)
    node = next(each for number, each in enumerate(ast.walk(tree)) if number == mutation.number)
    _, new = _changes(node)[mutation.choice]
    return ast.fix_missing_locations(_Replacing(node, new).visit(tree))


def _places_in_functions(tree: ast.Module) -> set[int]:
    """The numbers of the nodes that are run when a function is: not of annotations, decorators and defaults."""
    bodies: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, Function):
            for statement in node.body:
                bodies.update(map(id, _run_nodes(statement)))
    return {number for number, node in enumerate(ast.walk(tree)) if id(node) in bodies}


def _run_nodes(node: ast.AST) -> Iterator[ast.AST]:
    if isinstance(node, Function):  # a function in a function brings its own body
        return
    yield node
    skipped = [node.annotation] if isinstance(node, ast.AnnAssign) else []
    skipped += [node.exc, node.cause] if isinstance(node, ast.Raise) else []
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "zip":
        skipped += node.keywords  # strict= checks lengths, and changes no result
    for child in ast.iter_child_nodes(node):
        if not any(child is each for each in skipped):
            yield from _run_nodes(child)


def _changes(node: ast.AST) -> list[tuple[str, ast.AST]]:  # noqa: C901 - a table
    """The changes of one node, each in a few words, with the node to stand in its place."""
    match node:
        case ast.Compare():
            return [_of_comparison(node, place) for place, op in enumerate(node.ops) if type(op) in COMPARISONS]
        case ast.BinOp() | ast.AugAssign() if type(node.op) in OPERATORS and not _is_text(node):
            return [_with_operator(node, OPERATORS[type(node.op)]())]
        case ast.BoolOp():
            other = ast.Or() if isinstance(node.op, ast.And) else ast.And()
            return [_with_operator(node, other)]
        case ast.UnaryOp(op=ast.Not() | ast.USub() | ast.Invert()) if not isinstance(node.operand, ast.Constant):
            return [(f"{_name(node.op)} left out", node.operand)]
        case ast.Constant(value=bool() as value):
            return [(f"{value} becomes {not value}", ast.Constant(not value))]
        case ast.Constant(value=int() | float() as value):
            new = value + 1 if isinstance(value, int) else value * 2 + (value == 0)
            return [(f"{value!r} becomes {new!r}", ast.Constant(new))]
        case ast.If() | ast.While() | ast.IfExp() if isinstance(node.test, (ast.Name, ast.Call, ast.Attribute)):
            return [("condition negated", _with(node, "test", ast.UnaryOp(ast.Not(), node.test)))]
        case ast.Expr(value=ast.Call()):
            return [("call left out", ast.Pass())]
        case ast.Return(value=ast.expr()) if not _is_none(node.value):
            return [("returns None", ast.Return(ast.Constant(None)))]
        case ast.Break():
            return [("break becomes continue", ast.Continue())]
        case ast.Continue():
            return [("continue becomes break", ast.Break())]
        case _:
            return []


def _of_comparison(node: ast.Compare, place: int) -> tuple[str, ast.AST]:
    old, ops = node.ops[place], list(node.ops)
    ops[place] = COMPARISONS[type(old)]()
    return f"{_name(old)} becomes {_name(ops[place])}", _with(node, "ops", ops)


def _with_operator(node: ast.AST, new: ast.AST) -> tuple[str, ast.AST]:
    return f"{_name(node.op)} becomes {_name(new)}", _with(node, "op", new)


def _with(node: ast.AST, field: str, value: object) -> ast.AST:
    changed = copy.copy(node)
    setattr(changed, field, value)
    return changed


def _name(node: ast.AST) -> str:
    return type(node).__name__


def _is_none(node: ast.AST | None) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def _is_text(node: ast.BinOp | ast.AugAssign) -> bool:
    """Whether an operand is a text, so that only a message is put together, or a type error would be made."""
    parts = [node.value] if isinstance(node, ast.AugAssign) else [node.left, node.right]
    return any(
        isinstance(each, ast.JoinedStr) or (isinstance(each, ast.Constant) and isinstance(each.value, (str, bytes)))
        for each in parts
    )


class _Replacing(ast.NodeTransformer):
    def __init__(self, old: ast.AST, new: ast.AST) -> None:
        self._old, self._new = old, ast.copy_location(new, old)

    def visit(self, node: ast.AST) -> ast.AST:
        return self._new if node is self._old else self.generic_visit(node)


def apply(mutation: Mutation, file: str, source: str, functions: Sequence[FunctionType]) -> bool:
    """Make the change in the functions of a module's file that live; returns whether one of them was changed."""
    code = compile(mutated(source, mutation), file, "exec", dont_inherit=True)
    codes = list(_codes(code))
    alone = Counter(map(_key, codes))
    new = {_key(each): each for each in codes if alone[_key(each)] == 1}
    changed = False
    for function in functions:
        found = new.get(_key(function.__code__))
        if found is not None and found != function.__code__:
            function.__code__ = found
            changed = True
    return changed


def functions_of(file: str) -> list[FunctionType]:
    """The functions that live now and come from a file, however they are wrapped."""
    gc.unfreeze()  # what is frozen is not told
    found = [each for each in gc.get_objects() if type(each) is FunctionType and each.__code__.co_filename == file]
    gc.freeze()
    return found


def _codes(code: CodeType) -> Iterator[CodeType]:
    for each in code.co_consts:
        if isinstance(each, CodeType):
            yield each
            yield from _codes(each)


def _key(code: CodeType) -> tuple[str, int, int]:
    return code.co_name, code.co_firstlineno, len(code.co_freevars)
