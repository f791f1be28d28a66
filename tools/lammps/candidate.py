#!/usr/bin/env python3
"""Stock LAMMPS as a candidate of the gate, and `shear --export lammps`: a worked example of an adapter, sharing nothing with our solver.

    lammps-candidate [--own poly|equal|theory|reference] CASE_DIR OUT_DIR    answer a case (docs/formats.md) with `lmp`, or the program that LMP names
    lammps-candidate --deck CASE_DIR OUT_DIR                        write deck and data, run nothing

What stock styles have no exact equivalent of ends with exit code 77 and the reason. --own lets LAMMPS's own lubrication, noise and uniform
random numbers stand for those of the scene: lubricate/poly and brownian/poly, or lubricate and brownian (equal spheres). --own theory
takes lubrication, drag and noise from validation/theory through LAMMPS's library (host.c), for `run` alone. --own reference: theory where no stock
style is exact, else stock styles. How LAMMPS (29 Sep 2021) differs from docs/formats.md, and what is done about it:

  axes        its shears are xy, xz, yz only: axes are renamed so that the flow is along x and the gradient along y; a renaming that mirrors
              space changes the sign of spins and torques.
  velocities  laboratory ones, as ours; image velocities need `remap v` and `comm_modify vel yes`. read_data wraps x without changing
              u, so spheres are written inside the cell with image counts and the velocity of that image.
  drag        fix langevin at T = 0 is -(m/damp) u with damp = m/(6 pi eta a) of species 1, `scale` for the others; with the bias of
              temp/deform u is relative to h_rate * lamda = rate (y - ylo), which is U_inf as the cell starts at y = 0. `omega yes` is
              -8 pi eta a^3 w (its 10/3 times 2/5 m a^2/damp), towards no spin: right at rest only.
  noise       fix langevin draws uniform numbers; near velocity zero its force is noise alone. With a bias it draws none along a component
              whose velocity beyond the bias is exactly zero, hence 1e-200.
  cell        fix deform moves it at the end of a step, so forces see the cell of the step before. A first step therefore lets only the cell
              move (no sphere is integrated); from then on forces see the cell of their own time. `start`, `stop` give `run 0` a flow rate.
  flips       where the tilt flips, spheres outside at that moment are wrapped without changing velocity (mended upstream by pull request
              4577). So the cell never flips here: its tilt runs from minus to plus half of what it changes by, up to 16 strains.
  friction    that first step would advance the history of a pair that touches: such a start is refused.
  stress      is minus the pressure; six components, which is all for central forces. Frictional contacts are added up pair by pair.
"""
import csv, json, math, os, struct, subprocess, sys

PI = math.pi
VOIGT = ((0, 3, 4), (3, 1, 5), (4, 5, 2))       # LAMMPS's order xx yy zz xy xz yz
NOISES = {"drag_noise": "drag", "lubrication_noise": "lubrication"}


def stop(code, text):
    print("lammps-candidate: " + text if code == 1 else text, file=sys.stderr)
    sys.exit(code)


def only(where, what, known):
    for key in where:
        if key not in known.split():
            stop(77, f"stock LAMMPS styles have no exact equivalent of {what} \"{key}\" of the scene")


def need(condition, text):
    if not condition:
        stop(77, text)


