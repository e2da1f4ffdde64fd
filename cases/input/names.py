"""Valid names: one line of printable text, short enough for a table, a figure's title and a file name."""

from typing import Annotated

from msgspec import Meta

MAX_NAME = 100
"""Maximum number of characters of a name."""

RULE = f"one line of printable characters, {MAX_NAME} at most (names that are typed: a-z, 0-9, point, hyphen)"

Name = Annotated[
    str,
    Meta(min_length=1, max_length=MAX_NAME, pattern=r"\A[^\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff]+\Z"),
]
"""A name, such as that of a blade, a variant or a body."""

Typed = Annotated[
    str, Meta(max_length=MAX_NAME, pattern=r"\A[a-z0-9][a-z0-9.-]*\Z", description="as typed and printed")
]
"""A name used on the command line."""


def has_name(text: str) -> bool:
    """Whether a text is a valid ``Name``."""
    return 0 < len(text) <= MAX_NAME and text.isprintable()
