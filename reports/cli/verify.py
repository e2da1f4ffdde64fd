"""``southwell verify``: solves cases with every code, compares and judges the results, and writes a report."""

from pathlib import Path

from ...cases.plan.request import Execution, Request
from ...cases.verify.pipeline import verify
from ...references.protocol.process import Limits
from .arguments import Changes, Count, Positive, Workers, cluster_workers
from .mounting import Mounting
from .verify_output import Output, status


def command(
    *case: str,
    codes: str | None = None,
    out: Path = Path("southwell-report"),
    workers: Workers | None = None,
    scheduler: str | None = None,
    add: tuple[str, ...] = (),
    data_uncertainty: str | None = None,
    input_uncertainty: str | None = None,
    junit: Path | None = None,
    faults: str = "fast",
    witnesses: Count | None = None,
    time_limit: Positive | None = None,
    memory_limit: Positive = Limits.memory / 2**30,
    rpm: str | None = None,
    omega: str | None = None,
    changes: Changes = (),
    fresh: bool = False,
    mounting: Mounting | None = None,
    blade_only: bool = False,
) -> int:
    """Solve blades and turbines with every code, compare the results and write a report.

    Writes results.jsonl (one row per cell), report.md and figures. Status 1 if a cell fails or is inconclusive, if nothing was
    compared, if fewer independent groups confirm a blade than its case requires, or if a seeded fault is not detected.

    Answers are stored as they are computed. After an interruption (status 130), or if the run was killed or the disk is full
    (status 3), the same command continues. Earlier results are replaced when the new ones are complete.

    Parameters
    ----------
    case
        A turbine's file (.fst, .htc, TOML), blade files (ElastoDyn, BeamDyn, BModes, HAWC2, windIO), cases by name
        (`southwell cases`), one blade of a case as `case/blade`, or case files (TOML). Default: all cases. Of a turbine, the
        lowest eight modes are compared, of a blade the lowest six.
    codes
        Names separated by commas (`southwell codes`), or import paths `module:attribute`. Default: all codes.
    out
        Output folder; only one run at a time may write in it.
    workers
        Worker processes (default: one per processor), or workers of Slurm.
    scheduler
        Address of a Dask scheduler, as `tcp://host:8786`, or `slurm` with `--workers`. Default: processes of this machine.
    add
        `NAME=FILE.csv`: results of another program as one more column; may be repeated. Columns of the file: `speed [rpm]` (or
        rad/s, gamma), `frequency [Hz]` (or rad/s, gamma), `mode` (flapwise 1, or a number). Measurements have `measured [Hz]`
        instead of `frequency [Hz]`, and `uncertainty [%]`: they show how far the model is from the data, and do not
        affect the verdict.
    data_uncertainty
        Standard uncertainty of measured frequencies without one in the file: `1%`.
    input_uncertainty
        Standard uncertainty of the computed frequencies due to the blade's properties, for measured rows without one: `2%`.
    junit
        Output file for JUnit XML, one test case per cell.
    faults
        Seeded faults to run: `fast` (seven), `all`, `none`, or names separated by commas.
    witnesses
        Number of independent groups that must confirm each blade. Default: as the case says; none with `--codes`.
    time_limit
        Seconds for one solution by another code. Default: as the case says, otherwise 300.
    memory_limit
        Memory in GiB for one solution by another code, including the processes that it starts.
    rpm
        Rotor speeds of a blade file in rpm: a range `first:last:step` or a list `0,5,10`.
    omega
        Rotor speeds of a blade file in rad/s, in the same form.
    changes
        Change a property of every blade: `EI_flap=*1.1`, also EI_edge, GJ, EA, mass, tip_mass, twist, hub_radius, precone,
        pitch. May be repeated.
    fresh
        Compute every answer again instead of taking those of earlier runs from the store (`southwell cache`).
    blade_only
        Verify one blade of a turbine's .fst or .htc file, clamped at the hub, instead of the whole turbine.
    """
    execution = Execution(cluster_workers(workers, scheduler), scheduler, out=out, fresh=fresh)
    request = Request(
        subjects=case,
        codes=None if codes is None else tuple(codes.split(",")),
        rpm=rpm,
        omega=omega,
        mount=(mounting or Mounting()).mount(),
        blade_only=blade_only,
        changes=changes,
        add=add,
        data_uncertainty=data_uncertainty,
        input_uncertainty=input_uncertainty,
        faults=faults,
        witnesses=witnesses,
        time_limit=time_limit,
        memory_limit=memory_limit,
        execution=execution,
    )
    return status(verify(request, Output(out, junit)))
