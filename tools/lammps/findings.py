#!/usr/bin/env python3
"""make findings: each deck of tools/lammps/findings/ through `lmp`, its numbers beside what is right and beside what the cause named in docs/findings.md predicts.

A row is `what | right | LAMMPS | from the cause`. It holds if LAMMPS's number is the one that the cause predicts, and if it is wrong where we say
so. docs/findings.md must have each row as printed here. Then the gate: the sentences by which it names the faults in the fast tier, which the page
quotes. Ends with non-zero if anything differs, as it will under a LAMMPS in which a finding is mended.
"""
import json, math, os, subprocess, sys
from concurrent.futures import ThreadPoolExecutor

HERE = os.path.dirname(os.path.realpath(__file__))
PAGE = open(os.path.join(HERE, "../../docs/findings.md")).read()
LMP = os.environ.get("LMP", "lmp")
PI = math.pi
METAL, REAL = 0.6241509647, 14393.264316       # vxmu2f: LAMMPS's force units in viscosity x velocity x length of its units


def run(deck, seconds=1000, **variables):
    """Numbers of a deck by name; those printed until then if it takes more than so many seconds of one core."""
    words = ["sh", "-c", 'ulimit -t "$0"; exec "$@"', str(seconds), LMP, "-log", "none", "-nocite", "-in", os.path.join(HERE, "findings", deck)]
    for name, value in variables.items():
        words += ["-var", name, str(value)]
    ran = subprocess.run(words, capture_output=True, text=True)
    if ran.returncode == 127:
        sys.exit(f"findings: the LAMMPS program \"{LMP}\" was not found (Debian package lammps)")
    said = ran.stdout
    errors = [line for line in said.splitlines() if line.startswith("ERROR")]
    if errors:
        sys.exit(f"findings: {deck}: {errors[0]}")
    if ran.returncode not in (0, -9, -24):      # the two signals of the limit
        sys.exit(f"findings: {deck}: LAMMPS ended with {ran.returncode}")
    return {line.split()[1]: float(line.split()[2]) for line in said.splitlines() if line.startswith("RESULT")}


class Table:
    """Counts what does not hold; prints rows as the page has them."""

    def __init__(self):
        self.rows = self.bad = 0
        self.lines = []

    def head(self, text):
        self.lines.append("\n" + text)

    def complain(self, text):
        self.bad += 1
        self.lines.append("    DIFFERS: " + text)

    def row(self, what, right, measured, cause, sd=0.0, good=False):
        """sd: statistical error of `measured`, 0 for none; good: LAMMPS is right here."""
        self.rows += 1
        show = f"{round(measured, 9) + 0.0:.5g}" if not sd else f"{measured:.3f} +- {sd:.3f}" if abs(measured) < 1000 else f"{measured:.4g} +- {sd:.1g}"
        text = f"| {what} | {right:.4g} | {show} | {cause:.5g} |"
        self.lines.append(text)
        if not abs(measured - cause) <= (4 * sd or 1e-6 * max(abs(cause), 1e-6)):
            self.complain(f"the cause predicts {cause:.9g}, LAMMPS says {measured:.9g}")
        if good != (abs(measured - right) <= (4 * sd or 1e-6 * max(abs(right), 1e-6))):
            self.complain("this is right now" if not good else "this was right")
        if text not in PAGE:
            self.complain("docs/findings.md does not have this row")


def poly_squeeze(a, b, h):
    """The force on a sphere of radius a from lubricate/poly per closing speed (viscosity 1), from its source: gap and radii over its own radius."""
    x, k = h / a, b / a
    return 6 * PI * a * (k * k / (1 + k) ** 2 / x + (1 + 7 * k + k * k) / 5 / (1 + k) ** 3 * math.log(1 / x)
                         + (1 + 18 * k - 29 * k * k + 18 * k ** 3 + k ** 4) / 21 / (1 + k) ** 4 * x * math.log(1 / x))


