#!/usr/bin/env python3
"""make second-opinion: every stock style of LAMMPS that overlaps our physics, coefficient by coefficient, beside theory.

Two spheres on the x axis are given one unit velocity or spin after the other; forces and torques of `run 0` are the columns of R. Every
coefficient is shown as LAMMPS / theory, theory being the leading terms of Jeffrey & Onishi (1984) as in docs/physics.md, written here a third
time. Then the same with newton on, in other boxes, in a sheared cell; a pair in a flow; velocities set by lubricateU; noise; drag; contact and repulsion.

Each number has a verdict in tools/lammps/verdicts.csv, equal, convention or different, with the value seen in LAMMPS 29 Sep 2021, a bound and a reason. The table
goes to build/second-opinion.csv. Ends with non-zero if a number has left its bound or has no verdict: so another LAMMPS would show.
`--record` writes the values seen into verdicts.csv anew, keeping verdicts and reasons that are there.
"""
import csv, math, os, subprocess, sys, tempfile
from concurrent.futures import ThreadPoolExecutor

PI, ETA = math.pi, 0.7
LMP = os.environ.get("LMP", "lmp")
HERE = os.path.dirname(os.path.realpath(__file__))
FIELDS = ["style", "situation", "term", "verdict", "value", "bound", "reason"]


class Book:
    """Numbers by style, situation and term, beside the recorded ones."""

    def __init__(self):
        with open(os.path.join(HERE, "verdicts.csv")) as f:
            self.known = {(r["style"], r["situation"], r["term"]): r for r in csv.DictReader(f)}
        self.rows, self.changed = [], 0

    def see(self, style, situation, term, value, bound=1e-5):
        """bound: how far the number may be from the recorded one: rounding, or four statistical errors."""
        value = round(value, 9) + 0.0
        r = self.known.get((style, situation, term), {})
        good = bool(r) and r["verdict"] in ("equal", "convention", "different") and abs(value - float(r["value"])) <= float(r["bound"])
        self.changed += not good
        verdict = r.get("verdict") or guess(term, value, bound)
        self.rows.append([style, situation, term, verdict, f"{value:.7g}", f"{bound:.2g}", r.get("reason", "")])
        print(f"{style:16s} {situation:38s} {term:12s} {value:12.6g}  {verdict if good else 'CHANGED, was ' + r['value'] if r else 'NOT RECORDED'}", flush=True)

    def write(self, path):
        with open(path, "w", newline="") as f:
            csv.writer(f, lineterminator="\n").writerows([FIELDS] + self.rows)


def guess(term, value, bound):
    """For a number seen the first time; a person looks at it and gives the reason."""
    right = 0 if term.startswith(("third law", "symmetry", "twist", "change", "at rest", "sum", "beyond")) else -1 if term.startswith("cross") else 1
    return "equal" if abs(value - right) <= bound else "different"


book = Book()


def theory(a, b, xi):
    """Scalars of a pair of radii a, b at xi = 2 h/(a + b), by names: force on 1 from velocity of 2, torques from spins."""
    k, m = b / a, a / b
    L = math.log(1 / xi)
    return {
        "X_A": 6 * PI * ETA * a * (2 * k * k / (1 + k) ** 3 / xi + k * (1 + 7 * k + k * k) / (5 * (1 + k) ** 3) * L),
        "Y_A": 6 * PI * ETA * a * 4 * k * (2 + k + 2 * k * k) / (15 * (1 + k) ** 3) * L,
        "B_1": -4 * PI * ETA * a * a * k * (4 + k) / (5 * (1 + k) ** 2) * L,
        "B_2": -4 * PI * ETA * b * b * m * (4 + m) / (5 * (1 + m) ** 2) * L,
        "C_11": 8 * PI * ETA * a ** 3 * 2 * k / (5 * (1 + k)) * L,
        "C_12": 8 * PI * ETA * a ** 3 * k * k / (10 * (1 + k)) * L,
        "C_22": 8 * PI * ETA * b ** 3 * 2 * m / (5 * (1 + m)) * L,
    }


