"""Physical effects included in an analysis of a rotating blade."""

from dataclasses import dataclass, fields


@dataclass(frozen=True)
class Effects:
    """The effects included; all by default. A code declares the effects it lacks, and core can omit the same ones.

    Attributes:
        prestretch: the displacements of the steady state (deformed radius), not only its internal forces.
        coriolis: the gyroscopic terms, 2 Ω × velocity.
        rotary_inertia: the sections' moments of inertia.
        geometric: stiffening by the steady internal forces.
    """

    prestretch: bool = True
    coriolis: bool = True
    rotary_inertia: bool = True
    geometric: bool = True

    def lacks(self) -> tuple[str, ...]:
        """Names of the omitted effects."""
        return tuple(f.name.replace("_", " ") for f in fields(self) if not getattr(self, f.name))


ALL_EFFECTS = Effects()