def third_law(t):
    t.head("lubricate/poly: minus the force on 2 over the force on 1")
    for b, gap in ((1.4, 0.0012), (1.4, 0.012), (1.4, 0.12), (5, 0.3)):
        f = run("third-law.in", b=b, gap=gap)
        t.row(f"radii 1 and {b:g}, gap {gap:g}", 1, -f["on-2"] / f["on-1"], poly_squeeze(b, 1, gap) / poly_squeeze(1, b, gap))
    f = run("third-law.in", b=1, gap=0.01)
    t.row("radii 1 and 1, gap 0.01", 1, -f["on-2"] / f["on-1"], 1, good=True)


def pair_noise(t):
    t.head("noise of a pair over (2 kT/dt) times the drag of the same pair")
    n = 40000
    one, two = math.sqrt(0.8 / n), math.sqrt(1 / n)     # of <x x> and <x y> for uniform numbers
    h, L = 0.01, math.log(100)
    torque = (PI + 8 * PI * (1 / 8 + h / 16)) / (PI + 8 * PI * (1 / 5 + 0.188 * h))
    f = run("pair-noise.in")
    t.row("brownian/poly: <F_1 F_1>", 1, f["own"], 1, one, good=True)
    t.row("brownian/poly: <F_1 F_2>", -1, f["cross"], 0, two)
    t.row("brownian/poly: <(F_1 + F_2)^2>", 0, f["sum"], 2, 2 * math.sqrt(1.4 / n))
    t.row("brownian/poly: <T_1 T_1>", 1, f["torque"], torque, math.sqrt(0.8 / n))
    f = run("pair-noise.in", style="brownian", drag="lubricate")
    t.row("brownian: <F_1 F_1>", 1, f["own"], 1, one, good=True)
    t.row("brownian: <F_1 F_2>", -1, f["cross"], -1, one, good=True)
    t.row("brownian: <(F_1 + F_2)^2>", 0, f["sum"], 0, good=True)
    t.row("brownian: <T_1 T_1>", 1, f["torque"], 1, one, good=True)


def face_noise(t):
    t.head("brownian: <(F_1 + F_2)^2> over <F_1 F_1>")
    t.row("newton off, pair inside the cell", 0, run("face-noise.in", x=20)["sum"], 0, good=True)
    t.row("newton off, pair across a face", 0, run("face-noise.in", x=39)["sum"], 2, 2 * math.sqrt(1.4 / 20000))
    t.row("newton on, pair across a face", 0, run("face-noise.in", x=39, newton="on")["sum"], 0, good=True)


def sheared_spin(t):
    t.head("lubricate, lubricate/poly: force F_1y of a pair along the flow, over a Y_A rate")
    right = 0.1 * PI * 0.1 * math.log(100) * 0.3
    for style in ("lubricate", "lubricate/poly"):
        for edge in (1, 12, 60, 200):
            t.row(f"{style}, cell of edge {edge}, pair moves and turns with the flow", 1, run("sheared-spin.in", style=style, edge=edge)["force"] / right,
                  1 - (edge - 1), good=edge == 1)
    for edge in (1, 60):
        t.row(f"lubricate, cell of edge {edge}, pair at rest", 0, run("sheared-spin.in", edge=edge, turn=0)["force"] / right, -(edge - 1), good=edge == 1)


def relative_spin(t):
    t.head("torque p (W_1 - W_2), p over pi eta a^3 ln(a/h), and the rolling part a^2 Y_A over the same")
    for style, log, linear in (("lubricate", 0.15, 0), ("lubricate/poly", 1.6, 1.504)):
        for gap in (0.001, 0.01):
            f, unit = run("relative-spin.in", style=style, gap=gap), PI * math.log(1 / gap)
            t.row(f"{style}, gap {gap:g}: p", 0.6, (f["on-2"] - f["on-1"]) / 2 / unit, log + linear * gap)
            t.row(f"{style}, gap {gap:g}: rolling", 1, -(f["on-2"] + f["on-1"]) / 2 / unit, 1, good=True)
    for style, log, linear in (("lubricateU", 0.15, 0), ("lubricateU/poly", 6.4, 24.064)):      # torque = (8 pi eta a^3 + 2 p) W
        for gap in (0.001, 0.01):
            f, torque = run("dipole-spin.in", style=style, gap=gap), 12 / (2 + gap) ** 3
            t.row(f"{style}, gap {gap:g}: p", 0.6, (2 * torque / (f["spin-2"] - f["spin-1"]) - 8 * PI) / 2 / (PI * math.log(1 / gap)), log + linear * gap)