class Task:
    """The question in LAMMPS's axes: `case` and `scene` as read, cell, species, particles by state."""

    def __init__(self, folder, own):
        self.case = json.load(open(os.path.join(folder, "case.json")))
        self.scene = scene = json.load(open(os.path.join(folder, self.case["scene"])))
        self.protocol, self.forces, self.own = self.case["protocol"], scene.get("forces", {}), own
        only(scene, "the key", "$schema about dimensions seed realisation fluid box shear species start forces dynamics run output")
        need(self.protocol in ("forces", "noise", "run"), f"this adapter does not answer protocol \"{self.protocol}\"")
        need(scene.get("dimensions", 3) == 3, "this adapter writes three-dimensional boxes only")
        need("states" in self.case, "this adapter starts from states.csv: LAMMPS makes no packings")
        need(self.protocol != "noise" or not scene.get("shear"), "the noise of fix langevin alone is asked for at rest only")
        need("contacts" not in self.case, "tangential histories cannot be given to LAMMPS from outside")
        need(not scene.get("start", {}).get("thermal"), "thermal starting velocities are the candidate's own random numbers; this adapter draws none")
        for species in scene["species"]:
            only(species, "the species' key", "name radius density")
        self.radius = [s["radius"] for s in scene["species"]]
        self.mass = [4 / 3 * PI * s["density"] * s["radius"] ** 3 for s in scene["species"]]
        if own == "reference":
            turning = scene.get("shear") and self.forces.get("drag", {}).get("torque")
            self.own = own = "theory" if turning or "lubrication" in self.forces or "drag_noise" in self.forces or "contact" in self.forces and "repulsion" in self.forces else None
        self.eta, self.kT = scene.get("fluid", {}).get("viscosity"), scene.get("fluid", {}).get("kT", 0)
        self.read_box()
        self.check_forces()
        self.read_protocol()
        self.read_states(folder)

    def read_box(self):
        box, shears = self.scene["box"], self.scene.get("shear", [])
        need(len(shears) <= 1, "this adapter takes one simple shear, not a superposition")
        need(all(box["periodic"]), "this adapter writes boxes that are periodic in all directions")
        need("lengths" in box, "this adapter takes box.lengths, not a general cell: LAMMPS's cells are lower triangular")
        flow, gradient, self.rate = ("xyz".index(shears[0]["flow"]), "xyz".index(shears[0]["gradient"]), shears[0]["rate"]) if shears else (0, 1, 0)
        self.axis = (flow, gradient, 3 - flow - gradient)
        self.handed = 1 if (gradient - flow) % 3 == 1 else -1
        self.edge = [box["lengths"][k] for k in self.axis]
        self.volume = math.prod(self.edge)
        self.time = self.scene.get("start", {}).get("time", 0)
        self.tilt = math.remainder(self.rate * self.edge[1] * self.time, self.edge[0])     # the cell vector is known up to multiples of the first

    def check_forces(self):
        only(self.forces, "the force", "contact drag drag_noise lubrication lubrication_noise repulsion applied tether")
        contact, drag = self.forces.get("contact", {}), self.forces.get("drag", {})
        only(contact, "the contact's key", "normal_stiffness tangential_stiffness friction lever law normal_damping tangential_damping tension cap")
        self.friction = contact.get("friction", 0)
        need(contact.get("law", "plain") == "plain", "gran/hooke/history has the plain friction law only")
        need(not self.friction or contact["lever"] == "radius", "gran/hooke/history turns contacts about the full radii: only \"lever\": \"radius\"")
        need("normal_damping" not in contact or contact["tension"] == "allow" and (not self.friction or contact["cap"] == "absolute"),
             "gran/hooke/history lets contacts pull and caps friction by the absolute damped force: only \"allow\" and \"absolute\"")
        need(self.own != "theory" or self.protocol == "run", "the host of validation/theory answers protocol run only")
        need(self.own == "theory" or not (drag.get("torque") and self.rate),
             "fix langevin damps spins towards zero, not towards half the vorticity: in shear \"torque\" must be false")
        if not self.own:
            need("lubrication" not in self.forces,
                 "lubricate has other spin terms and wrong spins in shear, lubricate/poly breaks the third law at unequal radii: no equivalent of \"lubrication\"")
        need(self.forces.get("lubrication", {}).get("rotation_correction", "none") == "none", "lubricate has no rotation correction")
        own_law = self.own is not None
        for noise in NOISES:
            need(own_law or noise not in self.forces or self.forces[noise]["distribution"] == "uniform",
                 f"LAMMPS draws uniform numbers: {noise} must have \"distribution\": \"uniform\"")
        need(all("torque" not in a for a in self.forces.get("applied", {}).values()),
             "fix addtorque turns a group as a whole: no equivalent of an applied torque on each sphere")
        need("tether" not in self.forces or not self.rate, "fix spring/self keeps its anchors in the moving cell: a tether only without shear")

    def read_protocol(self):
        verlet, run, output = self.scene["dynamics"].get("verlet"), self.scene.get("run", {}), self.scene.get("output", {})
        self.steps = self.stress_every = self.states_every = 0
        need(verlet, "fix nve/sphere is half-step velocity Verlet: only \"dynamics\": { \"verlet\": ... }")
        self.dt = verlet["dt"]
        need(isinstance(self.dt, (int, float)), "the step must be a number")
        if self.protocol == "run":
            self.steps = round(run["steps"] if "steps" in run else run["time"] / self.dt if "time" in run else run["strain"] / (abs(self.rate) * self.dt))
            only(output, "the output", "stress states")
            self.stress_every = output.get("stress", {}).get("every", 0)
            states = output.get("states", {})
            need(not states.get("turn"), "LAMMPS does not integrate the angle that a sphere has turned through")
            self.states_every = math.gcd(states.get("every", 0), *states.get("at", []))
            change = self.rate * self.edge[1] * self.dt * self.steps
            need(abs(change) <= 16 * self.edge[0], "a run of more than 16 strains needs flips of LAMMPS's cell, which give some spheres a wrong velocity")
            self.tilt -= round(change / 2 / self.edge[0]) * self.edge[0]
        self.first = max(self.stress_every, 1) * max(self.states_every, 1)      # LAMMPS's number of step 0: fixes act at multiples

    def read_states(self, folder):
        self.states = {}
        with open(os.path.join(folder, self.case["states"])) as file:
            for row in csv.DictReader(line for line in file if line[0] not in "#\n"):
                x, u, w = ([float(row.get(n + "xyz"[k]) or 0) for k in self.axis] for n in ("", "u", "w"))
                self.states.setdefault(int(row.get("state") or 0), []).append((int(row["id"]), int(row["species"]) - 1, x, u, [self.handed * v for v in w]))
        need(not (self.protocol == "run" and self.friction and self.touching()),
             "a frictional run must start without contacts: LAMMPS would advance their history once before the first step")

    def touching(self):
        L, particles = self.edge, self.states[0]
        for a, (_, s, x, *_) in enumerate(particles):
            for (_, t, y, *_) in particles[a + 1:]:
                z, dy = math.remainder(y[2] - x[2], L[2]), y[1] - x[1]
                for n in range(round(-dy / L[1]) - 1, round(-dy / L[1]) + 2):
                    if math.hypot(math.remainder(y[0] - x[0] + n * self.tilt, L[0]), dy + n * L[1], z) < self.radius[s] + self.radius[t]:
                        return True
        return False


