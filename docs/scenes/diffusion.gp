set xlabel 'time'
set ylabel 'mean square displacement per component'
set logscale xy
set format y '10^{%L}'
set key top left
m = 4/3.*pi*0.9*1.3**3; zeta = 6*pi*0.7*1.3; kT = 0.31; tau = m/zeta
plot [0.01:30] '< awk -F, "!/^#/ && \$1 == 0 {x[\$3]=\$4; y[\$3]=\$5; z[\$3]=\$6} \$1 > 0 {s[\$2] += (\$4-x[\$3])^2+(\$5-y[\$3])^2+(\$6-z[\$3])^2; n[\$2]++} END {for (t in s) print t \",\" s[t]/(3*n[t])}" '.data.'/trajectory.csv' \
     with points pt 7 title 'measured', 2*kT/m*tau**2*(x/tau - 1 + exp(-x/tau)) with lines lw 2 title 'Langevin (1908)'