def measure(style, a, b, xi, edge=60.0, newton="off", shear=0.0, motions=None):
    """Force and torque on both spheres for each motion (12 numbers: U_1, U_2, W_1, W_2); default: the twelve unit motions."""
    h = 0.5 * (a + b) * xi
    motions = motions or [[float(k == c) for k in range(12)] for c in range(12)]
    cut = (a + b) * 1.3
    deck = [f"units lj\natom_style sphere\natom_modify map array\nnewton {newton}\ncomm_modify vel yes\nboundary p p p\nbox tilt large",
            f"region r prism 0 {edge} 0 {edge} 0 {edge} 0 0 0\ncreate_box 2 r",
            f"create_atoms 1 single {edge / 2} {edge / 2} {edge / 2}\ncreate_atoms 2 single {edge / 2 + a + b + h!r} {edge / 2} {edge / 2}",
            f"set type 1 diameter {2 * a!r}\nset type 2 diameter {2 * b!r}\nset type * density 1.0",
            f"pair_style {style.format(eta=ETA, inner=(a + b) * 1.00001, outer=cut)}\npair_coeff * *",
            "neighbor 0.3 bin", f"fix move all deform 1 xy erate {shear!r} remap v" if shear else "", "timestep 1e-9"]
    for m in motions:
        for s, (u, w) in enumerate(((m[0:3], m[6:9]), (m[3:6], m[9:12]))):
            deck.append(f"group g{s} id {s + 1}\nvelocity g{s} set {u[0]!r} {u[1]!r} {u[2]!r}\nset atom {s + 1} omega {w[0]!r} {w[1]!r} {w[2]!r}")
        deck.append("run 0 start 0 stop 1000\nprint 'FORCES $(fx[1]:%.17g) $(fy[1]:%.17g) $(fz[1]:%.17g) $(fx[2]:%.17g) $(fy[2]:%.17g) $(fz[2]:%.17g)"
                    " $(c_t[1][1]:%.17g) $(c_t[1][2]:%.17g) $(c_t[1][3]:%.17g) $(c_t[2][1]:%.17g) $(c_t[2][2]:%.17g) $(c_t[2][3]:%.17g)'")
    deck.insert(6, "compute t all property/atom tqx tqy tqz\ncompute keep all reduce sum c_t[1]\nthermo_style custom step c_keep")
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "in.lammps")
        open(path, "w").write("\n".join(deck) + "\n")
        said = subprocess.run([LMP, "-in", path, "-log", "none", "-nocite"], capture_output=True, text=True, cwd=folder).stdout
    rows = [[float(v) for v in line.split()[1:]] for line in said.splitlines() if line.startswith("FORCES")]
    if len(rows) != len(motions):
        sys.exit("second-opinion: LAMMPS stopped: " + "; ".join(l for l in said.splitlines() if "ERROR" in l)[:300])
    return rows


def scalars(columns):
    """The seven scalars from the twelve columns: n = x, so velocities along x squeeze, along y shear; torques are about z."""
    f = lambda column, row: columns[column][row]
    return {"X_A": f(3, 0), "Y_A": f(4, 1), "B_1": f(8, 1), "B_2": f(11, 1), "C_11": -f(8, 8), "C_12": -f(11, 8), "C_22": -f(11, 11)}


def worst(columns):
    """Largest violation of the third law and of the symmetry of R, over the largest element of its kind (force, coupling, torque)."""
    law = max(abs(c[k] + c[3 + k]) for c in columns for k in range(3)) / max(abs(c[k]) for c in columns for k in range(6))
    size = [max(abs(columns[i][j]) for i in I for j in J) for I, J in ((range(6), range(6)), (range(6), range(6, 12)), (range(6, 12), range(6, 12)))]
    lean = max(abs(columns[i][j] - columns[j][i]) / max(size[(i > 5) + (j > 5)], 1e-300) for i in range(12) for j in range(12))
    twist = max(abs(columns[i][j]) for i in (6, 9) for j in (6, 9))
    return law, lean, twist


def row(see, name, a, b, xi, style):
    columns = measure(style, a, b, xi)
    found, ours = scalars(columns), theory(a, b, xi)
    situation = f"b/a {b / a:.4g}, xi {xi:g}"
    for k in ours:
        see(name, situation, k, found[k] / ours[k])
    for k, v in zip(("third law", "symmetry", "twist"), worst(columns)):
        see(name, situation, k, v)


LUBRICATE = "lubricate {eta!r} 1 0 {inner!r} {outer!r} 1 0"
POLY = "lubricate/poly {eta!r} 1 0 {inner!r} {outer!r} 1 0"
WITHOUT_LOG = "lubricate {eta!r} 0 0 {inner!r} {outer!r} 1 0"


