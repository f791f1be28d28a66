set xlabel 'x of one sphere seen from the other'
set ylabel 'y'
set size ratio -1
set yrange [-2.5:2.5]
set object circle at 0,0 size 2 fillstyle solid 0.1 border lc 'gray'
plot '< awk -F, "!/^#/ && \$3 == 1 {x=\$4; y=\$5} \$3 == 2 {print x - \$4 \",\" y - \$5}" '.data.'/trajectory.csv' with lines lw 2 title 'path; grey: contact'
