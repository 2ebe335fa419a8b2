"""`python -m traction.campaigns.cost --drives 10 1000 10000`: what a drive costs, alone and in campaigns, measured in one run.

The drive alone is measured in this process, before the campaigns and after each, so that a machine which grows slower in between shows.
Each campaign runs in a process of its own, the parent of its workers, whose memory is that of this campaign alone.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median
from typing import Any

from .._html import number
from . import pool
from .drive import Job, run_row
from .run import Progress, campaign
from .spec import Spec

IDLE = 0.5  # load average of the last minute above which others use the machine
SINGLE = 100  # drives of each measurement of the drive alone


def spec_of(drives: int, duration_s: float) -> dict[str, Any]:
    """The campaign that is measured: slopes and masses on sand, one figure, logs not kept."""
    drive = [{"for_s": duration_s, "mode": "platform_speed", "speed_m_s": 0.2}]
    return {
        "title": f"{drives} drives",
        "scenario": {"duration_s": duration_s, "ground": {"soil": "sand"}, "drive": drive},
        "seed": 1,
        "method": "latin_hypercube",
        "drives": drives,
        "vary": {"ground.slope_rad": {"low": 0.0, "high": 0.1}, "rover.mass_kg": {"low": 2.4, "high": 3.6}},
        "keep": {"figures": {"speed": "mean(estimate.speed_m_s)"}},
    }


@dataclass(frozen=True)
class Cost:
    """Of one campaign.

    Attributes:
        drives, failed: rows.
        wall_s: of the whole campaign, the start of its workers included.
        steady_per_s: drives a second from the first answer to the last, without the start; None of a single drive.
        workers_cpu_s: CPU time of the workers, their start included; parent_cpu_s: of the process that hands out rows and writes.
        first_MB, last_MB: resident memory of the parent at the first answer and at the last; 1 MB is 10^6 bytes.
        bytes_a_row: of the Parquet files.

    """

    drives: int
    failed: int
    wall_s: float
    steady_per_s: float | None
    workers_cpu_s: float
    parent_cpu_s: float
    first_MB: float
    last_MB: float
    bytes_a_row: float


def single(duration_s: float, count: int = SINGLE) -> tuple[float, float]:
    """CPU and wall time of one drive with its figure in this process, s: means over `count` rows, after one that is not counted."""
    spec = Spec.of(spec_of(count + 1, duration_s))
    job = Job.of(spec, "")
    run_row(job, spec.rows[0])
    cpu, wall = time.process_time(), time.perf_counter()
    for row in spec.rows[1:]:
        answer = run_row(job, row)
        if answer["status"] != "done":
            raise RuntimeError(f"a drive of the measurement failed: {answer['error']}")
    return (time.process_time() - cpu) / count, (time.perf_counter() - wall) / count


def _resident_MB() -> float:
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def _cpu_s(who: int) -> float:
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


def measure(drives: int, duration_s: float, workers: int) -> Cost:
    """Run a campaign from this process, into a folder that is removed; what this process used before is not counted."""
    seen: list[tuple[int, float, float]] = []

    def look(progress: Progress) -> None:
        seen.append((progress.done, time.perf_counter(), _resident_MB()))

    with tempfile.TemporaryDirectory() as folder:
        own, theirs, began = _cpu_s(resource.RUSAGE_SELF), _cpu_s(resource.RUSAGE_CHILDREN), time.perf_counter()
        result = campaign(spec_of(drives, duration_s), Path(folder) / "c", workers=workers, progress=look)
        wall_s = time.perf_counter() - began
        parent, crew = _cpu_s(resource.RUSAGE_SELF) - own, _cpu_s(resource.RUSAGE_CHILDREN) - theirs
        size = sum(part.stat().st_size for part in (result.folder / "results").iterdir())
        failed = result.status.failed
    (done, at, first), (last_done, last_at, last) = seen[0], seen[-1]
    steady = (last_done - done) / (last_at - at) if last_at > at else None
    return Cost(drives, failed, wall_s, steady, crew, parent, first, last, size / drives)


def parent(drives: int) -> tuple[float, float]:
    """CPU and wall time that the process which hands out rows and writes needs for a drive, s: of a campaign whose drives take no time.

    Its start and the first tenth of a second are left out.
    """
    table = spec_of(drives, 1.0)
    spec = Spec.of(table)
    answer = run_row(Job.of(spec, ""), spec.rows[0])
    seen: list[tuple[int, float, float]] = []
    own, pool.WORKER = (
        pool.WORKER,
        (f"import traction.campaigns.pool as p\nanswer = {answer!r}\np.run_row = lambda job, row: answer\np.serve()\n"),
    )
    try:
        with tempfile.TemporaryDirectory() as folder:
            campaign(table, Path(folder) / "c", progress=lambda p: seen.append((p.done, time.process_time(), time.perf_counter())))
    finally:
        pool.WORKER = own
    if len(seen) < 3:
        raise RuntimeError(f"{drives} drives are over at once: too few to time; give more")
    (first, cpu, wall), (last, last_cpu, last_wall) = seen[1], seen[-1]
    return (last_cpu - cpu) / (last - first), (last_wall - wall) / (last - first)


def _elsewhere(drives: int, duration_s: float, workers: int) -> Cost:
    """`measure` in a fresh process."""
    code = "import json, sys; from traction.campaigns import cost; print(json.dumps(vars(cost.measure(*json.loads(sys.argv[1])))))"
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    words = [sys.executable, "-c", code, json.dumps([drives, duration_s, workers])]
    done = subprocess.run(words, env=env, stdout=subprocess.PIPE, check=True)
    return Cost(**json.loads(done.stdout))


def _shares(cost: Cost, workers: int, before: tuple[float, float], after: tuple[float, float]) -> dict[str, float | None]:
    """Throughput as a share of workers x single run, by the single runs on both sides of it: with the start, and from the first answer on.

    By CPU time, which others on the machine disturb least: what a drive alone takes of what it takes in the campaign, parent included.
    """
    cpu, wall = (0.5 * (before[i] + after[i]) for i in (0, 1))
    return {
        "of_cores_x_single": cost.drives / cost.wall_s * wall / workers,
        "steady_of_cores_x_single": None if cost.steady_per_s is None else cost.steady_per_s * wall / workers,
        "cpu_of_single": cpu * cost.drives / (cost.workers_cpu_s + cost.parent_cpu_s),
    }


def main(arguments: list[str] | None = None) -> int:
    """Print the table; exit code 1 where a drive failed."""
    parser = argparse.ArgumentParser(prog="python -m traction.campaigns.cost", description="what a drive costs, alone and in campaigns")
    parser.add_argument("--drives", type=int, nargs="+", default=[10, 1000, 10000], metavar="N", help="of each campaign (10 1000 10000)")
    parser.add_argument("--duration", type=float, default=10.0, metavar="S", help="of a drive, simulated (10)")
    parser.add_argument("--workers", type=int, metavar="N", help="processes (one a core)")
    parser.add_argument("--rounds", type=int, default=1, metavar="N", help="each campaign so often, the sizes in turn (1)")
    parser.add_argument(
        "--parent", type=int, default=0, metavar="N", help="also of N drives that take no time: what the parent needs for one"
    )
    parser.add_argument("--json", metavar="FILE", help="the figures, schema traction.cost/1")
    given = parser.parse_args(arguments)
    cores = len(os.sched_getaffinity(0))
    workers = cores if given.workers is None else given.workers
    if min(given.drives) < 1 or workers < 1 or given.rounds < 1 or not given.duration > 0:
        parser.error("--drives, --workers, --rounds and --duration: give more than 0")
    load = os.getloadavg()[0]
    print(f"{cores} cores, {workers} workers, drives of {given.duration:g} s; load {load:.2f} before")
    if load > IDLE:
        print(f"the load is above {IDLE}: others use this machine, and what is by the wall clock is not its own; CPU time is")
    singles, costs = [single(given.duration)], list[Cost]()
    for drives in given.drives * given.rounds:
        costs.append(_elsewhere(drives, given.duration, workers))
        singles.append(single(given.duration))
    told = [f"{1e3 * cpu:.1f} ({1e3 * wall:.1f})" for cpu, wall in singles]
    print(f"the drive alone, CPU (wall) in ms, at first and after each campaign: {', '.join(told)}")
    print(
        f"{'drives':>7} {'wall s':>8} {'a second':>9} {'of cores x single':>18} {'steady':>7} {'by CPU':>7} {'CPU ms a drive':>15}", end=""
    )
    print(f" {'parent ms':>10} {'parent MB first':>16} {'last':>7} {'bytes a row':>12} {'failed':>7}")
    shares = [_shares(cost, workers, *singles[at : at + 2]) for at, cost in enumerate(costs)]
    for cost, share in zip(costs, shares, strict=True):
        print(f"{cost.drives:>7} {cost.wall_s:>8.2f} {cost.drives / cost.wall_s:>9.2f} {number(share['of_cores_x_single']):>18}", end="")
        print(f" {number(share['steady_of_cores_x_single']):>7} {number(share['cpu_of_single']):>7}", end="")
        print(f" {1e3 * cost.workers_cpu_s / cost.drives:>15.1f} {1e3 * cost.parent_cpu_s / cost.drives:>10.2f}", end="")
        print(f" {cost.first_MB:>16.1f} {cost.last_MB:>7.1f} {cost.bytes_a_row:>12.0f} {cost.failed:>7}")
    for drives in given.drives if given.rounds > 1 else ():
        of = [share for cost, share in zip(costs, shares, strict=True) if cost.drives == drives]
        middle = {
            key: median([value for share in of if (value := share[key]) is not None]) for key in ("of_cores_x_single", "cpu_of_single")
        }
        print(f"{drives} drives, median of {len(of)}: {number(middle['of_cores_x_single'])} of cores x single,", end="")
        print(f" {number(middle['cpu_of_single'])} by CPU time")
    about_parent: dict[str, Any] = {}
    if given.parent:
        cpu_s, wall_s = parent(given.parent)
        about_parent = {"parent": {"drives": given.parent, "cpu_s": cpu_s, "wall_s": wall_s}}
        print(f"the parent alone, {given.parent} drives that take no time: {1e3 * cpu_s:.3f} ms of CPU a drive, {1 / wall_s:.0f} a second")
    if given.json is not None:
        alone_ms = [{"cpu_s": cpu, "wall_s": wall} for cpu, wall in singles]
        rows = [asdict(cost) | share for cost, share in zip(costs, shares, strict=True)]
        about = {"schema": "traction.cost/1", "cores": cores, "workers": workers, "duration_s": given.duration, "load": load}
        Path(given.json).write_text(
            json.dumps({**about, "single": alone_ms, "campaigns": rows, **about_parent}, indent=1) + "\n", encoding="utf-8"
        )
    return 1 if any(cost.failed for cost in costs) else 0


if __name__ == "__main__":
    sys.exit(main())