def pairs():
    a = 1.3
    for xi in (0.001, 0.01, 0.1):
        yield lambda see, xi=xi: row(see, "lubricate", a, a, xi, LUBRICATE)
        for ratio in (1, 1.4, 1 / 1.4, 5):
            yield lambda see, xi=xi, ratio=ratio: row(see, "lubricate/poly", a, a * ratio, xi, POLY)
    for name, style, ratio in (("lubricate", LUBRICATE, 1), ("lubricate/poly", POLY, 1), ("lubricate/poly", POLY, 1.4), ("lubricate/poly", POLY, 5)):
        yield lambda see, name=name, style=style, ratio=ratio: surroundings(see, name, style, a, ratio)


def surroundings(see, name, style, a, ratio):
    """R with newton on, in other boxes, and, its offset taken off, in a sheared cell."""
    one = measure(style, a, a * ratio, 0.01)
    still = measure(style, a, a * ratio, 0.01, shear=0.3, motions=[[0.0] * 12])[0]
    for what, how in (("newton on", {"newton": "on"}), ("box 24", {"edge": 24.0}), ("box 200", {"edge": 200.0}), ("sheared cell, rate 0.3", {"shear": 0.3})):
        if what == "newton on" and name == "lubricate/poly":
            continue        # refused by LAMMPS, with a sentence
        other = measure(style, a, a * ratio, 0.01, **how)
        offset = still if "shear" in how else [0.0] * 12
        change = max(abs(x - z - y) for p, q in zip(one, other) for y, x, z in zip(p, q, offset)) / abs(one[3][0])
        see(name, f"b/a {ratio:g}, xi 0.01, {what}", "change of R", change)


def flow_checks():
    """
    A pair along the flow of a sheared cell, at rest, and moving with the flow (U = (rate y, 0, 0), W = (0, 0, -rate/2)): F_1y over
    -(B_1 + B_2) rate/2, what a pair that moves with the flow should feel; one at rest should feel nothing.
    """
    rate, a, xi = 0.3, 1.3, 0.01
    ours = theory(a, a, xi)
    unit = -(ours["B_1"] + ours["B_2"]) * rate / 2
    for name, style in (("lubricate", LUBRICATE), ("lubricate/poly", POLY)):
        for edge in (12.0, 60.0, 200.0):
            yield lambda see, name=name, style=style, edge=edge: in_flow(see, name, style, a, xi, rate, edge, unit)


def in_flow(see, name, style, a, xi, rate, edge, unit):
    flow = [rate * edge / 2, 0, 0, rate * edge / 2, 0, 0, 0, 0, -rate / 2, 0, 0, -rate / 2]
    f = [measure(style, a, a, xi, edge=edge, shear=rate, motions=[m])[0][1] / unit for m in (flow, [0.0] * 12)]
    see(name, f"sheared cell, edge {edge:g}", "with flow", f[0])
    see(name, f"sheared cell, edge {edge:g}", "at rest", f[1])


def said_by(deck):
    """Numbers that a deck prints after the word RESULT."""
    with tempfile.TemporaryDirectory() as folder:
        open(os.path.join(folder, "in.lammps"), "w").write(deck)
        said = subprocess.run([LMP, "-in", "in.lammps", "-log", "none", "-nocite"], capture_output=True, text=True, cwd=folder, timeout=600).stdout
    if "ERROR" in said:
        sys.exit("second-opinion: LAMMPS stopped: " + said[said.index("ERROR"):][:300])
    return [[float(v) for v in line.split()[1:]] for line in said.splitlines() if line.startswith("RESULT")]


CELL = """atom_modify map array
newton {newton}
comm_modify vel yes
box tilt large
region r prism 0 {edge} 0 {edge} 0 {edge} 0 0 0
create_box 1 r
"""

ONE = "units lj\natom_style sphere\n" + CELL + """create_atoms 1 single 5 5 5
set type 1 diameter {d}
set type 1 density 0.7
pair_style zero 2
pair_coeff * *
timestep 1e-3
compute t all property/atom tqx tqy tqz
compute keep all reduce sum c_t[1]
compute c all temp/deform
thermo_style custom step c_keep
fix flow all deform 1 xy erate {rate} remap v
velocity all set 0.7 0.2 -0.4
set atom 1 omega 0.3 -0.5 0.9
{fix}
run 0 start 0 stop 1000
print 'RESULT $(fx[1]:%.15g) $(fy[1]:%.15g) $(fz[1]:%.15g) $(c_t[1][1]:%.15g) $(c_t[1][2]:%.15g) $(c_t[1][3]:%.15g)'
"""


def drags():
    for a in (0.5, 0.7, 2.5):
        for newton, edge, rate in (("off", 10, 0), ("on", 10, 0), ("off", 47, 0), ("off", 10, 0.3)):
            yield lambda see, a=a, newton=newton, edge=edge, rate=rate: drag(see, a, newton, edge, rate)