def units(t):
    t.head("arm of the shear force over the radius (torque/force/a), and noise of the squeeze over (2 kT/dt) X_A, in LAMMPS's unit systems")
    sd = math.sqrt(0.8 / 40000)
    for name, factor in (("lj", 1), ("metal", METAL), ("real", REAL)):
        for suffix in ("", "/poly"):
            f = run("units.in", units=name, suffix=suffix)
            t.row(f"lubricate{suffix}, units {name}: arm", 1, f["arm"], factor, good=factor == 1)
            t.row(f"brownian{suffix}, units {name}: noise", 1, f["noise"], factor ** 2, sd * factor ** 2, good=factor == 1)


def isotropic(t):
    t.head("isotropic (FLD) terms: noise of one sphere over (2 kT/dt) times its drag")
    sd = math.sqrt(0.8 / 20000)
    t.row("brownian, flaglog 0: <T T>", 1, run("fld-torque.in")["noise"], 0)
    t.row("brownian, flaglog 1: <T T>", 1, run("fld-torque.in", log=1)["noise"], 1, sd, good=True)
    t.row("brownian/poly, a = 1, with fix deform: <F F>", 1, run("poly-radius.in")["noise"], 0)
    t.row("brownian/poly, a = 1, without fix deform: <F F>", 1, run("poly-radius.in", deform=0)["noise"], 1, sd, good=True)
    t.row("brownian, a = 1, with fix deform: <F F>", 1, run("poly-radius.in", style="brownian")["noise"], 1, sd, good=True)


def flip(t):
    t.head("fix deform, remap v: velocity of a free sphere as of its first image, at the start 0.5")
    t.row("flip yes, sphere outside when the cell flips", 0.5, run("flip.in")["velocity"], 0.5 + 0.1 * 10)
    t.row("flip no", 0.5, run("flip.in", flip="no")["velocity"], 0.5, good=True)


def langevin(t):
    t.head("fix langevin on temp/deform, omega yes, T = 0, rate 0.1: what a free sphere settles to")
    f = run("langevin-spin.in")
    t.row("spin", -0.05, f["spin"], 0)
    t.row("velocity relative to the flow", 0, f["velocity"], 0, good=True)
    t.head("fix langevin: variance of the force on a held sphere over 2 kT m/(damp dt)")
    sd = math.sqrt(0.8 / 20000)
    t.row("velocity 0, bias of temp/deform", 1, run("langevin-cold.in")["noise"], 0)
    t.row("velocity 1e-200, bias of temp/deform", 1, run("langevin-cold.in", v=1e-200)["noise"], 1, sd, good=True)
    t.row("velocity 0, no bias", 1, run("langevin-cold.in", bias=0)["noise"], 1, sd, good=True)


def rerun(t):
    """The recursion of velocity Verlet with the drag of the half step; a set-up takes the drag of the full step in its place."""
    t.head("run 100 and run 100 beside run 200: relative difference of a velocity slowed by fix langevin, T = 0")
    eps = 0.01

    def slow(setups):
        v, drag = 1.0, 1.0
        for step in range(200):
            drag = v if step in setups else drag
            v -= eps / 2 * drag
            drag = v
            v -= eps / 2 * drag
        return v
    whole, parts = run("rerun.in", parts=1)["velocity"], run("rerun.in")["velocity"]
    t.row("run 100, run 100", 0, parts / whole - 1, slow((0, 100)) / slow((0,)) - 1)
    t.row("run 100, run 100 pre no", 0, run("rerun.in", pre="no")["velocity"] / whole - 1, 0, good=True)


