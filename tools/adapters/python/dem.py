"""Spheres with contact, friction, drag and lubrication in a sheared periodic cell, by velocity Verlet. Written from docs/physics.md and
docs/integrators.md alone: the code under test. Plain Python, so some 20 000 particle steps a second.

n points from i to j, forces are those on a particle, velocities are laboratory ones, a stress is force (x) position over the volume.
Particles are never put back into the cell: images are counted from where they are, in the lattice as the flow has sheared it.
"""
from itertools import product
from math import ceil, floor, log, pi, sqrt

ORIGINS = {"contact": ("contact_normal", "contact_tangential"), "drag": ("drag",), "lubrication": ("lubrication",)}


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]

def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

def plus(a, b, scale=1.0):
    return (a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2])

def times(s, a):
    return (s * a[0], s * a[1], s * a[2])

def across(a, n):
    """The part of a across the unit vector n."""
    return plus(a, n, -dot(a, n))

def apply(matrix, a):
    return (dot(matrix[0], a), dot(matrix[1], a), dot(matrix[2], a))


class Spheres:
    """One system. `cell`: three cell vectors at time 0; `gradient[i][k]`: dU_i/dx_k; `forces`: their constants as in a scene;
    `histories`: {(i, j): displacement of the surface of i against that of j}, i < j."""

    def __init__(self, x, u, w, radius, density, cell, periodic, gradient, viscosity, forces, dt, time=0.0, histories=None, turns=None):
        self.x, self.u, self.w, self.a = list(x), list(u), list(w), radius
        self.mass = [4 / 3 * pi * rho * a ** 3 for rho, a in zip(density, radius)]
        self.inertia = [0.4 * m * a * a for m, a in zip(self.mass, radius)]
        self.cell0, self.periodic, self.gradient, self.eta, self.dt, self.time = cell, periodic, gradient, viscosity, dt, time
        self.spin0 = (0.5 * (gradient[2][1] - gradient[1][2]), 0.5 * (gradient[0][2] - gradient[2][0]), 0.5 * (gradient[1][0] - gradient[0][1]))
        self.contact, self.drag, self.lubrication = forces.get("contact"), forces.get("drag"), forces.get("lubrication")
        self.friction = self.contact["friction"] if self.contact else 0
        self.turns = turns if turns is not None else bool(self.friction or self.lubrication or self.drag and self.drag["torque"])
        if not self.turns:
            self.w = [(0.0, 0.0, 0.0)] * len(self.w)
        self.turned = [(0.0, 0.0, 0.0)] * len(self.x)
        self.origins = [o for f in ORIGINS if f in forces for o in ORIGINS[f] if o != "contact_tangential" or self.friction] + ["kinetic"]
        self.given, self.histories, self.near, self.slack = histories or {}, {}, [], -1.0
        self.set_cell()
        self.add_forces(0.0, True)
        self.given = {}

    def set_cell(self):
        """H(t) = (1 + G t + G G t^2/2) H(0)."""
        moved = [plus(plus(c, apply(self.gradient, c), self.time), apply(self.gradient, apply(self.gradient, c)), 0.5 * self.time ** 2) for c in self.cell0]
        self.cell, self.volume = moved, abs(dot(moved[0], cross(moved[1], moved[2])))

    def list_pairs(self):
        """Pairs and images (i, j, shift) that may come within reach before anything has moved by `skin`; each once, i = j too."""
        a, b, c = self.cell
        reciprocal = [times(1 / dot(v, cross(p, q)), cross(p, q)) for v, p, q in ((a, b, c), (b, c, a), (c, a, b))]
        range_ = 1 + (self.lubrication["outer_gap"] / 2 if self.lubrication else 0)
        self.skin = 0.2 * min(self.a)
        self.widest = 2 * max(self.a) * range_ + self.skin
        self.near, pair_forces = [], self.contact or self.lubrication
        for i in range(len(self.x) if pair_forces else 0):
            for j in range(i, len(self.x)):
                reach, d = (self.a[i] + self.a[j]) * range_ + self.skin, plus(self.x[j], self.x[i], -1)
                counts = []
                for k in range(3):
                    place, margin = dot(reciprocal[k], d), reach * sqrt(dot(reciprocal[k], reciprocal[k]))
                    counts.append(range(ceil(-place - margin), floor(-place + margin) + 1) if self.periodic[k] else (0,))
                for s in product(*counts):
                    shift = plus(plus(times(s[0], a), b, s[1]), c, s[2])
                    if dot(plus(d, shift), plus(d, shift)) <= reach ** 2 and (i < j or s > (0, 0, 0)):
                        self.near.append((i, j, s))

    def peculiar(self, i):
        return plus(self.u[i], apply(self.gradient, self.x[i]), -1)

    def keep_list(self, dt):
        """Makes the list of pairs anew before any pair can have come nearer by more than the skin."""
        if self.slack >= 0:
            speed = max(sqrt(dot(c, c)) for c in map(self.peculiar, range(len(self.x))))
            rate = sqrt(sum(dot(row, row) for row in self.gradient))
            self.slack -= dt * (2 * speed + rate * self.widest)
        if self.slack < 0:
            self.list_pairs()
            self.slack = self.skin

    def add_forces(self, drift, book):
        """Forces and torques (and stresses, if they are to be booked) of the present places and velocities; histories advance by the slip
        of a drift of that duration."""
        n = len(self.x)
        self.force, self.torque = [(0.0, 0.0, 0.0)] * n, [(0.0, 0.0, 0.0)] * n
        self.stress = {o: [0.0] * 9 for o in self.origins} if book else None
        self.keep_list(drift)
        kept = {}
        for i, j, s in self.near:
            a, b, c = self.cell
            shift = plus(plus(times(s[0], a), b, s[1]), c, s[2])
            d = plus(plus(self.x[j], shift), self.x[i], -1)
            r = sqrt(dot(d, d))
            gap, normal = r - self.a[i] - self.a[j], times(1 / r, d)
            du = plus(plus(self.u[j], apply(self.gradient, shift)), self.u[i], -1)
            if self.contact and gap < 0:
                self.touch(i, j, s, d, r, gap, normal, du, drift, kept)
            if self.lubrication and 2 * gap / (self.a[i] + self.a[j]) <= self.lubrication["outer_gap"]:
                self.lubricate(i, j, d, r, gap, normal, du)
        self.histories = kept
        if self.drag:
            self.add_drag()

    def on_pair(self, i, j, d, origin, force, torque_i, torque_j):
        self.force[i] = plus(self.force[i], force)
        self.force[j] = plus(self.force[j], force, -1)          # one after the other: i and j may be the same sphere
        self.torque[i] = plus(self.torque[i], torque_i)
        self.torque[j] = plus(self.torque[j], torque_j)
        if self.stress:
            self.stress[origin] = [s + f * p / self.volume for s, (f, p) in zip(self.stress[origin], product(force, d))]

    def touch(self, i, j, s, d, r, gap, normal, du, drift, kept):
        contact, zero = self.contact, (0.0, 0.0, 0.0)
        self.on_pair(i, j, d, "contact_normal", times(contact["normal_stiffness"] * gap, normal), zero, zero)
        if not self.friction:
            return
        arm = r / (self.a[i] + self.a[j]) if contact["lever"] == "contact" else 1
        arm_i, arm_j = arm * self.a[i], arm * self.a[j]
        slip = plus(cross(plus(times(arm_i, self.w[i]), self.w[j], arm_j), normal), du, -1)
        history = self.histories.get((i, j, s)) or self.given.get((i, j), zero)
        history = across(plus(history, slip, drift), normal)
        k_t, cap = contact["tangential_stiffness"], -self.friction * contact["normal_stiffness"] * gap
        length = k_t * sqrt(dot(history, history))
        if length > cap:
            history = times(cap / length, history)
        kept[i, j, s] = history
        tangential = times(-k_t, history)
        turning = cross(normal, tangential)
        self.on_pair(i, j, d, "contact_tangential", tangential, times(arm_i, turning), times(arm_j, turning))

    def lubricate(self, i, j, d, r, gap, n, du):
        """Jeffrey & Onishi's leading terms, at xi not below the inner gap."""
        a, b = self.a[i], self.a[j]
        beta, xi = b / a, max(2 * gap / (a + b), self.lubrication["inner_gap"])
        s = r / (a + b) if self.lubrication["rotation_correction"] == "exact" else 1
        unit, L = pi * self.eta, log(1 / xi)
        X = 6 * unit * a * (2 * beta ** 2 / (1 + beta) ** 3 / xi + beta * (1 + 7 * beta + beta ** 2) / (5 * (1 + beta) ** 3) * L)
        Y = 6 * unit * a * 4 * beta * (2 + beta + 2 * beta ** 2) / (15 * (1 + beta) ** 3) * L
        B1 = -4 * unit * a ** 2 * beta * (4 + beta) / (5 * (1 + beta) ** 2) * L * s
        B2 = -4 * unit * b ** 2 * (1 + 4 * beta) / (5 * (1 + beta) ** 2) * L * s
        C11 = 8 * unit * a ** 3 * 2 * beta / (5 * (1 + beta)) * L * s * s
        C12 = 8 * unit * a ** 3 * beta ** 2 / (10 * (1 + beta)) * L * s * s
        C22 = 8 * unit * b ** 3 * 2 / (5 * (1 + beta)) * L * s * s
        wi, wj, turning = self.w[i], self.w[j], cross(du, n)
        force = plus(plus(times(Y, du), n, (X - Y) * dot(du, n)), cross(plus(times(B1, wi), wj, B2), n))
        self.on_pair(i, j, d, "lubrication", force, plus(times(B1, turning), across(plus(times(C11, wi), wj, C12), n), -1),
                     plus(times(B2, turning), across(plus(times(C12, wi), wj, C22), n), -1))

    def add_drag(self):
        strain = [0.5 * (self.gradient[i][k] + self.gradient[k][i]) for i, k in product(range(3), range(3))]
        for i, a in enumerate(self.a):
            self.force[i] = plus(self.force[i], self.peculiar(i), -6 * pi * self.eta * a)
            if self.drag["torque"]:
                self.torque[i] = plus(self.torque[i], plus(self.spin0, self.w[i], -1), 8 * pi * self.eta * a ** 3)
            if self.stress:
                self.stress["drag"] = [s + 20 / 3 * pi * self.eta * a ** 3 * e / self.volume for s, e in zip(self.stress["drag"], strain)]

    def kick(self):
        for i in range(len(self.x)):
            self.u[i] = plus(self.u[i], self.force[i], 0.5 * self.dt / self.mass[i])
            if self.turns:
                self.w[i] = plus(self.w[i], self.torque[i], 0.5 * self.dt / self.inertia[i])

    def step(self, new_time, book=False):
        """Kick dt/2, drift dt, cell to the new time, forces at the half-step velocities, kick dt/2."""
        self.kick()
        for i in range(len(self.x)):
            self.x[i] = plus(self.x[i], self.u[i], self.dt)
            self.turned[i] = plus(self.turned[i], self.w[i], self.dt)
        self.time = new_time
        self.set_cell()
        self.add_forces(self.dt, book)
        self.kick()

    def stresses(self):
        """{origin: nine components}, the kinetic one of the velocities of now."""
        c = [self.peculiar(i) for i in range(len(self.x))]
        self.stress["kinetic"] = [-sum(m * v[i] * v[k] for m, v in zip(self.mass, c)) / self.volume for i, k in product(range(3), range(3))]
        return self.stress
