"""What a file says before its cases, beside what is known of the family that it names and of the flags it describes.

A flag is ours, so its meaning is too: a label is checked by ours and read by the file's. A family of ours is told in
the words of its generator's version; of an earlier version, or of another's family, nothing is known here.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import fields

from hypcheck.casebook.families import FAMILIES
from hypcheck.casebook.family import Story
from hypcheck.casebook.frozen import cancellation, refusals
from hypcheck.casebook.frozen.flags import FLAGS
from hypcheck.casebook.frozen.model import FlagFacts, Head
from hypcheck.tables.numbers import shown_json

STORIES: Mapping[str, Story] = {
    **FAMILIES,
    cancellation.NAME: cancellation.HEAD,
    refusals.NAME: refusals.HEAD,
}


def wrong_story(head: Head) -> Iterator[str]:
    """Sentences about what a file says wrongly of a family of ours; none of the command that made it."""
    known = STORIES.get(head.name)
    if known is None or head.version < known.version:
        return
    for name, said, right in _differences(Story, head, known):
        yield f"family.{name} is {said}; of {head.name} it is {right}"


def wrong_meanings(flags: Mapping[str, FlagFacts]) -> Iterator[str]:
    """Sentences about flags that a file describes otherwise than they are checked."""
    for flag, facts in flags.items():
        for name, said, right in _differences(FlagFacts, facts, FLAGS[flag]):
            yield f"the {name} of the flag {flag} is {said}; it is {right}"


def _differences(kind: type[Story | FlagFacts], there: object, known: object) -> Iterator[tuple[str, str, str]]:
    """Names of fields that differ, with what is said there, cut where it is long, and what is right, whole."""
    for each in fields(kind):
        said, right = getattr(there, each.name), getattr(known, each.name)
        if said != right:
            yield each.name, shown_json(said), json.dumps(right, ensure_ascii=False)