def wide_gap(t):
    t.head("force on a sphere that slides past its neighbour, over pi eta a U: it must not be positive")
    t.row("lubricate, gap 1.2 a", 0, run("wide-gap.in")["force"] / PI, math.log(1.2))
    t.row("lubricate/poly, gap 1.2 a", 0, run("wide-gap.in", style="lubricate/poly")["force"] / PI, math.log(1.2))


def poly_side(a, b, h, log=1):
    """What the side of radius a of lubricateU/poly has for squeeze, shear and relative spin (viscosity 1), from its source."""
    x, k = h / a, b / a
    L = math.log(1 / x) if log else 0.0
    return (poly_squeeze(a, b, h) if log else 6 * PI * a * k * k / (1 + k) ** 2 / x,
            6 * PI * a * (4 * k * (2 + k + 2 * k * k) / 15 / (1 + k) ** 3 + 4 * (16 - 45 * k + 58 * k * k - 45 * k ** 3 + 16 * k ** 4) * x / 375 / (1 + k) ** 4) * L,
            8 * PI * a ** 3 * (0.4 * k * (1 + k) + (0.128 + 0.096 * k + 0.528 * k * k) * (1 + k) ** 2 * x) * L)


def equal_side(a, b, h, log=1):
    """The same for lubricateU."""
    x = h / a
    L = math.log(1 / x) if log else 0.0
    return 6 * PI * a * (1 / 4 / x + 9 / 40 * L), PI * a * L, 8 * PI * a ** 3 * 3 / 160 * L


def follow(side, b, gaps, force=0.0, angle=0.0, rate=0.0, log=1, tolerance=1e-3, most=10000):
    """
    The iteration of lubricateU (conjugate gradients) on a pair of radii 1 and b, whose sides see the gaps gaps[0] and gaps[1]: velocities along n
    and across, spins, as `free-pair.in` prints them. Ends where the rest is below `tolerance` of the load; None if it does not within `most` rounds.
    """
    radii, (squeeze, shear, spin) = (1.0, b), zip(side(1, b, gaps[0], log), side(b, 1, gaps[1], log))
    along, across = rate * math.sin(angle) * math.cos(angle), rate / 2 * math.cos(2 * angle)

    def resistance(v):          # v: along 1, 2, across 1, 2, spins 1, 2
        slip = v[2] - v[3] + v[4] + b * v[5]
        out = [6 * PI * a * v[k] + squeeze[k] * (v[k] - v[1 - k]) for k, a in enumerate(radii)]
        out += [6 * PI * a * v[2 + k] + (1 - 2 * k) * shear[k] * slip for k, a in enumerate(radii)]
        return out + [8 * PI * a ** 3 * v[4 + k] + a * shear[k] * slip + spin[k] * (v[4 + k] - v[5 - k]) for k, a in enumerate(radii)]
    dot = lambda p, q: sum(x * y for x, y in zip(p, q))
    load = [(1 - 2 * k) * (2 * a * squeeze[k] * along - force) for k, a in enumerate(radii)]
    load += [(1 - 2 * k) * 2 * a * shear[k] * across for k, a in enumerate(radii)] + [2 * a * a * shear[k] * across for k, a in enumerate(radii)]
    v, rest = [0.0] * 6, load
    way, size = rest, dot(load, load)
    for _ in range(most):
        image = resistance(way)
        old = dot(rest, rest)
        step = old / dot(image, way)
        v = [x + step * p for x, p in zip(v, way)]
        rest = [x - step * p for x, p in zip(rest, image)]
        if not dot(rest, rest) > tolerance ** 2 * size:         # also where it is not a number
            return v
        way = [x + dot(rest, rest) / old * p for x, p in zip(rest, way)]
    return None


