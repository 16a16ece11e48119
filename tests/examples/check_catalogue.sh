#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Checks the catalogue of instruments: documents and spectra. Usage: check_catalogue.sh [ROOT]; prints every fault and fails if there
# is one.
set -u
export LC_ALL=C
cd "${1:-.}/examples/catalogue" || exit 2
faults=$(mktemp) || exit 2
ids=$(mktemp) || exit 2
trap 'rm -f "$faults" "$ids"' EXIT

for file in data/*.xml; do
  if command -v xmllint > /dev/null; then xmllint --noout "$file" 2>&1; fi
  awk -v file="$file" -v ids="$ids" '
    function fault(text) { print file ": " (thing == "" ? "" : thing ": ") text }
    function is_number(text) { return text ~ /^-?[0-9]+(\.[0-9]+)?$/ }
    function number(name, least, most) {
      if (!(name in value)) fault("has no " name)
      else if (!is_number(value[name])) fault(name " is no number: " value[name])
      else if (value[name] + 0 < least + 0 || value[name] + 0 > most + 0) fault(name " is " value[name] ", expected " least " to " most)
    }
    function scanner() {
      thing = value["id"]
      number("wavelength_nm", 400, 2500)
      number("beamDivergence_rad", 0.00001, 0.02)
      number("pulseLength_ns", 0.5, 20)
      number("accuracy_m", 0.0001, 0.1)
      number("rangeMin_m", 0.01, 1000)
      if ("rangeMax_m" in value) number("rangeMax_m", value["rangeMin_m"] + 1, 1000000)
      number("maxNOR", 0, 15)
      if (value["pulseFreqs_Hz"] !~ /^[0-9]+(,[0-9]+)*$/) fault("pulseFreqs_Hz is no list of whole numbers")
      if (value["optics"] == "risley") {
        number("rotorFreq1_Hz", -1000, 1000)
        number("rotorFreq2_Hz", -1000, 1000)
        number("angle1_deg", -40, 40)
        number("angle2_deg", -40, 40)
      } else {
        number("scanFreqMin_Hz", 0, 1000)
        number("scanFreqMax_Hz", value["scanFreqMax_Hz"] + 0 == 0 ? 0 : value["scanFreqMin_Hz"], 1000)
        number("scanAngleMax_deg", 1, 180)
      }
      if (value["optics"] == "rotating") number("scanAngleEffectiveMax_deg", 1, value["scanAngleMax_deg"])
      if ("headRotatePerSecMax_deg" in value) number("headRotatePerSecMax_deg", 1, 10000)
    }
    BEGIN {
      RS = "<"
      known["scanner"] = " id name optics wavelength_nm beamDivergence_rad pulseLength_ns accuracy_m rangeMin_m rangeMax_m maxNOR" \
        " pulseFreqs_Hz receiverDiameter_m atmosphericVisibility_km scanFreqMin_Hz scanFreqMax_Hz scanProduct scanAngleMax_deg scanAngleEffectiveMax_deg " \
        " headRotatePerSecMax_deg rotorFreq1_Hz rotorFreq2_Hz angle1_deg angle2_deg refrIndex1 refrIndex2 refrIndex_air "
      known["platform"] = " id name type yaw_speed_deg pitch_offset_deg "
      known["FWFSettings"] = " beamSampleQuality binSize_ns "
      known["scannerMount"] = " x y z rotations "
      known["beamOrigin"] = known["headRotateAxis"] = known["incidentBeam"] = " x y z "
      known["rot"] = " axis angle_deg "
      known["channel"] = " id "
      known["document"] = known["channels"] = " "
      inside["document"] = ""
      inside["scanner"] = inside["platform"] = "document"
      inside["FWFSettings"] = inside["headRotateAxis"] = inside["channels"] = "scanner"
      inside["scannerMount"] = "platform"
      inside["channel"] = "channels"
      inside["incidentBeam"] = "channel"
      inside["beamOrigin"] = "scanner channel"
      inside["rot"] = "beamOrigin scannerMount"
    }
    NR == 1 { if ($0 != "") fault("text before the first element"); next }
    NR == 2 && $0 !~ /^\?xml version="1\.0"\?>/ { fault("does not begin with the XML declaration") }
    /^\?xml/ { next }
    /^!--/ {
      text = $0
      gsub(/[ \n]+/, " ", text)
      if (text !~ / --> ?$/) fault("a comment does not end where it should: " substr(text, 1, 60))
      if (text ~ /SPDX-Licen[s]e-Identifier: MIT/) licence = 1
      comment = text
      next
    }
    {
      if ($0 !~ />[ \n]*$/) { fault("stray text: " $0); next }
      tag = $0
      sub(/>[ \n]*$/, "", tag)
      closed = sub(/\/$/, "", tag)
    }
    /^\// {
      sub(/^\//, "", tag)
      if (tag != stack[depth]) fault("</" tag "> closes <" stack[depth] ">")
      if (tag == "scanner" || tag == "platform") thing = ""
      --depth
      comment = ""
      next
    }
    {
      name = tag
      sub(/[ \n].*/, "", name)
      sub(/^[^ \n]*[ \n]*/, "", tag)
      split("", value)
      while (match(tag, /^[A-Za-z0-9_]+="[^"]*"[ \n]*/)) {
        part = substr(tag, 1, RLENGTH)
        tag = substr(tag, RLENGTH + 1)
        key = part
        sub(/=.*/, "", key)
        sub(/^[^"]*"/, "", part)
        sub(/"[ \n]*$/, "", part)
        if (key in value) fault("<" name "> has " key " twice")
        if (index(known[name], " " key " ") == 0) fault("<" name "> has no attribute " key)
        value[key] = part
      }
      if (tag != "") fault("<" name "> has something that is no attribute: " tag)
      if (!(name in known)) fault("there is no element <" name ">")
      else if (index(" " inside[name] " ", " " stack[depth] " ") == 0) fault("<" name "> stands in <" stack[depth] ">")
      if (name == "scanner" || name == "platform") {
        thing = value["id"]
        if (thing !~ /^[a-z0-9_-]+$/) fault("has no good id")
        if (thing in seen) fault("is there twice")
        seen[thing] = 1
        if (comment !~ /Source: /) fault("has no comment that names the source of its figures")
        print file "#" thing >> ids
        channels = ""
      }
      if (name == "scanner") {
        if (value["optics"] !~ /^(oscillating|rotating|conic|line|risley)$/) fault("has no good optics")
        scanner()
      }
      if (name == "platform" && value["type"] !~ /^(static|linearpath|groundvehicle|multicopter)$/) fault("has no good type")
      if (name == "rot" && (value["axis"] !~ /^[xyz]$/ || !is_number(value["angle_deg"]))) fault("a rotation is not good")
      for (key in value) if (key ~ /^[xyz]$/ && !is_number(value[key])) fault("<" name "> has no number in " key)
      if (name == "channel") {
        if (index(channels " ", " " value["id"] " ")) fault("channel " value["id"] " is there twice")
        channels = channels " " value["id"]
      }
      if (!closed) stack[++depth] = name
      else if (name == "scanner" || name == "platform") thing = ""
      comment = ""
    }
    END {
      thing = ""
      if (depth > 0) fault("<" stack[depth] "> is not closed")
      if (!licence) fault("has no licence lines")
    }' "$file"
done >> "$faults"

# What existing surveys refer to.
while read -r file names; do
  for name in $names; do
    grep -qxF "data/$file.xml#$name" "$ids" || echo "data/$file.xml: $name is missing, which existing surveys name"
  done
done >> "$faults" << 'END'
scanners_als leica_als50 leica_als50-ii optech_2033 optech_3100 optech_galaxy riegl_lms-q560 riegl_lms-q780 riegl_vq_780i riegl_vux-1uav
scanners_als riegl_vux-1uav22 riegl_vux-1ha22 riegl_vq-880g-infrared riegl_vq-1560i riegl_vq-880g livox_mid-70 livox-mid-100
scanners_als dji-zenmuse-l1-non-repetitive dji-zenmuse-l2-repetitive dji-zenmuse-l2-non-repetitive
scanners_tls riegl_vz400 riegl_vz1000 riegl_vz2000i riegl_vz600i riegl_vq-450 vlp16 velodyne_hdl-64e panoscanner livox_mid-40 livox_mid-70
scanners_tls livox_mid-100 livox-avia-non-repetitive tractorscanner
platforms sr22 quadcopter copter_linearpath tractor tractor_leftside vehicle_linearpath vmx-450-car-left vmx-450-car-right vmq-1ha-car-0
platforms simple_linearpath tripod tripod_down
END
for name in aluminum asphalt conifer copper deciduous grass grass_dry shingle_gray shingle_red wood; do
  [ -f "spectra/$name.txt" ] || echo "spectra/$name.txt is missing, which existing surveys name"
done >> "$faults"

# 26 lines of header, then wavelength in um and percent, ascending, from 0.4 to 2.5 um.
for file in spectra/*; do
  awk -F '\t' -v file="$file" '
    function fault(text) { print file ":" FNR ": " text }
    function is_number(text) { return text ~ /^[0-9]+(\.[0-9]+)?$/ }
    FNR <= 26 { if (NF == 2 && is_number($1)) fault("a header of 26 lines was expected"); header = header $0 "\n"; next }
    NF != 2 || !is_number($1) || !is_number($2) { fault("expected two numbers: " $0); next }
    FNR == 27 && $1 != 0.4 { fault("begins at " $1 " um, not at 0.4") }
    FNR > 27 && $1 <= last { fault("wavelengths do not ascend") }
    $2 > 100 { fault("a reflectance above 100 %") }
    { last = $1 + 0; at[last] = $2 }
    END {
      if (last != 2.5) fault("ends at " last " um, not at 2.5")
      if (header !~ /\nX Units: Wavelength \(micrometers\)\nY Units: Reflectance \(percent\)\n/) fault("the header does not name the units")
      if (header !~ /SPDX-License-Identifier: MIT\n/ || header !~ /\nLiterature:\n/) fault("the header lacks licence or literature")
      if (header ~ /\nType: vegetation\n/) {  # water in leaves: Ustin & Jacquemoud 2020
        if (at[1.45] >= at[1.3] || at[1.45] >= at[1.65] || at[1.94] >= at[1.65] || at[1.94] >= at[2.2] && file !~ /dry/)
          fault("leaves absorb at 1.45 and 1.94 um")
        if (file !~ /dry/ && (at[0.8] < 5 * at[0.68] || at[0.55] <= at[0.68])) fault("green leaves have a red edge")
      }
    }' "$file"
done >> "$faults"

# The page that lists them all.
while read -r id; do
  grep -qF "\`${id#*#}\`" ../../docs/catalogue.md || echo "docs/catalogue.md does not name $id"
done < "$ids" >> "$faults"
for file in spectra/*.txt; do
  name=${file#spectra/}
  grep -qF "\`${name%.txt}\`" ../../docs/catalogue.md || echo "docs/catalogue.md does not name $file"
done >> "$faults"

if [ -s "$faults" ]; then
  cat "$faults"
  exit 1
fi
echo "The catalogue is sound: $(wc -l < "$ids") scanners and platforms, $(find spectra -type f | wc -l) spectra."
