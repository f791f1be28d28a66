#!/usr/bin/env python3
"""make second-opinion: the resistance of LAMMPS's lubrication styles, coefficient by coefficient, beside the near-field theory.

Two spheres on the x axis are given one unit velocity or spin after the other; forces and torques of `run 0` are the columns of R. Every
coefficient is shown as LAMMPS / theory, theory being the leading terms of Jeffrey & Onishi (1984) as in docs/physics.md, written here a third
time. Then: third law, symmetry of R, newton on and off, box sizes, and a pair that moves with the flow of a sheared cell.
"""
import math, os, subprocess, sys, tempfile

PI, ETA = math.pi, 0.7
LMP = os.environ.get("LMP", "lmp")
AXES = "xyz"


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


def row(name, a, b, xi, style, **how):
    columns = measure(style, a, b, xi, **how)
    found, ours = scalars(columns), theory(a, b, xi)
    law, lean, twist = worst(columns)
    print(f"{name:34s} {b / a:5.2f} {xi:7.4f} " + " ".join(f"{found[k] / ours[k]:8.4f}" for k in ours)
          + f" {law:10.1e} {lean:9.1e} {twist:8.1e}", flush=True)
    return columns


LUBRICATE = "lubricate {eta!r} 1 0 {inner!r} {outer!r} 1 0"
POLY = "lubricate/poly {eta!r} 1 0 {inner!r} {outer!r} 1 0"
WITHOUT_LOG = "lubricate {eta!r} 0 0 {inner!r} {outer!r} 1 0"


def main():
    version = subprocess.run([LMP, "-h"], capture_output=True, text=True).stdout.split("Simulator - ")[1].splitlines()[0]
    print(f"LAMMPS {version}; LAMMPS over theory; third law and symmetry as violation over the largest element; twist about n: absolute\n")
    print(f"{'style':34s} {'b/a':>5s} {'xi':>7s} " + " ".join(f"{k:>8s}" for k in theory(1, 1, 0.1)) + f" {'3rd law':>10s} {'symmetry':>9s} {'twist':>8s}")
    for xi in (0.001, 0.01, 0.1):
        row("lubricate", 1.3, 1.3, xi, LUBRICATE)
    row("lubricate, no log terms", 1.3, 1.3, 0.01, WITHOUT_LOG)
    for xi in (0.001, 0.01, 0.1):
        row("lubricate/poly, equal", 1.3, 1.3, xi, POLY)
    for b in (1.3 * 1.4, 1.3 / 1.4, 1.3 * 5):
        for xi in (0.001, 0.01, 0.1):
            row("lubricate/poly", 1.3, b, xi, POLY)
    one = measure(LUBRICATE, 1.3, 1.3, 0.01)
    print()
    for what, how in (("newton on", {"newton": "on"}), ("box 12", {"edge": 12.0}), ("box 200", {"edge": 200.0})):
        other = measure(LUBRICATE, 1.3, 1.3, 0.01, **how)
        print(f"lubricate, {what}: largest change {max(abs(x - y) for p, q in zip(one, other) for x, y in zip(p, q)) / one[3][0]:.1e} of X_A")
    flow_checks()
    noise_checks()
    print("second-opinion: what is equal, convention or different, and why: docs/lammps.md")


def flow_checks():
    """
    A pair along the flow of a sheared cell, at rest, and moving with the flow (U = (rate y, 0, 0), W = (0, 0, -rate/2)).

    With laboratory velocities the first feels nothing and the second F_1y = -(B_1 + B_2) rate/2. LAMMPS adds half of domain->h_rate to the
    spins to make them peculiar; h_rate is a length rate, rate x edge, so the spins are wrong by (edge - 1) rate/2 and so are force and torque.
    """
    rate, a, xi = 0.3, 1.3, 0.01
    ours = theory(a, a, xi)
    unit = -(ours["B_1"] + ours["B_2"]) * rate / 2
    print(f"\nsheared cell, rate {rate}, pair along the flow: F_1y over its value {unit:.6g} for a pair that moves with the flow")
    for name, style in (("lubricate", LUBRICATE), ("lubricate/poly", POLY)):
        for edge in (12.0, 60.0, 200.0):
            flow = [rate * edge / 2, 0, 0, rate * edge / 2, 0, 0, 0, 0, -rate / 2, 0, 0, -rate / 2]
            f = [measure(style, a, a, xi, edge=edge, shear=rate, motions=[m])[0][1] / unit for m in (flow, [0.0] * 12)]
            print(f"{name:16s} edge {edge:5g}: moving with the flow {f[0]:10.4f} (right: 1), at rest {f[1]:10.4f} (right: 0)", flush=True)


def draws(style, a, b, xi, kT, dt, count):
    """Noise forces and torques (12 numbers) of `count` steps on a frozen pair."""
    edge, h = 60.0, 0.5 * (a + b) * xi
    deck = [f"units lj\natom_style sphere\natom_modify map array\nnewton off\ncomm_modify vel yes\nboundary p p p\nregion r block 0 {edge} 0 {edge} 0 {edge}",
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


def noise_checks():
    kT, dt, count = 0.31, 1e-3, 8000
    blocks = (("<F1n F1n>", 0, 0, (3, 0)), ("<F1t F1t>", 1, 1, (4, 1)), ("<F1t F2t>", 1, 4, None), ("<F1t T1t>", 1, 8, (8, 1)),
              ("<T1t T1t>", 8, 8, None), ("<T1t T2t>", 8, 11, None))
    print(f"\nnoise of a frozen pair, {count} draws: covariance over (2 kT/dt) times LAMMPS's own R of the drag style; error about {math.sqrt(2 / count) * 1.2:.3f}")
    print(f"{'style':34s} {'b/a':>5s} {'xi':>7s} " + " ".join(f"{b[0]:>10s}" for b in blocks) + f" {'F1+F2':>9s}")
    for name, noise, drag, b in (("brownian", "brownian {eta!r} 1 0 {inner!r} {outer!r} {kT!r} 4711 1 0", LUBRICATE, 1.3),
                                 ("brownian/poly, equal", "brownian/poly {eta!r} 1 0 {inner!r} {outer!r} {kT!r} 4711 1 0", POLY, 1.3),
                                 ("brownian/poly", "brownian/poly {eta!r} 1 0 {inner!r} {outer!r} {kT!r} 4711 1 0", POLY, 1.82)):
        xi = 0.01
        z, columns = draws(noise, 1.3, b, xi, kT, dt, count), measure(drag, 1.3, b, xi)
        ratios = []
        for _, p, q, _ in blocks:
            if p == q == 1 or (p, q) in ((1, 4), (8, 8), (8, 11)):      # both tangential directions
                other = {1: 2, 4: 5, 8: 7, 11: 10}
                measured = sum(r[p] * r[q] + r[other[p]] * r[other[q]] for r in z) / (2 * len(z))
            else:
                measured = sum(r[p] * r[q] for r in z) / len(z)
            ratios.append(measured / (-2 * kT / dt * columns[q][p]))
        total = max(abs(r[k] + r[3 + k]) for r in z for k in range(3)) / max(abs(r[k]) for r in z for k in range(3))
        print(f"{name:34s} {b / 1.3:5.2f} {xi:7.4f} " + " ".join(f"{r:10.3f}" for r in ratios) + f" {total:9.1e}", flush=True)


if __name__ == "__main__":
    main()