def drag(see, a, newton, edge, rate):
    """fix langevin at T = 0 with damp = m/(6 pi eta a), and fix viscous with 6 pi eta a, over -6 pi eta a (u - U_inf) and -8 pi eta a^3 (w - Omega_inf)."""
    zeta, turn, mass = 6 * PI * ETA * a, 8 * PI * ETA * a ** 3, 4 / 3 * PI * a ** 3 * 0.7
    situation = f"a {a:g}, newton {newton}, box {edge}, rate {rate:g}"
    for name, fix in (("fix langevin", f"fix d all langevin 0 0 {mass / zeta!r} 1 omega yes\nfix_modify d temp c"), ("fix viscous", f"fix d all viscous {zeta!r}")):
        f = said_by(ONE.format(newton=newton, edge=edge, d=2 * a, rate=rate, fix=fix))[0]
        see(name, situation, "drag x", f[0] / (-zeta * (0.7 - 5 * rate)))
        see(name, situation, "drag y", f[1] / (-zeta * 0.2))
        if name == "fix langevin":
            see(name, situation, "torque x", f[3] / (-turn * 0.3))
            see(name, situation, "torque z", f[5] / (-turn * (0.9 + rate / 2)))


TWO = """units lj
atom_style sphere
atom_modify map array
newton {newton}
comm_modify vel yes
region r block 0 {edge} 0 {edge} 0 {edge}
create_box 2 r
create_atoms 1 single {x1} 5 5
create_atoms 2 single {x2} 5 5
set type 1 diameter {d1}
set type 2 diameter {d2}
set type * density 0.7
group one type 1
velocity one set 0.3 0 0
pair_style {style}
pair_coeff * * {coefficients}
run 0
print 'RESULT $(fx[1]:%.15g) $(fx[2]:%.15g)'
"""


def springs():
    for ratio in (1, 1.4, 5):
        for newton, edge, x1 in (("off", 10, 2.0), ("on", 10, 2.0), ("off", 23, 2.0), ("off", 10, 9.9)):
            yield lambda see, ratio=ratio, newton=newton, edge=edge, x1=x1: spring(see, ratio, newton, edge, x1)


def spring(see, ratio, newton, edge, x1):
    """Normal force of contacts with and without dashpot, and of the repulsion, inside the cell and across a face."""
    k, gamma, A, kappa = 900.0, 3.0, 2.0, 0.05
    a, b = 0.5, 0.5 * ratio
    m1, m2 = (4 / 3 * PI * r ** 3 * 0.7 for r in (a, b))
    dash = m1 * m2 / (m1 + m2) * gamma * 0.3
    situation = f"b/a {ratio:g}, newton {newton}, box {edge}" + (", across a face" if x1 > 9 else "")
    for name, term, style, coefficients, gap, force in (
            ("gran/hooke", "force", f"gran/hooke {k} 0 0 0 0 0", "", -0.04, k * 0.04),
            ("gran/hooke", "dashpot", f"gran/hooke {k} 0 {gamma} 0 0 0", "", -0.03, k * 0.03 + dash),
            ("gran/hooke/history", "force", f"gran/hooke/history {k} 200 {gamma} 0 0.5 0", "", -0.04, k * 0.04 + dash),
            ("granular", "force", "granular", f"hooke {k} {gamma} tangential linear_history 200 0 0.5 damping mass_velocity", -0.04, k * 0.04 + dash),
            ("born", "force", f"born {a + b + 1}", f"{A} {kappa} {a + b} 0 0", 0.06, A / kappa * math.exp(-0.06 / kappa))):
        x2 = x1 + a + b + gap
        f = said_by(TWO.format(newton=newton, edge=edge, x1=x1, x2=x2 - edge * (x2 >= edge), d1=2 * a, d2=2 * b, style=style, coefficients=coefficients))[0]
        see(name, situation, term, -f[0] / force)
        see(name, situation, "third law " + term, (f[0] + f[1]) / force)


