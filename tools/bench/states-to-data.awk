# states.csv (our columns) in a cube of edge `edge`, sheared at `rate` -> LAMMPS data file, atom_style sphere.
# Usage: awk -f states-to-data.awk -v edge=L -v rate=G -v radius1=A -v radius2=B -v density=R states.csv
function cells(v) { v /= edge; return v >= 0 ? int(v) : (v == int(v) ? v : int(v) - 1) }
BEGIN { FS = "," }
/^#/ || NF < 2 { next }
!header { for (k = 1; k <= NF; k++) column[$k] = k; header = 1; next }
{
    id = $column["id"]; kind = $column["species"]; n++
    x = $column["x"]; y = $column["y"]; z = $column["z"]; row = cells(y)
    kinds = kind > kinds ? kind : kinds
    place[n] = sprintf("%d %d %.17g %.17g %.17g %.17g %.17g", id, kind, 2 * (kind == 1 ? radius1 : radius2), density,
                       x - edge * cells(x), y - edge * row, z - edge * cells(z))
    motion[n] = sprintf("%d %.17g %.17g %.17g %.17g %.17g %.17g", id, $column["ux"] - rate * edge * row, $column["uy"],
                        $column["uz"], $column["wx"], $column["wy"], $column["wz"])
}
END {
    printf "spheres\n\n%d atoms\n%d atom types\n\n0 %.17g xlo xhi\n0 %.17g ylo yhi\n0 %.17g zlo zhi\n0 0 0 xy xz yz\n", n, kinds, edge, edge, edge
    printf "\nAtoms # sphere\n\n"; for (k = 1; k <= n; k++) print place[k]
    printf "\nVelocities\n\n"; for (k = 1; k <= n; k++) print motion[k]
}
