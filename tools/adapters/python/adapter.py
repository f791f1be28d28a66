#!/usr/bin/env python3
"""ADAPTER CASE_DIR OUT_DIR, or ADAPTER run-all: the spheres of dem.py as a candidate of the gate at level B (docs/adapter.md)."""
import csv
import json
import os
import re
import sys
import traceback
from math import ceil

from dem import Spheres

# The keys of a scene that are understood, with # for numbers. Any other may change the question, and is refused.
KNOWN = set("""$schema about seed realisation dimensions fluid.viscosity fluid.kT box.lengths.# box.cell.#.# box.periodic.#
    shear.#.flow shear.#.gradient shear.#.rate species.#.name species.#.radius species.#.density start.file start.time
    forces.contact.normal_stiffness forces.contact.tangential_stiffness forces.contact.friction forces.contact.lever forces.contact.law
    forces.drag.torque forces.lubrication.inner_gap forces.lubrication.outer_gap forces.lubrication.rotation_correction
    dynamics.verlet.dt dynamics.verlet.rotation run.steps run.time run.strain
    output.states.every output.states.at.# output.states.turn output.stress.every""".split())
SLOW, LARGE = 150_000, 1000     # particle steps in a run, particles in a state, that this code does in well under a minute
AXES = "xyz"


class Refused(Exception):
    """This I do not have: exit code 77."""


def need(condition, what):
    if not condition:
        raise Refused("these Python spheres do not have " + what)


def keys(value, path=""):
    """Every key of a scene as a path: species.2.radius is species.#.radius."""
    parts = value.items() if isinstance(value, dict) else (("#", v) for v in value) if isinstance(value, list) else None
    return {path} if parts is None else {k for name, v in parts for k in keys(v, f"{path}.{name}".lstrip("."))}


def table(path):
    with open(path, newline="") as lines:
        return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def vector(row, names):
    return tuple(float(row[n]) for n in names)


class Question:
    def __init__(self, folder):
        self.folder = folder
        with open(os.path.join(folder, "case.json")) as case:
            self.case = json.load(case)
        with open(os.path.join(folder, self.case["scene"])) as scene:
            self.scene = scene = json.load(scene)
        for key in sorted(keys(scene)):
            need(key in KNOWN, key)
        need(scene.get("dimensions", 3) == 3, "discs")
        need(scene.get("forces", {}).get("contact", {}).get("law", "plain") == "plain", "other friction laws")
        self.verlet = scene["dynamics"].get("verlet", {})
        need(isinstance(self.verlet.get("dt"), (int, float)), "this integrator")
        self.dt, self.start_time = self.verlet["dt"], scene.get("start", {}).get("time", 0)

    def spheres(self, rows, contacts=()):
        scene, box, order = self.scene, self.scene["box"], {row["id"]: k for k, row in enumerate(rows)}
        gradient = [[0.0] * 3 for _ in AXES]
        for shear in scene.get("shear", []):
            gradient[AXES.index(shear["flow"])][AXES.index(shear["gradient"])] += shear["rate"]
        species = [scene["species"][int(row["species"]) - 1] for row in rows]
        histories = {}
        for c in contacts:
            i, j, sign = order[c["i"]], order[c["j"]], 1
            if i > j:
                i, j, sign = j, i, -1
            histories[i, j] = tuple(sign * s for s in vector(c, ("sx", "sy", "sz")))
        return Spheres([vector(r, "xyz") for r in rows], [vector(r, ("ux", "uy", "uz")) for r in rows], [vector(r, ("wx", "wy", "wz")) for r in rows],
                       [s["radius"] for s in species], [s["density"] for s in species],
                       box.get("cell") or [[box["lengths"][i] if i == k else 0.0 for k in range(3)] for i in range(3)], box["periodic"], gradient,
                       scene.get("fluid", {}).get("viscosity", 0), scene.get("forces", {}), self.dt, self.start_time, histories,
                       {"auto": None, "on": True, "off": False}[self.verlet.get("rotation", "auto")])


