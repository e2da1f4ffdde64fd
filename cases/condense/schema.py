"""Schema of a file for ``southwell condense``: matrices, nodes and sections; unknown keys are rejected."""

from typing import Annotated, Literal

from msgspec import Meta, Struct

from ...core.condense.ties import Kind
from ..input.names import Name

Three = tuple[float, float, float]
Axis = Annotated[
    Literal["x", "y", "z", "-x", "-y", "-z"] | Three, Meta(description="in the model's axes: a name, or a vector")
]
Freedom = Annotated[int, Meta(ge=1, le=6, description="1–3 displacement along x, y, z; 4–6 rotation about them")]


class Matrix(Struct, frozen=True, forbid_unknown_fields=True):
    """One matrix of a file that has several."""

    file: str
    matrix: Annotated[str, Meta(description="a *MATRIX's TYPE, or a DMIG's name: KAAX")]


class Body(Struct, frozen=True, forbid_unknown_fields=True):
    """A segment's mass, where there is no mass matrix; in the unit of the file and the model's axes."""

    mass: Annotated[float, Meta(gt=0)]
    centre: Three
    moments: Annotated[
        list[float | list[float]], Meta(description="of inertia about the centre: three principal ones, or 3×3")
    ]


class Model(Struct, frozen=True, forbid_unknown_fields=True):
    """A finite element model as another code exported it."""

    stiffness: str | Matrix | None = None
    mass: str | Matrix | None = None
    nodes: Annotated[str | None, Meta(description="CSV of id, x, y, z")] = None
    freedoms: Annotated[
        str | tuple[Freedom, ...] | None,
        Meta(
            description="of a matrix that does not name them: those of each node, node after node as in the CSV of nodes; "
            "or a CSV of node, freedom, row by row"
        ),
    ] = None


class Piece(Model, frozen=True, forbid_unknown_fields=True):
    """One segment's own model; what it does not say is the file's."""

    body: Body | None = None


class At(Struct, frozen=True, forbid_unknown_fields=True):
    """A section: its plane passes through the point, across the axis."""

    point: Three
    axis: Annotated[Axis | None, Meta(description="none: the span")] = None
    tie: Kind | None = None


class CondenseFile(Model, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A file for ``southwell condense``: one model cut at its sections, or ``[[segments]]`` with a model each."""

    name: Name
    sections: Annotated[
        tuple[float | At, ...],
        Meta(min_length=2, description="from the root to the tip: coordinate along the span, or place"),
    ]
    segments: tuple[Piece, ...] = ()
    title: Annotated[str, Meta(description="one line")] = ""
    source: Annotated[str, Meta(description="where the matrices come from")] = ""
    tie: Annotated[Kind, Meta(description="of sections that say nothing else")] = "average"
    root: Annotated[Kind, Meta(description="of the first section")] = "rigid"
    weights: Annotated[
        Literal["mass", "mass matrix", "even"],
        Meta(description="what each node of a section stands for in an average tie: see core.ties.average"),
    ] = "mass"
    units: Annotated[
        Literal["m kg s", "mm t s"],
        Meta(description="of nodes, sections, bodies and matrices; mm t s: N/mm and tonnes"),
    ] = "m kg s"
    hub_radius: Annotated[
        Annotated[float, Meta(ge=0)] | None,
        Meta(description="m, from the rotor's axis to the first section; none: as it lies"),
    ] = None
    span: Annotated[Axis, Meta(description="from the root to the tip")] = "x"
    rotor: Annotated[Axis, Meta(description="the rotor's axis, the way it turns")] = "z"