def write_data(t, state, out):
    with open(os.path.join(out, f"lammps-{state}.data"), "w") as f:
        L, rows = t.edge, t.states[state]
        f.write(f"spheres\n\n{len(rows)} atoms\n{len(t.radius)} atom types\n\n" + "".join(f"0 {L[k]!r} {'xyz'[k]}lo {'xyz'[k]}hi\n" for k in range(3)))
        f.write(f"{t.tilt!r} 0 0 xy xz yz\n\nAtoms # sphere\n\n")
        speeds = ""
        for id, s, x, u, w in rows:
            ny, nz = math.floor(x[1] / L[1]), math.floor(x[2] / L[2])
            nx = math.floor((x[0] - x[1] / L[1] * t.tilt) / L[0])
            inside = (x[0] - ny * t.tilt - nx * L[0], x[1] - ny * L[1], x[2] - nz * L[2])
            f.write(f"{id} {s + 1} {2 * t.radius[s]!r} {t.scene['species'][s]['density']!r} {inside[0]!r} {inside[1]!r} {inside[2]!r} {nx} {ny} {nz}\n")
            v = (1e-200,) * 3 if t.protocol == "noise" else (u[0] - ny * t.rate * L[1], u[1], u[2])
            speeds += f"{id} " + " ".join(repr(c) for c in (*v, *w)) + "\n"
        f.write("\nVelocities\n\n" + speeds)


