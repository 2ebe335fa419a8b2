#!/usr/bin/env python3
"""Is a better model better on drives that it has not seen? Measured floors, trained on some directions, judged on the others.

For every floor and every direction of the omni robot's runs (`../shared/data/robotino`, docs/case_robotino.md): `traction diagnose --apply`
learns from that one direction (or, with --halves, from every second one as one data set), and the model as stated, the same model
fitted without an effect, and the model with what was named are judged on the directions that took no part, nothing free but offsets.

    python3 tests/bench/measured_floors.py --program build/host/host_tools/cli/traction --data ../shared/data/robotino
    python3 tests/bench/measured_floors.py ... --floor one_gray_v0.1 --halves --json FILE

A row a training: error in units of the sensors' noise (mean over the judged drives) of the three models, the ratio of the last two,
the names. *worse*: the result is more than 2 % worse than the plain fit (the goal: none). *bare*: an effect of the machine, named
without its class or tolerance, whose size no machine has: a radius more than 20 % off, a torque constant 30 %, a camera's scale 15 % (the goal: none).
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

FLOORS = {  # prefix of the files: models that an operator would take for that floor
    'one_table_v0.1': ['robotino'],
    'one_gray_v0.1': ['robotino', 'robotino_carpet'],
    'one_gray_v0.2': ['robotino', 'robotino_carpet'],
    'load_gray_ballast_v0.1': ['robotino', 'robotino_carpet'],
    'one_brown_v0.1': ['robotino', 'robotino_carpet'],
    'one_green_v0.1': ['robotino', 'robotino_carpet'],
}
IMPLAUSIBLE = {'wheel_radius': 0.20, 'torque_constant': 0.30, 'camera_scale': 0.15}  # relative: no part that works is so far off
WORSE = 1.02


def train(options, floor, model, logs, others):
    """One training: the JSON of `diagnose --apply`, or the words of its refusal."""
    with tempfile.TemporaryDirectory() as folder:
        answer, better = os.path.join(folder, 'answer.json'), os.path.join(folder, 'better.toml')
        command = [options.program, 'diagnose', '--model', f'models/{model}.toml', '--map', 'models/maps/robotino.toml', '--quiet']
        for log in logs:
            command += ['--log', log]
        command += ['--apply', '--out', better, '--json', answer, '--validate', *others]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode not in (0, 1) or not os.path.exists(answer):
            return {'refused': (done.stderr or done.stdout).strip().splitlines()[:1]}
        with open(answer, encoding='utf-8') as file:
            return json.load(file)


def row_of(floor, model, logs, answer):
    """What is told of one training."""
    row = {'floor': floor, 'model': model, 'trained_on': [os.path.basename(log) for log in logs]}
    if 'refused' in answer:
        return row | {'refused': answer['refused']}
    judged = [drive for drive in answer['validation'] if not drive['left_out']]
    mean = {key: sum(drive[key] for drive in judged) / len(judged) for key in ('stated', 'fitted', 'result')}
    classes = [member for group in answer['classes'] for member in group['members']]
    names = [{'effect': effect['effect'], 'wheel': effect.get('wheel'), 'size': [p['value'] for p in effect['parameters'].values()],
              'alone': effect['effect'] not in classes} for effect in answer['accepted']]
    bare = [name['effect'] for name in names
            if name['alone'] and name['size'] and abs(name['size'][0]) > IMPLAUSIBLE.get(name['effect'], float('inf'))]
    return row | mean | {'verdict': answer['verdict']['kind'], 'names': names, 'bare': bare,
                         'worse': bool(names) and mean['result'] > WORSE * mean['fitted']}


def trainings(options):
    """(floor, model, logs to learn from, logs to judge on) of every row."""
    for floor, models in FLOORS.items():
        if options.floor and floor not in options.floor:
            continue
        logs = sorted(os.path.join(options.data, name) for name in os.listdir(options.data) if name.startswith(floor + '_dir'))
        if not logs:
            sys.exit(f'measured_floors: no {floor}_dir*.csv in {options.data}; give --data, the folder of the robot\'s runs')
        sets = [logs[::2], logs[1::2]] if options.halves else [[log] for log in logs]
        for model in models:
            for chosen in sets:
                yield floor, model, chosen, [log for log in logs if log not in chosen]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--program', default='build/host/host_tools/cli/traction', help='the traction to judge')
    parser.add_argument('--data', default='../shared/data/robotino', help="the folder of the robot's runs")
    parser.add_argument('--floor', action='append', help='this floor alone (may be repeated): ' + ', '.join(FLOORS))
    parser.add_argument('--halves', action='store_true', help='learn from every second direction as one data set')
    parser.add_argument('--jobs', type=int, default=1)
    parser.add_argument('--json', help='write all rows to this file')
    options = parser.parse_args()
    if not os.path.isdir(options.data):
        sys.exit(f'measured_floors: no folder {options.data}; give --data, the folder of the robot\'s runs')
    rows = []
    with ThreadPoolExecutor(options.jobs) as pool:
        jobs = [(pool.submit(train, options, *job), job) for job in trainings(options)]
        for job, (floor, model, logs, _) in jobs:
            row = row_of(floor, model, logs, job.result())
            rows.append(row)
            tail = os.path.basename(logs[0])[-10:-4] if len(logs) == 1 else f'{len(logs)} runs'
            if 'refused' in row:
                print(f'{floor:24} {model:16} {tail:7} refused: {row["refused"]}', flush=True)
                continue
            words = ', '.join(n['effect'] + (f' {n["size"][0]:+.3g}' if n['size'] else '') + ('' if n['alone'] else ' (class)') for n in row['names'])
            flags = ' WORSE' * row['worse'] + ' BARE' * bool(row['bare'])
            print(f'{floor:24} {model:16} {tail:7} {row["stated"]:6.2f} {row["fitted"]:6.2f} {row["result"]:6.2f} '
                  f'{row["result"] / row["fitted"]:5.2f}{flags}  {row["verdict"]}: {words}', flush=True)
    judged = [row for row in rows if 'refused' not in row]
    named = [row for row in judged if row['names']]
    print(f'{len(rows)} trainings, {len(rows) - len(judged)} refused, {len(named)} named something: worse than the plain fit by 2 % '
          f'{sum(row["worse"] for row in named)}, implausible bare name {sum(bool(row["bare"]) for row in named)}')
    if options.json:
        with open(options.json, 'w', encoding='utf-8') as file:
            json.dump(rows, file, indent=1)


if __name__ == '__main__':
    main()
