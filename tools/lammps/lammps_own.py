"""LAMMPS's own lubrication, noise and uniform random numbers where the scene asks for others: what the gate says of them is in docs/findings.md."""
from lammps_stock import Stock, need


class Own(Stock):
    """`kind`: "poly" for lubricate/poly and brownian/poly, "equal" for lubricate and brownian, which take one radius."""

    def __init__(self, folder, kind, newton=None):
        self.kind = kind
        self.newton = newton or ("on" if kind == "equal" else "off")    # off: brownian draws anew on each side of a face; on: lubricate/poly refuses
        super().__init__(folder)

    def check_forces(self):
        self.check_drag()
        need(self.kind != "equal" or "lubrication" not in self.forces or len(set(self.radius)) == 1, "lubricate takes spheres of one radius only")

    def pair_styles(self, forces):
        a, found, kind = self.radius, super().pair_styles(forces), "/poly" if self.kind == "poly" else ""
        for name, head in (("lubrication", f"lubricate{kind} {self.eta!r} 1 0"), ("lubrication_noise", f"brownian{kind} {self.eta!r} 1 0")):
            if name in forces:
                l = self.forces["lubrication"]
                inner, outer = (lambda i, j, g=g: (a[i] + a[j]) * (1 + g / 2) for g in (l["inner_gap"], l["outer_gap"]))
                tail = f" {self.kT!r} {self.seed}" if name == "lubrication_noise" else ""
                k = a.index(max(a))
                found.append((f"{head} {inner(k, k)!r} {outer(k, k)!r}{tail} 1 0", [f"{i + 1} {j + 1} {inner(i, j)!r} {outer(i, j)!r}" for i, j in self.pairs_of_types()],
                              "forces.lubrication: LAMMPS's own near-field scalars, NOT those of the scene"))
        return found
