"""A whole table classified: read, answered and written a chunk at a time."""

from __future__ import annotations

from hypcheck.classification.answers import answers_of_chunk
from hypcheck.tables.formats import opened
from hypcheck.tables.route import Route


def classify_table(route: Route, *, mark: bool) -> None:
    """Write the answers about every row of the table at `route.source` to `route.target`.

    A row that is no valid query raises InputError, or with `mark` is marked as refused (127). After any error nothing
    is left at the target but what stood there before. Raises what opened() and answers() raise.
    """
    with opened(route, mark=mark) as (table, write):
        for chunk in table.chunks:
            write(chunk, answers_of_chunk(chunk))