def pair_styles(t, forces):
    """(style with its arguments, coefficients by pair of types, comment) of each pair force asked for."""
    a, found, kind = t.radius, [], "/poly" if t.own == "poly" else ""
    pairs = [(i, j) for i in range(len(a)) for j in range(i, len(a))]
    if "contact" in forces:
        c = t.forces["contact"]
        gn = c.get("normal_damping", 0)
        gt = c.get("tangential_damping", 0) if t.friction else 0
        style = f"gran/hooke/history {c['normal_stiffness']!r} {c['tangential_stiffness']!r} {gn!r} {gt!r} {t.friction!r} {int(gt > 0)}" if t.friction \
            else f"gran/hooke {c['normal_stiffness']!r} 0 {gn!r} 0 0 0"
        found.append((style, ["* *"], "forces.contact: k_n delta, m_eff gamma_n dashpot; tangential spring k_t with Coulomb's cap, full radii as lever arms"))
    if "repulsion" in forces and t.own != "theory":
        r, coefficients = t.forces["repulsion"], []
        for i, j in pairs:
            kappa, touch = r["kappa_factor"] * (a[i] + a[j]), a[i] + a[j]
            A = r["energy"] if r["form"] == "energy" else r["force"] * kappa
            coefficients.append(f"{i + 1} {j + 1} {A!r} {kappa!r} {touch!r} 0 0 {touch + r['cutoff'] * kappa!r}")
        found.append((f"born {2 * max(a) * (1 + r['cutoff'] * r['kappa_factor'])!r}", coefficients,
                      "forces.repulsion: A exp(-h/kappa) is born's A exp((sigma - r)/rho) with C = D = 0"))
    for name, head in () if t.own == "theory" else (("lubrication", f"lubricate{kind} {t.eta!r} 1 0"), ("lubrication_noise", f"brownian{kind} {t.eta!r} 1 0")):
        if name in forces:
            l = t.forces["lubrication"]
            inner, outer = (lambda i, j, g=g: (a[i] + a[j]) * (1 + g / 2) for g in (l["inner_gap"], l["outer_gap"]))
            tail = f" {t.kT!r} {t.case.get('seed', t.scene.get('seed', 1)) % 900000000 + 1}" if name == "lubrication_noise" else ""
            k = a.index(max(a))
            found.append((f"{head} {inner(k, k)!r} {outer(k, k)!r}{tail} 1 0", [f"{i + 1} {j + 1} {inner(i, j)!r} {outer(i, j)!r}" for i, j in pairs],
                          "forces.lubrication: LAMMPS's own near-field scalars, NOT those of the scene"))
    return found


