"""Lists what a blade's files hold and the blade does not: once, in every command's output and on every page."""

from collections.abc import Iterable

from rich.console import Console

from ...cases.input.readers import Unused


def lines(unused: Iterable[Unused]) -> tuple[str, ...]:
    """One line per quantity, each once."""
    return tuple(dict.fromkeys(str(quantity) for quantity in unused))


def show(unused: Iterable[Unused], console: Console) -> None:
    """Print the lines."""
    for line in lines(unused):
        console.print(line, style="yellow", markup=False, soft_wrap=True)
