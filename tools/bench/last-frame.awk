# Last frame of trajectory.csv as starting states, velocities and spins times `factor`.
/^#/ { next }
!seen++ { for (k = 1; k <= NF; k++) c[$k] = k; print "id,species,x,y,z,ux,uy,uz,wx,wy,wz"; next }
{ last[$c["id"]] = $c["id"] OFS $c["species"] OFS $c["x"] OFS $c["y"] OFS $c["z"] OFS scaled("ux") OFS scaled("uy") OFS scaled("uz") \
      OFS scaled("wx") OFS scaled("wy") OFS scaled("wz")
  n = n < $c["id"] ? $c["id"] : n }
END { for (i = 1; i <= n; i++) print last[i] }
function scaled(column) { return sprintf("%.17g", $c[column] * factor) }
