#!/usr/bin/env python3
"""elsewhere.py DIR [SHEAR]: plays the cluster. Makes the runs of the questions that `gate export DIR` wrote, as read_dump.py expects them: by stock
LAMMPS where `shear --export lammps` gives a deck, else by `shear` itself, whose dump has nine digits and no image flags."""
import json
import math
import os
import subprocess
import sys

from read_dump import NINE, PRESSURE, Flow, table, write


def by_lammps(shear, case, scene, run):
    """LAMMPS's dump as it is; the pressures of its thermo output, and the stresslets of drag in closed form, as a table. False where no deck of stock
    styles is the same scene, or where the pressure of pairs is that of two origins in one."""
    if scene["forces"].get("contact", {}).get("friction", 0) > 0 or not {"contact", "drag"} >= set(scene["forces"]):
        return False
    if subprocess.run([shear, os.path.join(case, "scene.json"), "--export", "lammps", run], capture_output=True).returncode != 0:
        return False
    subprocess.run(["lmp", "-in", "in.lammps", "-screen", "none"], cwd=run, check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    os.rename(os.path.join(run, "lammps.dump"), os.path.join(run, "dump.lammpstrj"))
    flow, eta, cubes = Flow(scene), scene["fluid"]["viscosity"], 0.0
    for row in table(os.path.join(case, scene["start"]["file"])):
        cubes += scene["species"][int(row["species"]) - 1]["radius"] ** 3
    rows = {}
    with open(os.path.join(run, "log.lammps")) as log:
        for line in log:
            words = line.split()
            if len(words) == 13 and words[0].isdigit():         # Step, pressure of pairs, kinetic pressure: xx yy zz xy xz yz each
                rows[int(words[0])] = words[1:]
    del rows[min(rows)]                                         # the step in which only the cell moved
    drag = [10 / 3 * math.pi * eta * cubes * (flow.gradient[i][k] + flow.gradient[k][i]) / flow.volume for i in range(3) for k in range(3)]
    header = ["step"] + [f"{o}_p{k}" for o in ("contact_normal", "kinetic") for k in PRESSURE] + ["drag_" + k for k in NINE]
    write(os.path.join(run, "stress.csv"), header, [[step, *pressures, *drag] for step, pressures in rows.items()])
    return True


def by_shear(shear, case, scene, run):
    output = scene["output"]
    every = [output[k]["every"] for k in ("states", "stress") if "every" in output.get(k, {})] + output.get("states", {}).get("at", [])
    command = [shear, os.path.join(case, "scene.json"), "-o", run, "--set", f"output.dump.every={math.gcd(*every)}"]
    return subprocess.run(command, stdout=subprocess.DEVNULL).returncode == 0


def main(folder, shear="build/shear"):
    made = {"LAMMPS": 0, "shear": 0}
    with open(os.path.join(folder, "questions.txt")) as questions:
        for line in questions:
            case = os.path.join(folder, line.split("\t")[0])
            run = os.path.join(os.path.dirname(case), "run")
            with open(os.path.join(case, "case.json")) as file:
                question = json.load(file)
            if question["protocol"] != "run" or os.path.exists(os.path.join(run, "dump.lammpstrj")):
                continue
            with open(os.path.join(case, question["scene"])) as file:
                scene = json.load(file)
            os.makedirs(run, exist_ok=True)
            made["LAMMPS" if by_lammps(shear, case, scene, run) else "shear"] += 1
            if not os.path.exists(os.path.join(run, "dump.lammpstrj")) and not by_shear(shear, case, scene, run):
                print("no run of", question["name"])
    print("runs made: " + ", ".join(f"{count} by {code}" for code, count in made.items()))


if __name__ == "__main__":
    main(*sys.argv[1:])
