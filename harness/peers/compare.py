#!/usr/bin/env python3
"""Runs the same problem alternately in riprap and in a peer, and compares their CPU times: a dam break in free water against
PySPH, and polyhedral boxes that settle in a tray against Yade. Prints a table, and writes it to a file with --json.

    harness/peers/compare.py [--rounds N] [--json FILE] [dam] [boxes]

Times are CPU times of the process with all of its threads, differences between two numbers of steps, so that start-up and
compilation cancel. Installs PySPH into <target>/peers, and Yade with apt-get if it is missing; riprap itself needs neither.
"""
import argparse
import json
import math
import os
import random
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
TARGET = os.path.join(ROOT, os.environ.get("CARGO_TARGET_DIR", "target"))
PYSPH = "pysph==1.0b2"
RIPRAP = os.path.join(TARGET, "release/riprap")

# Lengths in m. `steps` are riprap steps, between which the time is taken; each contains two steps of the water.
DAM = {"tank": [0.8, 0.4, 0.6], "column": [0.4, 0.4, 0.5], "spacing": 0.02, "smoothing": 2.0, "steps": [20, 120]}
# The contact force is `stiffness` (N/m³) times the area and the depth of a contact, which is the overlap volume.
BOXES = {"edges": [0.1, 0.08, 0.06], "tray": [0.64, 0.56], "count": [4, 4, 6], "gap": 0.01, "stiffness": 1e8,
         "friction": 35, "time_step": 4e-5, "steps": 6500}


def cpu_seconds(command, **more):
    """CPU time of a command and its child processes, and its output."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(command)}:\n{done.stdout}{done.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime, done.stdout


def write(folder, name, text):
    path = os.path.join(folder, name)
    with open(path, "w") as file:
        file.write(text)
    return path


def riprap(folder, scene, steps):
    """CPU seconds, summary and output folder of a run of `steps` steps."""
    out = os.path.join(folder, f"riprap_{steps}")
    seconds, _ = cpu_seconds([RIPRAP, "run", scene, "--steps", str(steps), "--out", out])
    with open(os.path.join(out, "summary.json")) as file:
        return seconds, json.load(file), out


def last_row(out, name):
    with open(os.path.join(out, name)) as file:
        rows = file.read().split()
    return dict(zip(rows[0].split(","), map(float, rows[-1].split(","))))


def pysph():
    """The Python interpreter of an environment with PySPH."""
    python = os.path.join(TARGET, "peers/bin/python")
    ready = os.path.exists(python) and subprocess.run([python, "-c", "import pysph"]).returncode == 0
    if not ready:
        subprocess.run([sys.executable, "-m", "venv", "--clear", os.path.join(TARGET, "peers")], check=True)
        subprocess.run([python, "-m", "pip", "--quiet", "install", PYSPH], check=True)
    return python


def between(runs):
    """CPU seconds per step from two runs, each given by its CPU seconds and its number of steps."""
    (start, first), (end, last) = runs
    return (end - start) / (last - first)


def dam(rounds):
    """A dam break in both programs, with equal particles, neighbours, kernel, speed of sound and steps."""
    python = pysph()
    tank, column = DAM["tank"], DAM["column"]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        walls = "".join(f'{face} = {{ kind = "wall" }}\n' for face in ("x_min", "x_max", "y_min", "y_max", "z_min"))
        scene = write(folder, "dam.toml", f"""
