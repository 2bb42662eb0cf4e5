"""How TypeScript is spelled: literals, choices and doc comments."""

import json
import textwrap
from collections.abc import Iterable
from typing import Any

WIDTH = 100


def text(value: str) -> str:
    """A string literal."""
    return json.dumps(value, ensure_ascii=False)


def number(value: float | None) -> str:
    """A number as JavaScript spells it; null for none."""
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    return json.dumps(value)


def literal(value: Any) -> str:
    """Any plain value."""
    return json.dumps(value, ensure_ascii=False)


def choice(values: Iterable[str]) -> str:
    """A union of texts."""
    return " | ".join(map(text, values))


def union(name: str, members: Iterable[str]) -> list[str]:
    """A named type that is one of others."""
    members = list(members)
    line = f"export type {name} = {' | '.join(members)};"
    if len(line) <= WIDTH:
        return [line]
    return [f"export type {name} =", *(f"  | {one}" for one in members[:-1]), f"  | {members[-1]};"]


def comment(words: str, indent: str = "") -> list[str]:
    """A doc comment, each paragraph wrapped on its own."""
    paragraphs = [" ".join(one.split()) for one in words.replace("``", "`").split("\n\n")]
    whole = f"{indent}/** {paragraphs[0]} */"
    if len(paragraphs) == 1 and len(whole) <= WIDTH:
        return [whole]
    start = f"{indent} * "
    lines = [f"{indent}/**"]
    for paragraph in paragraphs:
        if len(lines) > 1:
            lines.append(f"{indent} *")
        lines += textwrap.wrap(
            paragraph,
            WIDTH,
            initial_indent=start,
            subsequent_indent=start,
            break_long_words=False,
            break_on_hyphens=False,
        )
    return [*lines, f"{indent} */"]