def draws(style, a, b, xi, kT, dt, count, newton="off"):
    """Noise forces and torques (12 numbers) of `count` steps on a frozen pair."""
    edge, h = 60.0, 0.5 * (a + b) * xi
    deck = [f"units lj\natom_style sphere\natom_modify map array\nnewton {newton}\ncomm_modify vel yes\nboundary p p p\nregion r block 0 {edge} 0 {edge} 0 {edge}",
            f"create_box 2 r\ncreate_atoms 1 single 30 30 30\ncreate_atoms 2 single {30 + a + b + h!r} 30 30",
            f"set type 1 diameter {2 * a!r}\nset type 2 diameter {2 * b!r}\nset type * density 1.0",
            f"pair_style {style.format(eta=ETA, inner=(a + b) * 1.00001, outer=(a + b) * 1.3, kT=kT)}\npair_coeff * *\nneighbor 0.3 bin\ntimestep {dt!r}",
            f"dump d all custom 1 draws id fx fy fz tqx tqy tqz\ndump_modify d sort id format float %.17g\nrun {count}"]
    with tempfile.TemporaryDirectory() as folder:
        open(os.path.join(folder, "in.lammps"), "w").write("\n".join(deck) + "\n")
        said = subprocess.run([LMP, "-in", "in.lammps", "-log", "none", "-nocite"], capture_output=True, text=True, cwd=folder).stdout
        if "ERROR" in said:
            sys.exit("second-opinion: LAMMPS stopped: " + said[said.index("ERROR"):][:300])
        rows = [[float(v) for v in line.split()] for line in open(os.path.join(folder, "draws")) if len(line.split()) == 7 and line[0].isdigit()]
    return [one[1:4] + two[1:4] + one[4:7] + two[4:7] for one, two in zip(rows[2::2], rows[3::2])]


MOVING = "units lj\natom_style hybrid sphere dipole\n" + CELL + """{spheres}
set type 1 diameter {d1!r}
set atom 2 diameter {d2!r}
set type 1 density 1.0
pair_style hybrid/overlay {load} {style} {eta!r} {log} {inner!r} {outer!r} {rate!r} 1 {vf}
pair_coeff * * {coefficients}
pair_coeff * * {style}
neighbor 0.3 bin
timestep {dt!r}
fix move all nve/noforce
{flow}
compute w all property/atom omegaz
compute keep all reduce sum c_w
thermo_style custom step c_keep
run 1
print 'RESULT {numbers}'
"""


