"""`python -m traction.campaigns FILE.toml --out FOLDER`: what `traction campaign` runs."""

from __future__ import annotations

import argparse
import json
import os
import sys
from typing import Any

from .._errors import FileError, InputError
from .._extras import extra
from . import Campaign, campaign, read_plan
from .picture import check_ending
from .run import bar
from .sensitivity import Sensitivity


def _write(
    file: str | None,
    title: str,
    folder: str | None,
    drives: int,
    done: int,
    failed: int,
    picture: str | None = None,
    effects: Sensitivity | None = None,
) -> None:
    if file is None:
        return
    about: dict[str, Any] = {"schema": "traction.campaign/1", "title": title, "folder": folder}
    about |= {"drives": drives, "done": done, "failed": failed}
    if effects is not None:
        about |= {"plot": picture, "sensitivity": effects.json}
    with open(file, "w", encoding="utf-8") as stream:
        json.dump(about, stream)


def _told(result: Campaign, file: str | None, picture: str | None = None, table: str | None = None) -> int:
    status = result.status
    failed = f", {status.failed} of them failed (column `error`)" if status.failed else ""
    print(f"{result.title}: {status.done} of {status.total} drives{failed}, in {result.folder}/results")
    for one in result.tables():
        print("\n" + one.text + (f"{one.missing} logs are not in it, for their program failed\n" if one.missing else ""), end="")
        if table is not None:
            with open(table, "w", encoding="utf-8") as stream:
                json.dump(one.json, stream)
    effects = None
    if picture is not None:
        effects = result.plot(picture)
        print(effects.text)
    _write(file, result.title, str(result.folder), status.total, status.done, status.failed, picture, effects)
    return 1 if status.failed else 0


def main(arguments: list[str] | None = None) -> int:
    """Exit codes as the command line's: 0 done, 1 some drives failed, 2 wrong command line, 3 bad input, 4 file error, 130 stopped."""
    parser = argparse.ArgumentParser(prog="traction campaign", description="many drives from one file, into one table (docs/campaign.md)")
    parser.add_argument("spec", nargs="?", metavar="FILE.toml", help="what varies, and what is kept of each drive")
    parser.add_argument("--out", metavar="FOLDER", help="where results go; a stopped campaign goes on there")
    parser.add_argument("--workers", type=int, metavar="N", help="processes (one a core)")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="a Dask scheduler, tcp://HOST:PORT: its workers drive")
    parser.add_argument("--status", action="store_true", help="how far the campaign in FOLDER is; drives nothing")
    parser.add_argument(
        "--plot", metavar="FILE", help="a picture of the drives that are done, .svg or .png; without FILE.toml drives nothing"
    )
    parser.add_argument("--dry-run", action="store_true", help="the number of drives, and the first rows; drives nothing")
    parser.add_argument("--table-json", help=argparse.SUPPRESS)  # of traction bench lab --out: traction.bench_lab/1
    parser.add_argument("--json", metavar="FILE", help="the result for programs, schema traction.campaign/1")
    given = parser.parse_args(arguments)
    if given.workers is not None and given.workers < 0:
        parser.error("--workers: give 0 (this process alone) or more")
    if not (given.status or given.plot) and given.spec is None:
        parser.error("FILE.toml is missing")
    if given.out is None and not given.dry_run:
        parser.error("--out is missing")
    try:
        if given.plot is not None:
            check_ending(given.plot)
            extra("matplotlib", "plot")  # before the drives, not after them
            extra("SALib", "plot")
        if given.plot is not None and given.spec is None:
            _told(Campaign(given.out), given.json, given.plot)
            return 0  # the picture counts what failed
        if given.status:
            return _told(Campaign(given.out), given.json)
        spec = read_plan(given.spec)
        if given.dry_run:
            print(f"{spec.title}: {len(spec.rows)} drives")
            for row in spec.rows[:5]:
                print("  " + ", ".join(f"{key}={value}" for key, value in row.items()))
            _write(given.json, spec.title, None, len(spec.rows), 0, 0)
            return 0
        result = campaign(spec, given.out, workers=given.workers, scheduler=given.scheduler, progress=bar(spec.title))
        return _told(result, given.json, given.plot, given.table_json)
    except KeyboardInterrupt:
        print("\nstopped; the same command goes on where it was", file=sys.stderr)
        return 130
    except InputError as error:
        print(f"traction: {error}", file=sys.stderr)
        return 4 if isinstance(error, FileError) else 3
    except ImportError as error:
        print(f"traction: {error}", file=sys.stderr)
        return 4
    except OSError as error:
        print(f"traction: {error.filename or given.out}: {os.strerror(error.errno or 0)}", file=sys.stderr)
        return 4


if __name__ == "__main__":
    sys.exit(main())
