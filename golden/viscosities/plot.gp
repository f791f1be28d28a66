# Sheared viscosities, code against code: eta_r against volume fraction and against Pe. `make golden` calls it: gnuplot plot.gp in this folder.
set terminal pngcairo size 1400,620 enhanced font 'sans,12' background 'white'
set output '../../docs/viscosities.png'
set datafile separator comma
set multiplot layout 1,2
set logscale y
set ylabel 'η_r = viscosity / fluid viscosity'
set key top left
has(word) = strstrt(strcol('point').' ', word.' ') > 0
is(quantity) = strcol('quantity') eq quantity
repelled(d) = strstrt(strcol('point'), 'A/kT') > 0
row(mu, ok) = (is('viscosity') && has('mu '.mu) && ok ? 1 : NaN)
contact = '< cat viscosities-contact-table.csv && grep -v -e "^#" -e "^point," viscosities-contact-named-table.csv'
brownian = '< (cat viscosities-brownian-50-table.csv; cat viscosities-brownian-45-table.csv viscosities-brownian-named-table.csv viscosities-repulsion-table.csv | grep -v -e "^#" -e "^point,") 2>/dev/null'
fit(phi, J) = (1 - phi/J)**-1.5

set title 'contact and drag (no noise); lines: fits of Li (2026), Fig. 4.9a, for spheres with lubrication'
set xlabel 'volume fraction'
set xrange [0.38:0.60]
set yrange [1.5:200]
plot [0.38:0.585] fit(x, 0.642) lc 'black' title 'Li, Pe 10^4, no friction: (1 - φ/0.642)^{-1.5}', \
     [0.38:0.575] fit(x, 0.587) lc 'black' dt 2 title 'Li, Pe → 0: (1 - φ/0.587)^{-1.5}', \
     for [mu in '0 0.5 1'] contact using (column('phi')*row(mu, 1)):'candidate':'candidate_error' with yerrorbars pt 7 ps 0.7 lc int(2*mu)+1 title 'shear, μ '.mu, \
     for [mu in '0 0.5 1'] contact using (column('phi')*row(mu, 1)+0.002):'reference':'reference_error' with yerrorbars pt 6 ps 1.3 lc int(2*mu)+1 title 'LAMMPS, μ '.mu

set title 'contact, lubrication, drag and noise; constants of Li (2026), Table 4.1'
set xlabel 'Pe = 6π η a^3 rate/kT'
set logscale x
set format x '10^{%T}'
set xrange [0.1:3e4]
set yrange [4:90]
series = "'phi 0.45|0|1' 'phi 0.45|0.5|2' 'phi 0.50|0|3' 'phi 0.50|0.5|4'"
phi_of(s) = s[1:strstrt(s,'|')-1]
mu_of(s) = s[strstrt(s,'|')+1:strlen(s)-2]
colour(s) = int(s[strlen(s):*])
of_series(s) = row(mu_of(s), has(phi_of(s)) && !repelled(0))
of_repelled(x) = row('0.5', has('phi 0.50') && repelled(0))
set key top left
set style line 9 lc rgb 'brown'
curve(phi, mu, more) = "< cat viscosities-brownian-*-table.csv viscosities-repulsion-table.csv | grep -E '^".phi.' mu '.mu.' Pe [0-9.e]+'.more.",.*,viscosity,' | sort -t, -g -k3,3"
plot for [s in series] curve(phi_of(s), mu_of(s), '') using 3:6 with lines lc colour(s) notitle, \
     curve('phi 0.50', '0.5', ' A/kT 100') using 3:6 with lines ls 9 notitle, \
     for [s in series] brownian using (column('x')*of_series(s)):'candidate':'candidate_error' with yerrorbars pt 7 ps 0.7 lc colour(s) title 'φ '.phi_of(s)[5:*].', μ '.mu_of(s), \
     brownian using (column('x')*of_repelled(0)):'candidate':'candidate_error' with yerrorbars ls 9 pt 5 ps 0.8 title 'φ 0.50, μ 0.5, repulsion A/kT 100', \
     for [s in series] brownian using (1.12*column('x')*of_series(s)):'reference':'reference_error' with yerrorbars pt 6 ps 1.3 lc colour(s) notitle, \
     brownian using (1.12*column('x')*of_repelled(0)):'reference':'reference_error' with yerrorbars ls 9 pt 4 ps 1.3 notitle, \
     NaN with points pt 6 ps 1.3 lc 'black' title 'open: LAMMPS (moved to the right)', \
     [7e3:1.4e4] fit(0.45, 0.642) lc 'black' dt 3 notitle, [7e3:1.4e4] fit(0.50, 0.642) lc 'black' notitle, [0.12:0.25] fit(0.45, 0.587) lc 'black' dt 3 title 'Li, μ 0, φ 0.45', [0.12:0.25] fit(0.50, 0.587) lc 'black' title 'Li, μ 0, φ 0.50'
unset multiplot