def drift(t):
    t.head("sum of the drags of a free pair: at rest under a force F along n, over F; in shear at 45 degrees, over X_A (a_1 + a_2) rate/2")
    for b, gap in ((1.4, 0.0012), (1.4, 0.012), (1.4, 0.12), (1, 0.01)):
        f, v = run("free-pair.in", b=b, gap=gap, force=1), follow(poly_side, b, (gap, gap), force=1)
        t.row(f"lubricateU/poly, radii 1 and {b:g}, gap {gap:g}, at rest", 0, 6 * PI * (f["along-1"] + b * f["along-2"]), 6 * PI * (v[0] + b * v[1]), good=b == 1)
    f = run("free-pair.in", style="lubricateU", force=1)
    t.row("lubricateU, gap 0.01, at rest", 0, 6 * PI * (f["along-1"] + f["along-2"]), 0, good=True)
    for b, gap in ((1.4, 0.012), (5, 0.03), (1, 0.01)):
        f, unit = run("free-pair.in", b=b, gap=gap, rate=0.1, angle=PI / 4, log=0), poly_side(1, b, gap, 0)[0] * (1 + b) * 0.05
        t.row(f"lubricateU/poly without log terms, radii 1 and {b:g}, gap {gap:g}, in shear", 0, 6 * PI * (f["along-1"] + b * f["along-2"]) / unit, 2 * (1 - b) / (1 + b), good=b == 1)


def iteration(t):
    t.head("spin and slip of a free pair of equal spheres in shear, n at 0.6 rad to the flow, over what the style's own resistances ask for")
    for style, gap, side, tolerance in (("lubricateU/poly", 0.01, poly_side, 1e-3), ("lubricateU/poly", 0.001, poly_side, 1e-3), ("lubricateU", 0.01, equal_side, 1e-4), ("lubricateU", 0.001, equal_side, 1e-4),
                                        ("lubricateU", 0.0001, equal_side, 1e-4)):
        f, ours = run("free-pair.in", style=style, gap=gap, rate=0.1, angle=0.6), [follow(side, 1, (gap, gap), rate=0.1, angle=0.6, tolerance=e) for e in (1e-13, tolerance)]
        for what, k, name in (("spin", 4, "spin-1"), ("velocity across n", 2, "across-1")):
            t.row(f"{style}, gap {gap:g}: {what}", 1, f[name] / ours[0][k], ours[1][k] / ours[0][k], good=(style, gap) == ("lubricateU", 0.01))
    t.head("steps that end within 5 seconds of one core, of 1")
    for log, b in ((1, 2), (0, 5), (1, 5)):
        gap = 0.005 * (1 + b)
        ended(t, f"lubricateU/poly, radii 1 and {b}, gap {gap:g}" + ("" if log else ", without log terms"), follow(poly_side, b, (gap, gap), force=1, log=log) is not None,
              b=b, gap=gap, force=1, log=log)


def ended(t, what, ends, **how):
    f = run("free-pair.in", seconds=5, **how)
    if "started" not in f:
        t.complain("LAMMPS did not start")
    t.row(what, 1, float("along-1" in f), float(ends), good=ends)


