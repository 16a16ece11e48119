# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Prepares a header or the README for Doxygen: `awk -f docs/reference_filter.awk HEADER`. Lines keep their numbers.
# - Functions that a concept or convention explains once for all of its models are given that explanation.
# - A unit literal is named by its unit.
# - Links of the README to other files, which the reference does not have, become their text.
# - Checks and promises of optional members are left out; concepts of constants, which a macro defines, are written out.
# - A comment after several variables of one declaration is given to each of them.
BEGIN {
  says["validate"] = "Refuses settings outside of their limits. Errors: `SettingError`."
  says["fields"] = "Table of the members: shows each to a visitor, with its attribute, unit and limits in documents."
  says["operator=="] = "Compares member by member."
  says["archive"] = "Names the members that a scene cache keeps."
  says["memory"] = "Memory that this occupies [bytes]."
  says["bounds"] = "Smallest box around all that can be met [m]."
  of["at"] = "Motion"; of["open"] = "Gated"; of["pulse"] = of["duration"] = "PulseSource"; of["share"] = of["offset"] = "Footprint"
  of["closest"] = "Target, and as the concepts Geometry and Accelerator,"; of["surface"] = "Geometry, or SceneQueries,"; of["material_count"] = "Geometry"; of["order"] = "Accelerator"
  of["closest_hit"] = of["occluded"] = "SceneQueries"; of["misses_cone"] = "MissesCones"; of["visit_materials"] = "VisitsMaterials"
  of["workspace"] = of["detect"] = "Detector"; of["width"] = "EchoWidth"; of["emitters"] = "PulseSource"
  of["reflections"] = of["trace"] = "Transport"; of["measured"] = "MeasuresBeam"
  of["poses"] = "MovesInLanes"; of["pulse_lanes"] = "MakesLanes"; of["derivatives"] = "Differentiable"; of["slot_from"] = "FindsSlots"; of["next_pulse"] = "SkipsBlocked"
  of["backscatter"] = of["scattered_share"] = "ScatteringLaw"; of["scattered"] = "ScattersBetween"; of["sample"] = "SamplesDirections"
  of["returned_share"] = of["returned_half_angle"] = "Retroreflects"
  of["draw_for_leg"] = "DrawsByLeg"; of["visit_errors"] = "StatesErrors"; of["judges_surfaces"] = "JudgesSurfaces"; of["power"] = "PulseForm"; of["min_share"] = "TruncatedWidthMeasure"
  for (name in of) says[name] = "As the concept " of[name] " requires."
  says["size"] = "Number of elements."
  says["all_hits"] = "Calls `visitor(hit)` with every `RayHit` of a ray, by range. Returns the number of calls."
  says["ground_height"] = "Height of the ground nearest to a height at a place; by default the highest [m]. Empty if there is none."
  says["parts"] = "Parts, as given."
  says["deterministic"] = "True if no hit depends on the key of a ray."
  says["direction_min"] = "Minimum of component k of the directions; infinite for NaN."
  says["direction_max"] = "Maximum of component k of the directions; minus infinity for NaN."
  says["offer"] = "Takes a hit of ray j with a primitive of the current part, if it counts."
  says["limit_of"] = "Largest range at which a hit of ray j still counts [m]."
  says["limit"] = "Largest range at which any hit still counts [m]; minus infinity for NaN."
  says["settings"] = "Settings, as validated."
  says["set"] = "Sets a lane."
  says["angle"] = "Elevation of the beam above forward [rad]."
  says["pulse_width"] = "Width of a laser's outgoing pulse, by the measure of its echoes [s]. Errors: as `validate`."
  says["depth"] = "Steps from the root to the deepest leaf, at most 64."
  says["data"] = says["begin"] = "Pointer to the first element."
  says["end"] = "Pointer past the last element."
  says["empty"] = "True without elements."
  says["operator[]"] = "Element `i`, from 0."
  says["operator()"] = "Takes a batch of pulses, as the concept EchoSink requires. Errors: `FileError` if a file cannot be written."
  says["close"] = "Completes the files under their final names. Errors: `FileError`."
  says["normalize"] = "Makes the rotation unit, after `validate` has accepted its norm."
  says["is_consistent"] = "True if the members that `archive` has filled fit together."
  says["sample_interval"] = "Time between two samples of a waveform [s]."
  says["passage"] = "Passage of a ray through the solid of a voxel."
  says["meeting"] = "Visitor of the voxels along ray j, for `VoxelIndex::walk`."
  says["subrays"] = "Subrays of a pulse."
  says["recorded_subrays"] = "Subrays of a pulse in its results."
  says["sink"] = "Sink that is given the points."
  says["layout"] = "Layout of the records."
  says["scan_start"] = "Start of the scan."
  says["columns"] = "Number of columns."
  says["fail_at_line"] = says["fail_at_byte"] = "Throws a FileError of a problem, at a place in this file."
  says["reads_empty_shots"] = "As the concept ChoosesShots describes."
  says["emitter_count"] = "Number of emitters."
  says["mean_specific_force"] = "As `mean_angular_rate`, of the specific force [m/s^2]."
  says["derivatives_at"] = "Pose of the sensor in the world, and its derivatives."
  says["grid"] = "Places of the points of a scan, by row and column."
  says["normal"] = "Unit normal at the hit of ray j; zero for a surface without direction."
  tag = "Empty object, to be filled by `archive`."
  overrides = "Overrides the function of the base class."
  variable_type = "^ +(alignas\\(.*\\) |static |constexpr |const )*[A-Za-z_][A-Za-z0-9_:]*(<[^ ]*(, [0-9]+)?>)? "
  variables = "^[a-z_]+(\\[[0-9]\\])*({}| = [^,()]*)?(, [a-z_]+(\\[[0-9]\\])*({}| = [^,()]*)?)*$"
  function_of_a_class = "^ +(\\[\\[[a-z_:]+\\]\\] |static |constexpr |friend |inline )*[A-Za-z_][A-Za-z0-9_:<>, ]*[&* ]+([a-z_]+(==)?|operator\\[\\]|operator\\(\\))\\("
}
FILENAME ~ /\.md$/ {
  while (match($0, /\]\((docs\/[A-Za-z0-9.\/_-]*(\.md|\.ipynb)|examples\/[a-z_.]*|[A-Z]*\.md)\)/)) {
    start = RSTART
    length_of_link = RLENGTH
    match(substr($0, 1, start), /.*\[/)
    $0 = substr($0, 1, RLENGTH - 1) substr($0, RLENGTH + 1, start - RLENGTH - 1) substr($0, start + length_of_link)
  }
  print
  next
}
/^PULSECAST_OPTIONAL_MEMBER\(/ { hidden = 1 }
/^PULSECAST_OPTIONAL_CONSTANT\(/ {
  gsub(/.*\(|[,)]/, "")
  $0 = "template <class T> concept " $1 " = T::" $2 ";"
}
/^ +using refinements = / { $0 = "" }
hidden {
  if (/\)$/) hidden = 0
  print ""
  next
}
# Each line of the list of units gives two literals.
/^#define PULSECAST_UNIT/, !/\\$/ {
  print ""
  next
}
/^PULSECAST_UNIT\(/ {
  name = substr($0, 16, index($0, ",") - 16)
  text = "/** Number with the unit `" substr(name, 2) "`, in SI units and radians. */ consteval double operator\"\"" name
  print text "(long double v); " text "(unsigned long long v);"
  next
}
function with(text, line) {
  match(line, /^ */)
  return substr(line, 1, RLENGTH) "/** " text " */ " substr(line, RLENGTH + 1)
}
/^ +static constexpr bool strides_lanes = / {
  print with("As the concept StridesLanes describes.", $0)
  next
}
# Explanation of the function declared in a line without a docstring; empty if there is none.
function explanation(line,   name) {
  if (line ~ /^ +explicit [A-Za-z]+\(DeserializeTag/) return tag
  if (line ~ /^ +(explicit )?[A-Z][A-Za-z0-9]+Lanes\(const /) return "Of components by lane, or of one value in all lanes."
  if (line ~ /^ +explicit [A-Za-z]+\(OutputFile file/) return "Writes to a file that is open. Errors: as above."
  if (line ~ /^void list_members\(/) return "Lists the members that a scene cache keeps."
  if (line ~ / std::string part\(/) return "Part of a message."
  if (line ~ /^ +struct Workspace \{/) return "Scratch memory of one worker."
  if (line ~ /^ +class Columns \{/) return "Data of the voxels that this filling needs, by number of the voxel."
  if (line ~ /^ +.*\(.* override( |;|$)/) return overrides
  if (line ~ /^ *(return|else|throw|if|for) / || !match(line, function_of_a_class)) return ""
  name = substr(line, RSTART, RLENGTH - 1)
  sub(/.*[&* ]/, "", name)
  return name in says ? says[name] : ""
}
# A docstring goes before the template.
/^ *template <.*>$/ && before !~ /^ *\/\/\// {
  held = $0
  next
}
/^ *requires / && held != "" {
  held = held "\n" $0
  next
}
{
  line = $0
  text = before ~ /^ *\/\/\// || line ~ /\/\/\/</ ? "" : explanation(line)
  if (held != "") {
    print text == "" ? held : with(text, held)
    held = text = ""
  }
  if (text != "") {
    line = with(text, line)
  } else if (match(line, /; *\/\/\/< /)) {
    text = substr(line, RSTART + RLENGTH)
    list = substr(line, 1, RSTART - 1)
    if (match(list, variable_type)) {
      type = substr(list, 1, RLENGTH)
      list = substr(list, RLENGTH + 1)
      if (list ~ /, / && list ~ variables) {
        n = split(list, one, /, /)
        line = ""
        for (i = 1; i <= n; ++i) line = line type one[i] "; /**< " text " */ "
      }
    }
  }
  print line
  if (line !~ /^ *(template <.*>$|requires )/) before = $0
}