def moving(style, a, b, xi, load="central", angle=0.0, rate=0.0, log=1, vf=0, edge=60.0, newton="off", place=(0.4, 0.4), dt=1e-9):
    """
    What lubricateU sets: velocities (x, y) relative to the flow and spins (z) relative to half its vorticity, of spheres 1 and 2 (and 3), and the
    load: force on 2 and torques on 1 and 2. Loads: `central` repulsion; `across` n, from a sphere 8 above 1 and one 8 below 2; `dipoles` along n and across.
    """
    r = a + b + 0.5 * (a + b) * xi
    at = [[place[0] * edge, place[1] * edge], [place[0] * edge + r * math.cos(angle), place[1] * edge + r * math.sin(angle)]]
    pair, coefficients, force, torques = f"lj/cut/dipole/cut {1.2 * (a + b)!r}", f"lj/cut/dipole/cut 0 1 {1.2 * (a + b)!r}", 0.0, (0.0, 0.0)
    spins = ""
    if load == "central":
        pair, coefficients, force = f"born {1.2 * (a + b)!r}", f"born 2.0 0.5 {a + b!r} 0 0", 4 * math.exp((a + b - r) / 0.5)
    elif load == "across":
        at += [[at[0][0], at[0][1] + 8], [at[1][0], at[1][1] - 8]]
        pair, coefficients, force = "born 8.2", "born 2.0 100 8 0 0", 0.02
    elif load == "dipoles":
        spins, force, torques = "\nset atom 1 dipole 5 0 0\nset atom 2 dipole 0 5 0", 75 / r ** 4, (-25 / r ** 3, -50 / r ** 3)
    names = [f"$(v{c}[{k + 1}]" + (f"-{rate!r}*y[{k + 1}]" if c == "x" else "") + ":%.15g)" for k in range(min(3, len(at))) for c in "xy"]
    deck = MOVING.format(newton=newton, edge=edge, d1=2 * a, d2=2 * b, load=pair, style=style, eta=ETA, log=log, inner=(a + b) * 1.00001, outer=(a + b) * 1.3,
                         rate=rate, vf=vf, coefficients=coefficients, dt=dt, flow=f"fix flow all deform 1 xy erate {rate!r} remap v" if rate else "",
                         spheres="\n".join(f"create_atoms 1 single {x % edge!r} {y % edge!r} {edge / 2!r}" for x, y in at) + spins,
                         numbers=" ".join(["$(c_w[1]:%.15g) $(c_w[2]:%.15g)"] + names))
    v = said_by(deck)[0]
    return [v[2 + 2 * k:4 + 2 * k] for k in range(len(names) // 2)], [w + rate / 2 for w in v[:2]], force, torques


def solved(M, y):
    """x of M x = y, by elimination."""
    rows = [list(m) + [v] for m, v in zip(M, y)]
    for k, pivot in enumerate(rows):
        for row in rows:
            if row is not pivot:
                f = row[k] / pivot[k]
                row[:] = [p - f * q for p, q in zip(row, pivot)]
    return [row[-1] / row[k] for k, row in enumerate(rows)]


def alone(a):
    return 6 * PI * ETA * a, 8 * PI * ETA * a ** 3


def loaded(see, name, xi):
    """Equal spheres at rest under three loads: the pair's scalars, once the known drag of each sphere is taken off."""
    a = 1.3
    ours, (zeta, turn), situation = theory(a, a, xi), alone(a), f"b/a 1, xi {xi:g}"
    U, W, force, _ = moving(name, a, a, xi)
    u = U[1][0] - U[0][0]
    see(name, situation, "X_A", (force / u - zeta / 2) / ours["X_A"])
    see(name, situation, "third law", (U[0][0] + U[1][0]) / u)
    U, W, force, _ = moving(name, a, a, xi, "across")
    see(name, situation, "drag", zeta * U[2][1] / force)
    one = [U[1][1] - U[0][1], (W[0] + W[1]) / 2], force, 0.0
    U, W, force, torques = moving(name, a, a, xi, "dipoles")
    two = [U[1][1] - U[0][1], (W[0] + W[1]) / 2], force, (torques[0] + torques[1]) / 2
    Y, B = solved((one[0], two[0]), (one[1], two[1]))           # zeta u/2 + Y_A u + 2 B_1 W = force
    B1, C = solved((one[0], two[0]), (one[2], two[2]))          # B_1 u + (8 pi eta a^3 + C_11 + C_12) W = torque
    see(name, situation, "Y_A", (Y - zeta / 2) / ours["Y_A"])
    see(name, situation, "B of force", B / 2 / ours["B_1"])
    see(name, situation, "B of torque", B1 / ours["B_1"])
    see(name, situation, "C_11 + C_12", (C - turn) / (ours["C_11"] + ours["C_12"]))
    see(name, situation, "C_11 - C_12", ((torques[0] - torques[1]) / (W[0] - W[1]) - turn) / (ours["C_11"] - ours["C_12"]))


def flow_of(a, b, xi, angle, rate, log=1):
    """Right: u_1, u_2 along n; u_1, u_2 across n, spins, all relative to the flow, of a free pair. The strain acts over the distance a + b of closest points."""
    S, (z1, r1), (z2, r2) = theory(a, b, xi), alone(a), alone(b)
    if not log:
        S = {k: 0.0 for k in S} | {"X_A": 6 * PI * ETA * a * 2 * (b / a) ** 2 / (1 + b / a) ** 3 / xi}
    X, Y, B1, B2 = S["X_A"], S["Y_A"], S["B_1"], S["B_2"]
    along, across = (a + b) * rate * math.sin(angle) * math.cos(angle), (a + b) * rate / 2 * math.cos(2 * angle)
    return solved(((z1 + X, -X), (-X, z2 + X)), (X * along, -X * along)) + solved(
        ((z1 + Y, -Y, -B1, -B2), (-Y, z2 + Y, B1, B2), (-B1, B1, r1 + S["C_11"], S["C_12"]), (-B2, B2, S["C_12"], r2 + S["C_22"])),
        (Y * across, -Y * across, -B1 * across, -B2 * across))


def carried(see, name, ratio, xi, angle, situation="", log=1, **how):
    """A free pair in shear: velocities and spins relative to the flow over the right ones, and the sum of the drags, which must vanish."""
    a, rate = 1.3, 0.4
    b, n = a * ratio, (math.cos(angle), math.sin(angle))
    U, W, _, _ = moving(name, a, b, xi, "flow", angle, rate, log=log, **how)
    right = flow_of(a, b, xi, angle, rate, log)
    along, across = [u[0] * n[0] + u[1] * n[1] for u in U], [u[1] * n[0] - u[0] * n[1] for u in U]
    situation = f"b/a {ratio:g}, xi {xi:g}, shear, angle {angle:g}" + situation
    see(name, situation, "along n", (along[1] - along[0]) / (right[1] - right[0]))
    if log:
        see(name, situation, "across n", (across[1] - across[0]) / (right[3] - right[2]))
        see(name, situation, "spin 1", W[0] / right[4])
        see(name, situation, "spin 2", W[1] / right[5])
    size = sum(r * math.hypot(*u) for r, u in zip((a, b), U))
    see(name, situation, "third law", math.hypot(*(a * U[0][k] + b * U[1][k] for k in (0, 1))) / size)


def pushed(see, name, ratio, xi):
    """A pair at rest under a central force: speeds over the right ones, and the sum of the drags over the force."""
    a, b = 1.3, 1.3 * ratio
    U, _, force, _ = moving(name, a, b, xi)
    X, z1, z2 = theory(a, b, xi)["X_A"], alone(a)[0], alone(b)[0]
    situation = f"b/a {ratio:.4g}, xi {xi:g}"
    for k, right in enumerate(solved(((z1 + X, -X), (-X, z2 + X)), (-force, force))):
        see(name, situation, f"speed {k + 1}", U[k][0] / right)
    see(name, situation, "third law", (z1 * U[0][0] + z2 * U[1][0]) / force)


def elsewhere(see, name, what, how):
    """The same pair of equal spheres in shear elsewhere: largest change of a velocity relative to the flow or a spin, over the largest."""
    a, rate = 1.3, 0.4
    flat = lambda v: v[0][0] + v[0][1] + [a * w for w in v[1]]
    one, other = (flat(moving(name, a, a, 0.01, "flow", 0.6, rate, **h)) for h in ({}, how))
    see(name, f"b/a 1, xi 0.01, shear, {what}", "change", max(abs(x - y) for x, y in zip(one, other)) / max(map(abs, one)))


def crowded(see, name):
    """flagVF 1: the drag of a sphere far from others, over 6 pi eta a (1 + 2.725 phi - 6.583 phi^2), phi of the four spheres."""
    a, edge = 1.3, 24.0
    U, _, force, _ = moving(name, a, a, 0.01, "across", vf=1, edge=edge, place=(0.5, 0.5))
    phi = 4 * 4 / 3 * PI * a ** 3 / edge ** 3
    see(name, "flagVF 1, box 24", "drag", force / U[2][1] / alone(a)[0] / (1 + 2.725 * phi - 6.583 * phi * phi))


def moving_checks():
    for name in ("lubricateU", "lubricateU/poly"):
        for xi in (0.001, 0.01, 0.1):
            yield lambda see, name=name, xi=xi: loaded(see, name, xi)
        for xi, angle in ((0.001, 0.6), (0.01, 0.6), (0.01, 1.3), (0.01, 2.5), (0.1, 0.6)):
            yield lambda see, name=name, xi=xi, angle=angle: carried(see, name, 1, xi, angle)
        for what, how in (("newton on", {"newton": "on"}), ("box 24", {"edge": 24.0}), ("box 200", {"edge": 200.0}), ("lower", {"place": (0.4, 0.2)}),
                          ("across a face in x", {"place": (0.99, 0.4)}), ("across a face in y", {"place": (0.4, 0.99)})):
            if what != "newton on" or name == "lubricateU":         # else refused by LAMMPS, with a sentence
                yield lambda see, name=name, what=what, how=how: elsewhere(see, name, what, how)
        yield lambda see, name=name: crowded(see, name)
    for xi, ratio in ((0.001, 1.4), (0.01, 1.4), (0.1, 1.4), (0.01, 1 / 1.4)):
        yield lambda see, xi=xi, ratio=ratio: pushed(see, "lubricateU/poly", ratio, xi)
    for xi in (0.001, 0.01, 0.1):
        yield lambda see, xi=xi: carried(see, "lubricateU/poly", 1.4, xi, 0.6)
    for ratio in (1, 1.4, 5):
        yield lambda see, ratio=ratio: carried(see, "lubricateU/poly", ratio, 0.01, 0.6, ", no log terms", log=0)


TURN = """units lj
atom_style sphere
atom_modify map array
newton {newton}
comm_modify vel yes
region r block 0 10 0 10 0 10
create_box 1 r
create_atoms 1 single 4 5 5
create_atoms 1 single 4.96 5 5
set type 1 diameter 1
set type 1 density 0.7
pair_style {style}
pair_coeff * * {coefficients}
timestep 0.001
group two id 2
velocity two set 0 2 0
run 1 post no
print 'RESULT $(fy[1]:%.15g)'
velocity two set 0 0 0
set atom 2 x $(4+0.96*cos({angle})) y $(5+0.96*sin({angle}))
run 1 post no
print 'RESULT $(fy[1]*cos({angle})-fx[1]*sin({angle}):%.15g)'
"""


def turns():
    for name, style, coefficients in (("gran/hooke/history", "gran/hooke/history 900 200 0 0 0.5 0", ""),
                                      ("granular", "granular", "hooke 900 0 tangential linear_history 200 0 0.5 damping mass_velocity")):
        for newton in ("off", "on"):
            for angle in (0.1, 0.3, 1.0):
                yield lambda see, name=name, style=style, coefficients=coefficients, newton=newton, angle=angle: turn(see, name, style, coefficients, newton, angle)


def turn(see, name, style, coefficients, newton, angle):
    """A contact slides for one step; then the pair is turned: tangential force over that before, and over the projection of the history as in docs/physics.md."""
    before, after = said_by(TURN.format(newton=newton, style=style, coefficients=coefficients, angle=angle))
    see(name, f"newton {newton}, turn by {angle:g}", "history", after[0] / before[0] / math.cos(angle))


def noise_checks():
    for name, drag, ratio, newton in (("brownian", LUBRICATE, 1, "off"), ("brownian", LUBRICATE, 1, "on"), ("brownian/poly", POLY, 1, "off"), ("brownian/poly", POLY, 1.4, "off"),
                                      ("brownian/poly", POLY, 5, "off")):
        yield lambda see, name=name, drag=drag, ratio=ratio, newton=newton: noise(see, name, drag, ratio, newton)


def noise(see, name, drag, ratio, newton):
    """Covariances over (2 kT/dt) times LAMMPS's own R of the drag style: squeeze, shear, coupling, spins; bounds are four statistical errors of uniform numbers."""
    kT, dt, count, xi, a = 0.31, 1e-3, 8000, 0.01, 1.3
    blocks = (("<F1n F1n>", 0, 0), ("cross F1n F2n", 0, 3), ("<F1t F1t>", 1, 1), ("cross F1t F2t", 1, 4), ("<F1t T1t>", 1, 8), ("<T1t T1t>", 8, 8), ("<T1t T2t>", 8, 11))
    other = {1: 2, 4: 5, 8: 7, 11: 10}      # the other tangential direction
    style = name + " {eta!r} 1 0 {inner!r} {outer!r} {kT!r} 4711 1 0"
    z, columns = draws(style, a, a * ratio, xi, kT, dt, count, newton), measure(drag, a, a * ratio, xi)
    situation = f"b/a {ratio:g}, xi {xi:g}, newton {newton}"
    for term, p, q in blocks:
        both = (p, q) in ((1, 1), (1, 4), (8, 8), (8, 11))
        measured = sum(r[p] * r[q] + (r[other[p]] * r[other[q]] if both else 0) for r in z) / (2 if both else 1) / len(z)
        R, scale = -columns[q][p], math.sqrt(columns[p][p] * columns[q][q])
        see(name, situation, term, measured / (2 * kT / dt * R) * (-1 if term.startswith("cross") else 1), 4 * 1.2 * scale / abs(R) / math.sqrt(len(z)))
    total = sum((r[k] + r[3 + k]) ** 2 for r in z for k in range(3)) / sum(r[k] ** 2 for r in z for k in range(3))
    see(name, situation, "sum of forces", total, 0.2 if total > 1e-9 else 1e-5)


def numbers(task):
    found = []
    task(lambda *number: found.append(number))
    return found


def main():
    version = subprocess.run([LMP, "-h"], capture_output=True, text=True).stdout.split("Simulator - ")[1].splitlines()[0]
    print(f"LAMMPS {version}: LAMMPS over theory; third law, symmetry and change as violation over the largest element; twist about n: absolute")
    tasks = [task for part in (pairs, flow_checks, moving_checks, noise_checks, drags, springs, turns) for task in part()]
    with ThreadPoolExecutor(max_workers=16) as pool:        # what takes long is the start of each `lmp`
        for found in pool.map(numbers, tasks):
            for number in found:
                book.see(*number)
    book.write(os.path.join(os.environ.get("B", "build"), "second-opinion.csv"))
    if sys.argv[1:] == ["--record"]:
        book.write(os.path.join(HERE, "verdicts.csv"))
    counts = {v: sum(r[3] == v for r in book.rows) for v in ("equal", "convention", "different")}
    gone = set(book.known) - {tuple(r[:3]) for r in book.rows}
    print(f"second-opinion: {len(book.rows)} numbers: {counts['equal']} equal, {counts['convention']} convention, {counts['different']} different; "
          f"{book.changed} not as recorded, {len(gone)} recorded and not seen (reasons: docs/lammps.md)")
    return 1 if book.changed or gone else 0


if __name__ == "__main__":
    sys.exit(main())