def half_step(t):
    t.head("closing speed of a free pair under a force along the flow, across a face over that inside the cell, without log terms; rate 0.1, dt 0.002")
    speed = lambda f: f["along-1"] - f["along-2"]
    for rate in (0.1, 0):
        how = {"style": "lubricateU", "newton": "on", "force": 1, "log": 0, "rate": rate, "dt": 0.002}
        found = speed(run("free-pair.in", x=39, **how)) / speed(run("free-pair.in", **how))
        start = follow(equal_side, 1, (0.01, 0.01), force=1, log=0, tolerance=1e-4)
        inside, face = (follow(equal_side, 1, (h, h), force=1, log=0, tolerance=1e-4) for h in
                        (0.01 + 0.001 * (start[1] - start[0]) - lag for lag in (0, 0.001 * rate * 20)))     # gaps half a step later
        t.row("lubricateU, newton on, pair across a face" + ("" if rate else ", at rest"), 1, found, (face[0] - face[1]) / (inside[0] - inside[1]), good=not rate)
    t.head("the same with newton off: steps that end within 5 seconds of one core, of 1")
    for style, side, tolerance in (("lubricateU", equal_side, 1e-4), ("lubricateU/poly", poly_side, 1e-3)):
        for x in (20, 39):
            lag = 0.002 * (x > 38)
            ended(t, f"{style}, newton off, pair " + ("across a face" if lag else "inside"), follow(side, 1, (0.01 - lag, 0.01 + lag), force=1, log=0, tolerance=tolerance) is not None,
                  style=style, x=x, force=1, log=0, rate=0.1, dt=0.002)


GATE = (("--own poly", "lubrication-resistance", ("third law of R", "R symmetric", "R positive semidefinite", "Y_A")),
        ("--own poly", "noise-equal-pairs", ("pair noise: nothing outside the range of R", "pair noise: size")),
        ("--own equal", "noise-equal-pairs", ("R of lubrication: declared model",)),
        ("--own equal --newton off", "noise-equal-pairs", ("pair noise: nothing outside the range of R", "pair noise: size")))


def gate(t):
    """The fast tier must name the faults by itself; what it says is quoted on the page."""
    build = os.path.join(HERE, "../..", os.environ.get("B", "build"))
    for own, case, wanted in GATE:
        command = f"gate run --candidate \"build/lammps-candidate {own}\" --case {case}"
        t.head(command)
        work = os.path.join(build, "findings", own.replace(" ", "").replace("-", ""))
        subprocess.run([os.path.join(build, "gate"), "run", "--candidate", f"{build}/lammps-candidate {own}", "--case", case, "--work", work, "--report", work],
                       capture_output=True, cwd=os.path.join(HERE, "../.."))
        found = json.load(open(os.path.join(work, case, "results.json")))
        found = found["results"] if isinstance(found, dict) else found
        verdicts = {r["what"]: r for r in found}
        if not verdicts.keys() >= set(wanted):
            t.complain(f"the gate did not judge this: {found[0]['sentence']}")
            continue
        for what in wanted:
            t.rows += 1
            sentence = " ".join(verdicts[what]["sentence"].split())
            t.lines.append(f"fails: {sentence}")
            if verdicts[what]["verdict"] != "FAIL":
                t.complain(f"\"{what}\" no longer fails")
            if sentence not in PAGE:
                t.complain("docs/findings.md does not quote this sentence")
        if own == "--own equal":        # what is right must pass
            for what in ("R of lubrication: symmetric", "R of lubrication: positive", "pair noise: nothing outside the range of R", "pair noise: size", "pair noise: covariance"):
                t.rows += 1
                t.lines.append(f"{verdicts[what]['verdict']}: {what}")
                if verdicts[what]["verdict"] != "pass":
                    t.complain("this passed")


def fill(part):
    t = Table()
    part(t)
    return t


def main():
    said = subprocess.run([LMP, "-h"], capture_output=True, text=True).stdout
    version = said.split("Simulator - ")[1].splitlines()[0] if "Simulator - " in said else "unknown"
    print(f"LAMMPS {version}\n| what | right | LAMMPS | from the cause |")
    parts = (third_law, pair_noise, face_noise, sheared_spin, relative_spin, units, isotropic, flip, langevin, rerun, wide_gap, drift, iteration, half_step)
    with ThreadPoolExecutor(max_workers=len(parts)) as pool:    # what takes long is the start of each `lmp`
        tables = list(pool.map(fill, parts)) + [fill(gate)]
    for t in tables:
        print("\n".join(t.lines))
    bad = sum(t.bad for t in tables)
    print(f"\nfindings: {sum(t.rows for t in tables)} rows, {bad} not as docs/findings.md says (LAMMPS {version})")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
