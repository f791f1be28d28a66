# Sheared suspensions against Li (2026), chapter 4: `cd docs/published && gnuplot shear.gp` draws every table of this folder that it names.
set terminal pngcairo noenhanced size 640,440 font 'sans,11'
set datafile separator comma
set datafile commentschars '#'
set key autotitle columnheader
set xlabel offset 0,0.3

set logscale x
set format x '%.0e'
set offsets graph 0.08, graph 0.08, graph 0.3, 0
set yrange [0:*]

set output 'fig4.6a.png'
set title 'phi 0.55, no noise: viscosity against the Stokes number'
set xlabel 'St = density rate a^2 / viscosity'
set ylabel 'viscosity / fluid viscosity'
set arrow 1 from 0.1, graph 0 to 0.1, graph 1 nohead dashtype 2 lc 'gray'
plot for [q in 'viscosity contact lubrication'] 'fig4.6a.csv' using (column('x')):(column(q)):(column(q.'_error')) with yerrorlines pt 7 ps 0.8 title q
unset arrow 1

set output 'fig4.5b.png'
set title 'phi 0.50: viscosity against the stiffness of contacts'
set xlabel 'k_n / (viscosity rate a)'
plot for [t in 'fig4.5b.csv fig4.5b-noise.csv'] for [q in 'viscosity contact'] t using (column('x')):(column(q)):(column(q.'_error')) \
    with yerrorlines pt (t eq 'fig4.5b.csv' ? 7 : 6) ps 0.9 title (t eq 'fig4.5b.csv' ? 'no noise: ' : 'Pe 10: ').q

set output 'fig4.6b.png'
set title 'phi 0.45, Pe 10: viscosity against tau_I/tau_B'
set xlabel 'tau_I / tau_B'
plot for [q in 'viscosity contact lubrication'] 'fig4.6b.csv' using (column('x')):(column(q)):(column(q.'_error')) with yerrorlines pt 7 ps 0.8 title q

set output 'fig4.9b.png'
set title 'phi 0.50: viscosity against Pe, without and with friction'
set xlabel 'Pe'
set key top left
plot for [q in 'viscosity contact lubrication structural_zero'] 'fig4.9b.csv' every ::0::3 using (column('x')):(column(q)):(column(q.'_error')) with yerrorlines pt 7 ps 0.8 title (q eq 'structural_zero' ? 'structural Brownian' : q), \
    'fig4.9b.csv' every ::4::5 using (column('x')):(column('viscosity')):(column('viscosity_error')) with yerrorlines pt 4 ps 1.2 title 'viscosity, friction 0.5'

unset logscale x
set format x '%g'
set output 'fig4.7.png'
set title 'phi 0.45, friction 1: outer cut-off 0.05 and 0.5'
set style data histograms
set offsets 0, 0, graph 0.25, 0
set style histogram errorbars gap 1 lw 1
set style fill solid 0.4
set xlabel ''
set xtics rotate by -12 font ',9'
set bmargin 4
set key top left
plot for [q in 'viscosity lubrication contact'] '< cat fig4.7.csv; grep -v -e ^# -e ^point fig4.7-noise.csv' using (column(q)):(column(q.'_error')):xtic(strcol('point')) title q
set bmargin -1
set xtics norotate font ',11'

set output 'fig4.8.png'
set terminal pngcairo noenhanced size 960,420 font 'sans,11'
set style data lines
set offsets 0, 0, 0, 0
set multiplot layout 1,2
set title 'phi 0.50: all pairs'
set xlabel 'r / a'
set ylabel 'g(r)'
set xrange [1.9:4]
set key top right
array pe[4] = ['Pe 0.3', 'Pe 1', 'Pe 10', 'Pe 1e4']
plot for [k=1:4] '< grep -E "^kind|^g," fig4.9b-structure.csv' using (column('at')):(column(pe[k])) with lines lw 2 title pe[k]
set title 'pairs near contact in the flow-gradient plane'
set xlabel 'angle from the flow / degrees'
set ylabel 'density, 1 where all directions are alike'
set xrange [0:180]
set xtics 45
set yrange [0:*]
set key bottom right
plot for [k=1:4] '< grep -E "^kind|^ring," fig4.9b-structure.csv' using (360*column('at')):(column(pe[k])) with linespoints pt 7 title pe[k]
unset multiplot
