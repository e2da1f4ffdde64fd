"""The registered codes of this package, by what they solve."""

from southwell.references.protocol import registry
from southwell.references.protocol.interface import BladeAdapter, MechanismAdapter

BLADE_CODES = [name for name, path in registry.registered().items() if isinstance(registry.code(path), BladeAdapter)]
MECHANISM_CODES = [
    name for name, path in registry.registered().items() if isinstance(registry.code(path), MechanismAdapter)
]