def physics(t, state, forces):
    """The deck from the data file to the computes, with only these forces."""
    a, lines = t.radius, []
    put = lines.append
    put("clear\nunits lj\natom_style sphere\nboundary p p p\nnewton off\ncomm_modify vel yes       # ghosts know velocities: image velocity = rate x cell\nbox tilt large")
    put(f"read_data lammps-{state}.data")
    styles = pair_styles(t, forces)
    hybrid = len(styles) > 1
    if not styles:
        put(f"pair_style zero {2 * max(a)!r}\npair_coeff * *")
    for _, _, comment in styles:
        put("# " + comment)
    if styles:
        put("pair_style " + ("hybrid/overlay " if hybrid else "") + " ".join(s for s, _, _ in styles))
    for style, coefficients, _ in styles:
        for c in coefficients:
            i, j, *rest = c.split()
            put(" ".join(["pair_coeff", i, j, *([style.split()[0]] if hybrid else []), *rest]))
    # The skin costs neighbours, but LAMMPS also rebuilds its lists when a corner of the sheared cell has moved half of it.
    if t.own == "theory":   # reads the same list up to the outer cut-off; the rest of the skin lasts while no sphere moves by half of it
        r = t.forces.get("repulsion", {"cutoff": 0, "kappa_factor": 0})
        reach, rest = 2 * max(a) * max(t.forces.get("lubrication", {}).get("outer_gap", 0), r["cutoff"] * r["kappa_factor"]), 0.2 * min(a)
        fast = 8 * math.sqrt(t.kT / min(t.mass)) + 20 * abs(t.rate) * max(a)
        put(f"neighbor {reach + rest!r} bin\nneigh_modify every {min(200, max(10, int(0.4 * rest / (fast * t.dt))))} delay 0 check no\nfix host all external pf/callback 1 1")
    else:
        put(f"neighbor {max(0.3 * min(a), min(1.2 * min(a), 0.08 * t.edge[1]))!r} bin\nneigh_modify every 1 delay 0 check yes")
    put(f"# shear: dU_x/dy; `remap v` changes the velocity of what crosses a face\nfix flow all deform 1 xy erate {t.rate!r} remap v flip no")
    put("compute c all temp/deform\ncompute pp all pressure NULL pair\ncompute pk all pressure c ke")
    put("thermo_style custom step " + " ".join(f"c_{p}[{k}]" for p in ("pp", "pk") for k in range(1, 7)) + "\nthermo_modify format float %.17g lost error")
    if t.own != "theory" and ("drag" in forces or "drag_noise" in forces):
        damp = [m / (6 * PI * t.eta * r) for m, r in zip(t.mass, a)]
        kT = t.kT if "drag_noise" in forces else 0
        scale = "".join(f" scale {k + 1} {damp[k] / damp[0]!r}" for k in range(1, len(a)))
        put(f"# forces.drag: -6 pi eta a (u - U_inf){' and its noise' if kT else ''}; `omega yes` is -8 pi eta a^3 w\n"
            f"fix drag all langevin {kT!r} {kT!r} {damp[0]!r} {t.scene.get('seed', 1) % 900000000 + 1}{scale}"
            f" omega {'yes' if t.forces['drag'].get('torque') else 'no'}\nfix_modify drag temp c")
    names = [s["name"] for s in t.scene["species"]]
    for name in ("applied", "tether"):
        for species, value in t.forces.get(name, {}).items() if name in forces else ():
            k = names.index(species) + 1
            vector = " ".join(repr(value["force"][j]) for j in t.axis) if name == "applied" else ""
            put(f"# forces.{name} on {species}\ngroup {name}{k} type {k}\nfix {name}{k} {name}{k} "
                + (f"addforce {vector}" if name == "applied" else f"spring/self {value['stiffness']!r}"))
    return "\n".join(lines) + "\n"


def write_deck(t, f):
    about = " ".join(t.scene.get("about", "").split())
    f.write(f"# {about}\n# LAMMPS's x, y, z are the scene's {', '.join('xyz'[k] for k in t.axis)}. Stress is minus the pressure; c_pp is that of pairs, c_pk the kinetic one.\n")
    named = [n for n in t.forces if n not in NOISES]
    if t.protocol == "forces":
        for state in t.states:
            for force in named:     # one frame of forces in the dump for each
                f.write(physics(t, state, [force]) + "timestep 1\ndump s all custom 1 lammps.dump id ix iy iz x y z fx fy fz tqx tqy tqz\n"
                        "dump_modify s append yes sort id format float %.17g\nrun 0 start 0 stop 1000\n")
    elif t.protocol == "noise":
        for noise in (n for n in NOISES if n in t.forces):
            f.write(physics(t, 0, [noise]) + f"timestep {t.dt!r}\ndump s all custom 1 lammps-{noise}.dump id ix iy iz x y z fx fy fz tqx tqy tqz\n"
                    f"dump_modify s sort id format float %.17g\nrun {t.case['draws']}\n")
    else:
        f.write(physics(t, 0, t.forces))
        f.write(f"reset_timestep {t.first - 1}\ntimestep {t.dt!r}\ngroup moving empty\nfix move moving nve/sphere\nthermo {t.stress_every}\n")
        if t.states_every:
            f.write(f"dump s all custom {t.states_every} lammps.dump id ix iy iz x y z vx vy vz omegax omegay omegaz\ndump_modify s sort id format float %.17g\n")
        if t.stress_every and t.friction:
            f.write("compute pairs all pair/local dist force fx fy fz p1 p2 p3 cutoff radius\n"
                    f"dump p all local {t.stress_every} lammps.pairs c_pairs[*]\ndump_modify p format float %.17g\n")
        span = f"start {t.first - 1} stop {t.first + t.steps}"
        f.write(f"# one step in which only the cell moves, then all steps of the run; `pre no` keeps forces and lists\n"
                f"run 1 start {t.first - 1} stop {t.first + t.steps}\ngroup moving union all\nrun {t.steps} {span} pre no\n")


