# gnuplot docs/measured/mean-force.gp: potential of mean force near contact, from the tables that `gate run --tier standard --case mean-force...` leaves
set datafile separator ','
set terminal pngcairo size 900,520 font 'sans,11'
set output 'docs/mean-force.png'
set xlabel 'gap'; set ylabel 'potential of mean force / kT'; set key top right; set xrange [-0.006:0.012]; set yrange [-0.25:1.7]
plot 'docs/measured/mean-force.csv' using 1:5 with lines lw 2 lc rgb 'black' title 'flat, and the spring in contact', \
     '' using 1:2:3 with yerrorbars pt 7 ps 0.7 lc 1 title 'split, X_A dt/m = 2.5', \
     'docs/measured/mean-force-verlet.csv' using 1:4 with lines dt 2 lc 2 title 'predicted: verlet, 0.5', '' using 1:2:3 with yerrorbars pt 5 ps 0.6 lc 2 title 'verlet', \
     'docs/measured/mean-force-predicted.csv' using 1:4 with lines dt 2 lc 4 title 'predicted: predicted\_verlet, 0.8', '' using 1:2:3 with yerrorbars pt 9 ps 0.7 lc 4 title 'predicted\_verlet'
