#!/usr/bin/env python3
"""Several runs of one machine, diagnosed together: what clean and hidden logs of the independent generator are told.

  python3 tests/bench/several_runs.py --build build/host --generator fleet --category clean --runs 2 --seeds 941000 941011

Each machine drives --runs times (lab_generate --runs): other plan, place and noise, an accelerometer and a gyro with another offset each time.
`traction diagnose` gets the logs, their maps and the data sheet; the seals are opened when every log is answered.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/host", help="folder of the built programs")
    parser.add_argument("--program", help="another traction, such as one before a change")
    parser.add_argument("--generator", default="fleet", choices=["apart", "fleet", "strange", "bent"])
    parser.add_argument("--category", default="clean", choices=["clean", "one", "two", "outside"])
    parser.add_argument("--runs", type=int, default=2)
    parser.add_argument("--seeds", type=int, nargs=2, required=True, metavar=("FIRST", "LAST"))
    return parser.parse_args()


def answer(asked, seed, folder):
    """The verdict on one machine's runs; its seal stays closed in the folder."""
    kind = ["--apart", "--blind"] if asked.generator == "apart" else ["--" + asked.generator]
    log, model, seal = folder / f"{seed}.csv", folder / f"{seed}.toml", folder / f"{seed}.seal"
    subprocess.run([asked.generate, *kind, "--category", asked.category, "--seed", str(seed), "--runs", str(asked.runs),
                    "--out", log, "--model", model, "--seal", seal], check=True, stdout=subprocess.DEVNULL)
    logs = [log] + [pathlib.Path(f"{log}.{run}.csv") for run in range(2, asked.runs + 1)]
    maps = [pathlib.Path(f"{one}.map.toml") for one in logs]
    command = [asked.program, "diagnose", "--model", model, "--json", "-", "--quiet"]
    for one, its_map in zip(logs, maps):
        command += ["--log", one] + (["--map", its_map] if its_map.exists() else [])
    told = subprocess.run(command, capture_output=True, text=True)
    for one in logs:
        one.unlink()
    if not told.stdout.strip():  # the check refused a log, or the program failed
        return {"verdict": {"kind": "refused"}, "accepted": [], "text": told.stderr.strip()[:200]}
    return json.loads(told.stdout)


def members(found):
    """Every name that is told, with those it cannot be told from."""
    names = {one["effect"] for one in found["accepted"]}
    for one in found.get("classes", []):
        names |= {name.split(" on wheel")[0] for name in one["members"]}
    return names


def main():
    asked = options()
    build = pathlib.Path(asked.build)
    asked.generate = build / "tests/lab/generator/lab_generate"
    asked.program = asked.program or build / "host_tools/cli/traction"
    seeds = range(asked.seeds[0], asked.seeds[1] + 1)
    counts = {"nothing": 0, "named": 0, "right": 0, "wrong_model": 0, "refused": 0}
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        found = {seed: answer(asked, seed, folder) for seed in seeds}
        for seed in seeds:
            seal = json.loads((folder / f"{seed}.seal").read_text())
            hidden = [one["name"] for one in seal["effects"]]
            kind = found[seed]["verdict"]["kind"]
            told = members(found[seed])
            counts["nothing"] += kind == "nothing"
            counts["refused"] += kind == "refused"
            counts["wrong_model"] += kind == "wrong_model"
            counts["named"] += bool(told)
            counts["right"] += bool(told) and any(name in told for name in hidden)
            print(seed, seal["soil"], seal["drive"], "hidden:", ", ".join(hidden) or "nothing", "| told:", kind, ", ".join(sorted(told)))
    print(f"{len(seeds)} machines, {asked.runs} runs each: {counts['nothing']} told nothing, {counts['named']} told a name, "
          f"{counts['right']} of these the hidden one (or its class), {counts['wrong_model']} a wrong model, {counts['refused']} refused")


if __name__ == "__main__":
    main()
