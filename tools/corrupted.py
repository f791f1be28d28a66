#!/usr/bin/env python3
"""Right answers, spoilt on the way: does the gate notice that a table is short, empty, late, or not there?

    tools/corrupted.py [WORD]       ask for each file and each way to spoil it one case that reads it; WORD: those with this word in them

Every line must say FAIL. Our solver answers; what it wrote is then changed, as a candidate might write it: without rows, without the first or the second half of
them, without the last, with steps between the steps, with times half as long again, with one number of one row off by a thousandth, or not at all. An answer that
is whole, of a program that then ends with an error, is no answer.
"""
import os, subprocess, sys

WAYS = "header first-half second-half last-row between-steps times one-number missing".split()
FILES = {                               # file: a case that reads it
    "temperature.csv": "observers", "contacts.csv": "observers", "viscosity.csv": "observers", "stress.csv": "observers", "brownian_stress.csv": "observers",
    "displacement.csv": "observers", "velocity_correlation.csv": "observers", "pair_distribution.csv": "observers", "pair_plane.csv": "observers",
    "averages.csv": "observers", "green_kubo.csv": "observers-at-rest", "trajectory.csv": "stages",
}
MORE = [("stress.csv", "header", case) for case in ("stages", "stages-drawn", "sweeps-or-global", "flat", "metamorphic", "random-start")]
MORE += [("stress.csv", "first-half", case) for case in ("stages", "stages-drawn", "sweeps-or-global", "flat", "metamorphic")]
MORE += [("displacement.csv", "first-half", "stages"), ("viscosity.csv", "first-half", "stages"), ("trajectory.csv", "species", "stages")]
MORE += [(file, "header", "resume") for file in ("averages.csv", "displacement.csv")] + [(file, "header", "resume-at-rest") for file in ("temperature.csv", "contacts.csv")]
MORE += [("*", "error", case) for case in ("noise-torque-off", "virial", "encounter", "lubrication-forces")]
HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
BUILD = os.environ.get("BUILD", os.path.join(HERE, "..", "build"))


def spoil(path, way):
    lines = open(path).read().splitlines()
    comments = [line for line in lines if line.startswith("#")]
    header, *rows = [line for line in lines if not line.startswith("#")]
    names = header.split(",")

    def each(column, change):
        at = names.index(column)
        return [",".join(change(v) if k == at else v for k, v in enumerate(row.split(","))) for row in rows]
    middle = len(rows) // 2
    if way == "missing":
        return os.remove(path)
    if way == "header":
        rows = []
    elif way == "first-half":
        rows = rows[:middle]
    elif way == "second-half":
        rows = rows[middle:]
    elif way == "last-row":
        rows = rows[:-1]
    elif way == "between-steps":
        rows = each("step", lambda v: repr(float(v) + 0.5))
    elif way == "times":
        rows = each("time", lambda v: repr(float(v) * 1.5 + 1e-3))
    elif way == "species":
        rows = each("species", lambda v: "2")
    elif way == "one-number":
        cells = rows[middle].split(",")
        number = max((k for k in range(len(cells)) if names[k] not in ("step", "time", "id", "species", "species_a", "species_b", "lag", "kind", "quantity", "U")
                      and float(cells[k]) != 0), key=lambda k: names[k] in ("count", "mean"))
        cells[number] = repr(float(cells[number]) * 1.001 + (1 if names[number] == "count" else 0))
        rows[middle] = ",".join(cells)
    with open(path, "w") as out:
        out.write("\n".join(comments + [header] + rows) + "\n")


def answer(way, file, case, out):
    code = subprocess.call([os.path.join(BUILD, "shear"), "--evaluate", case, out])
    path = os.path.join(out, file)
    if code == 0 and way == "error":
        code = 1
    elif code == 0 and os.path.exists(path):
        spoil(path, way)
    return code


def main(word):
    fits = {"between-steps": lambda f: f not in ("displacement.csv", "velocity_correlation.csv", "pair_distribution.csv", "pair_plane.csv", "averages.csv", "green_kubo.csv")}
    fits["times"] = fits["between-steps"]
    trials = [(file, way, case) for file, case in FILES.items() for way in WAYS if fits.get(way, lambda f: True)(file)] + MORE
    wrong = 0
    for file, way, case in trials:
        name = f"{file} {way} {case}"
        if word not in name:
            continue
        command = f"{os.path.abspath(sys.argv[0])} --answer {way} '{file}'"
        run = subprocess.run([os.path.join(BUILD, "gate"), "run", "--candidate", command, "--case", case, "--work", os.path.join(BUILD, "corrupted", "cases"),
                              "--report", os.path.join(BUILD, "corrupted", "report")], capture_output=True, text=True)
        seen = run.returncode == 1
        wrong += not seen
        said = [line.strip() for line in run.stdout.splitlines() if line.strip().startswith("fails:")]
        print(f"{'ok   ' if seen else 'WRONG'} {file:25} {way:14} {case:18} {said[0][7:107] if said else 'exit code %d' % run.returncode}", flush=True)
    print(f"corrupted: {len([t for t in trials if word in ' '.join(t)])} spoilt answers, {wrong} not noticed")
    return wrong != 0


if len(sys.argv) == 6 and sys.argv[1] == "--answer":
    sys.exit(answer(*sys.argv[2:]))
sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else ""))
