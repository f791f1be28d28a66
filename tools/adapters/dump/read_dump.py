#!/usr/bin/env python3
"""read_dump.py [--runs DIR] CASE_DIR OUT_DIR: finished runs as a candidate of the gate at level C (docs/adapter.md). The run of a question is a
folder `run` beside its `case`, or DIR/<name in case.json>/run:

  dump.lammpstrj   LAMMPS text dump with id, x y z, vx vy vz, and omegax omegay omegaz where spheres turn. With ix iy iz the frames may lie
                   as far apart as they like; without, near enough for no sphere to stray a quarter of a cell from where its velocity takes it.
                   xu yu zu in place of x y z will do at rest only: in a flow vx is that of the wrapped sphere, which is not in the file.
  stress.csv       `step` and per origin nine columns <origin>_xx ... <origin>_zz in tension, or six of pressure, <origin>_pxx pyy pzz pxy pxz
                   pyz, as codes print them. Origins: docs/adapter.md.

The first frame is the start, whatever its TIMESTEP. Time, flow and lattice come from the scene: in LAMMPS the cell that forces
see and the cell in the dump differ by a step (docs/lammps.md).
"""
import csv
import json
import os
import sys

PRESSURE = "xx yy zz xy xz yz".split()
NINE = [a + b for a in "xyz" for b in "xyz"]
ORIGINS = "contact_normal contact_tangential repulsion lubrication drag lubrication_noise kinetic".split()


def refuse(reason):
    print("this reader has no " + reason)
    sys.exit(77)


def matrix(rows, v):
    return [sum(a * b for a, b in zip(row, v)) for row in rows]