def write_parameters(t, out):
    """What host.c reads: see its head."""
    l = t.forces.get("lubrication", {})
    style = pair_styles(t, t.forces)[0][0].split()[0] if "contact" in t.forces else "zero"
    flags = [int(n in t.forces) for n in ("drag", "lubrication", "drag_noise", "lubrication_noise")]
    flags.insert(1, int(t.forces.get("drag", {}).get("torque", False)))
    need(len({t.forces[n]["distribution"] for n in NOISES if n in t.forces}) < 2, "the host draws all its numbers from one distribution")
    uniform = int(any(t.forces[n]["distribution"] == "uniform" for n in NOISES if n in t.forces))
    r = t.forces.get("repulsion", {"form": "energy", "energy": 0, "kappa_factor": 1, "cutoff": 0})
    repulsion = [int(r["form"] == "energy"), r[r["form"]], r["kappa_factor"], r["cutoff"]]
    values = [t.eta, t.rate, t.dt, t.kT, t.scene.get("seed", 1), t.scene.get("realisation", 0), uniform, *flags, l.get("inner_gap", 1), l.get("outer_gap", 0), *repulsion, t.stress_every, t.first, style]
    with open(os.path.join(out, "host.parameters"), "w") as f:
        f.write("\n".join(str(v) for v in values) + "\n")


def run_lammps(out, hosted):
    program = os.environ.get("LMP", "lmp")
    host = [os.path.join(os.path.dirname(os.path.realpath(__file__)), "lammps-host"), "in.lammps", "host.parameters"]
    try:
        done = subprocess.run(host if hosted else [program, "-in", "in.lammps", "-log", "lammps.log", "-screen", "none", "-nocite"], cwd=out, capture_output=True)
    except FileNotFoundError:
        stop(1, "the program lammps-host is not beside this one" if hosted else f"the LAMMPS program \"{program}\" was not found (Debian package lammps; or give its full path in the environment variable LMP)")
    if done.returncode or hosted and not os.path.getsize(os.path.join(out, "lammps.log")):
        errors = [line.strip() for line in open(os.path.join(out, "lammps.log")) if line.startswith("ERROR")]
        stop(1, f"LAMMPS stopped: {errors[-1] if errors else f'exit code {done.returncode}'} (see {out}/lammps.log)")


def frames(path):
    """(step, tilt, rows of numbers) of each frame of a dump."""
    with open(path) as f:
        while line := f.readline():
            if line.startswith("ITEM: TIMESTEP"):
                step, tilt = int(f.readline()), 0.0
            elif line.startswith("ITEM: NUMBER"):
                count = int(f.readline())
            elif line.startswith("ITEM: BOX"):
                tilt = float(f.readline().split()[2])
            elif line.startswith(("ITEM: ATOMS", "ITEM: ENTRIES")):
                yield step, tilt, [[float(v) for v in f.readline().split()] for _ in range(count)]


def pressures(out):
    """(step, pair stress, kinetic stress) of each line of thermodynamic output."""
    for line in open(os.path.join(out, "lammps.log")):
        words = line.split()
        if len(words) == 13 and words[0].isdigit():
            v = [-float(w) for w in words[1:]]
            yield int(words[0]), *([[v[o + VOIGT[a][b]] for b in range(3)] for a in range(3)] for o in (0, 6))


