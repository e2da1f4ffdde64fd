"""Lists the quantities in a blade's files that are not used, in the output of every command and on every page."""

from collections.abc import Iterable

from rich.console import Console

from ...cases.input.readers import Unused


def lines(unused: Iterable[Unused]) -> tuple[str, ...]:
    """One line per quantity, without repetition."""
    return tuple(dict.fromkeys(str(quantity) for quantity in unused))


def show(unused: Iterable[Unused], console: Console) -> None:
    """Print one line per unused quantity."""
    for line in lines(unused):
        console.print(line, style="yellow", markup=False, soft_wrap=True)