def inverse(m):
    """Of three rows."""
    cross = lambda a, b: (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    a, b, c = zip(*m)
    volume = sum(p * q for p, q in zip(a, cross(b, c)))
    return [[x / volume for x in cross(p, q)] for p, q in ((b, c), (c, a), (a, b))]


def table(path):
    with open(path, newline="") as lines:
        yield from csv.DictReader(line for line in lines if not line.startswith("#"))


class Flow:
    """The scene's lattice, H(t) = (1 + G t + G G t^2/2) H(0), cell vectors in columns, and its velocity gradient G."""

    def __init__(self, scene):
        box = scene["box"]
        self.cell = [list(c) for c in zip(*box["cell"])] if "cell" in box else [[box["lengths"][i] * (i == k) for k in range(3)] for i in range(3)]
        self.gradient = [[0.0] * 3 for _ in range(3)]
        for shear in scene.get("shear", []):
            self.gradient["xyz".index(shear["flow"])]["xyz".index(shear["gradient"])] += shear["rate"]
        a, b, c = zip(*self.cell)
        self.volume = abs(sum(p * (b[i - 2] * c[i - 1] - b[i - 1] * c[i - 2]) for i, p in enumerate(a)))
        self.rate = max((abs(s["rate"]) for s in scene.get("shear", [])), default=0.0)

    def carry(self, x, time):
        """Where the flow takes a place in that time."""
        gx = matrix(self.gradient, x)
        return [p + time * q + 0.5 * time * time * r for p, q, r in zip(x, gx, matrix(self.gradient, gx))]

    def lattice(self, time):
        return [list(row) for row in zip(*(self.carry(c, time) for c in zip(*self.cell)))]


def frames(path):
    """(TIMESTEP, cell vectors in columns, {id: {column: number}}) of a LAMMPS text dump."""
    with open(path) as lines:
        for line in lines:
            if not line.startswith("ITEM: TIMESTEP"):
                continue
            step = int(next(lines))
            next(lines)
            count = int(next(lines))
            next(lines)
            bounds = [[float(v) for v in next(lines).split()] for _ in range(3)]
            xy, xz, yz = [(b + [0.0])[2] for b in bounds]
            width = [bounds[0][1] - bounds[0][0] - max(0, xy, xz, xy + xz) + min(0, xy, xz, xy + xz),      # bounds are those of a box around
                     bounds[1][1] - bounds[1][0] - max(0, yz) + min(0, yz), bounds[2][1] - bounds[2][0]]  # the tilted cell
            names = next(lines).split()[2:]
            rows = [dict(zip(names, next(lines).split())) for _ in range(count)]
            yield step, [[width[0], xy, xz], [0.0, width[1], yz], [0.0, 0.0, width[2]]], {int(r["id"]): {k: float(r[k]) for k in names if k != "element"} for r in rows}


class Path:
    """One sphere, followed as if it had never been put back into the cell."""

    def __init__(self, row):
        self.species, self.time = row["species"], None
        self.x, self.c, self.shift = [float(row[k]) for k in "xyz"], [0.0] * 3, [0.0] * 3

    def follow(self, flow, time, cell, row):
        """Its place, from the lattice points that image flags count, or else the image nearest to where it was heading."""
        x = [row[k] for k in ("x", "y", "z")] if "x" in row else [row[k] for k in ("xu", "yu", "zu")]
        lattice = flow.lattice(time)
        back, counted = inverse(lattice), [0.0] * 3
        if "ix" in row:             # flags count vectors of the dump's own cell, each a whole number of ours but for that step
            own = [[round(v) for v in matrix(back, column)] for column in zip(*cell)]
            counted = matrix(list(zip(*own)), [row["ix"], row["iy"], row["iz"]])
        first = self.time is None
        if first or "ix" not in row:
            drift = 0 if first else time - self.time
            heading = [p + drift * q for p, q in zip(flow.carry(self.x, drift), self.c)]
            away = matrix(back, [p - q for p, q in zip(heading, x)])
            self.shift = [round(a) - n for a, n in zip(away, counted)]
            if max(abs(a - round(a)) for a in away) > 0.25:
                sys.exit(f"dump.lammpstrj: at time {time:g} sphere {int(row['id'])} is far from where it was heading: frames too far apart, or not this start")
        moved = matrix(lattice, [n + s for n, s in zip(counted, self.shift)])
        self.time, self.x = time, [p + q for p, q in zip(x, moved)]
        self.u = [row[k] + g for k, g in zip(("vx", "vy", "vz"), matrix(flow.gradient, moved))]      # the image moves with the flow
        self.c = [p - q for p, q in zip(self.u, matrix(flow.gradient, self.x))]
        self.w = [row.get(k, 0.0) for k in ("omegax", "omegay", "omegaz")]


def write(path, header, rows):
    with open(path, "w") as out:
        for row in [header, *rows]:
            out.write(",".join(f"{v:.17g}" if isinstance(v, float) else str(v) for v in row) + "\n")


def trajectory(run, out, scene, case_dir, dt):
    states = scene["output"]["states"]
    flow = Flow(scene)
    start = {int(row.get("id", k + 1)): Path(row) for k, row in enumerate(table(os.path.join(case_dir, scene["start"]["file"])))}
    rows, first = [], None
    for timestep, cell, spheres in frames(os.path.join(run, "dump.lammpstrj")):
        first = timestep if first is None else first
        step = timestep - first
        if flow.rate and "x" not in next(iter(spheres.values())):
            refuse("velocity of the wrapped sphere where the dump has xu yu zu in a flow")
        for number, path in start.items():
            path.follow(flow, scene["start"].get("time", 0) + step * dt, cell, spheres[number])
            if step in states.get("at", ()) or "every" in states and step % states["every"] == 0:
                rows.append([step, path.time, number, *path.x, *path.u, *path.w, path.species])
    write(os.path.join(out, "trajectory.csv"), "step time id x y z ux uy uz wx wy wz species".split(), rows)


def stresses(run, out, scene, dt):
    rate, rows, first = Flow(scene).rate, [], None
    for row in table(os.path.join(run, "stress.csv")):
        origins = [o for o in ORIGINS if o + "_xx" in row or o + "_pxx" in row]
        values = []
        for origin in origins:
            if origin + "_pxx" in row:
                tension = {k: -float(row[f"{origin}_p{k}"]) for k in PRESSURE}
                values += [tension.get(k, tension.get(k[::-1])) for k in NINE]
            else:
                values += [float(row[f"{origin}_{k}"]) for k in NINE]
        first = int(row["step"]) if first is None else first
        step = int(row["step"]) - first
        time = scene["start"].get("time", 0) + step * dt
        if step % scene["output"]["stress"]["every"] == 0:
            rows.append([step, time, rate * time, *values])
    write(os.path.join(out, "stress.csv"), ["step", "time", "strain"] + [f"{o}_{k}" for o in origins for k in NINE], rows)


def main(case_dir, out, runs=None):
    case = json.load(open(os.path.join(case_dir, "case.json")))
    scene = json.load(open(os.path.join(case_dir, case["scene"])))
    run = os.path.join(runs, case["name"], "run") if runs else os.path.join(os.path.dirname(os.path.normpath(case_dir)), "run")
    if case["protocol"] != "run":
        refuse("protocol " + case["protocol"])
    if not os.path.exists(os.path.join(run, "dump.lammpstrj")):
        refuse("run of this question")
    dynamics, output = next(iter(scene["dynamics"].values())), scene.get("output", {})
    if output.get("states", {}).get("turn") or "stages" in scene or set(output) - {"states", "stress", "dump", "checkpoint"}:
        refuse("turn, stages or other tables")
    if "states" in output:
        trajectory(run, out, scene, case_dir, dynamics["dt"])
    if "stress" in output:
        stresses(run, out, scene, dynamics["dt"])


if __name__ == "__main__":
    main(*sys.argv[3:], sys.argv[2]) if sys.argv[1] == "--runs" else main(*sys.argv[1:])
