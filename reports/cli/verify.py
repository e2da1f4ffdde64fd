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

    The command writes results.jsonl (one row per case, code, speed and mode), report.md and figures. The status is 1 if a row
    fails or is inconclusive, if nothing was compared, if fewer independent groups confirm a blade than its case requires, or if
    a seeded fault is not detected.

    Answers are stored as they are computed. If the run was interrupted (status 130) or killed, or if the disk was full (status
    3), the same command continues it. Earlier results are replaced when the new ones are complete.

    Parameters
    ----------
    case
        Turbine files (.fst, .htc, TOML), blade files (ElastoDyn, BeamDyn, BModes, HAWC2, windIO), names of cases (listed by
        `southwell cases`), one blade of a case as `case/blade`, or case files (TOML). Default: all cases. The lowest eight
        modes of a turbine file and the lowest six of a blade file are compared.
    codes
        Names of codes (listed by `southwell codes`) or import paths `module:attribute`, separated by commas. Default: all
        codes.
    out
        Output folder. Only one run at a time may write to it.
    workers
        Number of worker processes, or of Slurm workers. Default: one per processor.
    scheduler
        Address of a Dask scheduler, for example `tcp://host:8786`, or `slurm` with `--workers`. Default: processes of this
        machine.
    add
        `NAME=FILE.csv`: add the results of another program. May be repeated. The file has the columns `speed [rpm]` (or rad/s,
        gamma), `frequency [Hz]` (or rad/s, gamma) and `mode` (flapwise 1, or a number). Measurements have the columns `measured
        [Hz]` and `uncertainty [%]` instead of `frequency [Hz]`; they do not affect the verdict.
    data_uncertainty
        Standard uncertainty of measured frequencies whose file states none, for example `1%`.
    input_uncertainty
        Standard uncertainty of the computed frequencies due to the blade's properties, for measured rows that state none, for
        example `2%`.
    junit
        Output file for JUnit XML, one test case per cell.
    faults
        Seeded faults to run: `fast` (seven), `all`, `none`, or names separated by commas.
    witnesses
        Number of independent groups that must confirm each blade. Default: the number in the case; 0 with `--codes`.
    time_limit
        Time limit in seconds for one solution by another code. Default: the limit in the case, otherwise 300.
    memory_limit
        Memory limit in GiB for one solution by another code, including the processes that it starts.
    rpm
        Rotor speeds of a blade file in rpm: a range `first:last:step` or a list `0,5,10`.
    omega
        Rotor speeds of a blade file in rad/s, in the same form.
    changes
        Change a property of every blade: `EI_flap=*1.1`, also EI_edge, GJ, EA, mass, tip_mass, twist, hub_radius, precone,
        pitch. May be repeated.
    fresh
        Compute every answer again instead of reusing the answers of earlier runs (see `southwell cache`).
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
