# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Draws scores by numbers of subrays: gnuplot -e "csv='...'; picture='...'" bench/study/tradeoff.gp
# A panel a scene. Add terminal='pngcairo' to look at it as PNG.
if (!exists("terminal")) terminal = "svg"
set datafile separator ","
set encoding utf8
set style line 1 linecolor rgb "#d55e00" linewidth 1.2 pointtype 4 pointsize 0.5  # rings
set style line 2 linecolor rgb "#0072b2" linewidth 1.2 pointtype 6 pointsize 0.5  # sunflower
set style line 3 linecolor rgb "#009e73" linewidth 1.6 pointtype 7 pointsize 0.5  # lattice
kinds = "rings sunflower lattice"
scenes = system(sprintf("cut -d, -f1,2 '%s' | uniq | cut -d, -f1 | uniq | tr ' ' '_'", csv))
rows(scene, kind) = sprintf("< tr ' ' '_' < '%s' | awk -F, '$1 == \"%s\" && $2 == \"%s\"' | sort -t, -k3n", csv, scene, kind)

set terminal @terminal size 1400,820 enhanced font "Arial,12" background rgb "white"
set output picture
columns = 5
lines = (words(scenes) + columns - 1) / columns
set multiplot layout lines,columns margins 0.045,0.99,0.11,0.955 spacing 0.035,0.075
set border 31 linewidth 0.7
set grid xtics ytics back linetype 1 linecolor rgb "#e0e0e0" linewidth 0.6
set tics nomirror font ",10"
set logscale xy
set format y "%g"
set xrange [0.8:170]
set xtics (1, 3, 7, 19, 37, 127)
unset key
set label 1 "rings" at screen 0.40,0.025 point linestyle 1 offset 1,0 textcolor rgb "#d55e00"
set label 2 "sunflower" at screen 0.47,0.025 point linestyle 2 offset 1,0 textcolor rgb "#0072b2"
set label 3 "lattice" at screen 0.56,0.025 point linestyle 3 offset 1,0 textcolor rgb "#009e73"
do for [k = 1:words(scenes)] {
  set title word(scenes, k) font ",13" offset 0,-0.7 noenhanced
  if (k > (lines - 1) * columns) { set xlabel "subrays" offset 0,0.6 } else { unset xlabel }
  if (k % columns == 1) { set ylabel "score [mm an echo]" offset 1.5,0 } else { unset ylabel }
  plot for [i = 1:3] rows(word(scenes, k), word(kinds, i)) using 3:4 with linespoints linestyle i, \
       for [i = 1:3] rows(word(scenes, k), word(kinds, i)) using 3:4:5:6 with yerrorbars linestyle i
  unset label
}
unset multiplot