def tensor(t, s):
    """Nine components in the scene's axes, as cells."""
    turned = [[0] * 3 for _ in range(3)]
    for a in range(3):
        for b in range(3):
            turned[t.axis[a]][t.axis[b]] = s[a][b]
    return "".join(f",{v:.17g}" for row in turned for v in row)


def vector(t, v, handed=1):
    turned = [0.0] * 3
    for k in range(3):
        turned[t.axis[k]] = v[k] * handed
    return turned


def origins(t):
    found = (["contact_normal"] if "contact" in t.forces else []) + (["contact_tangential"] if t.friction else [])
    return found + [n for n in ("repulsion", "lubrication", "drag") if n in t.forces] + ["kinetic"]


def header(t):
    return "".join(f",{o}_{a}{b}" for o in origins(t) for a in "xyz" for b in "xyz") + "\n"


def drag_stresslet(t, state):
    """LAMMPS has no stresslet: (20/3) pi eta a^3 E is a constant of the scene, written down from it."""
    s = 20 / 3 * PI * t.eta * sum(t.radius[p[1]] ** 3 for p in t.states[state]) * t.rate / 2 / t.volume
    return [[0, s, 0], [s, 0, 0], [0, 0, 0]]


def contact_by_pairs(t, rows):
    """Normal and tangential stress: distance, normal force (positive: repulsion), its vector, tangential force, both on i; d = x_i - x_j."""
    parts = [[[0.0] * 3 for _ in range(3)] for _ in range(2)]
    for r, f, *v in rows:
        for part in range(2 if f else 0):
            for a in range(3):
                for b in range(3):
                    parts[part][a][b] -= v[3 * part + a] * r * v[b] / f / t.volume
    return parts


def read_pairs(t, out):
    """Contact stress of each frame of pairs; and slipping.csv for the gate's check of paths: contacts, and those at the cap."""
    found = {}
    with open(os.path.join(out, "slipping.csv"), "w") as f:
        f.write("step,contacts,slipping\n")
        for step, _, rows in frames(os.path.join(out, "lammps.pairs")):
            touching = [(abs(row[1]), math.hypot(*row[5:8])) for row in rows if row[1]]
            f.write(f"{step - t.first},{len(touching)},{sum(s >= t.friction * n * (1 - 1e-9) for n, s in touching)}\n")
            found[step] = contact_by_pairs(t, rows)
    return found


def stress_cells(t, state, part, kinetic):
    part = {**part, "kinetic": kinetic}
    if "drag" in t.forces:
        part["drag"] = drag_stresslet(t, state)
    return "".join(tensor(t, part[o]) for o in origins(t)) + "\n"


def answer_run(t, out):
    if t.stress_every:
        hosted = {}
        if t.own == "theory":
            for line in open(os.path.join(out, "host.stress")):
                step, *v = line.split()
                hosted[int(step)] = [[[float(v[9 * part + 3 * a + b]) / t.volume for b in range(3)] for a in range(3)] for part in range(2)]
        need(hosted or sum(o in origins(t) for o in ("contact_normal", "repulsion", "lubrication")) < 2, "LAMMPS does not tell the pressures of several pair styles apart")
        pairs = read_pairs(t, out) if t.friction else {}
        with open(os.path.join(out, "stress.csv"), "w") as f:
            f.write("step,time,strain" + header(t))
            last = -1
            for step, pair, kinetic in pressures(out):
                if step % t.stress_every or step < t.first or step == last:
                    continue        # printed anyway: first and last step of each of the two runs, and so step 0 twice
                last, passed = step, (step - t.first) * t.dt
                part = dict(zip(("contact_normal", "contact_tangential"), pairs[step])) if t.friction else {o: pair for o in origins(t)}
                if hosted:
                    part["lubrication"], part["repulsion"] = hosted[step]
                f.write(f"{step - t.first},{t.time + passed:.17g},{abs(t.rate) * passed:.17g}" + stress_cells(t, 0, part, kinetic))
    if t.states_every:
        with open(os.path.join(out, "trajectory.csv"), "w") as f:
            f.write("step,time,id,x,y,z,ux,uy,uz,wx,wy,wz\n")
            for step, tilt, rows in frames(os.path.join(out, "lammps.dump")):
                if step < t.first:
                    continue        # before the spheres began to move
                tilt -= t.rate * t.edge[1] * t.dt       # the cell in the dump is a step ahead
                for id, ix, iy, iz, x, y, z, ux, uy, uz, *w in rows:
                    place = vector(t, (x + ix * t.edge[0] + iy * tilt, y + iy * t.edge[1], z + iz * t.edge[2]))
                    cells = place + vector(t, (ux + iy * t.rate * t.edge[1], uy, uz)) + vector(t, w, t.handed)
                    f.write(f"{step - t.first},{t.time + (step - t.first) * t.dt:.17g},{id:.0f}," + ",".join(f"{c:.17g}" for c in cells) + "\n")


