"""Installation hints: from a checkout, until the package is published."""


def extra(name: str) -> str:
    """The command that installs an extra of this package."""
    return f"pip install '.[{name}]' in a checkout of Southwell"
