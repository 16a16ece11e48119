// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "outputs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>

#include <pulsecast/base/text.hpp>
#include <pulsecast/io/geojson.hpp>
#include <pulsecast/io/misses.hpp>
#include <pulsecast/io/png.hpp>
#include <pulsecast/io/text_files.hpp>
#include <pulsecast/io/trajectory.hpp>
#include <pulsecast/shape/hillshade.hpp>

#include "loading.hpp"
#include "parts.hpp"
#include "point_formats.hpp"

namespace fs = std::filesystem;
using namespace pulsecast;

namespace {

using SensorPose = Pose<frame::Instrument, frame::World>;

/// Poses of the scanner in some legs, which outlive it: of the last that has begun.
Options::Sensor sensor_of(std::vector<std::pair<Tick, const helios::SurveyLeg*>> legs) {
  return [legs = std::move(legs)](Tick tick) -> SensorPose {
    auto at = std::find_if(legs.rbegin(), legs.rend(), [&](const auto& leg) { return leg.first <= tick; });
    if (at == legs.rend()) return legs.front().second->instrument_at({});
    Tick since{tick.second - at->first.second, tick.fraction - at->first.fraction};
    if (since.fraction < 0) since = {since.second - 1, since.fraction + 1};
    return at->second->instrument_at(std::min(since, at->second->duration()));
  };
}

/// Grid of a leg for PTX. Throws std::invalid_argument if its pulses are in none.
io::PtxScan ptx_scan(const helios::SurveySettings& survey, const helios::CompiledSurvey& compiled, std::size_t k) {
  const helios::CompiledSurvey::Leg& leg = compiled.legs[k];
  const helios::SurveyLeg& of_leg = compiled.source.legs()[k];
  const auto refuse = [&](const std::string& problem) {
    throw std::invalid_argument("--format ptx: leg " + std::to_string(leg.number) + " " + problem +
                                "; --format npz or laz takes any scan");
  };
  if (survey.scanner.channels.size() != 1) refuse("has several channels: expected one");
  if (!std::holds_alternative<helios::RotatingOptic>(survey.scanner.channels.front().optic))
    refuse("has another optic: expected a rotating mirror, whose lines are the columns of a grid");
  const SensorPose pose = of_leg.instrument_at({});
  for (const double share : {0.3, 0.7, 1.0}) {
    const SensorPose later = of_leg.instrument_at(Tick::of_seconds(share * leg.duration.seconds()));
    if (later.position != pose.position || later.rotation != pose.rotation)
      refuse("moves: expected a scanner on a tripod");
  }
  const double rate = survey.legs[leg.number].scanner.scan_rate, slots = rate > 0 ? leg.pulse_rate / rate : 0;
  const double whole = std::nearbyint(slots);
  if (!(whole >= 1) || std::fabs(slots - whole) > 1e-9 * whole)
    refuse("has " + text::to_text(slots) + " pulses a line: expected pulseFreq_hz to be a multiple of scanFreq_hz");
  io::PtxScan scan{
      .first = leg.first, .end = leg.end, .line_slots = static_cast<std::uint64_t>(whole), .scanner = pose};
  // Rows are the slots of a line in which the mirror lets pulses out: all but the longest gap.
  std::vector<char> open(scan.line_slots, 0);
  const PulseIndex some = std::min(leg.end, leg.first + 8 * scan.line_slots);
  for (PulseIndex i = leg.first; i < some; ++i)
    if (compiled.source.pulse(i)) open[(i - leg.first) % scan.line_slots] = 1;
  std::uint64_t gap = 0, longest = 0, begin = 0;
  for (std::uint64_t i = 0; i < 2 * scan.line_slots; ++i) {
    gap = open[i % scan.line_slots] != 0 ? 0 : gap + 1;
    if (gap > longest && gap <= scan.line_slots) {
      longest = gap;
      begin = (i + 1) % scan.line_slots;
    }
  }
  if (longest == scan.line_slots) refuse("has no pulses: expected angles in which the mirror lets some out");
  scan.rows = scan.line_slots - longest;
  scan.before = (scan.line_slots - begin) % scan.line_slots;
  return scan;
}

}  // namespace

