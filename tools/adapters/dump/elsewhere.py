#!/usr/bin/env python3
"""elsewhere.py DIR [SHEAR]: plays the cluster. Makes the runs of the questions that `gate export DIR` wrote, as read_dump.py expects them: by stock
LAMMPS where `shear --export lammps` gives a deck, else by `shear` itself, whose dump has nine digits and no image flags."""
import csv
import json
import math
import os
import subprocess
import sys


def by_lammps(shear, case, run):
    """LAMMPS's dump as it is, and the pressures of its thermo output as a table."""
    if subprocess.run([shear, os.path.join(case, "scene.json"), "--export", "lammps", run], capture_output=True).returncode != 0:
        return False
    subprocess.run(["lmp", "-in", "in.lammps", "-screen", "none"], cwd=run, check=True, stdin=subprocess.DEVNULL)
    os.rename(os.path.join(run, "lammps.dump"), os.path.join(run, "dump.lammpstrj"))
    rows, reading = [], False
    for line in open(os.path.join(run, "log.lammps")):
        words = line.split()
        if words[:1] == ["Step"]:
            header, reading = words, True
        elif reading and words[:1] and words[0].isdigit():
            rows.append(words)
        else:
            reading = False
    print(header)
    return True


def by_shear(shear, case, scene, run):
    output = scene["output"]
    every = [output[k]["every"] for k in ("states", "stress") if "every" in output.get(k, {})] + output.get("states", {}).get("at", [])
    subprocess.run([shear, os.path.join(case, "scene.json"), "-o", run, "--set", f"output.dump.every={math.gcd(*every)}"], check=True, stdout=subprocess.DEVNULL)
