"""The gate's second code: stock LAMMPS where its styles are exact, else LAMMPS's library with the resistances of validation/theory (host.c).

    --own theory      lubrication, drag and noise from validation/theory, contacts, integration, cell, images and lists from LAMMPS; for `run` alone
    --own reference   theory where no stock style is exact, else stock styles
"""
import json, math, os, sys
from lammps_stock import NOISES, Stock, need


class Exact(Stock):
    """Stock styles, with what the gate's check of paths and `make retrace` want to know besides."""
    loads = " fx fy fz tqx tqy tqz"

    def contact_stress(self, step, rows):
        """Also slipping.csv: how many contacts there are, and how many are at the cap."""
        touching = [row for row in rows if row[1]]
        slipping = sum(math.hypot(*row[5:8]) >= self.friction * abs(row[1]) * (1 - 1e-9) for row in touching)
        self.slips.append(f"{step - self.first},{len(touching)},{slipping}\n")
        return super().contact_stress(step, touching)

    def answer_run(self, out):
        self.slips = ["step,contacts,slipping\n"]
        super().answer_run(out)
        with open(os.path.join(out, "slipping.csv"), "w") as file:
            file.writelines(self.slips)


class Theory(Exact):
    """A deck without the forces that lammps-host serves, and the parameters that it reads (head of host.c)."""
    tells_apart = True

    def check_forces(self):
        need(self.protocol == "run", "the host of validation/theory answers protocol run only")

    def pair_styles(self, forces):
        return super().pair_styles([n for n in forces if n == "contact"])

    def drag(self, forces):
        return ""

    def neighbour_list(self):
        # the host reads the same list up to the outer cut-off; the rest of the skin lasts while no sphere moves by half of it
        a, r = self.radius, self.forces.get("repulsion", {"cutoff": 0, "kappa_factor": 0})
        reach, rest = 2 * max(a) * max(self.forces.get("lubrication", {}).get("outer_gap", 0), r["cutoff"] * r["kappa_factor"]), 0.2 * min(a)
        fast = 8 * math.sqrt(self.kT / min(self.mass)) + 20 * abs(self.rate) * max(a)
        every = min(200, max(10, int(0.4 * rest / (fast * self.dt))))
        return f"neighbor {reach + rest!r} bin\nneigh_modify every {every} delay 0 check no\nfix host all external pf/callback 1 1"

    def command(self):
        host = os.path.join(os.path.dirname(os.path.realpath(__file__)), "lammps-host")
        if not os.path.exists(host):
            sys.exit("lammps-candidate: the program lammps-host is not beside this one")
        return [host, "in.lammps", "host.parameters"]

    def run_lammps(self, out):
        write_parameters(self, out)
        super().run_lammps(out)

    def stress_parts(self, out):
        known = super().stress_parts(out)
        for line in open(os.path.join(out, "host.stress")):
            step, *v = line.split()
            lubrication, repulsion = ([[float(v[9 * part + 3 * a + b]) / self.volume for b in range(3)] for a in range(3)] for part in range(2))
            known.setdefault(int(step), {}).update(lubrication=lubrication, repulsion=repulsion)
        return known


def write_parameters(t, out):
    """What host.c reads: see its head."""
    l = t.forces.get("lubrication", {})
    style = t.pair_styles(t.forces)[0][0].split()[0] if "contact" in t.forces else "zero"
    flags = [int(n in t.forces) for n in ("drag", "lubrication", "drag_noise", "lubrication_noise")]
    flags.insert(1, int(t.forces.get("drag", {}).get("torque", False)))
    need(len({t.forces[n]["distribution"] for n in NOISES if n in t.forces}) < 2, "the host draws all its numbers from one distribution")
    uniform = int(any(t.forces[n]["distribution"] == "uniform" for n in NOISES if n in t.forces))
    r = t.forces.get("repulsion", {"form": "energy", "energy": 0, "kappa_factor": 1, "cutoff": 0})
    repulsion = [int(r["form"] == "energy"), r[r["form"]], r["kappa_factor"], r["cutoff"]]
    values = [t.eta, t.rate, t.dt, t.kT, t.scene.get("seed", 1), t.scene.get("realisation", 0), uniform, *flags, l.get("inner_gap", 1), l.get("outer_gap", 0), *repulsion, t.stress_every, t.first, style]
    with open(os.path.join(out, "host.parameters"), "w") as f:
        f.write("\n".join(str(v) for v in values) + "\n")


def reference(folder):
    """The class that answers this case exactly."""
    case = json.load(open(os.path.join(folder, "case.json")))
    scene = json.load(open(os.path.join(folder, case["scene"])))
    forces = scene.get("forces", {})
    turning = scene.get("shear") and forces.get("drag", {}).get("torque")
    return Theory if turning or "lubrication" in forces or "drag_noise" in forces or "contact" in forces and "repulsion" in forces else Exact
