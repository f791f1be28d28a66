set xlabel 'time'
set ylabel 'shear stress by origin'
plot data.'/stress.csv' using "time":"lubrication_noise_xy" with lines lc 'gray' title 'pair noise', '' using "time":"contact_normal_xy" with lines title 'contact', \
     '' using "time":"lubrication_xy" with lines title 'lubrication', '' using "time":"drag_xy" with lines lw 2 title 'drag'
