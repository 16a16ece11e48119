# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Draws what bench_tradeoff found: gnuplot -e "csv='...'; edges='...'; pictures='...'" bench/study/tradeoff.gp
# Each scenario is a picture of three errors against time; the last one is of footprints alone. Add terminal='pngcairo' to look at them as PNG.
if (!exists("terminal")) terminal = "svg"
ending = terminal eq "svg" ? "svg" : "png"
set datafile separator ","
set datafile missing "nan"
set encoding utf8
set style line 1 linecolor rgb "#d55e00" linewidth 1.2 pointtype 4 pointsize 0.55   # rings
set style line 2 linecolor rgb "#0072b2" linewidth 1.2 pointtype 6 pointsize 0.55   # sunflower
set style line 3 linecolor rgb "#009e73" linewidth 1.6 pointtype 7 pointsize 0.55   # lattice
set style line 4 linecolor rgb "#999999" linewidth 1.0 pointtype 1 pointsize 0.5    # subrays by bins
set style line 5 linecolor rgb "#cc79a7" linewidth 1.4 pointtype 2 pointsize 0.7    # bins
set style line 6 linecolor rgb "#000000" linewidth 1.4 pointtype 8 pointsize 0.9    # analytic
set style line 8 linecolor rgb "#f0e442" linewidth 7                                # front
set style line 9 linecolor rgb "#000000" linewidth 1.6 pointtype 6 pointsize 1.7    # default
set style line 11 linecolor rgb "#a07800" linewidth 1.2 pointtype 8 pointsize 0.8   # simpler meshes
set style line 12 linecolor rgb "#a07800" linewidth 1.2 pointtype 10 pointsize 0.8  # height fields
set style line 13 linecolor rgb "#a07800" linewidth 1.2 pointtype 5 pointsize 0.7   # voxels
set style line 14 linecolor rgb "#a07800" linewidth 1.2 pointtype 12 pointsize 0.9  # leaves by chance

tens = ""
do for [e = -4:5] { do for [m in "1 2 5"] { tens = tens.sprintf("%s %s", tens eq "" ? "" : ",", m."e".sprintf("%d", e)) } }

short = "sub(/^(mesh|height field|voxels|leaves by chance) of /, \"\", $3); sub(/^one leaf in /, \"1/\", $3); sub(/^height field$/, \"\", $3); print"
rows(scenario, condition) = sprintf("< awk -F, -v OFS=, '$1 == \"%s\" && (%s) { %s }' %s | sort -t, -k8g", scenario, condition, short, csv)
subrays(kind) = sprintf("$2 == \"subrays\" && $4 == \"%s\"", kind)
form(pattern) = sprintf("$2 == \"form\" && $3 ~ /%s/", pattern)
forms = "'^(mesh|one leaf)' '^height' '^voxels' '^leaves'"
form_names = "'simpler mesh' 'height field' 'voxels' 'leaves by chance'"
kinds = "rings sunflower lattice"
drawn = "$7 == 1 || $2 == \"form\""

# An error of nothing has no place on a logarithmic axis: it stands on the lower edge.
shown(error, floor) = error < floor ? floor : error

scenarios = "terrain wood_tripod wood_drone street facade step"
titles = "'Terrain from 1,500 m' 'A wood from a tripod' 'A wood from a drone' 'A street from a car' \
  'A facade with edges and wires: pulses that meet one' 'Steps smaller than the footprint: pulses that meet one'"
errors = "'range: root mean square error [mm]' 'echoes missed or invented [%]' 'intensity: mean error [%]'"
columns = "13 17 19"