void take_columns(Options& o, const helios::SurveySettings& survey, const helios::Simulation& simulation) {
  const helios::CompiledSurvey& compiled = simulation.compiled();
  std::map<std::string, std::vector<std::pair<Tick, const helios::SurveyLeg*>>> legs;
  o.ptx_scans.clear();
  for (std::size_t k = 0; k < compiled.legs.size(); ++k) {
    const helios::CompiledSurvey::Leg& leg = compiled.legs[k];
    if (!leg.active) continue;
    for (const std::string& prefix : {prefix_of(leg), whole_run}) {
      legs[prefix].emplace_back(leg.start, &compiled.source.legs()[k]);
      if (o.format == "ptx" && leg.end > leg.first) o.ptx_scans[prefix].push_back(ptx_scan(survey, compiled, k));
      if (o.format == "ptx") o.ptx_scans[prefix];
    }
  }
  if (!legs.empty()) {
    constexpr double step = 1000;  // [m]: at such distances, single precision errs by less than 0.1 mm
    const Vec3 at = legs[whole_run].front().second->instrument_at({}).position;
    for (int axis = 0; axis < 3; ++axis) o.origin[axis] = std::nearbyint(at[axis] / step) * step + 0.0;
  }
  o.sensors.clear();
  for (auto& [prefix, of_prefix] : legs) o.sensors[prefix] = sensor_of(std::move(of_prefix));
  o.points = simulation.points();
  if (o.colours) o.point_colours = o.points.colours;
  o.attributes = std::make_shared<const ObjectAttributes>(o.points.attributes);
  if (o.attributes->empty()) o.attributes.reset();
  o.fields = io::layouts::columns(o.columns, o.points.attributes.names());
  if (o.uncertainty)
    for (const io::PointField& field : io::layouts::uncertainty()) o.fields.push_back(field);
}

io::PointLayout point_layout(const Options& o) {
  std::vector<io::PointField> fields = io::layouts::columns(io::usual_point_columns);
  const auto add = [&](const std::vector<io::PointField>& more) {
    for (const io::PointField& field : more)
      if (std::ranges::find(fields, field.name, &io::PointField::name) == fields.end()) fields.push_back(field);
  };
  const bool is_single = o.format == "pcd" || o.format == "mcap";  // as PCL and the viewers of ROS expect
  for (std::size_t k = 0; is_single && k < 3; ++k) fields[k].type = io::NumberType::float32;
  add(io::layouts::columns({io::column("clock"), io::column("ring")}));
  if (o.colours)
    add(o.format == "ply" ? io::layouts::colours()
        : is_single       ? io::layouts::packed_colour()
                          : io::layouts::columns({io::column("red"), io::column("green"), io::column("blue")}));
  if (o.near_infrared) add(io::layouts::columns({io::column("near_infrared")}));
  if (o.attributes) add(io::layouts::attributes(o.attributes->names()));
  add(o.fields);
  for (io::PointField& field : fields)  // Open3D leaves out properties of the types ushort and uint
    if (o.format == "ply" && (field.type == io::NumberType::uint16 || field.type == io::NumberType::uint32))
      field.type = field.type == io::NumberType::uint16 ? io::NumberType::int32 : io::NumberType::float64;
  return io::PointLayout::packed(fields);
}

io::PointTextColumns text_columns(const Options& o) { return {o.fields, o.points}; }

std::vector<std::string> file_channels(const Options& o, const helios::SurveySettings& survey) {
  std::vector<std::string> ids;
  if (o.split_by_channel && survey.scanner.channels.size() > 1)
    for (const auto& channel : survey.scanner.channels)
      ids.push_back(channel.id.empty() ? std::to_string(ids.size()) : channel.id);
  return ids;
}

