"""The gate's adapter for stock LAMMPS: a case (docs/formats.md) in, a deck of stock styles, LAMMPS's numbers out. Nothing of our solver takes part.

What stock styles have no exact equivalent of ends with exit code 77 and the reason. How LAMMPS (29 Sep 2021) differs from docs/formats.md, and
what is done about it: docs/lammps.md, "What the adapter does about LAMMPS's conventions".
"""
import csv, json, math, os, subprocess, sys

PI = math.pi
VOIGT = ((0, 3, 4), (3, 1, 5), (4, 5, 2))       # LAMMPS's order xx yy zz xy xz yz
NOISES = ("drag_noise", "lubrication_noise")


def need(condition, text):
    if not condition:
        print(text, file=sys.stderr)
        sys.exit(77)


def only(where, what, known):
    for key in where:
        need(key in known.split(), f"stock LAMMPS styles have no exact equivalent of {what} \"{key}\" of the scene")


class Stock:
    """The question in LAMMPS's axes: `case` and `scene` as read, cell, species, particles by state; its deck; its answer."""
    tells_apart = False     # whether the stresses of several pair forces are known
    newton, loads = "off", ""   # loads: further columns of LAMMPS's dump, force and torque of each sphere

    # ---- reading a case, and refusing what has no equivalent ----

    def __init__(self, folder):
        self.case = json.load(open(os.path.join(folder, "case.json")))
        self.scene = scene = json.load(open(os.path.join(folder, self.case["scene"])))
        self.protocol, self.forces = self.case["protocol"], scene.get("forces", {})
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
        self.seed = (scene.get("seed", 1) + 104729 * scene.get("realisation", 0)) % 900000000 + 1
        self.eta, self.kT = scene.get("fluid", {}).get("viscosity"), scene.get("fluid", {}).get("kT", 0)
        self.read_box()
        self.check_contact()
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
        self.handed = 1 if (gradient - flow) % 3 == 1 else -1       # a renaming that mirrors space changes the sign of spins
        self.edge = [box["lengths"][k] for k in self.axis]
        self.volume = math.prod(self.edge)
        self.time = self.scene.get("start", {}).get("time", 0)
        self.tilt = math.remainder(self.rate * self.edge[1] * self.time, self.edge[0])     # the cell vector is known up to multiples of the first

    def check_contact(self):
        contact = self.forces.get("contact", {})
        only(contact, "the contact's key", "normal_stiffness tangential_stiffness friction lever law normal_damping tangential_damping tension cap")
        self.friction = contact.get("friction", 0)
        need(contact.get("law", "plain") == "plain", "gran/hooke/history has the plain friction law only")
        need(not self.friction or contact["lever"] == "radius", "gran/hooke/history turns contacts about the full radii: only \"lever\": \"radius\"")
        need("normal_damping" not in contact or contact["tension"] == "allow" and (not self.friction or contact["cap"] == "absolute"),
             "gran/hooke/history lets contacts pull and caps friction by the absolute damped force: only \"allow\" and \"absolute\"")
        only(self.forces, "the force", "contact drag drag_noise lubrication lubrication_noise repulsion applied tether")
        need(self.forces.get("lubrication", {}).get("rotation_correction", "none") == "none", "lubricate has no rotation correction")
        need(all("torque" not in a for a in self.forces.get("applied", {}).values()),
             "fix addtorque turns a group as a whole: no equivalent of an applied torque on each sphere")
        need("tether" not in self.forces or not self.rate, "fix spring/self keeps its anchors in the moving cell: a tether only without shear")

    def check_drag(self):
        need(not (self.forces.get("drag", {}).get("torque") and self.rate),
             "fix langevin damps spins towards zero, not towards half the vorticity: in shear \"torque\" must be false")

    def check_forces(self):
        self.check_drag()
        need("lubrication" not in self.forces,
             "lubricate has other spin terms and wrong spins in shear, lubricate/poly breaks the third law at unequal radii: no equivalent of \"lubrication\"")
        need(self.forces.get("drag_noise", {}).get("distribution") != "gaussian", "LAMMPS draws uniform numbers: drag_noise must have \"distribution\": \"uniform\"")

    def read_protocol(self):
        run, output = self.scene.get("run", {}), self.scene.get("output", {})
        self.dt = self.scene["dynamics"].get("verlet", {}).get("dt")
        need(isinstance(self.dt, (int, float)), "fix nve/sphere is half-step velocity Verlet with a step that is a number: only \"dynamics\": { \"verlet\": { \"dt\": ... } }")
        if self.protocol != "run":
            return
        self.steps = run["steps"] if "steps" in run else math.ceil((run["time"] if "time" in run else run["strain"] / abs(self.rate)) / self.dt * (1 - 1e-12))
        only(output, "the output", "stress states")
        states, self.stress_every = output.get("states", {}), output.get("stress", {}).get("every", 0)
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
        L, at = self.edge, [(self.radius[s], x) for _, s, x, *_ in self.states[0]]
        pairs = ((a + b, [y[k] - x[k] for k in range(3)]) for i, (a, x) in enumerate(at) for b, y in at[i + 1:])
        return any(math.hypot(math.remainder(d[0] + n * self.tilt, L[0]), d[1] + n * L[1], math.remainder(d[2], L[2])) < reach
                   for reach, d in pairs for n in range(round(-d[1] / L[1]) - 1, round(-d[1] / L[1]) + 2))

    # ---- the deck ----

    def write_data(self, state, out):
        """The spheres of a state: inside the cell, with image counts and the velocity of that image."""
        with open(os.path.join(out, f"lammps-{state}.data"), "w") as f:
            L, rows, speeds = self.edge, self.states[state], ""
            f.write(f"spheres\n\n{len(rows)} atoms\n{len(self.radius)} atom types\n\n" + "".join(f"0 {L[k]!r} {'xyz'[k]}lo {'xyz'[k]}hi\n" for k in range(3)))
            f.write(f"{self.tilt!r} 0 0 xy xz yz\n\nAtoms # sphere\n\n")
            for id, s, x, u, w in rows:
                ny, nz = math.floor(x[1] / L[1]), math.floor(x[2] / L[2])
                nx = math.floor((x[0] - x[1] / L[1] * self.tilt) / L[0])
                inside = (x[0] - ny * self.tilt - nx * L[0], x[1] - ny * L[1], x[2] - nz * L[2])
                f.write(f"{id} {s + 1} {2 * self.radius[s]!r} {self.scene['species'][s]['density']!r} {inside[0]!r} {inside[1]!r} {inside[2]!r} {nx} {ny} {nz}\n")
                v = (1e-200,) * 3 if self.protocol == "noise" else (u[0] - ny * self.rate * L[1], u[1], u[2])   # at exactly 0 fix langevin draws no noise
                speeds += f"{id} " + " ".join(repr(c) for c in (*v, *w)) + "\n"
            f.write("\nVelocities\n\n" + speeds)

    def pairs_of_types(self):
        return [(i, j) for i in range(len(self.radius)) for j in range(i, len(self.radius))]

    def pair_styles(self, forces):
        """(style with its arguments, coefficients by pair of types, comment) of each pair force asked for."""
        a, found = self.radius, []
        if "contact" in forces:
            c = self.forces["contact"]
            gn = c.get("normal_damping", 0)
            gt = c.get("tangential_damping", 0) if self.friction else 0
            style = f"gran/hooke/history {c['normal_stiffness']!r} {c['tangential_stiffness']!r} {gn!r} {gt!r} {self.friction!r} {int(gt > 0)}" if self.friction \
                else f"gran/hooke {c['normal_stiffness']!r} 0 {gn!r} 0 0 0"
            found.append((style, ["* *"], "forces.contact: k_n delta, m_eff gamma_n dashpot; tangential spring k_t with Coulomb's cap, full radii as lever arms"))
        if "repulsion" in forces:
            r, coefficients = self.forces["repulsion"], []
            for i, j in self.pairs_of_types():
                kappa, touch = r["kappa_factor"] * (a[i] + a[j]), a[i] + a[j]
                A = r["energy"] if r["form"] == "energy" else r["force"] * kappa
                coefficients.append(f"{i + 1} {j + 1} {A!r} {kappa!r} {touch!r} 0 0 {touch + r['cutoff'] * kappa!r}")
            found.append((f"born {2 * max(a) * (1 + r['cutoff'] * r['kappa_factor'])!r}", coefficients,
                          "forces.repulsion: A exp(-h/kappa) is born's A exp((sigma - r)/rho) with C = D = 0"))
        return found

    def neighbour_list(self):
        # The skin costs neighbours, but LAMMPS also rebuilds its lists when a corner of the sheared cell has moved half of it.
        a = min(self.radius)
        return f"neighbor {max(0.3 * a, min(1.2 * a, 0.08 * self.edge[1]))!r} bin\nneigh_modify every 1 delay 0 check yes"

    def drag(self, forces):
        damp = [m / (6 * PI * self.eta * r) for m, r in zip(self.mass, self.radius)]
        kT = self.kT if "drag_noise" in forces else 0
        scale = "".join(f" scale {k + 1} {damp[k] / damp[0]!r}" for k in range(1, len(damp)))
        return (f"# forces.drag: -6 pi eta a (u - U_inf){' and its noise' if kT else ''}; `omega yes` is -8 pi eta a^3 w\n"
                f"fix drag all langevin {kT!r} {kT!r} {damp[0]!r} {self.seed}{scale}"
                f" omega {'yes' if self.forces['drag'].get('torque') else 'no'}\nfix_modify drag temp c")

    def physics(self, state, forces):
        """The deck from the data file to the fixes, with only these forces."""
        styles = self.pair_styles(forces) or [(f"zero {2 * max(self.radius)!r}", ["* *"], "no pair force")]
        hybrid = len(styles) > 1
        lines = ["clear\nunits lj\natom_style sphere\nboundary p p p\nnewton " + self.newton + "\ncomm_modify vel yes       # ghosts know velocities: image velocity = rate x cell\nbox tilt large",
                 f"read_data lammps-{state}.data"]
        lines += ["# " + comment for _, _, comment in styles]
        lines.append("pair_style " + ("hybrid/overlay " if hybrid else "") + " ".join(s for s, _, _ in styles))
        for style, coefficients, _ in styles:
            for i, j, *rest in map(str.split, coefficients):
                lines.append(" ".join(["pair_coeff", i, j, *([style.split()[0]] if hybrid else []), *rest]))
        lines += [self.neighbour_list(), f"# shear: dU_x/dy; `remap v` changes the velocity of what crosses a face\nfix flow all deform 1 xy erate {self.rate!r} remap v flip no",
                  "compute c all temp/deform\ncompute pp all pressure NULL pair\ncompute pk all pressure c ke",
                  "thermo_style custom step " + " ".join(f"c_{p}[{k}]" for p in ("pp", "pk") for k in range(1, 7)) + "\nthermo_modify format float %.17g lost error"]
        if "drag" in forces or "drag_noise" in forces:
            lines.append(self.drag(forces))
        names = [s["name"] for s in self.scene["species"]]
        for name in ("applied", "tether"):
            for species, value in self.forces.get(name, {}).items() if name in forces else ():
                k = names.index(species) + 1
                act = "addforce " + " ".join(repr(value["force"][j]) for j in self.axis) if name == "applied" else f"spring/self {value['stiffness']!r}"
                lines.append(f"# forces.{name} on {species}\ngroup {name}{k} type {k}\nfix {name}{k} {name}{k} {act}")
        return "\n".join(lines) + "\n"

    def write_deck(self, out):
        dump, exact = "dump s all custom {} {} id ix iy iz x y z {}\ndump_modify s{} sort id format float %.17g\n", "fx fy fz tqx tqy tqz"
        with open(os.path.join(out, "in.lammps"), "w") as f:
            f.write(f"# {' '.join(self.scene.get('about', '').split())}\n# LAMMPS's x, y, z are the scene's {', '.join('xyz'[k] for k in self.axis)}. "
                    "Stress is minus the pressure; c_pp is that of pairs, c_pk the kinetic one.\n")
            if self.protocol == "forces":
                for state in self.states:
                    for force in (n for n in self.forces if n not in NOISES):   # one frame of forces in the dump for each; `start`, `stop` give run 0 a flow rate
                        f.write(self.physics(state, [force]) + "timestep 1\n" + dump.format(1, "lammps.dump", exact, " append yes") + "run 0 start 0 stop 1000\n")
            elif self.protocol == "noise":
                for noise in (n for n in NOISES if n in self.forces):
                    f.write(self.physics(0, [noise]) + f"timestep {self.dt!r}\n" + dump.format(1, f"lammps-{noise}.dump", exact, "") + f"run {self.case['draws']}\n")
            else:
                f.write(self.physics(0, self.forces) + f"reset_timestep {self.first - 1}\ntimestep {self.dt!r}\ngroup moving empty\nfix move moving nve/sphere\nthermo {self.stress_every}\n")
                if self.states_every:
                    f.write(dump.format(self.states_every, "lammps.dump", "vx vy vz omegax omegay omegaz" + self.loads, ""))
                if self.stress_every and self.friction:
                    f.write("compute pairs all pair/local dist force fx fy fz p1 p2 p3 cutoff radius\n"
                            f"dump p all local {self.stress_every} lammps.pairs c_pairs[*]\ndump_modify p format float %.17g\n")
                span = f"start {self.first - 1} stop {self.first + self.steps}"
                f.write(f"# one step in which only the cell moves, then all steps of the run; `pre no` keeps forces and lists\n"
                        f"run 1 {span}\ngroup moving union all\nrun {self.steps} {span} pre no\n")

    def command(self):
        return [os.environ.get("LMP", "lmp"), "-in", "in.lammps", "-log", "lammps.log", "-screen", "none", "-nocite"]

    def run_lammps(self, out):
        words, log = self.command(), os.path.join(out, "lammps.log")
        for name in ("lammps.dump", "lammps.log"):      # frozen states append to the first
            open(os.path.join(out, name), "w").close()
        try:
            code = subprocess.run(words, cwd=out, capture_output=True).returncode
        except FileNotFoundError:
            sys.exit(f"lammps-candidate: the LAMMPS program \"{words[0]}\" was not found (Debian package lammps; or give its full path in the environment variable LMP)")
        if code or not os.path.getsize(log):
            errors = [line.strip() for line in open(log) if line.startswith("ERROR")]
            sys.exit(f"lammps-candidate: LAMMPS stopped: {errors[-1] if errors else f'exit code {code}'} (see {log})")

    # ---- the answer ----

    def vector(self, v, handed=1):
        """Three numbers in the scene's axes, or nothing of nothing."""
        return [v[self.axis.index(k)] * handed for k in range(3) if v]

    def origins(self):
        contact = (["contact_normal"] if "contact" in self.forces else []) + (["contact_tangential"] if self.friction else [])
        return contact + [n for n in ("repulsion", "lubrication", "drag") if n in self.forces] + ["kinetic"]

    def header(self):
        return "".join(f",{o}_{a}{b}" for o in self.origins() for a in "xyz" for b in "xyz") + "\n"

    def stress_cells(self, state, part, kinetic):
        """Nine components of each origin in the scene's axes. LAMMPS has no stresslet: (20/3) pi eta a^3 E is a constant of the scene, written down from it."""
        part = {**part, "kinetic": kinetic}
        if "drag" in self.forces:
            s = 20 / 3 * PI * self.eta * sum(self.radius[p[1]] ** 3 for p in self.states[state]) * self.rate / 2 / self.volume
            part["drag"] = [[0, s, 0], [s, 0, 0], [0, 0, 0]]
        at = [self.axis.index(k) for k in range(3)]
        return "".join(f",{part[o][a][b]:.17g}" for o in self.origins() for a in at for b in at) + "\n"

    def contact_stress(self, step, rows):
        """Normal and tangential, added up pair by pair: distance, normal force (positive: repulsion), its vector, tangential force, both on i; d = x_i - x_j."""
        parts = [[[-sum(v[3 * which + a] * r * v[b] / f for r, f, *v in rows if f) / self.volume for b in range(3)] for a in range(3)] for which in range(2)]
        return dict(zip(("contact_normal", "contact_tangential"), parts))

    def stress_parts(self, out):
        """Stress by origin at each step where LAMMPS's pressure of all pairs is not enough."""
        need(self.tells_apart or sum(o in self.forces for o in ("contact", "repulsion", "lubrication")) < 2, "LAMMPS does not tell the pressures of several pair styles apart")
        return {step: self.contact_stress(step, rows) for step, _, rows in frames(os.path.join(out, "lammps.pairs"))} if self.friction else {}

    def answer_run(self, out):
        if self.stress_every:
            known, printed = self.stress_parts(out), {step: stress for step, *stress in pressures(out)}     # of both runs, and so some steps twice
            with open(os.path.join(out, "stress.csv"), "w") as f:
                f.write("step,time,strain" + self.header())
                for step in range(self.first, self.first + self.steps + 1, self.stress_every):
                    (pair, kinetic), passed = printed[step], (step - self.first) * self.dt
                    part = {**{o: pair for o in self.origins()}, **known.get(step, {})}
                    f.write(f"{step - self.first},{self.time + passed:.17g},{abs(self.rate) * passed:.17g}" + self.stress_cells(0, part, kinetic))
        if self.states_every:
            with open(os.path.join(out, "trajectory.csv"), "w") as f:
                f.write("step,time,id,x,y,z,ux,uy,uz,wx,wy,wz" + (",fx,fy,fz,tx,ty,tz" if self.loads else "") + "\n")
                for step, tilt, rows in frames(os.path.join(out, "lammps.dump")):
                    tilt -= self.rate * self.edge[1] * self.dt       # the cell in the dump is a step ahead
                    for id, ix, iy, iz, x, y, z, ux, uy, uz, *w in rows if step >= self.first else ():   # before, the spheres do not move
                        place = self.vector((x + ix * self.edge[0] + iy * tilt, y + iy * self.edge[1], z + iz * self.edge[2]))
                        cells = place + self.vector((ux + iy * self.rate * self.edge[1], uy, uz)) + self.vector(w, self.handed) + self.vector(w[3:]) + self.vector(w[6:], self.handed)
                        f.write(f"{step - self.first},{self.time + (step - self.first) * self.dt:.17g},{id:.0f}," + ",".join(f"{c:.17g}" for c in cells) + "\n")

    def answer_forces(self, out):
        dump, log = frames(os.path.join(out, "lammps.dump")), pressures(out)
        with open(os.path.join(out, "forces.csv"), "w") as f, open(os.path.join(out, "stress.csv"), "w") as s:
            f.write("state,force,id,fx,fy,fz,tx,ty,tz\n")
            s.write("state" + self.header())
            for state, rows in self.states.items():
                total, part, kinetic = [[0.0] * 6 for _ in rows], {"contact_tangential": [[0] * 3] * 3}, None
                for force in (n for n in self.forces if n not in NOISES):
                    (_, _, acting), (_, pair, kinetic) = next(dump), next(log)
                    part["contact_normal" if force == "contact" else force] = pair
                    for k, v in enumerate(acting):
                        cells = self.vector(v[7:10]) + self.vector(v[10:13], self.handed)
                        total[k] = [a + b for a, b in zip(total[k], cells)]
                        f.write(f"{state},{force},{v[0]:.0f}," + ",".join(f"{c:.17g}" for c in cells) + "\n")
                for k, cells in enumerate(total):
                    f.write(f"{state},total,{k + 1}," + ",".join(f"{c:.17g}" for c in cells) + "\n")
                s.write(f"{state}" + self.stress_cells(state, part, kinetic))

    def answer_noise(self, out):
        for noise in (n for n in NOISES if n in self.forces):
            path = os.path.join(out, f"lammps-{noise}.dump")
            with open(os.path.join(out, f"noise_{noise}.txt"), "w") as f:
                for k, (_, _, rows) in enumerate(frames(path)):
                    for v in rows if k else ():     # the first frame is that of the set-up
                        f.write(" ".join(f"{c:.17g}" for c in self.vector(v[7:10]) + self.vector(v[10:13], self.handed)) + "\n")
            os.remove(path)


def frames(path):
    """(step, tilt, rows of numbers) of each frame of a dump: nine lines of head, of which the second, fourth and sixth are read."""
    with open(path) as f:
        while head := [f.readline().split() for _ in range(9)]:
            if not head[0]:
                return
            yield int(head[1][0]), float(head[5][2]), [[float(v) for v in f.readline().split()] for _ in range(int(head[3][0]))]


def pressures(out):
    """(step, pair stress, kinetic stress) of each line of thermodynamic output; stress is minus the pressure."""
    for line in open(os.path.join(out, "lammps.log")):
        words = line.split()
        if len(words) == 13 and words[0].isdigit():
            v = [-float(w) for w in words[1:]]
            yield int(words[0]), *([[v[o + VOIGT[a][b]] for b in range(3)] for a in range(3)] for o in (0, 6))