do for [k = 1:words(scenarios)] {
  scenario = word(scenarios, k)
  if (system(sprintf("grep -c '^%s,' %s", scenario, csv)) + 0 == 0) { continue }
  set terminal @terminal size 1500,600 enhanced font "Arial,13" background rgb "white"
  set output sprintf("%s/tradeoff_%s.%s", pictures, scenario, ending)
  set multiplot layout 2,3 title word(titles, k) font ",16" margins 0.05,0.985,0.22,0.88 spacing 0.055,0
  set border 31 linewidth 0.7
  set grid xtics ytics back linetype 1 linecolor rgb "#e0e0e0" linewidth 0.6
  set tics nomirror font ",11"
  do for [panel = 1:3] {
    set lmargin at screen 0.045 + (panel - 1) * 0.325
    set rmargin at screen 0.335 + (panel - 1) * 0.325
    set tmargin at screen 0.89
    set bmargin at screen 0.25
    y = int(word(columns, panel))
    unset logscale
    set autoscale
    floor = 0.01
    top = 1
    stats rows(scenario, sprintf("$%d > 0 && (%s)", y, drawn)) using y nooutput
    if (exists("STATS_records")) { floor = 0.6 * STATS_min; top = 1.7 * STATS_max }
    stats rows(scenario, sprintf("$%d == 0 && (%s)", y, drawn)) using y nooutput
    zeros = exists("STATS_records")
    stats rows(scenario, drawn) using 8 nooutput
    set logscale xy
    set xrange [0.85 * STATS_min : 1.4 * STATS_max]
    set yrange [floor : top]
    eval "set xtics (".tens.")"
    eval "set ytics (".tens.")"
    if (zeros > 0) { set ytics add ("0" floor) }
    set format "%g"
    set xlabel "nanoseconds a pulse" offset 0,0.4
    set title word(errors, panel) font ",13" offset 0,-0.4
    unset key
    plot rows(scenario, sprintf("$%d == 1", 26 + panel)) using 8:(shown(column(y), floor)) with steps linestyle 8, \
         rows(scenario, "$2 == \"both\"") using 8:(shown(column(y), floor)) with points linestyle 4, \
         for [f = 1:4] rows(scenario, form(word(forms, f))) using 8:(shown(column(y), floor)) with points linestyle 10 + f, \
         rows(scenario, form("of|in").(scenario eq "terrain" ? " && $3 !~ /mesh/" : "")) using 8:(shown(column(y), floor)):3 with labels left offset 0.5,0.4 font ",9" textcolor rgb "#806000", \
         for [f = 1:3] rows(scenario, subrays(word(kinds, f))) using 8:(shown(column(y), floor)) with linespoints linestyle f, \
         rows(scenario, "$2 == \"bins\" && $6 != \"analytic\"") using 8:(shown(column(y), floor)) with points linestyle 5, \
         rows(scenario, "$2 == \"bins\" && $6 == \"analytic\"") using 8:(shown(column(y), floor)) with points linestyle 6, \
         rows(scenario, "$2 == \"default\"") using 8:(shown(column(y), floor)) with points linestyle 9, \
         rows(scenario, subrays("lattice")." && ($5 == 1 || $5 == 4 || $5 == 9 || $5 == 37 || $5 == 279)") \
           using 8:(shown(column(y), floor)):5 with labels left offset 0.5,0.5 font ",10" textcolor rgb "#009e73", \
         rows(scenario, subrays("rings")." && ($5 == 19 || $5 == 279)") \
           using 8:(shown(column(y), floor)):5 with labels left offset 0.5,0.5 font ",10" textcolor rgb "#d55e00"
  }
  # the key, in a place of its own below
  set lmargin at screen 0.05
  set rmargin at screen 0.95
  set tmargin at screen 0.14
  set bmargin at screen 0.01
  unset logscale
  unset title
  unset xlabel
  set key center center horizontal Left reverse font ",12" samplen 2 width 2
  unset border
  unset tics
  unset grid
  plot [0:1] [0:1] NaN with lines linestyle 8 title "front", NaN with points linestyle 9 title "default", \
       for [f = 1:3] NaN with linespoints linestyle f title word(kinds, f)." of 1 to 279 subrays", \
       NaN with points linestyle 5 title "bins of 0.05 to 2 ns", NaN with points linestyle 6 title "analytic detector", \
       NaN with points linestyle 4 title "lattices by bins", for [f = 1:4] NaN with points linestyle 10 + f title word(form_names, f)
  unset multiplot
  unset key
}

# Footprints alone.
set lmargin
set rmargin
set tmargin
set bmargin
set terminal @terminal size 1500,560 enhanced font "Arial,13" background rgb "white"
set output sprintf("%s/tradeoff_edges.%s", pictures, ending)
set multiplot layout 1,3 title "Footprints on edges and wires" font ",16" margins 0.05,0.985,0.22,0.88 spacing 0.05,0
set border 31 linewidth 0.7
set grid xtics ytics back linetype 1 linecolor rgb "#e0e0e0" linewidth 0.6
set tics nomirror font ",11"
set logscale xy
set xrange [0.9:330]
set yrange [0.15:50]
eval "set ytics (".tens.")"
set xtics (1, 4, 9, 19, 37, 62, 130, 279)
set xlabel "subrays"
of(kind) = sprintf("< awk -F, '$1 == \"%s\"' %s", kind, edges)
do for [panel = 1:2] {
  set title panel == 1 ? "energy, upright or level in the beam: error [%]" : "energy, in any direction: error [%]" font ",13" offset 0,-0.4
  edge = panel == 1 ? 3 : 5
  if (panel == 2) { set key at screen 0.5,0.06 center center horizontal maxcols 3 Left reverse font ",12" samplen 3 width 1 } else { unset key }
  plot for [k = 1:3] of(word(kinds, k)) using 2:edge with linespoints linestyle k title word(kinds, k).": edges", \
       for [k = 1:3] of(word(kinds, k)) using 2:(column(edge + 1)) with lines linestyle k dashtype 3 title "wires"
}
unset key
if (system(sprintf("grep -c '^facade,' %s", csv)) + 0 > 0) {
  set title "echoes of the facade, intensity: mean error [%]" font ",13" offset 0,-0.4
  plot for [k = 1:3] sprintf("< awk -F, '$1 == \"facade\" && %s' %s", subrays(word(kinds, k)), csv) using 5:19 with linespoints linestyle k
}
unset multiplot