title = "A column of water collapses"
domain = {{ size = {tank} }}
fluid = {{ acceleration = [0, 0, -9.81] }}
particles = {{ spacing = {DAM["spacing"]}, smoothing = {DAM["smoothing"]} }}
water = [{{ kind = "box", size = {column}, position = {[edge / 2 for edge in column]} }}]
run = {{ duration = 10 }}
output = {{ every = 10 }}
[[probes]]
name = "front"
kind = "run_up"
min = [0, 0, 0]
max = [{tank[0]}, {tank[1]}, {column[2]}]
direction = "+x"
every = 0.001
[boundaries]
z_max = {{ kind = "open" }}
{walls}""")
        for turn in range(rounds):
            own, theirs = [], []
            for steps in DAM["steps"]:
                seconds, summary, out = riprap(folder, scene, steps)
                own.append((seconds, summary["pool"]["acoustic_steps"]))
            pool = summary["pool"]
            setup = {**DAM, "sound_speed": pool["sound_speed"], "time_step": summary["time"] / pool["acoustic_steps"]}
            setup = write(folder, "dam.json", json.dumps(setup))
            # The first round also compiles PySPH.
            for steps in [1] * (turn == 0) + [steps for _, steps in own]:
                command = [python, os.path.join(HERE, "pysph_dam.py"), setup, "--openmp", "--max-steps", str(steps)]
                command += ["--disable-output", "--quiet", "-d", os.path.join(folder, "pysph")]
                seconds, text = cpu_seconds(command)
                theirs.append((seconds, steps))
            found = json.loads(text.splitlines()[-1])
            rows.append({
                "riprap": between(own), "peer": between(theirs[-2:]), "time": summary["time"], "steps": own[1][1],
                "riprap_particles": pool["particles"] + pool["shell"],
                "peer_particles": found["particles"] + found["boundary_particles"],
                "riprap_front": last_row(out, "front.csv")["x"], "peer_front": found["front"],
            })
    return rows


def boxes(rounds):
    """Boxes that fall into a tray in both programs, with equal boxes, stiffness per volume and steps."""
    if not shutil.which("yade"):
        subprocess.run(["apt-get", "update", "-qq"], check=True)
        subprocess.run(["apt-get", "install", "-qq", "--no-install-recommends", "yade"], check=True, stdout=subprocess.DEVNULL)
    edges, tray, gap, count = (BOXES[key] for key in ("edges", "tray", "gap", "count"))
    chance = random.Random(1)
    blocks = []
    for n in range(math.prod(count)):
        at = [n % count[0], n // count[0] % count[1], n // (count[0] * count[1])]
        centre = [(at[k] + 0.5) * tray[k] / count[k] for k in (0, 1)] + [(at[2] + 0.5) * (edges[0] + gap)]
        axis = [chance.gauss(0, 1) for _ in range(3)]
        size = math.hypot(*axis)
        blocks.append({"position": centre, "axis": [a / size for a in axis], "angle": chance.uniform(0, 0.5)})
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        text = f"""
title = "Boxes settle in a tray"
rock = {{ gravity = [0, 0, -9.81], corner_area = 0.25, time_step = {BOXES["time_step"]} }}
materials = [{{ name = "rock", density = 2650, normal_stiffness = {BOXES["stiffness"]}, friction = {BOXES["friction"]}, damping = 0.3 }}]
run = {{ duration = 10 }}
output = {{ every = 10, histories = [{{ quantities = ["contacts", "block_max_speed"], every = {10 * BOXES["time_step"]} }}] }}
"""
        x, y = tray
        walls = [([-1, -1, -1], [x + 1, y + 1, 0]), ([-1, -1, 0], [0, y + 1, 2]), ([x, -1, 0], [x + 1, y + 1, 2]),
                 ([0, -1, 0], [x, 0, 2]), ([0, y, 0], [x, y + 1, 2])]
        for low, high in walls:
            text += f'[[solids]]\nkind = "box"\nmin = {low}\nmax = {high}\n'
        for block in blocks:
            turn = f"{{ axis = {block['axis']}, angle = {math.degrees(block['angle'])} }}"
            text += f'[[blocks]]\nkind = "box"\nsize = {edges}\nposition = {block["position"]}\nrotation = {turn}\n'
        scene = write(folder, "boxes.toml", text)
        setup = write(folder, "boxes.json", json.dumps({**BOXES, "blocks": blocks}))
        for _ in range(rounds):
            own = []
            for steps in (1, BOXES["steps"]):
                seconds, summary, out = riprap(folder, scene, steps)
                own.append((seconds, steps))
            result = os.path.join(folder, "yade.json")
            cpu_seconds(["yade", "-n", "-x", "-j1", os.path.join(HERE, "yade_boxes.py"), setup, result])
            with open(result) as file:
                found = json.load(file)
            with open(os.path.join(out, "history.csv")) as file:
                history = [row.split(",") for row in file.read().split()]
            column = history[0].index("contacts")
            contacts = [float(row[column]) for row in history[1:]]
            rows.append({
                "riprap": between(own), "peer": found["seconds"] / BOXES["steps"],
                "riprap_contacts": statistics.mean(contacts), "peer_contacts": found["contacts"],
                "riprap_speed": last_row(out, "history.csv")["block_max_speed"], "peer_speed": found["speed"],
                "peer_lowest": found["lowest"],
            })
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--json", metavar="FILE")
    parser.add_argument("cases", nargs="*", metavar="CASE", help="dam, boxes; both without any")
    arguments = parser.parse_args()
    subprocess.run(["cargo", "build", "--quiet", "--release", "-p", "riprap-harness"], cwd=ROOT, check=True)
    commit = subprocess.run(["git", "rev-parse", "--short=12", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout.strip()
    cases = {"dam": dam, "boxes": boxes}
    made = {case: cases[case](arguments.rounds) for case in arguments.cases or cases}
    for case, rows in made.items():
        ratios = sorted(row["peer"] / row["riprap"] for row in rows)
        print(f"{case}: the peer takes {statistics.median(ratios):.2f} times the CPU time ({ratios[0]:.2f} to {ratios[-1]:.2f})")
        for row in rows:
            print("   ", ", ".join(f"{name} {value:.4g}" for name, value in row.items()))
    if arguments.json:
        with open(arguments.json, "w") as file:
            json.dump({"commit": commit, "cores": os.cpu_count(), **made}, file, indent=1)
            file.write("\n")


if __name__ == "__main__":
    main()