std::string prefix_of(const helios::CompiledSurvey::Leg& leg) {
  if (leg.strip) return "strip" + std::string(3 - std::min<std::size_t>(3, leg.strip->size()), '0') + *leg.strip;
  const std::string number = std::to_string(leg.number);
  return "leg" + std::string(3 - std::min<std::size_t>(3, number.size()), '0') + number;
}

std::vector<fs::path> point_files(const fs::path& folder, const std::string& prefix, const Options& o,
                                  const std::vector<std::string>& channels) {
  if (channels.empty()) return {folder / (prefix + "_points." + o.format)};
  std::vector<fs::path> all;
  for (const std::string& channel : channels)
    all.push_back(folder / (prefix + "_points_dev" + channel + '.' + o.format));
  return all;
}

namespace {
std::string waveform_ending(const Options& o) {
  return point_format(o.format).waveform_arrays ? "_fullwave.npz" : "_fullwave.txt";
}
}  // namespace

std::vector<fs::path> leg_files(const fs::path& folder, const std::string& prefix, const Options& o,
                                const std::vector<std::string>& channels) {
  std::vector<fs::path> all;
  for (const fs::path& points : point_files(folder, prefix, o, channels)) {
    all.push_back(points);
    if (las_settings(o, 0).waveforms) all.push_back(fs::path(points).replace_extension(".wdp"));
  }
  all.push_back(folder / (prefix + "_trajectory.txt"));
  if (o.write_waveform) all.push_back(folder / (prefix + waveform_ending(o)));
  if (o.write_pulse) all.push_back(folder / (prefix + "_pulse.txt"));
  if (o.write_misses) all.push_back(folder / (prefix + "_misses.txt"));
  if (o.geojson) all.push_back(folder / (prefix + "_map.geojson"));
  return all;
}

io::LasSettings las_settings(const Options& o, double start_time) {
  io::LasSettings settings{.scale = o.las_scale,
                           .gps_time = o.adjusted_time ? io::GpsTime::adjusted_standard : io::GpsTime::week,
                           .start_time = start_time};
  settings.reference = o.reference.value_or(io::SpatialReference{});
  settings.light_kinds = o.light_paths;
  settings.colours = o.point_colours;
  settings.near_infrared = o.near_infrared && o.point_colours;
  settings.attributes = o.attributes;
  for (const io::PointField& field : o.fields)
    if (field.column != &io::attribute_column) settings.columns.push_back(field);  // LAS has all attributes
  settings.points = o.points;
  if (o.format == "las" && o.las_1_0) settings.format = io::LasFormat::las_1_0;
  settings.waveforms = o.format == "las" && o.write_waveform && !o.las_1_0;
  return settings;
}

struct LegFiles::Inside {
  std::vector<std::unique_ptr<PointFile>> points{};
  io::TrajectoryWriter trajectory;
  std::optional<io::WaveformTextWriter> waveforms{};
  std::unique_ptr<PointFile> waveform_arrays{};
  std::optional<io::PulseTextWriter> pulses{};
  std::optional<io::MissTextWriter> misses{};
  std::optional<io::MissPoints> miss_points{};
  std::unique_ptr<PointFile> map{};
  std::vector<Shot> shots{};
  bool in_scans = false;  // also of pulses without echoes
};

