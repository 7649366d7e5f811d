"""What a file says before its cases, beside what is known of the family that it names and of the flags it describes.

A flag is ours, so its meaning is too: a label is checked by ours and read by the file's. A family of ours is told in
the words of its generator's version; of an earlier version, or of another's family, nothing is known here.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields

from hypcheck.casebook.families import FAMILIES
from hypcheck.casebook.family import Story
from hypcheck.casebook.frozen import cancellation, refusals
from hypcheck.casebook.frozen.flags import FLAGS
from hypcheck.casebook.frozen.model import FlagFacts, Head
from hypcheck.visible import shortened

STORIES: Mapping[str, Story] = {
    **FAMILIES,
    cancellation.NAME: cancellation.HEAD,
    refusals.NAME: refusals.HEAD,
}

QUOTED = 200
"""Characters of what a file says that are quoted; it may say any number of them."""


def wrong_story(head: Head) -> Iterator[str]:
    """Sentences about what a file says wrongly of a family of ours; none of the command that made it."""
    known = STORIES.get(head.name)
    if known is None or head.version < known.version:
        return
    for each in fields(Story):
        said, right = getattr(head, each.name), getattr(known, each.name)
        if said != right:
            yield f"family.{each.name} is {_quoted(said)}; of {head.name} it is {right!r}"


def wrong_meanings(flags: Mapping[str, FlagFacts]) -> Iterator[str]:
    """Sentences about flags that a file describes otherwise than they are checked."""
    for name, facts in flags.items():
        for each in fields(FlagFacts):
            said, right = getattr(facts, each.name), getattr(FLAGS[name], each.name)
            if said != right:
                yield f"the {each.name} of the flag {name} is {_quoted(said)}; it is {right!r}"


def _quoted(said: object) -> str:
    return shortened(repr(said), QUOTED)