class Answer:
    """trajectory.csv and stress.csv, whose rows begin with what `first` names."""

    def __init__(self, folder, first, stress_first, turn=False):
        self.folder, self.first, self.stress_first, self.turn, self.files = folder, first, stress_first, turn, {}

    def write(self, name, header, values):
        if name not in self.files:
            self.files[name] = open(os.path.join(self.folder, name), "w")
            self.files[name].write(",".join(header) + "\n")
        self.files[name].write(",".join(f"{v:.17g}" if isinstance(v, float) else str(v) for v in values) + "\n")

    def frame(self, first, rows, s):
        header = self.first + "time id x y z ux uy uz wx wy wz species".split() + ["turn_x", "turn_y", "turn_z"] * self.turn
        for k, row in enumerate(rows):
            self.write("trajectory.csv", header, [*first, s.time, row["id"], *s.x[k], *s.u[k], *s.w[k], row["species"], *(s.turned[k] * self.turn)])

    def stress(self, first, s):
        stresses = s.stresses()
        header = self.stress_first + [f"{origin}_{a}{b}" for origin in stresses for a in AXES for b in AXES]
        self.write("stress.csv", header, [*first, *(v for origin in stresses.values() for v in origin)])

    def close(self):
        for file in self.files.values():
            file.close()


def answer_steps(q, out):
    answer = Answer(out, ["state", "step"], ["state"])
    states, contacts = {}, {}
    for row in table(os.path.join(q.folder, q.case["states"])):
        states.setdefault(row["state"], []).append(row)
    for row in table(os.path.join(q.folder, q.case["contacts"])) if "contacts" in q.case else []:
        contacts.setdefault(row["state"], []).append(row)
    for state, rows in states.items():
        need(len(rows) <= LARGE, f"the time for {len(rows)} spheres")
        s = q.spheres(rows, contacts.get(state, ()))
        answer.frame((state, 0), rows, s)
        if q.case.get("stress"):
            answer.stress((state,), s)
        for step in range(1, q.case["steps"] + 1):
            s.step(q.start_time + step * q.dt)
            answer.frame((state, step), rows, s)
    answer.close()


def answer_run(q, out):
    run, output = q.scene["run"], q.scene.get("output", {})
    need("file" in q.scene.get("start", {}), "a start of its own")
    rows = table(os.path.join(q.folder, q.scene["start"]["file"]))
    rate = max((abs(s["rate"]) for s in q.scene.get("shear", [])), default=0)
    steps = run["steps"] if "steps" in run else ceil((run["time"] if "time" in run else run["strain"] / rate) / q.dt * (1 - 1e-12))
    need(steps * len(rows) <= SLOW and len(rows) <= LARGE, f"the time for {steps} steps of {len(rows)} spheres")
    states, stress = output.get("states", {}), output.get("stress", {}).get("every", steps + 1)
    answer = Answer(out, ["step"], ["step", "time", "strain"], states.get("turn", False))
    s = q.spheres(rows)
    for step in range(steps + 1):
        if step > 0:
            s.step(q.start_time + step * q.dt, step % stress == 0)
        if step in states.get("at", ()) or "every" in states and step % states["every"] == 0:
            answer.frame((step,), rows, s)
        if stress <= steps and step % stress == 0:
            answer.stress((step, s.time, rate * s.time), s)
    answer.close()


def answer(case_dir, out_dir):
    """Answers one question; the exit code."""
    try:
        q = Question(case_dir)
        need(q.case["protocol"] in ("steps", "run"), "protocol " + q.case["protocol"])
        (answer_steps if q.case["protocol"] == "steps" else answer_run)(q, out_dir)
        return 0
    except Refused as reason:
        print(reason, file=sys.stderr)
        return 77
    except Exception:       # a mistake of the adapter: the next question may still be answered
        traceback.print_exc()
        return 1


if __name__ == "__main__":
    if sys.argv[1:] == ["run-all"]:
        for line in sys.stdin:
            print(answer(*line.rstrip("\n").split("\t")), flush=True)
    else:
        sys.exit(answer(*sys.argv[1:]))