LegFiles::LegFiles(const fs::path& folder, const std::string& prefix, const Options& o, double start_time,
                   const std::vector<std::string>& channels)
    : inside_(new Inside{.trajectory =
                             io::TrajectoryWriter(folder / (prefix + "_trajectory.txt"), {.start_time = start_time})}) {
  inside_->in_scans = point_format(o.format).in_scans;
  for (const fs::path& path : point_files(folder, prefix, o, channels)) {
    std::error_code error;
    if (o.format == "kitti") fs::remove_all(path, error);  // the folder that a run before left
    inside_->points.push_back(point_file(path, prefix, o, start_time));
  }
  if (o.write_waveform && !point_format(o.format).waveform_arrays)
    inside_->waveforms.emplace(folder / (prefix + waveform_ending(o)),
                               io::TextFileSettings{start_time, o.waveform_bins});
  if (o.write_waveform && point_format(o.format).waveform_arrays)
    inside_->waveform_arrays = part<ArraysPart>().waveforms(folder / (prefix + waveform_ending(o)), start_time);
  if (o.write_pulse) inside_->pulses.emplace(folder / (prefix + "_pulse.txt"), io::TextFileSettings{start_time});
  if (o.write_misses) inside_->misses.emplace(folder / (prefix + "_misses.txt"), io::TextFileSettings{start_time});
  if (o.misses_at) inside_->miss_points.emplace(io::MissSettings{.range = *o.misses_at});
  if (o.geojson) inside_->map = map_file(folder / (prefix + "_map.geojson"), o);
}
LegFiles::~LegFiles() = default;

void LegFiles::operator()(const EchoBatch& batch) {
  const EchoBatch points = inside_->miss_points ? (*inside_->miss_points)(batch) : batch;
  for (std::size_t k = 0; k < inside_->points.size(); ++k) {
    EchoBatch part = points;
    if (inside_->points.size() > 1) {
      inside_->shots.clear();
      for (const Shot& shot : points.shots)
        if (shot.channel == k) inside_->shots.push_back(shot);
      part.shots = inside_->shots;
    }
    (*inside_->points[k])(part);
  }
  if (inside_->waveforms) (*inside_->waveforms)(batch);
  if (inside_->waveform_arrays) (*inside_->waveform_arrays)(batch);
  if (inside_->pulses) (*inside_->pulses)(batch);
  if (inside_->misses) (*inside_->misses)(batch);
  if (inside_->map) (*inside_->map)(batch);
}

bool LegFiles::reads_empty_shots() const noexcept {
  return inside_->in_scans || inside_->pulses || inside_->misses || inside_->miss_points || inside_->map;
}

void LegFiles::add_trajectory(const helios::SurveyLeg& leg, Tick start, double interval) {
  if (interval > 0) inside_->trajectory.add(leg.path(), start, leg.recorded(), interval);
}

void LegFiles::close() {
  if (inside_->waveforms) inside_->waveforms->close();
  if (inside_->waveform_arrays) inside_->waveform_arrays->close();
  if (inside_->pulses) inside_->pulses->close();
  if (inside_->misses) inside_->misses->close();
  if (inside_->map) inside_->map->close();
  inside_->trajectory.close();
  for (const auto& file : inside_->points) file->close();
}

LeftOut LegFiles::left_out() const {
  LeftOut sum;
  for (const auto& file : inside_->points) file->count(sum);
  if (inside_->waveforms)
    sum.add({.waveforms_cut = inside_->waveforms->waveforms_cut(), .samples_max = inside_->waveforms->samples_max()});
  return sum;
}

std::unique_ptr<PointFile> map_file(const fs::path& path, const Options& o) {
  const io::SpatialReference in = o.reference.value_or(io::SpatialReference{});
  return std::make_unique<WrittenFile<io::GeoJsonWriter>>(
      path, io::GeoJsonSettings{.epsg = in.epsg, .unit = in.unit, .vertical_unit = in.vertical_unit});
}

namespace {

class Picture final : public WrittenFile<io::ImageWriter> {
 public:
  Picture(const fs::path& path, const helios::SurveySettings& survey)
      : WrittenFile(path, io::ImageSettings{.frame_on = io::FrameOn::standing}) {
    for_each_raster(survey, [this](const Raster& raster, const Placement& placement) {
      writer_.add_ground(raster, hillshade(raster), placement);
    });
  }
};

}  // namespace

std::unique_ptr<PointFile> picture_file(const fs::path& path, const helios::SurveySettings& survey) {
  return std::make_unique<Picture>(path, survey);
}