def answer_forces(t, out):
    dump, log = frames(os.path.join(out, "lammps.dump")), pressures(out)
    with open(os.path.join(out, "forces.csv"), "w") as f, open(os.path.join(out, "stress.csv"), "w") as s:
        f.write("state,force,id,fx,fy,fz,tx,ty,tz\n")
        s.write("state" + header(t))
        for state, rows in t.states.items():
            total, part, kinetic = [[0.0] * 6 for _ in rows], {}, None
            for force in (n for n in t.forces if n not in NOISES):
                (_, _, acting), (_, pair, kinetic) = next(dump), next(log)
                part.update({o: pair for o in ("contact_normal", force)} if force == "contact" else {force: pair})
                part.setdefault("contact_tangential", [[0] * 3] * 3)
                for k, v in enumerate(acting):
                    cells = vector(t, v[7:10]) + vector(t, v[10:13], t.handed)
                    total[k] = [a + b for a, b in zip(total[k], cells)]
                    f.write(f"{state},{force},{v[0]:.0f}," + ",".join(f"{c:.17g}" for c in cells) + "\n")
            for k, cells in enumerate(total):
                f.write(f"{state},total,{k + 1}," + ",".join(f"{c:.17g}" for c in cells) + "\n")
            s.write(f"{state}" + stress_cells(t, state, part, kinetic))


def answer_noise(t, out):
    for noise in (n for n in NOISES if n in t.forces):
        path = os.path.join(out, f"lammps-{noise}.dump")
        head = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({t.case['draws']}, {len(t.states[0])}, 6), }}"
        with open(os.path.join(out, f"noise_{noise}.npy"), "wb") as f:
            f.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", 118) + (head.ljust(117) + "\n").encode())
            for k, (_, _, rows) in enumerate(frames(path)):
                for v in rows if k else ():     # the first frame is that of the set-up
                    f.write(struct.pack("<6d", *vector(t, v[7:10]), *vector(t, v[10:13], t.handed)))
        os.remove(path)


def main(words):
    deck_only = words[:1] == ["--deck"]
    own = words[1] if words[:1] == ["--own"] and len(words) > 1 else None
    if len(words) != 2 + deck_only + 2 * bool(own) or own not in (None, "poly", "equal", "theory", "reference"):
        print(__doc__, file=sys.stderr)
        return 2
    folder, out = words[-2:]
    t = Task(folder, own)
    os.makedirs(out, exist_ok=True)
    for state in t.states:
        write_data(t, state, out)
    with open(os.path.join(out, "in.lammps"), "w") as f:
        write_deck(t, f)
    if deck_only:
        return 0
    open(os.path.join(out, "lammps.dump"), "w").close()     # frozen states append to it
    if t.own == "theory":
        write_parameters(t, out)
    run_lammps(out, t.own == "theory")
    {"forces": answer_forces, "noise": answer_noise, "run": answer_run}[t.protocol](t, out)
    return 0


sys.exit(main(sys.argv[1:]))
